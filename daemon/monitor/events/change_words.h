// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"
#include "estimator/watch/recovery.h"

namespace framewatch::daemon {

/// Labels that people gave to frames, such as "north wall", by the frame's name, such as y2.
using FrameLabels = std::map<std::string, std::string>;
FrameLabels frame_labels(const estimator::Structure& structure);

/// Returns where the parameter named `parameter` (estimator::Parameter) is: "story 1, frame y2",
/// "floor 2, panel x1y1", "stories 6 to 12, along x", "stories 6 to 12, frame y1", "frames along
/// x". A frame with a label has it instead of its name: "story 1, north wall". Takes any text.
std::string place_words(const std::string& parameter, const FrameLabels& labels = {});

/// Returns the place with the parameter, which leads to its line of the configuration: "story 1,
/// north wall (kx_1_y2)".
std::string named_place(const std::string& parameter, const FrameLabels& labels);
/// Returns the words for the frame of a place: "north wall", or "frame y2" without a label.
std::string frame_words(const std::string& frame, const FrameLabels& labels);

/// Returns the words for the element that `parameter` belongs to: "frame y2 of story 1", "floor
/// panel x1y1 of floor 2", "stories 6 to 12 along x", "frame y1 of stories 6 to 12", "bending of
/// frames along x". A frame with a label has both: "north wall (y2) of story 1". Takes any text.
std::string element_words(const std::string& parameter, const FrameLabels& labels = {});

/// Returns `ratio` in percent, rounded to the digits that `std_error` justifies (both relative):
/// "0.83 %", "15 %".
std::string percent_words(double ratio, double std_error);
/// Returns a sentence about a measured change: "story 1, frame y2 (kx_1_y2) has lost 14.8 % of its
/// stiffness, give or take 0.4 %: 36 times its uncertainty". `ratio` is relative to the baseline
/// and negative for a loss; `std_error` > 0. For a loss of a group of stories it adds the largest
/// loss of a single story: "; one of stories 5 to 8 may have lost up to 8 %".
std::string change_sentence(const estimator::Parameter& parameter, double ratio, double std_error,
                            const FrameLabels& labels);

/// Returns a sentence about a change that is not measured yet: "story 1, frame y2 (kx_1_y2) is
/// changing: it loses stiffness, how much is not known yet". Only the sign of `ratio` counts.
std::string changing_sentence(const estimator::Parameter& parameter, double ratio,
                              const FrameLabels& labels);

/// Returns "everything softened by 5.0 %, give or take 0.4 %: ...", followed by the causes that
/// change all stiffnesses alike and how to tell them apart. With `std_error` NaN it gives no
/// number.
std::string common_change_sentence(double ratio, double std_error);

/// The `place` of an event that concerns all stiffnesses together.
inline constexpr const char* kWholeBuilding = "building";

/// Returns the relative loss of one story of a group if it alone caused the group's loss `loss` (0
/// to 1). Assumes that all stories of the group were equally stiff springs in series. For a single
/// story it returns `loss`.
double loss_of_one_story(const estimator::Parameter& parameter, double loss);
/// Returns the relative loss of a group if one of its stories loses `loss_of_story` (0 to 1): the
/// inverse of loss_of_one_story().
double loss_of_group(const estimator::Parameter& parameter, double loss_of_story);

/// Separates an event's message from the recovery_words() that follow it.
inline const std::string kAfterStrongMotion = "; after strong motion: ";

/// Returns what a recovery law says, to follow the name of the element: "lost 9 % at the
/// earthquake, 6 % after 1 hour, recovering: 4 % (+-1 %) expected after 1 day", or "..., lasting:
/// full recovery is excluded, at least 6 % stays".
std::string recovery_words(const estimator::RecoveryLaw& law);

}  // namespace framewatch::daemon
