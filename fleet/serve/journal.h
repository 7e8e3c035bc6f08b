#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "fleet/serve/command_order.h"
#include "fleet/serve/commander.h"
#include "fleet/store/database.h"

namespace framewatch::fleet {

/// Writes a command into the journal before it is sent, and finds whom it is for. `building`: a
/// name, or "all": every one that is not retired. False, with the reason, when it is not in the
/// journal: then it must not be sent.
[[nodiscard]] bool note_order(Database& database, const std::string& building, CommandOrder& order,
                              std::string& why);

/// Writes what became of it. False: the database did not take it.
[[nodiscard]] bool note_result(Database& database, const CommandResult& result);

/// The newest 200 commands of `building` (empty: of all): [{"request", "came_us", "who", "verb",
/// "content": {}, "buildings": n, "done", "refused", "waiting": of them, "answers": [{"building",
/// "came_us", "done", "answer"}]: the first 50, those that did not obey first}].
std::string journal_json(Database& database, const std::string& building);

}  // namespace framewatch::fleet
