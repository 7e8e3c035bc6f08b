// What is asked of a building whose channels come from a network's files, and how it is read, as
// parts of InitQuestion.
#pragma once

#include <string>

#include "daemon/tools/init/draft.h"

namespace framewatch::daemon {

std::string ask_base(const BuildingDraft& draft);
bool asks_base(const BuildingDraft& draft);
std::string take_base(const std::string& text, BuildingDraft& draft, ColumnCache& files);
std::string understood_base(const BuildingDraft& draft);

/// Of any building; with what headers say of it.
std::string ask_stories(const BuildingDraft& draft);
std::string initial_directions(const BuildingDraft& draft);

/// "40x25": metres along x and y; asked for where headers name sides and no bays say how long.
std::string ask_plan(const BuildingDraft& draft);
bool asks_plan(const BuildingDraft& draft);
std::string take_plan(const std::string& text, BuildingDraft& draft, ColumnCache& files);
std::string understood_plan(const BuildingDraft& draft);

/// Gives every channel of a station its place, from its header or from NAME=PLACE of a person. What
/// neither says is open.
void place_station(const InitAnswers& answers, InitReading& reading);

/// Gives every place of the building its channel: by NAME=PLACE, by the columns' titles where they
/// can be read in one way, by number where nobody named them; of a station by its headers. What is
/// left is open.
void place_channels(const InitAnswers& answers, InitReading& reading);

}  // namespace framewatch::daemon
