#include "daemon/monitor/service/command_path.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include <fmt/core.h>

namespace framewatch::daemon {
namespace {

constexpr const char* kInstalledDirectory = "/run/framewatch";  // of framewatch.service

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

bool is_ours(const std::string& directory) {
  struct stat found {};
  return ::lstat(directory.c_str(), &found) == 0 && S_ISDIR(found.st_mode) &&
         found.st_uid == ::geteuid();
}

/// Below $XDG_RUNTIME_DIR when that is this user's: sudo may leave another one's there.
std::string session_directory() {
  const std::string directory = variable("XDG_RUNTIME_DIR");
  return is_ours(directory) ? directory + "/framewatch" : "";
}

std::string temporary_directory() {
  return fmt::format("/tmp/framewatch-{}", ::geteuid());
}

}  // namespace

std::string command_directory(const Config& config) {
  if (!config.commands.directory.empty()) return config.commands.directory;
  const std::string unit = variable("RUNTIME_DIRECTORY");  // several are separated by colons
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
  if (!S_ISDIR(found.st_mode)) return problem("is no directory");
  if (found.st_uid != ::geteuid() && found.st_uid != 0)
    return problem("belongs to another user, who could answer in our place");
  const bool sticky = (found.st_mode & S_ISVTX) != 0;
  const bool open = (found.st_mode & S_IWOTH) != 0 || ((found.st_mode & S_IWGRP) != 0 && !sticky);
  if (open) return problem("others may write there: chmod o-w,g-w, or for a group chmod o-w,+t");
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

}  // namespace framewatch::daemon
