// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "estimator/setup/pipeline_config.h"

namespace framewatch::earthquake {

/// A building with the right design. Its sensors have no noise, its options are the defaults.
struct StudyBuilding {
  std::string name;
  estimator::PipelineConfig config;
};

/// Three stories in a plane, 500 t each, lowest frequency 3 Hz, 3 % damping, a channel on every
/// floor.
StudyBuilding three_stories();
/// Two stories in space, one bay each way, flexible floors, a channel on every frame of every
/// floor.
StudyBuilding two_stories_in_space();
/// A plane building of equal floors of 800 t with channels on the base and on `floors`. Its
/// stiffness falls to a third at the top, its lowest frequency is 10 Hz over the number of stories.
StudyBuilding stories_with_channels(int stories, const std::vector<int>& floors);

/// Sets the channels' noise densities from their standard deviations, m/s^2, at the rate of
/// config.options.
void set_noise(const std::vector<double>& sigma, estimator::PipelineConfig& config);

/// Draws a design that is off by at most `off`, relative, in each stiffness and each damping. The
/// stories of a group are off by the same factor, so that only what is identified is off.
Eigen::VectorXd design_off(const estimator::PipelineConfig& config, double off, std::uint64_t seed);

}  // namespace framewatch::earthquake
