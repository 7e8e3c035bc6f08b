// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/config/config.h"

namespace framewatch::daemon {

/// Expected accuracy of a group of stories, relative.
struct GroupOutlook {
  std::string parameter;  ///< kx_6to10
  double window_error, design_error, sensor_error, damping_error;
};

/// A further measured floor and its gain.
struct AdvisedFloor {
  int floor;
  std::vector<std::string> channels;  ///< its channels: as on the highest measured floor
  double least_seen_loss;             ///< LayoutOutlook::least_seen_loss with this floor
};

/// Expected errors of the stories above the highest measured floor, relative; of the worst group.
struct TopErrors {
  double stiffness = 0;  ///< of one window, of the design and of sensors together
  double damping = 0;    ///< of one window
};

/// Expected accuracy of a building with sensors on some floors, from its design.
struct LayoutOutlook {
  std::vector<int> floors;  ///< measured
  double shaking_mps2;      ///< rms of the assumed base motion
  bool noise_configured;
  std::vector<GroupOutlook> groups;
  /// Smallest relative stiffness loss that is detected at every place, and the place that sets it.
  /// Infinite if some place never shows a loss.
  double least_seen_loss = 0;
  int weakest_story = 0;
  std::vector<AdvisedFloor> advised;  ///< best first
  std::optional<TopErrors> top;       ///< without a channel on the roof; empty: it has one
  TopErrors top_with_roof;            ///< with one there, if top is set
};

/// Predicts accuracy from the design. `config` must have groups of stories. `advise`: largest
/// number of floors to name.
LayoutOutlook layout_outlook(const Config& config, int advise);

/// Returns lines for people; the first one has the heading's column.
std::string layout_text(const LayoutOutlook& outlook, const estimator::Structure& structure);

/// Returns warnings about a layout with sensors on some floors: what it cannot show or shows
/// poorly, contradictions between channels, and the consequences. `config` must have groups of
/// stories.
std::vector<std::string> layout_warnings(const Config& config, const LayoutOutlook& outlook);

}  // namespace framewatch::daemon
