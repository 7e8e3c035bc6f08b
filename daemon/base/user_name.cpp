#include "daemon/base/user_name.h"

#include <grp.h>
#include <pwd.h>
#include <unistd.h>

#include <cstdlib>
#include <vector>

#include <fmt/core.h>

#include "daemon/base/printable.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMaxEntry = 65536, kMaxName = 64;  // bytes

}  // namespace

std::string user_name(uid_t user) {
  std::vector<char> memory(kMaxEntry);
  passwd entry{};
  passwd* found = nullptr;
  if (::getpwuid_r(user, &entry, memory.data(), memory.size(), &found) == 0 && found != nullptr)
    return printable(found->pw_name, kMaxName);
  // systemd says how a user is called that exists only while the service does.
  const char* const own = user == ::geteuid() ? std::getenv("USER") : nullptr;
  return own != nullptr ? printable(own, kMaxName) : fmt::format("uid {}", user);
}

std::string group_name(gid_t group) {
  std::vector<char> memory(kMaxEntry);
  struct group entry {};
  struct group* found = nullptr;
  if (::getgrgid_r(group, &entry, memory.data(), memory.size(), &found) != 0 || found == nullptr)
    return fmt::format("gid {}", group);
  return printable(found->gr_name, kMaxName);
}

}  // namespace framewatch::daemon
