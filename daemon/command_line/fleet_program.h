#pragma once

#include <string_view>

namespace framewatch::daemon {

/// Whether the program framewatch-fleet does what this command asks: it alone needs NATS and
/// PostgreSQL, and is a package of its own.
bool is_of_fleet(std::string_view command);

/// Becomes framewatch-fleet, which lies beside this program or in PATH: `framewatch fleet task` as
/// `framewatch-fleet task`, `framewatch uplink` as `framewatch-fleet uplink`. Returns, with
/// kBadInput and what is missing said, only when there is no such program.
int become_fleet_program(int argc, const char* const* argv);

}  // namespace framewatch::daemon
