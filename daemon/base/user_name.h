#pragma once

#include <sys/types.h>

#include <string>

namespace framewatch::daemon {

/// Name of a user of this machine; "uid 1234" without one. May take as long as a directory server.
std::string user_name(uid_t user);
/// Name of a group; "gid 1234" without one.
std::string group_name(gid_t group);

}  // namespace framewatch::daemon
