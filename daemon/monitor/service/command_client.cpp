#include "daemon/monitor/service/command_client.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>

#include <fmt/core.h>

#include "daemon/base/process.h"
#include "daemon/monitor/service/command_path.h"
#include "drivers/files/descriptor.h"

namespace framewatch::daemon {
namespace {

constexpr timeval kPatience{10, 0};

/// Who may, for one who may not.
std::string permission_problem(const std::string& directory, const std::string& path) {
  struct stat found {};
  if (::stat(path.c_str(), &found) != 0 && ::stat(directory.c_str(), &found) != 0)
    return fmt::format("{}: no permission", path);
  const std::string group = group_name(found.st_gid), user = user_name(::geteuid());
  return fmt::format(
      "{0}: no permission: the user {1} and members of the group {2} may (sudo usermod -aG {2} "
      "{3}, then log in anew)",
      path, user_name(found.st_uid), group, user);
}

/// Connects; otherwise errno says why not.
bool connect_to(const drivers::Descriptor& file, const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  errno = ENAMETOOLONG;
  if (path.size() >= sizeof address.sun_path) return false;
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  for (const int option : {SO_SNDTIMEO, SO_RCVTIMEO})  // the first one holds for connect() too
    ::setsockopt(file.get(), SOL_SOCKET, option, &kPatience, sizeof kPatience);
  return ::connect(file.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
}

CommandAnswer exchange(const drivers::Descriptor& file, const std::string& path,
                       const CommandPacket& command) {
  const std::vector<std::uint8_t> bytes = packet_bytes(command);
  if (bytes.size() > CommandPacket::kMaxBytes)
    return {false, fmt::format("a command has {} bytes at most", CommandPacket::kMaxBytes), {}};
  std::vector<std::uint8_t> in(CommandPacket::kMaxBytes + 1);
  if (::send(file.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL) < 0)
    return {false, fmt::format("{}: {}", path, std::strerror(errno)), {}};
  const ssize_t got = ::recv(file.get(), in.data(), in.size(), 0);
  if (got <= 0)
    return {
        false,
        fmt::format("{}: the daemon {}", path,
                    got == 0 || errno != EAGAIN ? "hung up without an answer" : "does not answer"),
        {}};
  const auto packet = packet_of({in.data(), static_cast<std::size_t>(got)});
  if (!packet) return {false, fmt::format("{}: what answers is no daemon", path), {}};
  if (packet->channel == CommandPacket::kRefused)
    return {true, {packet->bytes.begin(), packet->bytes.end()}, {}};
  return {true, "", packet->bytes};
}

}  // namespace

CommandAnswer give_command(const Config& config, const std::string& service,
                           const CommandPacket& command) {
  std::string looked, forbidden;
  for (const std::string& directory : command_directories(config)) {
    const std::string path = command_path(directory, config, service);
    const drivers::Descriptor file(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0));
    if (connect_to(file, path)) return exchange(file, path, command);
    if (errno == EACCES)
      forbidden = permission_problem(directory, path);
    else if (errno != ENOENT && errno != ECONNREFUSED)
      return {false,
              fmt::format("{}: {}", path,
                          errno == EAGAIN ? "the daemon does not answer" : std::strerror(errno)),
              {}};
    looked += (looked.empty() ? "" : ", ") + path;
  }
  if (!forbidden.empty()) return {false, forbidden, {}};
  return {false,
          fmt::format("no framewatch {} takes commands here (looked for {}): does it run with this "
                      "configuration?",
                      service, looked),
          {}};
}

}  // namespace framewatch::daemon
