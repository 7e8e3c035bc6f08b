// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <framewatch/window_estimate_t.hpp>

#include "daemon/config/config.h"
#include "drivers/files/file_problems.h"
#include "drivers/files/partial_file.h"
#include "drivers/files/text_output.h"
#include "drivers/records/record.h"

namespace framewatch::daemon {

/// Writes estimates as CSV, one row per window (docs/formats.md), compressed if the name ends in
/// .gz. Methods return false when the file cannot be written or a message breaks the rules of its
/// type; error() says why.
class EstimatesCsvWriter {
 public:
  /// Continues a table: the file gets no header. Call it before open().
  void continue_table() { continued_ = true; }
  [[nodiscard]] bool open(const std::string& path, const std::vector<std::string>& names,
                          const std::vector<std::string>& units, bool boxplot);
  /// Adds a row.
  [[nodiscard]] bool write(const framewatch::window_estimate_t& estimate);
  [[nodiscard]] bool close();
  const std::string& error() const { return fault_.empty() ? file_.error() : fault_; }
  /// Returns true if a message caused the failure.
  bool at_fault() const { return !fault_.empty(); }

 private:
  drivers::TextOutput file_;
  std::string fault_;
  std::size_t parameters_ = 0;
  bool boxplot_ = false, continued_ = false;
};

/// Returns what is wrong with an estimate of that many parameters; empty if it is valid.
std::string fault_of(const framewatch::window_estimate_t& estimate, std::size_t parameters);

/// Writes the window_estimate_t on `channel` of a log as estimates CSV (docs/formats.md), with the
/// parameter_table_t of the same log; compressed if the name ends in .gz. Returns false, with every
/// problem and without a file, when the log is damaged, has no table or holds a message that breaks
/// the rules of its type.
bool write_estimates_csv(const std::string& log, const std::string& channel, bool boxplot,
                         const std::string& out, std::vector<drivers::Problem>& problems);

/// Collects estimates and writes them as a MATLAB file, version 5 (docs/formats.md). Variables:
/// `parameter` and `unit`, columns of names; `window_end_s` and `status`, columns; `value`,
/// `std_error` and `observable`, windows x parameters; with boxplots also `q1`, `median`, `q3`,
/// `whisker_low`, `whisker_high`, `outliers`, windows x parameters. NaN stands for a missing value.
/// Equal estimates give byte-identical files. The format limits each variable to 2 GiB.
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

/// Receives the messages of a replay.
class EstimateOutput {
 public:
  virtual ~EstimateOutput() = default;
  /// Stores or sends a message. Returns false on failure, as close() does; error() says why.
  [[nodiscard]] virtual bool put(std::int64_t time_us, const std::string& channel,
                                 const std::vector<std::uint8_t>& bytes) = 0;
  /// Completes the output. A file gets its final name only here; without close() no file remains.
  [[nodiscard]] virtual bool close() = 0;
  virtual std::string error() const = 0;
  /// Returns the number of the next event; 0 for outputs without events.
  virtual std::int64_t events() const { return 0; }
};

/// Returns the rule that the name of an output breaks; empty if the name is valid.
std::string problem_of_output_name(const std::string& path);

struct EstimateFile {
  std::string path;
  bool boxplot = false;    ///< with the boxplot statistics, in .csv and .mat
  bool goes_on = false;    ///< continues another part: a .csv gets no header
  std::int64_t event = 0;  ///< number of the first event
};

/// Makes an output by the ending of its name: .lcmlog holds every message; .csv, .csv.gz and .mat
/// hold the main window's estimates. Returns nullptr and sets `error` on failure.
std::unique_ptr<EstimateOutput> estimate_output(const Config& config, const EstimateFile& file,
                                                std::string& error);

/// Makes an output that publishes the messages on LCM. Returns nullptr and sets `error` when LCM
/// cannot start with that URL.
std::unique_ptr<EstimateOutput> lcm_estimate_output(const Config& config, const std::string& url,
                                                    std::string& error);

}  // namespace framewatch::daemon
