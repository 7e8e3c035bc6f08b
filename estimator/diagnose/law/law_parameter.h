#pragma once

namespace framewatch::estimator {

/// One parameter of an effect that is being fitted, and how a fit may change it.
struct LawParameter {
  double value = 0;  ///< as the fit sees it: the logarithm where `logarithmic`
  bool logarithmic = false;
  double step = 0;                    ///< unit of the fit's unknown, of the size of a useful change
  double low = -1e300, high = 1e300;  ///< bounds of `value`
  double sigma = 0;                   ///< of a weak prior around `centre`; 0: no prior
  double centre = 0;
  bool free = true;  ///< false: held at its value

  /// The value as the law has it.
  double plain() const;
};

/// Whether a value has run into one of its bounds.
bool at_bound(const LawParameter& parameter);

/// Free, without bounds. step: > 0 or taken as its size.
LawParameter linear_parameter(double value, double step);
/// Free, fitted by its logarithm. value, low, high: > 0, as the law has them.
LawParameter logarithmic_parameter(double value, double low, double high);
LawParameter bounded_parameter(double value, double step, double low, double high,
                               bool free = true);
/// Held at its value.
LawParameter fixed_parameter(double value);

}  // namespace framewatch::estimator
