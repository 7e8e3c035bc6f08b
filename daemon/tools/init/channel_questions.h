// SPDX-License-Identifier: MIT
// Questions about channels and stations, and readers of their answers, as parts of InitQuestion.
#pragma once

#include <string>

#include "daemon/tools/init/draft.h"

namespace framewatch::daemon {

std::string ask_base(const BuildingDraft& draft);
bool asks_base(const BuildingDraft& draft);
std::string take_base(const std::string& text, BuildingDraft& draft, ColumnCache& files);
std::string understood_base(const BuildingDraft& draft);

/// Questions for any building, with hints from headers.
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

/// Assigns a channel to every place of the building: by NAME=PLACE, by column titles if they have
/// one reading, by number for unnamed columns, and by headers for a station. The rest stays open.
void place_channels(const InitAnswers& answers, InitReading& reading);

}  // namespace framewatch::daemon
