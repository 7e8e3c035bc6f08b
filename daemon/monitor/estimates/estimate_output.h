#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <framewatch/window_estimate_t.hpp>

#include "daemon/config/config.h"
#include "drivers/files/partial_file.h"
#include "drivers/files/problem.h"
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

/// Takes the messages of a replay.
class EstimateOutput {
 public:
  virtual ~EstimateOutput() = default;
  /// False when it cannot be stored or sent; error() says why, here and below.
  [[nodiscard]] virtual bool put(std::int64_t time_us, const std::string& channel,
                                 const std::vector<std::uint8_t>& bytes) = 0;
  /// A file gets its final name only here; without close() no file is left.
  [[nodiscard]] virtual bool close() = 0;
  virtual std::string error() const = 0;
  /// Number of the next event, where events have one.
  virtual std::int64_t events() const { return 0; }
};

/// The rule that the name of an output breaks; empty when it is valid.
std::string problem_of_output_name(const std::string& path);

struct EstimateFile {
  std::string path;
  bool boxplot = false;    ///< statistics too, in .csv and .mat
  bool goes_on = false;    ///< after another part: a .csv has no header of its own
  std::int64_t event = 0;  ///< number of the first event
};

/// By the name's end: .lcmlog holds every message, .csv, .csv.gz and .mat the main window's
/// estimates. Null, and the reason, when it cannot be made.
std::unique_ptr<EstimateOutput> estimate_output(const Config& config, const EstimateFile& file,
                                                std::string& error);

/// Publishes the messages on LCM. Null, with the reason, when LCM cannot start with that URL.
std::unique_ptr<EstimateOutput> lcm_estimate_output(const Config& config, const std::string& url,
                                                    std::string& error);

}  // namespace framewatch::daemon
