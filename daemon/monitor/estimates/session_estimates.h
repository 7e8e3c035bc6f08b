// SPDX-License-Identifier: MIT
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

/// The statement of a model_fit_t about every parameter: relative error of its absolute value, and
/// the word for it.
struct ModelFitTold {
  std::int64_t end_us = 0;
  std::vector<double> error;
  std::vector<std::int32_t> word;
};

/// The main window's estimates of one session. Parameters are in the order of the table, windows in
/// the order of the log.
struct SessionEstimates {
  parameter_table_t table{};  ///< the first one: the estimator began with its design
  std::vector<std::int64_t> start_us, end_us;  ///< sensor time
  std::vector<double> residual_ratio;
  std::vector<std::vector<double>> value, std_error;  ///< [parameter][window], SI; NaN: no value
  std::vector<std::vector<std::uint8_t>> reason;      ///< [parameter][window]: told_reason()
  std::vector<ModelFitTold> model_fit;                ///< in the order of the log
  std::optional<status_t> status;                     ///< the last one
  std::optional<watch_t> watch;                       ///< the last one; empty without [watch]
  std::vector<event_t> events;
  std::vector<std::string> notes;  ///< damaged parts that were left out, for the user

  std::size_t windows() const { return end_us.size(); }
  std::size_t parameters() const { return value.size(); }
  /// Returns true if [watch] compared this parameter with a baseline; the events then say what
  /// changed.
  bool compared(std::size_t parameter) const;
};

/// The windows `from` to `to` - 1.
struct WindowRange {
  std::size_t from = 0, to = 0;
  std::size_t size() const { return to - from; }
};

/// Reads an event log of estimates. Leaves out damaged or truncated parts and notes them, so that a
/// session that ended in a power cut has a report. Returns nullopt, with the problems, if nothing
/// is left.
std::optional<SessionEstimates> read_session_estimates(const std::string& path,
                                                       std::vector<drivers::Problem>& problems);

/// Returns the windows that lie completely between two times.
WindowRange windows_within(const SessionEstimates& session, std::int64_t from_us,
                           std::int64_t to_us);

/// Returns the last model fit that was published within these windows; nullptr without any.
const ModelFitTold* model_fit_at_end(const SessionEstimates& session, WindowRange windows);

/// Returns the statistics that BoxplotWindow gives for these values. Ignores values that are not
/// finite.
estimator::BoxplotStatistics boxplot_of(std::vector<double> values);

}  // namespace framewatch::daemon
