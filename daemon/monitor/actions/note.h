// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <framewatch/acknowledge_t.hpp>
#include <framewatch/acknowledged_t.hpp>

#include "daemon/monitor/events/event_messages.h"
#include "daemon/monitor/service/service_manager.h"

namespace framewatch::daemon {

/// A remark about the building, for the history, as it is stored: an acknowledgement without an
/// event. `event` has its kind (kNoteKind or kMaintenanceKind) and id; `by` its time, author and
/// text.
struct Note {
  event_t event{};
  Acknowledgement by;
};

/// Returns the note that a request of this user asks for. Refuses a malformed request: returns
/// nullopt and sets `refused` to the reason. The request's `time_us` is the time that the note is
/// about, its `id` kPlainNote or kMaintenance, its `comment` the text. now_us: host clock.
std::optional<Note> note_of(const acknowledge_t& request, const std::string& user,
                            std::int64_t now_us, std::string& refused);

struct NoteArguments {
  std::string text;
  std::string config = kInstalledConfig;
  std::string at;            ///< UTC; empty: now
  bool maintenance = false;  ///< the building was changed on purpose
  std::string who;           ///< a name beside the user's name, which the daemon knows
};

/// Runs `framewatch note`: asks the running daemon over its socket to keep a note in its history.
/// Returns the exit code: 1 when it is refused, 2 without an answer or with an invalid argument.
int note_command(const NoteArguments& arguments);

}  // namespace framewatch::daemon
