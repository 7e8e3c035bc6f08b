#pragma once

#include <vector>

namespace framewatch::estimator {

/// matched: every floor's equations on its own eigenvectors, each filtered at its own frequency
/// (docs/equations.md); paper: the paper's, one 0.1-Hz high-pass, trapezoid, plain least squares.
enum class Variant { matched, paper };

/// What a person may set about the estimation; defaults are the recommended values.
struct EstimatorOptions {
  Variant variant = Variant::matched;
  double rate_hz = 100;  ///< sampling rate of the common grid
  double window_s = 5;   ///< rounded to 20 blocks of whole samples
  /// Further windows, five per length; rounded to whole blocks of the main one, at least four.
  std::vector<double> other_windows_s = {1, 2.5, 10};
  /// Length of the windows that motion is accumulated over, however weak (LongWindow); 0: none.
  double long_window_s = 0;
  double hop_s = 0.01;  ///< between published windows; rounded to whole samples, >= 1
  int boxplot_windows = 500;
  double high_pass_hz = 0.3;       ///< drift control, second order; the paper's variant: 0.1
  double filter_damping = 0.35;    ///< of the oscillator sections
  double corner_ratio = 1;         ///< of the sections' corners to the floors' frequencies
  bool prior = true;               ///< weak prior about theta0 where data say little
  bool self_tune = true;           ///< re-tune the row filters to what was identified
  double settle_s = 3;             ///< at least this long before a (re)started window counts
  double lateness_s = 0.5;         ///< an instant is closed this long after its time
  bool fill_single_losses = true;  ///< repair a single lost sample by the 4-point cubic
  double min_snr = 10;             ///< gate: a value needs at least this regressor energy ratio
  double max_error_k = 0.10;       ///< gate: largest relative standard error, frame stiffness
  double max_error_g = 0.20;       ///< floor-panel stiffness
  double max_error_c = 0.20;       ///< damping of frames and panels
};

/// Lengths of the main and of the other windows, s, by WindowEstimate::window.
inline std::vector<double> window_lengths_s(const EstimatorOptions& options) {
  std::vector<double> out{options.window_s};
  out.insert(out.end(), options.other_windows_s.begin(), options.other_windows_s.end());
  return out;
}

}  // namespace framewatch::estimator
