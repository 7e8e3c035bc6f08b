// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include <framewatch/acknowledge_t.hpp>
#include <framewatch/acknowledged_t.hpp>
#include <framewatch/event_t.hpp>

namespace framewatch::daemon {

/// Values of event_t::state.
namespace event_state {
enum : std::int32_t { cleared, raised, changed };
}
inline constexpr std::array kEventStates = {"cleared", "raised", "changed"};

/// Values of event_t::severity.
namespace severity {
enum : std::int32_t { information, warning, alarm };
}
inline constexpr std::array kSeverities = {"information", "warning", "alarm"};

/// Returns the word for `number`. Another program may send a number out of range: it gets the
/// nearest word.
template <std::size_t N>
constexpr const char* word(const std::array<const char*, N>& words, std::int32_t number) {
  return words[static_cast<std::size_t>(std::clamp(number, 0, static_cast<std::int32_t>(N) - 1))];
}

/// Returns an event as one line of JSON (schema `framewatch.event/1`, docs/actions.md) for commands
/// and webhooks.
std::string event_json(const event_t& event, const std::string& building);

/// An acknowledgement of an event: by whom, when, and with which comment.
struct Acknowledgement {
  std::int64_t time_us = 0;  ///< host clock
  std::string who, comment;

  template <typename Archive>
  void archive(Archive& a) {
    a(time_us, who, comment);
  }
};

/// In place of an event's id: every raised event. In acknowledged_t such an entry says when and by
/// whom all events were acknowledged at once, so that a page can do the same with its own events.
inline constexpr std::int64_t kAllEvents = 0;

/// In place of an event's id in a request to keep a note: a remark, or that the building was
/// changed on purpose. The history stores it as an acknowledgement of one of these kinds.
inline constexpr std::int64_t kPlainNote = -1, kMaintenance = -2;
inline constexpr const char *kNoteKind = "note", *kMaintenanceKind = "maintenance";
inline constexpr const char* kNoteCommand = "NOTE";  ///< CommandPacket::channel of such a request

/// Makes a request to acknowledge the event with this id (kAllEvents: every raised event), with a
/// random request number and the time of the host's clock.
acknowledge_t acknowledge_request(std::int64_t id, const std::string& who,
                                  const std::string& comment);

/// Returns the author of a command for people, on one line: the user and, if given, the name that
/// the command itself states: "alice", "alice (says: Bob)".
std::string who_text(const std::string& user, const std::string& says);

void add_acknowledged(acknowledged_t& message, const event_t& event, const Acknowledgement& by);

/// Appends the entry that says that all events were acknowledged.
void add_all_acknowledged(acknowledged_t& message, const Acknowledgement& by);

}  // namespace framewatch::daemon
