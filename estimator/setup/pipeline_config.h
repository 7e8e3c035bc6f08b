#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "estimator/setup/options.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/story_groups.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

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

}  // namespace framewatch::estimator
