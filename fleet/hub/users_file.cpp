// SPDX-License-Identifier: MIT
#include "fleet/hub/users_file.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <sstream>

#include <fmt/core.h>

#include "daemon/base/file_digest.h"
#include "drivers/files/input_file.h"
#include "drivers/files/partial_file.h"
#include "fleet/message/address.h"

namespace framewatch::fleet {
namespace {

constexpr const char* kList = "buildings";
constexpr const char* kUsers = "users.conf";

// Reserved for the hub: a building with such a name would have the certificate of a hub program.
constexpr const char* kRoles[] = {"operator", "worker", "page", "admin"};

constexpr const char* kBeginning =
    R"(# Made by `framewatch fleet enroll` and `revoke` from the list in `buildings`.
users: [
  { user: "CN=operator" }
  { user: "CN=worker", permissions: {
      publish: [ "$JS.API.CONSUMER.MSG.NEXT.>", "$JS.API.CONSUMER.INFO.>", "$JS.API.STREAM.INFO.>",
                 "$JS.ACK.>", "fw.down.*.resend", "framewatch.>" ]
      subscribe: [ "_INBOX_worker.>" ] } }
  { user: "CN=page", permissions: {
      publish: [ "fw.down.>", "$JS.API.DIRECT.GET.>", "$JS.API.STREAM.MSG.GET.>", "$JS.API.STREAM.INFO.>",
                 "$JS.API.CONSUMER.MSG.NEXT.FW_LAST.page", "$JS.API.CONSUMER.INFO.FW_LAST.page",
                 "$JS.ACK.FW_LAST.page.>" ]
      subscribe: [ "_INBOX_page.>", "fw.up.>" ] } }
)";

}  // namespace

std::string problem_of_building(const std::string& name) {
  if (is_building_name(name) &&
      std::find(std::begin(kRoles), std::end(kRoles), name) == std::end(kRoles))
    return {};
  return "must be 1 to 32 of a-z, 0-9 and -, and not all, operator, worker, page or admin";
}

std::string users_text(const std::vector<std::string>& buildings) {
  std::string out = kBeginning;
  for (const std::string& b : buildings)
    out += fmt::format(
        "  {{ user: \"CN={0}\", permissions: {{\n"
        "      publish: [ \"fw.up.{0}.>\" ], allow_responses: {{ max: 1, expires: \"60s\" }}\n"
        "      subscribe: [ \"_INBOX_{0}.>\", \"fw.down.{0}.>\", \"fw.down.all.>\" ] }} }}\n",
        b);
  return out + "]\n";
}

std::string UsersFile::users_path() const {
  return (std::filesystem::path(directory_) / kUsers).string();
}

std::string UsersFile::read() {
  const std::string path = (std::filesystem::path(directory_) / kList).string();
  buildings_.clear();
  if (drivers::is_absent(path)) return {};
  std::string error;
  const auto text = daemon::read_text_file(path, error);
  if (!text) return fmt::format("{}: {}", path, error);
  std::istringstream lines(*text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.empty()) continue;
    if (const std::string rule = problem_of_building(line); !rule.empty())
      return fmt::format("{}:{}: a building {}", path, number, rule);
    add(line);
  }
  return {};
}

bool UsersFile::has(const std::string& building) const {
  return std::binary_search(buildings_.begin(), buildings_.end(), building);
}

void UsersFile::add(const std::string& building) {
  const auto at = std::lower_bound(buildings_.begin(), buildings_.end(), building);
  if (at == buildings_.end() || *at != building) buildings_.insert(at, building);
}

void UsersFile::remove(const std::string& building) {
  std::erase(buildings_, building);
}

std::string UsersFile::write() const {
  std::string list;
  for (const std::string& b : buildings_) list += b + "\n";
  std::string problem = replace_file(users_path(), users_text(buildings_));
  if (problem.empty())
    problem = replace_file((std::filesystem::path(directory_) / kList).string(), list);
  return problem;
}

std::string replace_file(const std::string& path, const std::string& text) {
  drivers::PartialFile file;
  if (!file.open(path)) return fmt::format("{}: {}", path, file.error());
  std::FILE* stream = file.stream();
  const bool written = stream != nullptr &&
                       std::fwrite(text.data(), 1, text.size(), stream) == text.size() &&
                       std::fclose(stream) == 0;
  if (!written || !file.commit()) return fmt::format("{}: {}", path, file.error());
  return {};
}

}  // namespace framewatch::fleet
