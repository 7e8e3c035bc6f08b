#pragma once

#include <string>
#include <vector>

#include <framewatch/parameter_table_t.hpp>
#include <framewatch/window_estimate_t.hpp>

namespace framewatch::daemon {

/// The largest relative error of the estimates, |estimate - truth| / truth.
struct GroupError {
  double worst_ratio = 0;
  std::string worst;                 ///< parameter name
  std::vector<std::string> without;  ///< parameters that have no estimate
};

struct EstimateErrors {
  GroupError frames;  ///< stiffness of frames
  GroupError panels;  ///< stiffness of floor panels
};

/// `truth` in the table's order and units.
EstimateErrors errors_against(const framewatch::parameter_table_t& table,
                              const framewatch::window_estimate_t& estimate,
                              const std::vector<double>& truth);

/// A header and one line per parameter: truth, estimate, error, standard error, status, quartiles.
/// Stiffness in kN, damping in N.
std::vector<std::string> estimate_table(const framewatch::parameter_table_t& table,
                                        const framewatch::window_estimate_t& estimate,
                                        const std::vector<double>& truth);

/// The reasons of window_estimate_t, and one more that follows from them: its element moves enough,
/// but what the window says of it is too uncertain: it contradicts the other channels, or cannot be
/// told from another element.
inline constexpr int kTooUncertain = 6, kReasons = 7;

/// reason of a parameter that has so much regressor energy (snr); min_snr: estimator.min_snr.
constexpr int told_reason(int reason, double snr, double min_snr) {
  return reason == 2 && snr > min_snr ? kTooUncertain : reason;
}

/// "ok", "warming up", "quiet", "floor too stiff", "plan symmetric", "channel lost", "too
/// uncertain".
const char* reason_word(int reason);

}  // namespace framewatch::daemon
