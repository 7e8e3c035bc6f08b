// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "drivers/files/file_problems.h"

namespace framewatch::daemon {

/// Writes the window_estimate_t on `channel` of a log as estimates CSV (docs/formats.md), with the
/// parameter_table_t of the same log; compressed if the name ends in .gz. Returns false, with every
/// problem and without a file, when the log is damaged, has no table or holds a message that breaks
/// the rules of its type.
bool write_estimates_csv(const std::string& log, const std::string& channel, bool boxplot,
                         const std::string& out, std::vector<drivers::Problem>& problems);

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
