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

/// The word for a number; a number out of range, from another program, gives the nearest word.
template <std::size_t N>
constexpr const char* word(const std::array<const char*, N>& words, std::int32_t number) {
  return words[static_cast<std::size_t>(std::clamp(number, 0, static_cast<std::int32_t>(N) - 1))];
}

/// An event as one line of JSON (schema `framewatch.event/1`, docs/actions.md) for commands and
/// webhooks.
std::string event_json(const event_t& event, const std::string& building);

/// Who acknowledged an event, and when.
struct Acknowledgement {
  std::int64_t time_us = 0;  ///< host clock
  std::string who, comment;

  template <typename Archive>
  void archive(Archive& a) {
    a(time_us, who, comment);
  }
};

/// As an event's id: every event that is raised, whoever found it. In acknowledged_t it says when
/// and by whom everything was acknowledged at once, so that a page does it with its own events.
inline constexpr std::int64_t kAllEvents = 0;

/// A request to acknowledge an event, with a random request number. id kAllEvents: every raised
/// event.
acknowledge_t acknowledge_request(std::int64_t id, const std::string& who,
                                  const std::string& comment);

/// Who gave a command, for people: the user, and what the command says of its giver where it does:
/// "alice", "alice (says: Bob)". One line.
std::string who_text(const std::string& user, const std::string& says);

/// Appends one acknowledged event to the message.
void add_acknowledged(acknowledged_t& message, const event_t& event, const Acknowledgement& by);

/// Appends that everything was acknowledged.
void add_all_acknowledged(acknowledged_t& message, const Acknowledgement& by);

/// The message that one event is acknowledged.
acknowledged_t acknowledged_message(const event_t& event, const Acknowledgement& by);

}  // namespace framewatch::daemon
