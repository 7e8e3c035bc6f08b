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

/// "ok", "warming up", "quiet", "floor too stiff", "plan symmetric", "channel lost".
const char* reason_word(int reason);

}  // namespace framewatch::daemon
