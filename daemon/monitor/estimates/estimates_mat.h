#pragma once

#include <string>
#include <vector>

#include <framewatch/window_estimate_t.hpp>

#include "drivers/files/partial_file.h"

namespace framewatch::daemon {

/// Collects estimates and writes them as a MATLAB file, version 5 (docs/formats.md): `parameter`
/// and `unit`, columns of names; `window_end_s` and `status`, columns; `value`, `std_error` and
/// `observable`, windows x parameters; with boxplots `q1`, `median`, `q3`, `whisker_low`,
/// `whisker_high`, `outliers` likewise. NaN where there is no value. The same estimates give the
/// same bytes. A variable of that format holds at most 2 GiB.
class EstimatesMatWriter {
 public:
  [[nodiscard]] bool open(const std::string& path, const std::vector<std::string>& names,
                          const std::vector<std::string>& units, bool boxplot);
  [[nodiscard]] bool write(const framewatch::window_estimate_t& estimate);
  [[nodiscard]] bool close();
  const std::string& error() const { return error_; }

 private:
  struct Column {
    const char* name;
    std::vector<double> values;  ///< window-major
  };

  drivers::PartialFile out_;
  std::string error_;
  std::vector<std::string> names_, units_;
  bool boxplot_ = false;
  std::vector<double> end_s_, status_;
  std::vector<Column> columns_;
};

}  // namespace framewatch::daemon
