// SPDX-License-Identifier: MIT
#include "daemon/monitor/service/command_client.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include <fmt/core.h>

#include "daemon/base/process.h"
#include "drivers/files/descriptor.h"
#include "drivers/lcm/multicast/lcm_packet.h"

namespace framewatch::daemon {
namespace {

constexpr const char* kInstalledDirectory =
    "/run/framewatch";  // RuntimeDirectory of framewatch.service

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

bool is_ours(const std::string& directory) {
  struct stat found {};
  return ::lstat(directory.c_str(), &found) == 0 && S_ISDIR(found.st_mode) &&
         found.st_uid == ::geteuid();
}

/// Returns the directory below $XDG_RUNTIME_DIR if that belongs to this user: after sudo it may be
/// another user's.
std::string session_directory() {
  const std::string directory = variable("XDG_RUNTIME_DIR");
  return is_ours(directory) ? directory + "/framewatch" : "";
}

std::string temporary_directory() {
  return fmt::format("/tmp/framewatch-{}", ::geteuid());
}

constexpr timeval kPatience{10, 0};

/// Returns who has the permission that this user lacks, and how to get it.
std::string permission_problem(const std::string& directory, const std::string& path) {
  struct stat found {};
  if (::stat(path.c_str(), &found) != 0 && ::stat(directory.c_str(), &found) != 0)
    return fmt::format("{}: no permission", path);
  const std::string group = group_name(found.st_gid), user = user_name(::geteuid());
  return fmt::format(
      "{0}: no permission: only the user {1} and members of the group {2} can give commands. Run "
      "sudo usermod -aG {2} {3}, then log in again",
      path, user_name(found.st_uid), group, user);
}

/// Connects. Returns false and sets errno on failure.
bool connect_to(const drivers::Descriptor& file, const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  errno = ENAMETOOLONG;
  if (path.size() >= sizeof address.sun_path) return false;
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  for (const int option : {SO_SNDTIMEO, SO_RCVTIMEO})  // the first one holds for connect(), too
    ::setsockopt(file.get(), SOL_SOCKET, option, &kPatience, sizeof kPatience);
  return ::connect(file.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
}

CommandAnswer exchange(const drivers::Descriptor& file, const std::string& path,
                       const CommandPacket& command) {
  const std::vector<std::uint8_t> bytes = packet_bytes(command);
  if (bytes.size() > CommandPacket::kMaxBytes)
    return {false, fmt::format("a command has {} bytes at most", CommandPacket::kMaxBytes)};
  std::vector<std::uint8_t> in(CommandPacket::kMaxBytes + 1);
  if (::send(file.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL) < 0)
    return {false, fmt::format("{}: {}", path, std::strerror(errno))};
  const ssize_t got = ::recv(file.get(), in.data(), in.size(), 0);
  if (got <= 0)
    return {false,
            fmt::format("{}: the daemon {}", path,
                        got == 0 || errno != EAGAIN ? "closed the connection without an answer"
                                                    : "does not answer")};
  const auto packet = packet_of({in.data(), static_cast<std::size_t>(got)});
  if (!packet) return {false, fmt::format("{}: the answer is not from a framewatch daemon", path)};
  if (packet->channel == CommandPacket::kRefused)
    return {true, {packet->bytes.begin(), packet->bytes.end()}};
  return {true, "", packet->bytes};
}

}  // namespace

CommandPacket refused(const std::string& why) {
  return {CommandPacket::kRefused, {why.begin(), why.end()}};
}

std::vector<std::uint8_t> packet_bytes(const CommandPacket& packet) {
  std::vector<std::uint8_t> out(packet.channel.begin(), packet.channel.end());
  out.push_back(0);
  out.insert(out.end(), packet.bytes.begin(), packet.bytes.end());
  return out;
}

std::optional<CommandPacket> packet_of(std::span<const std::uint8_t> bytes) {
  const auto end = std::find(bytes.begin(), bytes.end(), std::uint8_t{0});
  if (end == bytes.end() || end == bytes.begin() || bytes.size() > CommandPacket::kMaxBytes)
    return std::nullopt;
  if (end - bytes.begin() > std::ptrdiff_t{drivers::kLongestLcmChannel}) return std::nullopt;
  return CommandPacket{{bytes.begin(), end}, {end + 1, bytes.end()}};
}

std::string command_directory(const Config& config) {
  if (!config.commands.directory.empty()) return config.commands.directory;
  const std::string unit = variable("RUNTIME_DIRECTORY");  // systemd separates several by colons
  if (!unit.empty()) return unit.substr(0, unit.find(':'));
  const std::string session = session_directory();
  return session.empty() ? temporary_directory() : session;
}

std::vector<std::string> command_directories(const Config& config) {
  if (!config.commands.directory.empty()) return {config.commands.directory};
  std::vector<std::string> out;
  const std::string at_login = fmt::format("/run/user/{}/framewatch", ::geteuid());
  for (const std::string& ours : {session_directory(), at_login, temporary_directory()})
    if (is_ours(ours) && std::find(out.begin(), out.end(), ours) == out.end()) out.push_back(ours);
  out.emplace_back(kInstalledDirectory);
  return out;
}

std::string prepare_command_directory(const std::string& directory) {
  const auto problem = [&](const std::string& what) {
    return fmt::format("{}: {}", directory, what);
  };
  if (::mkdir(directory.c_str(), 0700) != 0 && errno != EEXIST)
    return problem(std::strerror(errno));
  struct stat found {};
  if (::lstat(directory.c_str(), &found) != 0) return problem(std::strerror(errno));
  if (!S_ISDIR(found.st_mode)) return problem("is not a directory");
  if (found.st_uid != ::geteuid() && found.st_uid != 0)
    return problem("belongs to another user, who could answer instead of framewatch");
  const bool sticky = (found.st_mode & S_ISVTX) != 0;
  const bool open = (found.st_mode & S_IWOTH) != 0 || ((found.st_mode & S_IWGRP) != 0 && !sticky);
  if (open)
    return problem("others may write there: run chmod o-w,g-w, or chmod o-w,+t for a group");
  return "";
}

std::string command_path(const std::string& directory, const Config& config,
                         const std::string& service) {
  std::string name;
  for (const char c : config.lcm.prefix + service) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
    name += plain ? std::string(1, c) : fmt::format("%{:02x}", static_cast<unsigned char>(c));
  }
  return directory + "/" + name;
}

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
                          errno == EAGAIN ? "the daemon does not answer" : std::strerror(errno))};
    looked += (looked.empty() ? "" : ", ") + path;
  }
  if (!forbidden.empty()) return {false, forbidden};
  return {false,
          fmt::format("no framewatch {} takes commands here (looked for {}). Start it with this "
                      "configuration, or name the configuration with which it runs",
                      service, looked)};
}

}  // namespace framewatch::daemon
