#pragma once

#include <string>
#include <vector>

#include <framewatch/window_estimate_t.hpp>

#include "drivers/files/file_problems.h"
#include "drivers/files/text_output.h"
#include "drivers/records/record.h"

namespace framewatch::daemon {

/// Writes estimates as CSV, one row per window (docs/formats.md), .gz when the name says so. False
/// when the file cannot be written or the message breaks its type's rules; error() says why.
class EstimatesCsvWriter {
 public:
  /// To be called before open(): the file continues a table and gets no header.
  void continue_table() { continued_ = true; }
  [[nodiscard]] bool open(const std::string& path, const std::vector<std::string>& names,
                          const std::vector<std::string>& units, bool boxplot);
  [[nodiscard]] bool write(const framewatch::window_estimate_t& estimate);
  [[nodiscard]] bool close();
  const std::string& error() const { return fault_.empty() ? file_.error() : fault_; }
  /// It was the message.
  bool at_fault() const { return !fault_.empty(); }

 private:
  drivers::TextOutput file_;
  std::string fault_;
  std::size_t parameters_ = 0;
  bool boxplot_ = false, continued_ = false;
};

/// Says what is wrong with an estimate of that many parameters; empty when it is valid.
std::string fault_of(const framewatch::window_estimate_t& estimate, std::size_t parameters);

/// Writes the window_estimate_t on `channel` of a log as estimates CSV (docs/formats.md), .gz when
/// the name says so, with the parameter_table_t of the same log. False, with every problem and no
/// file, when the log is damaged, has no table or holds a message that breaks its type's rules.
bool write_estimates_csv(const std::string& log, const std::string& channel, bool boxplot,
                         const std::string& out, std::vector<drivers::Problem>& problems);

}  // namespace framewatch::daemon
