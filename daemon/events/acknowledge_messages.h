#pragma once

#include <cstdint>
#include <string>

#include <framewatch/acknowledge_t.hpp>
#include <framewatch/acknowledged_t.hpp>
#include <framewatch/event_t.hpp>

#include "daemon/events/acknowledgement.h"

namespace framewatch::daemon {

/// A request to acknowledge an event, with a random request number. id 0: every raised event.
acknowledge_t acknowledge_request(std::int64_t id, const std::string& who,
                                  const std::string& comment);

/// Who gave a command, for people: the user, and what the command says of its giver where it does:
/// "alice", "alice (says: Bob)". One line.
std::string who_text(const std::string& user, const std::string& says);

/// Appends one acknowledged event to the message.
void add_acknowledged(acknowledged_t& message, const event_t& event, const Acknowledgement& by);

/// The message that one event is acknowledged.
acknowledged_t acknowledged_message(const event_t& event, const Acknowledgement& by);

}  // namespace framewatch::daemon
