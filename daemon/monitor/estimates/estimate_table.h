// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <framewatch/parameter_table_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "estimator/identify/estimate/estimate.h"

namespace framewatch::daemon {

/// A column of boxplot statistics in an estimate.
struct BoxColumn {
  const char* name;
  std::vector<double> framewatch::window_estimate_t::*values;  ///< by parameter
  double estimator::BoxplotStatistics::*value;
};
inline constexpr BoxColumn kBoxColumns[] = {
    {"q1", &window_estimate_t::q1, &estimator::BoxplotStatistics::q1},
    {"median", &window_estimate_t::median, &estimator::BoxplotStatistics::median},
    {"q3", &window_estimate_t::q3, &estimator::BoxplotStatistics::q3},
    {"whisker_low", &window_estimate_t::whisker_low, &estimator::BoxplotStatistics::whisker_low},
    {"whisker_high", &window_estimate_t::whisker_high, &estimator::BoxplotStatistics::whisker_high},
};

/// The largest relative error, |estimate - truth| / truth, of a group of parameters.
struct GroupError {
  double worst_ratio = 0;
  std::string worst;                 ///< name of the parameter with that error
  std::vector<std::string> without;  ///< names of the parameters without an estimate
};

struct EstimateErrors {
  GroupError frames;  ///< stiffness of frames
  GroupError panels;  ///< stiffness of floor panels
};

/// Compares an estimate with `truth`, which has the order and units of the table.
EstimateErrors errors_against(const framewatch::parameter_table_t& table,
                              const framewatch::window_estimate_t& estimate,
                              const std::vector<double>& truth);

/// Returns a header and one line per parameter: truth, estimate, error, standard error, status,
/// quartiles. Stiffness in kN, damping in N.
std::vector<std::string> estimate_table(const framewatch::parameter_table_t& table,
                                        const framewatch::window_estimate_t& estimate,
                                        const std::vector<double>& truth);

/// The number of reasons of window_estimate_t, and one that follows from them. kTooUncertain: the
/// element moves enough, but the window contradicts the other channels or cannot tell the element
/// from another one.
inline constexpr int kTooUncertain = 6, kReasons = 7;

/// Returns the reason of a parameter with the regressor energy `snr`; `min_snr` is
/// estimator.min_snr.
constexpr int told_reason(int reason, double snr, double min_snr) {
  return reason == 2 && snr > min_snr ? kTooUncertain : reason;
}

/// Returns "ok", "warming up", "quiet", "floor too stiff", "plan symmetric", "channel lost" or "too
/// uncertain".
const char* reason_word(int reason);

}  // namespace framewatch::daemon
