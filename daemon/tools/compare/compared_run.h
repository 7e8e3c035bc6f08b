// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/base/record_file_arguments.h"
#include "daemon/tools/compare/run_modes.h"
#include "daemon/tools/report/session_report.h"
#include "estimator/watch/change_point.h"

namespace framewatch::daemon {

/// One side of a comparison: what is known of a building from one source.
struct ComparedRun {
  std::string name;  ///< as people gave it, without folders if that is unique
  std::string what;  ///< "record", "session", "log of estimates", "history", "configuration"
  /// Holds what the source has: without samples no motion, without a log only the table.
  SessionReport report;
  /// By parameter: the mean of windows that do not overlap; of an element that changed, of those
  /// after its last change. NaN without windows; count 0 and error 0 for a design.
  std::vector<estimator::WindowMean> values;
  RunModes modes;
  std::vector<std::string> notes;  ///< for the reader, one sentence each

  const parameter_table_t& table() const { return report.estimates.table; }
  /// Returns the transfer functions after a change within the run, or those of a run without one.
  const std::vector<TransferFunction>& transfer() const {
    return report.transfer_after.empty() ? report.transfer : report.transfer_after;
  }
};

/// Options for reading a source.
struct RunOptions {
  std::string config;  ///< of record files and raw logs; empty: sources state their own
  RecordFileArguments record;
};

/// Reads a source. Returns nullopt, with every problem, if it cannot.
///
/// A folder of `framewatch record` brings its configuration, unless one is given. Record files and
/// raw logs are replayed with the given one. PLACE@FROM..TO stands for the summaries of a history
/// between two times (UTC, or seconds since 1970, either may be left out); PLACE is a configuration
/// or the folder of the history. A configuration alone stands for its design.
std::optional<ComparedRun> read_run(const std::string& source, const RunOptions& options,
                                    std::vector<std::string>& problems);

}  // namespace framewatch::daemon
