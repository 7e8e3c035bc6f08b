#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "estimator/structure/parameter_table.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/story_groups.h"
#include "estimator/structure/structure.h"

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

/// Everything the estimating process needs to know, validated by problems().
struct PipelineConfig {
  Structure structure;
  std::vector<SensorAxis> axes;
  EstimatorOptions options;
  /// Design parameters of every story, SI, in the order of ParameterTable(structure); empty when
  /// the drawings say nothing.
  Eigen::VectorXd design;
  BendingStiffness bending_nmprad{};   ///< of the design
  std::vector<int> group_floors = {};  ///< WantedGroups::floors
  double mass_tolerance = 0.02;        ///< relative standard deviation of a floor's mass
  double profile_tolerance = 0.05;     ///< of a story's share in its group's flexibility
  /// Of groups of stories, by parameter: relative error that these tolerances make
  /// (LayoutPrediction::design_error); empty: none is counted.
  std::vector<double> design_error = {};
  /// Of groups of stories: what a loss in one story makes of their values
  /// (LayoutPrediction::change_error, change_leak); empty: the usual.
  std::vector<double> change_error = {}, change_leak = {};

  StoryGroups groups() const {
    return story_groups(structure, axes, {group_floors, bending_nmprad.any()});
  }
  /// What is identified.
  ParameterTable parameters() const { return ParameterTable(structure, groups(), bending_nmprad); }
};

std::vector<std::string> problems(const PipelineConfig& config);

/// What the row filters are tuned to.
struct Tuning {
  Eigen::VectorXd theta0;             ///< parameters, theta order, SI
  std::vector<double> noise_density;  ///< of every axis, m/s^2/sqrt(Hz)
  bool found_right = true;            ///< a window has confirmed it; windows are published
};

}  // namespace framewatch::estimator
