#pragma once

namespace framewatch::estimator {

/// One parameter of an effect that is being fitted, and how a fit may change it.
struct LawParameter {
  double value = 0;  ///< as the fit uses it: the logarithm if `logarithmic`
  bool logarithmic = false;
  double step = 0;  ///< unit of the fit's unknown, about the size of a significant change
  double low = -1e300, high = 1e300;  ///< bounds of `value`
  double sigma = 0;                   ///< of a weak prior around `centre`; 0: no prior
  double centre = 0;
  bool free = true;  ///< false: held at its value

  /// Returns the value in the law's own unit.
  double plain() const;
};

/// Returns true if the value has reached one of its bounds.
bool at_bound(const LawParameter& parameter);

/// Returns a free parameter without bounds. Uses |step| as its step.
LawParameter linear_parameter(double value, double step);
/// Returns a free parameter that is fitted by its logarithm. value, low, high: > 0, in the law's
/// unit.
LawParameter logarithmic_parameter(double value, double low, double high);
LawParameter bounded_parameter(double value, double step, double low, double high,
                               bool free = true);
/// Returns a parameter held at this value.
LawParameter fixed_parameter(double value);

}  // namespace framewatch::estimator
