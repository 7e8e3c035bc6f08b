#pragma once

#include <string>

#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {

/// "0.83 %", "15 %": with as many digits as an error of that size deserves.
std::string percent_words(double ratio, double std_error);
/// "story 1, frame y2 (kx_1_y2) has lost 14.8 % of its stiffness, give or take 0.4 %: 36 times its
/// uncertainty": ratio relative to the baseline, negative for a loss; std_error > 0.
std::string change_sentence(const estimator::Parameter& parameter, double ratio, double std_error);

}  // namespace framewatch::daemon
