// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "estimator/state/abi.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/story_groups.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// The equations to identify from.
enum class Variant {
  /// Each floor's equations are projected on its own eigenvectors and filtered at their own
  /// frequencies (docs/equations.md).
  matched,
  /// The method of the paper, with one 0.1-Hz high-pass, the trapezoidal rule and plain least
  /// squares.
  paper
};

/// The options of the estimation that an operator may set. The defaults are the recommended values.
struct EstimatorOptions {
  Variant variant = Variant::matched;  ///< equations to identify from
  double rate_hz = 100;                ///< sampling rate of the common grid
  double window_s = 5;                 ///< rounded to 20 blocks of whole samples
  /// Lengths of further windows, at most 20 times window_s. Rounded to whole blocks of the main
  /// window, at least four.
  std::vector<double> other_windows_s = {1, 2.5, 10};
  /// Length of the long windows, which accumulate motion however weak it is (LongWindow). 0: no
  /// long windows.
  double long_window_s = 0;
  double hop_s = 0.01;           ///< between published windows; rounded to whole samples, >= 1
  int boxplot_windows = 500;     ///< windows that WindowEstimate::boxplot covers
  double high_pass_hz = 0.3;     ///< drift-control corner; the paper's variant: 0.1
  double filter_damping = 0.35;  ///< damping ratio of the oscillator sections
  double corner_ratio = 1;  ///< corner frequencies of the sections over the floors' frequencies
  bool prior = true;        ///< use a weak prior around theta0 where the data say little
  bool self_tune = true;    ///< retune the row filters to the identified parameters
  double settle_s = 3;      ///< shortest time before a (re)started window counts
  double lateness_s = 0.5;  ///< an instant is closed this long after its time
  bool fill_single_losses = true;  ///< repair a single lost sample by the 4-point cubic
  double min_snr = 10;             ///< gate: least ratio of a regressor's energy to its noise
  double max_error_k = 0.10;       ///< gate: largest relative standard error of a frame stiffness
  double max_error_g = 0.20;       ///< gate: the same for a floor-panel stiffness
  double max_error_c = 0.20;       ///< gate: the same for the damping of frames and panels
};

/// Returns the lengths of the main window and of the other windows, s, indexed by
/// WindowEstimate::window.
inline std::vector<double> window_lengths_s(const EstimatorOptions& options) {
  std::vector<double> out{options.window_s};
  out.insert(out.end(), options.other_windows_s.begin(), options.other_windows_s.end());
  return out;
}

/// The configuration of an estimation: building, sensor axes, options and design. Check it with
/// problems().
struct PipelineConfig {
  Structure structure;           ///< the building
  std::vector<SensorAxis> axes;  ///< the sensors; samples name an axis by its index here
  EstimatorOptions options;      ///< how to estimate
  /// Design parameters of every story, SI, in the order of ParameterTable(structure). Empty without
  /// a design.
  Eigen::VectorXd design;
  BendingStiffness bending_nmprad{};   ///< bending stiffness in the design
  std::vector<int> group_floors = {};  ///< floors where groups end (WantedGroups::floors)
  double mass_tolerance = 0.02;        ///< relative standard deviation of a floor's mass
  double profile_tolerance = 0.05;     ///< the same for a story's share in its group's flexibility
  /// Relative error of each parameter that these tolerances cause, for groups of stories
  /// (LayoutPrediction::design_error). Empty: not counted.
  std::vector<double> design_error = {};
  /// Effect of a loss in one story on the value of its group, relative
  /// (LayoutPrediction::change_error). Empty: typical values.
  std::vector<double> change_error = {};
  /// Effect of a loss in one story on the values of the other groups, relative
  /// (LayoutPrediction::change_leak). Empty: typical values.
  std::vector<double> change_leak = {};

  /// Returns the groups of stories that the axes identify.
  StoryGroups groups() const {
    return story_groups(structure, axes, {group_floors, bending_nmprad.any()});
  }
  /// Returns the table of the parameters that are identified.
  ParameterTable parameters() const { return ParameterTable(structure, groups(), bending_nmprad); }
};

/// Returns a message for every rule that the configuration breaks, with the key and the limit.
/// Returns an empty vector if a Pipeline can be made of it.
std::vector<std::string> problems(const PipelineConfig& config);

/// The parameters and noise levels that the row filters are tuned to.
struct Tuning {
  Eigen::VectorXd theta0;             ///< parameters, theta order, SI
  std::vector<double> noise_density;  ///< noise of every axis, m/s^2/sqrt(Hz)
  bool found_right = true;  ///< a window has confirmed the tuning, so windows are published
};

}  // namespace framewatch::estimator
