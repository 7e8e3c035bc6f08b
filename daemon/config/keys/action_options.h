#pragma once

#include <string>
#include <vector>

namespace framewatch::daemon {

/// [actions]: what `framewatch run` does when an event is raised, changes or is cleared,
/// docs/actions.md.
struct ActionSettings {
  int severity = 1;                ///< least event_t::severity of delivered events
  std::vector<std::string> kinds;  ///< of delivered events; empty: all
  double changed_every_s = 60;  ///< least time between two deliveries of the same event's changes
  int per_minute = 12;          ///< most deliveries by the command, and by the webhook

  std::vector<std::string> command;  ///< program and arguments; empty: none
  double command_timeout_s = 30;

  std::string webhook;               ///< URL; empty: none
  std::string webhook_header_file;   ///< further headers, one a line; empty: none
  std::string webhook_ca_file;       ///< certificates that are trusted; empty: the system's
  double webhook_timeout_s = 10;     ///< of one try
  double webhook_patience_s = 3600;  ///< a failed delivery is repeated for this long
};

}  // namespace framewatch::daemon
