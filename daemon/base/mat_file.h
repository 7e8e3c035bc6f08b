// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "drivers/files/partial_file.h"

struct _mat_t;

namespace framewatch::daemon {

/// Writes variables into a MATLAB file, version 5. Each call returns false on failure.
class MatFile {
 public:
  /// Largest variable in that format.
  static constexpr std::size_t kMaxBytes = std::size_t{1} << 31;

  explicit MatFile(_mat_t* file) : file_(file) {}
  /// Writes a matrix of `columns` columns from `values` in row-major order.
  [[nodiscard]] bool matrix(const char* name, const std::vector<double>& values,
                            std::size_t columns);
  /// Writes a column of texts.
  [[nodiscard]] bool texts(const char* name, std::vector<std::string> texts);

 private:
  _mat_t* file_;
};

/// Creates a file with the variables that `fill` writes, as a PartialFile that is renamed when
/// complete. Equal content gives equal bytes. Returns an empty string, or the reason of a failure;
/// then no file is left.
std::string write_mat_file(drivers::PartialFile& out, const std::function<bool(MatFile&)>& fill);
std::string write_mat_file(const std::string& path, const std::function<bool(MatFile&)>& fill);

}  // namespace framewatch::daemon
