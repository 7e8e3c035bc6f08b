// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "estimator/motion/sample.h"

namespace framewatch::estimator {

/// Tells if a window has estimates.
enum class WindowStatus {
  warming_up,           ///< too little data since the start or an interruption
  valid,                ///< at least one parameter has a value
  nothing_identifiable  ///< no parameter has a value: WindowEstimate::reason says why
};

/// Tells if a parameter has a value, or why not.
enum class Observability {
  observable,       ///< it has a value
  warming_up,       ///< too little data since the start or an interruption
  quiet,            ///< its element moves too little above the sensors' noise
  floor_too_stiff,  ///< the frames move, but this floor panel does not shear enough
  symmetric_plan,   ///< the panel cannot shear, because the frames of each direction are alike
  channel_lost      ///< a sensor that it needs delivers nothing
};

/// Boxplot statistics of one parameter over the last windows in which it was observable, as MATLAB
/// draws them; NaN without such windows.
struct BoxplotStatistics {
  double q1;            ///< first quartile
  double median;        ///< second quartile
  double q3;            ///< third quartile
  double whisker_low;   ///< least value that is not an outlier
  double whisker_high;  ///< largest value that is not an outlier
  int outliers = 0;     ///< number of values beyond the whiskers
  int count = 0;        ///< number of windows in the statistics

  /// Archives the state, as every archive() does: estimator/state/archive.h.
  void archive(auto& a) { a(q1, median, q3, whisker_low, whisker_high, outliers, count); }
};

/// The result of one window. Vectors follow the parameter table; entries that are not observable
/// are NaN. A value-initialized estimate is not valid.
struct WindowEstimate {
  WindowEstimate() = default;
  /// Makes an estimate of so many parameters, none of which has a value.
  explicit WindowEstimate(std::size_t parameters);

  /// Published after its time, because the filters were not tuned to the building when the window
  /// ended.
  bool late = false;
  int window = 0;              ///< 0: the main window; i: EstimatorOptions::other_windows_s[i - 1]
  Time start;                  ///< first instant of the window
  Time end;                    ///< last instant of the window
  std::int64_t sequence = -1;  ///< increases by 1 per estimate of a window length
  WindowStatus status = WindowStatus::warming_up;  ///< tells if there are values
  int rows = 0;                                    ///< sample sets in the window
  double residual_ratio = 0;                       ///< rms residual over rms response
  std::vector<double> value;                       ///< SI
  std::vector<double> std_error;                   ///< SI, one standard deviation
  std::vector<Observability> reason;               ///< why a parameter has no value
  std::vector<double> snr;  ///< energy of the regressor over its expected noise energy
  /// Rms deformation of a stiffness parameter's element in the window, m (ElementDrift). NaN if
  /// unknown and in long windows.
  std::vector<double> amplitude;
  std::vector<double> prior_share;  ///< 0..1: share of the prior in the value
  std::vector<double> noise_share;  ///< 0..1: share of the noise that remains in the regressors
  /// The newest observable value, of this window or an older one, SI; NaN without one. Main window
  /// only.
  std::vector<double> last_value;
  std::vector<double> last_std_error;      ///< its standard error
  std::vector<Time> last_end;              ///< end of its window
  std::vector<BoxplotStatistics> boxplot;  ///< of the last windows
  /// The solution of the normal equations before the gate, SI. For studies; never published.
  std::vector<double> solution;

  /// Archives the state, as every archive() does: estimator/state/archive.h.
  void archive(auto& a) {
    a(start, end);
    a.within(sequence, -1, a.kMaxCount);
    a.within(status, 0, static_cast<double>(WindowStatus::nothing_identifiable));
    a.within(rows, 0, a.kMaxCount);
    a(residual_ratio, value, std_error);
    a.each_within(reason, 0, static_cast<double>(Observability::channel_lost));
    a(snr, amplitude, prior_share, noise_share, last_value, last_std_error, last_end, boxplot,
      solution);
  }
};

/// Tells from the misfit if a parameter's absolute value can be trusted.
enum class FitWord {
  unknown,       ///< no window has shown the parameter yet
  fits,          ///< value and error can be trusted
  only_changes,  ///< the value may be off by far more than its error; its changes can be trusted
  does_not_fit   ///< not even changes can be trusted
};

/// How well the model describes the measurement. A parameter's errors are relative, one standard
/// deviation. They are constant while the building does not change, so they are not part of a
/// change. They remain valid while no window shows the parameter
/// (docs/equations.md, errors of the model).
struct ModelFit {
  static constexpr double kOnlyChanges = 0.15;  ///< misfit above which FitWord is only_changes
  static constexpr double kNothing = 0.3;       ///< misfit above which it is does_not_fit

  /// Makes a fit of so many parameters, of which nothing is known.
  explicit ModelFit(std::size_t parameters = 0);

  Time start{};                ///< first instant of the newest window
  Time end{};                  ///< last instant of the newest window
  std::int64_t sequence = -1;  ///< increases by 1 per fit
  /// By parameter, table order; NaN until a window shows it. Rms of what the equations leave beyond
  /// sensor noise, over the rms of the stiffness forces.
  std::vector<double> misfit;
  std::vector<double> design_error;  ///< from tolerances of masses and of story shares
  std::vector<double> misfit_error;  ///< error that the misfit may hide
  std::vector<double> corner_error;  ///< spread over filter corners, beyond noise
  std::vector<double> error;         ///< all of these; at least 1 if the model does not fit
  std::vector<FitWord> word;         ///< whether the absolute value can be trusted

  /// Archives the state, as every archive() does: estimator/state/archive.h.
  void archive(auto& a) {
    a(start, end);
    a.within(sequence, -1, a.kMaxCount);
    a(misfit, design_error, misfit_error, corner_error, error);
    a.each_within(word, 0, static_cast<double>(FitWord::does_not_fit));
  }
};

/// Returns the word for a misfit by the thresholds above; unknown for NaN.
FitWord fit_word(double misfit);

}  // namespace framewatch::estimator
