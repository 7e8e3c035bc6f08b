#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "estimator/motion/sample.h"

namespace framewatch::estimator {

/// Whether a parameter's absolute value is to be believed, by its misfit.
enum class FitWord {
  unknown,       ///< no window has shown the parameter yet
  fits,          ///< value and error mean what they say
  only_changes,  ///< the value may be off by far more; changes of it mean something
  does_not_fit   ///< not even changes
};

/// How well the model describes what was measured. A parameter's errors are relative, one standard
/// deviation; they stay while the building stays as it is, so they are no part of a change, and
/// stand while no window shows the parameter (docs/equations.md, errors of the model).
struct ModelFit {
  static constexpr double kOnlyChanges = 0.15, kNothing = 0.3;  ///< misfits above which

  explicit ModelFit(std::size_t parameters = 0);

  Time start{}, end{};         ///< of the newest window
  std::int64_t sequence = -1;  ///< +1 per fit
  /// By parameter, table order; NaN where no window has shown it yet.
  /// Rms of what the equations leave beyond sensor noise, over the rms of the stiffness forces.
  std::vector<double> misfit;
  std::vector<double> design_error;  ///< from tolerances of masses and of stories in their group
  std::vector<double> misfit_error;  ///< what the misfit may hide
  std::vector<double> corner_error;  ///< spread over corners of the row filters, beyond noise
  std::vector<double> error;         ///< of all these; at least 1 where the model does not fit
  std::vector<FitWord> word;

  template <typename Archive>
  void archive(Archive& a) {
    a(start, end);
    a.within(sequence, -1, a.kMaxCount);
    a(misfit, design_error, misfit_error, corner_error, error);
    a.each_within(word, 0, static_cast<double>(FitWord::does_not_fit));
  }
};

/// By the thresholds above; unknown of NaN.
FitWord fit_word(double misfit);

}  // namespace framewatch::estimator
