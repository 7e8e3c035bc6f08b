#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <framewatch/event_t.hpp>
#include <framewatch/model_fit_t.hpp>
#include <framewatch/parameter_table_t.hpp>
#include <framewatch/status_t.hpp>
#include <framewatch/watch_t.hpp>

#include "drivers/files/file_problems.h"
#include "drivers/records/record.h"
#include "estimator/identify/estimate/estimate.h"

namespace framewatch::daemon {

/// What model_fit_t says of every parameter: relative error of its absolute value, and the word.
struct ModelFitTold {
  std::int64_t end_us = 0;
  std::vector<double> error;
  std::vector<std::int32_t> word;
};

/// The estimates of one session, of the main window only. Parameters in the order of the
/// table, windows in the order of the log.
struct SessionEstimates {
  parameter_table_t table{};  ///< the first one: its design is the one the estimator began with
  std::vector<std::int64_t> start_us, end_us;  ///< sensor time
  std::vector<double> residual_ratio;
  std::vector<std::vector<double>> value, std_error;  ///< [parameter][window], SI; NaN: none
  std::vector<std::vector<std::uint8_t>> reason;      ///< [parameter][window]: told_reason()
  std::vector<ModelFitTold> model_fit;                ///< in the order of the log
  std::optional<status_t> status;                     ///< the last one
  std::optional<watch_t> watch;                       ///< the last one; none: without [watch]
  std::vector<event_t> events;
  std::vector<std::string> notes;  ///< damage that was left out, for the person

  std::size_t windows() const { return end_us.size(); }
  std::size_t parameters() const { return value.size(); }
  /// Whether [watch] compared this parameter with a baseline: then the events say what changed.
  bool compared(std::size_t parameter) const;
};

/// Windows `from` to `to` - 1.
struct WindowRange {
  std::size_t from = 0, to = 0;
  std::size_t size() const { return to - from; }
};

/// Reads an event log of estimates. Damaged or truncated parts are left out and noted, so that a
/// session that ended in a power cut has a report too. Empty, with the problems, when nothing is
/// left.
std::optional<SessionEstimates> read_session_estimates(const std::string& path,
                                                       std::vector<drivers::Problem>& problems);

/// Windows that lie wholly between two times.
WindowRange windows_within(const SessionEstimates& session, std::int64_t from_us,
                           std::int64_t to_us);

/// The last one that was told within these windows; null: none was.
const ModelFitTold* model_fit_at_end(const SessionEstimates& session, WindowRange windows);

/// The statistics that BoxplotWindow gives for these values, of any number of them at once; those
/// that are not finite do not count.
estimator::BoxplotStatistics boxplot_of(std::vector<double> values);

}  // namespace framewatch::daemon
