#pragma once

#include <string>

#include "estimator/structure/parameter_table.h"
#include "estimator/watch/recovery.h"

namespace framewatch::daemon {

/// Where the parameter of a name (estimator::Parameter) is: "story 1, frame y2", "floor 2, panel
/// x1y1", "stories 6 to 12, along x", "stories 6 to 12, frame y1", "frames along x".
std::string place_words(const std::string& parameter);

/// What it is of: "frame y2 of story 1", "floor panel x1y1 of floor 2", "stories 6 to 12 along x",
/// "frame y1 of stories 6 to 12", "bending of frames along x".
std::string element_words(const std::string& parameter);

/// "0.83 %", "15 %": with as many digits as an error of that size deserves.
std::string percent_words(double ratio, double std_error);
/// "story 1, frame y2 (kx_1_y2) has lost 14.8 % of its stiffness, give or take 0.4 %: 36 times its
/// uncertainty": ratio relative to the baseline, negative for a loss; std_error > 0. Of a group of
/// stories it goes on with what that may be of one story: "; one of stories 5 to 8 may have lost up
/// to 8 %".
std::string change_sentence(const estimator::Parameter& parameter, double ratio, double std_error);

/// "story 1, frame y2 (kx_1_y2) is changing: it loses stiffness, how much is not known yet", of a
/// change whose record has no number. ratio: its sign counts.
std::string changing_sentence(const estimator::Parameter& parameter, double ratio);

/// "everything softened by 5.0 %, give or take 0.4 %: ..." with the causes that change every
/// stiffness alike and what tells them apart. std_error NaN: no number yet.
std::string common_change_sentence(double ratio, double std_error);

/// The place of an event about what every stiffness has in common.
inline constexpr const char* kWholeBuilding = "building";

/// What one story of a group has lost, relative, when the stiffness of the group has lost `loss`
/// and its stories were equally stiff: they are springs in series. The same for a single story.
/// loss: 0 to 1.
double loss_of_one_story(const estimator::Parameter& parameter, double loss);
/// The other way round: what the group loses with one story.
double loss_of_group(const estimator::Parameter& parameter, double loss_of_story);

/// Stands before recovery_words() in the message of an event.
inline const std::string kAfterStrongMotion = "; after strong motion: ";

/// What a recovery law says, to follow the name of the element: "lost 9 % at the earthquake, 6 %
/// after 1 hour, recovering: 4 % (+-1 %) expected after 1 day"; "..., lasting: full recovery is
/// excluded, at least 6 % stays".
std::string recovery_words(const estimator::RecoveryLaw& law);

}  // namespace framewatch::daemon
