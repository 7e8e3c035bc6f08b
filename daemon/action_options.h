#pragma once

#include <string>
#include <vector>

namespace framewatch::daemon {

/// [actions]: what `framewatch run` does when an event is raised, changes or is cleared,
/// docs/actions.md.
struct ActionSettings {
  int severity = 1;                ///< the least that is told, event_t::severity
  std::vector<std::string> kinds;  ///< that are told; empty: all
  double changed_every_s = 60;     ///< a change of an event follows what was told of it no sooner
  int per_minute = 12;             ///< told at most, by each way

  std::vector<std::string> command;  ///< program and arguments; empty: none
  double command_timeout_s = 30;

  std::string webhook;              ///< URL; empty: none
  std::string webhook_header_file;  ///< further headers, one a line; empty: none
  std::string webhook_ca_file;      ///< certificates that are trusted; empty: the system's
  double webhook_timeout_s = 10;    ///< of one try
  double webhook_patience_s = 3600;
};

}  // namespace framewatch::daemon
