// SPDX-License-Identifier: MIT
#include "fleet/hub/hub_commands.h"

#include <csignal>
#include <filesystem>

#include <fmt/core.h>

#include "daemon/base/exit_code.h"
#include "daemon/base/file_digest.h"
#include "daemon/base/printable.h"
#include "drivers/files/input_file.h"
#include "drivers/files/number_text.h"
#include "fleet/hub/certificates.h"
#include "fleet/hub/setup.h"
#include "fleet/hub/users_file.h"
#include "fleet/link/nats_link.h"

namespace framewatch::fleet {
namespace {

namespace fs = std::filesystem;

constexpr int kAnswer_ms = 5000;
constexpr const char* kOperator = "operator";

int refuse(const char* command, const std::string& why) {
  fmt::print(stderr, "framewatch fleet {}: {}\n", command, daemon::printable(why));
  return daemon::kBadInput;
}

/// Signals the servers to reload users.conf. Returns an empty text, or which server it failed for.
std::string reload(const std::vector<std::string>& files) {
  for (const std::string& file : files) {
    std::string error;
    auto text = daemon::read_text_file(file, error);
    if (!text) return fmt::format("{}: {}", file, error);
    while (!text->empty() && text->back() == '\n') text->pop_back();
    const auto process = drivers::parse_integer(*text);
    if (!process || *process < 2 || *process > INT32_MAX)
      return fmt::format("{}: expected a process id", file);
    if (::kill(static_cast<::pid_t>(*process), SIGHUP) != 0)
      return fmt::format("{}: process {} does not exist", file, *process);
  }
  return {};
}

int told(const char* command, const std::string& what, const UsersFile& users,
         const std::vector<std::string>& files) {
  if (const std::string why = reload(files); !why.empty()) return refuse(command, why);
  fmt::print("{}\n", what);
  if (files.empty())
    fmt::print("Copy {} to every server of the hub and reload it: nats-server --signal reload\n",
               users.users_path());
  return 0;
}

std::string certify(const Authority& authority, const std::string& directory,
                    const std::string& name, const std::vector<std::string>& hosts) {
  if (!drivers::is_absent((fs::path(directory) / (name + ".pem")).string())) return {};
  return authority.issue(name, hosts);
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> out(1);
  for (const char c : text) {
    if (c == ',')
      out.emplace_back();
    else
      out.back() += c;
  }
  return out;
}

}  // namespace

int setup_command(const SetupArguments& a) {
  std::string error;
  const fs::path folder(a.hub.directory);
  const auto link =
      NatsLink::open({a.hub.hubs, kOperator, (folder / "operator.pem").string(),
                      (folder / "operator.key").string(), (folder / "ca.pem").string()},
                     error);
  if (!link) return refuse("setup", error);
  if (!link->is_connected()) return refuse("setup", "no hub: " + link->trouble());
  const AskHub ask = [&](const std::string& subject, const std::string& json,
                         std::string& why) -> std::optional<std::string> {
    const auto answer = link->request(subject, {json.begin(), json.end()}, kAnswer_ms, why);
    if (!answer) return std::nullopt;
    return std::string(answer->bytes.begin(), answer->bytes.end());
  };
  const SetupOutcome done = set_up(hub_parts(a.replicas, a.buildings), ask, a.only_look);
  for (const std::string& line : done.lines) fmt::print("{}\n", daemon::printable(line));
  for (const std::string& problem : done.problems) (void)refuse("setup", problem);
  if (!done.problems.empty()) return daemon::kBadInput;
  return a.only_look && done.changed > 0 ? daemon::kFailed : 0;
}

int authority_command(const AuthorityArguments& a) {
  const Authority authority(a.directory);
  if (drivers::is_absent((fs::path(a.directory) / "ca.pem").string()))
    if (const std::string why = authority.make(); !why.empty()) return refuse("authority", why);
  for (const std::string& server : a.servers) {
    const std::size_t equals = server.find('=');
    const std::string name = server.substr(0, equals);
    const std::vector<std::string> hosts =
        equals == server.npos ? std::vector{name} : split(server.substr(equals + 1));
    for (const std::string& host : hosts)
      if (!is_host(name) || !is_host(host))
        return refuse("authority", fmt::format("'{}' is not NAME=HOST,HOST,...", server));
    if (const std::string why = certify(authority, a.directory, name, hosts); !why.empty())
      return refuse("authority", why);
  }
  for (const char* role : {"operator", "worker", "page", "admin"})
    if (const std::string why = certify(authority, a.directory, role, {}); !why.empty())
      return refuse("authority", why);
  UsersFile users(a.directory);
  std::string why = users.read();
  if (why.empty()) why = users.write();
  if (!why.empty()) return refuse("authority", why);
  fmt::print("{}: the authority, {} servers, operator, worker, page and admin; {} buildings\n",
             a.directory, a.servers.size(), users.buildings().size());
  return 0;
}

int request_command(const RequestArguments& a) {
  if (const std::string rule = problem_of_building(a.building); !rule.empty())
    return refuse("request", fmt::format("the name of a building {}", rule));
  for (const std::string& file : {a.key, a.request})
    if (!drivers::is_absent(file)) return refuse("request", file + " exists already");
  if (const std::string why = make_request(a.building, a.key, a.request); !why.empty())
    return refuse("request", why);
  fmt::print("Keep {} here. Send {} to the operator of the hub.\n", a.key, a.request);
  return 0;
}

int enroll_command(const EnrollArguments& a) {
  UsersFile users(a.directory);
  std::string why = problem_of_building(a.building);
  if (!why.empty()) return refuse("enroll", fmt::format("the name of a building {}", why));
  if (why = users.read(); !why.empty()) return refuse("enroll", why);
  const std::string certificate = a.certificate.empty() ? a.building + ".pem" : a.certificate;
  if (why = Authority(a.directory).sign(a.building, a.request, certificate); !why.empty())
    return refuse("enroll", why);
  users.add(a.building);
  if (why = users.write(); !why.empty()) return refuse("enroll", why);
  return told("enroll",
              fmt::format("{}: send {} back to the building, with {}", a.building, certificate,
                          (fs::path(a.directory) / "ca.pem").string()),
              users, a.reload);
}

int revoke_command(const EnrollArguments& a) {
  UsersFile users(a.directory);
  if (const std::string why = users.read(); !why.empty()) return refuse("revoke", why);
  if (!users.has(a.building)) return refuse("revoke", a.building + " is not enrolled");
  users.remove(a.building);
  if (const std::string why = users.write(); !why.empty()) return refuse("revoke", why);
  return told("revoke", a.building + " is no longer admitted", users, a.reload);
}

}  // namespace framewatch::fleet
