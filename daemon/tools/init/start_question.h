#pragma once

#include <string>

#include "daemon/tools/init/draft.h"

namespace framewatch::daemon {

// What tuning starts from: a first natural frequency or period, stiffnesses, a rule of the field,
// or nothing. As the members of InitQuestion.
std::string ask_start(const BuildingDraft& draft);
std::string initial_start(const BuildingDraft& draft);
std::string take_start(const std::string& text, BuildingDraft& draft, ColumnCache& files);

}  // namespace framewatch::daemon
