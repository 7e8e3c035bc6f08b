#pragma once

#include <string>
#include <vector>

#include "daemon/config/config.h"

namespace framewatch::daemon {

/// Expected accuracy of a group of stories, relative.
struct GroupOutlook {
  std::string parameter;  ///< kx_6to10
  double window_error, design_error, damping_error;
};

/// One more measured floor, and what it would gain.
struct AdvisedFloor {
  int floor;
  std::vector<std::string> channels;  ///< what stands there: as on the highest measured floor
  double least_seen_loss;             ///< of LayoutOutlook, with it
};

/// Expected accuracy of a building with sensors on some floors, from its design.
struct LayoutOutlook {
  std::vector<int> floors;  ///< measured
  double shaking_mps2;      ///< rms of the base's motion that this is for
  bool noise_configured;
  std::vector<GroupOutlook> groups;
  /// The loss of stiffness that is seen wherever it happens, relative, and the place that asks for
  /// so much. Infinite: there are places where none is.
  double least_seen_loss = 0;
  int weakest_story = 0;
  std::vector<AdvisedFloor> advised;  ///< best first
};

/// config: of groups of stories. advise: floors to name at most.
LayoutOutlook layout_outlook(const Config& config, int advise);

/// Lines for people, the first one with the heading's column.
std::string layout_text(const LayoutOutlook& outlook, const estimator::Structure& structure);

/// Returns warnings about a layout with sensors on some floors: what it cannot show or shows
/// poorly, contradictions between channels, and the consequences. `config` must have groups of
/// stories.
std::vector<std::string> layout_warnings(const Config& config, const LayoutOutlook& outlook);

}  // namespace framewatch::daemon
