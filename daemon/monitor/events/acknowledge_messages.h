#pragma once

#include <cstdint>
#include <string>

#include <framewatch/acknowledge_t.hpp>
#include <framewatch/acknowledged_t.hpp>
#include <framewatch/event_t.hpp>

#include "daemon/monitor/events/acknowledgement.h"

namespace framewatch::daemon {

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
