#pragma once

#include <vector>

namespace framewatch::estimator {

/// Indices of the parameters of LawForm::slack: a brace that yields to either side, and is slack up
/// to where it has yielded,
///
///   f = kh (clip(d - u, 0, dy) - clip(-d - w, 0, dy)), u = max(play, largest d so far - dy),
///
/// w the same of -d. Source: Tremblay and Filiatrault, Earthquake Eng. Struct. Dyn. 25 (1996);
/// OpenSees' ElasticPPGap with damage.
struct SlackIndex {
  enum : std::size_t { kh, dy, play };
};

/// Slack toward positive and toward negative deformation, m, of a brace that has not moved yet.
std::vector<double> first_slack(const std::vector<double>& p);
/// Force over kh.
double slack_force(const std::vector<double>& p, const std::vector<double>& slack, double d);
/// Ends a step at d.
void slacken(const std::vector<double>& p, std::vector<double>& slack, double d);

}  // namespace framewatch::estimator
