// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::python {

/// A valid configuration and the text that it was read from.
class Building {
 public:
  /// path: of the text, or its name in messages; paths in the text are relative to it. Throws Error
  /// with every problem.
  Building(std::string path, std::string text);

  const daemon::Config& config() const { return config_; }
  const std::string& path() const { return config_.path; }
  const std::string& text() const { return text_; }
  const estimator::ParameterTable& table() const { return table_; }

 private:
  std::string text_;
  daemon::Config config_;
  estimator::ParameterTable table_;
};

}  // namespace framewatch::python
