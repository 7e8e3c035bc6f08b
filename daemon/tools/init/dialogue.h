// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "daemon/tools/init/draft.h"

namespace framewatch::daemon {

/// Takes the answers one after the other, each judged by those before it. `take_defaults`: what is
/// not answered and has a default is not open. The plan is whole when nothing is open.
InitReading read_answers(const InitAnswers& answers, bool take_defaults, ColumnCache& files);

/// The terminal where a person answers.
struct Terminal {
  std::function<std::optional<std::string>()> read_line;  ///< empty: there is no more
  std::function<void(const std::string&)> say;
};

/// Returns remarks about a completely described building, or an empty text.
using Remarks = std::function<std::string(const BuildingPlan&)>;

/// Asks what is open, question by question, until the person agrees with what was understood; every
/// answer can be changed until then. Empty: the person left.
std::optional<BuildingPlan> ask_building(InitAnswers answers, const std::string& path,
                                         const Remarks& remarks, ColumnCache& files,
                                         const Terminal& terminal);

/// The understood answers, a numbered line each.
std::string summary_text(const InitReading& reading);

}  // namespace framewatch::daemon
