#pragma once

#include <functional>
#include <string>
#include <vector>

struct _mat_t;

namespace framewatch::daemon {

/// What goes into a MATLAB file, version 5. Each returns false when it cannot be written.
class MatFile {
 public:
  /// A variable of that format holds at most this.
  static constexpr std::size_t kMostBytes = std::size_t{1} << 31;

  explicit MatFile(_mat_t* file) : file_(file) {}
  /// rows x columns from values in row-major order.
  [[nodiscard]] bool matrix(const char* name, const std::vector<double>& values,
                            std::size_t columns);
  /// A column of texts.
  [[nodiscard]] bool texts(const char* name, std::vector<std::string> texts);

 private:
  _mat_t* file_;
};

/// Writes what `fill` puts into it as PATH.partial, renamed when it is whole. The same content
/// gives the same bytes. Empty, or why not; then nothing stays.
std::string write_mat_file(const std::string& path, const std::function<bool(MatFile&)>& fill);

}  // namespace framewatch::daemon
