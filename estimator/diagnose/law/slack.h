#pragma once

#include <vector>

namespace framewatch::estimator {

/// Indices of the parameters of LawForm::slack: a brace that yields in both directions and stays
/// slack by its plastic deformation,
///
///   f = kh (clip(d - u, 0, dy) - clip(-d - w, 0, dy)), u = max(play, largest d so far - dy),
///
/// and w likewise for -d. Source: Tremblay and Filiatrault, Earthquake Eng. Struct. Dyn. 25 (1996);
/// OpenSees' ElasticPPGap with damage.
struct SlackIndex {
  enum : std::size_t { kh, dy, play };
};

/// Returns the slack toward positive and toward negative deformation, m, of a brace that has not
/// moved yet.
std::vector<double> first_slack(const std::vector<double>& p);
/// Returns the force over kh at deformation d.
double slack_force(const std::vector<double>& p, const std::vector<double>& slack, double d);
/// Updates the slack after a step that ends at d.
void slacken(const std::vector<double>& p, std::vector<double>& slack, double d);

}  // namespace framewatch::estimator
