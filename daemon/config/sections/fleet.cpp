// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/core.h>

#include "daemon/config/keys/section.h"
#include "daemon/config/sections/sections.h"
#include "drivers/files/number_text.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kLongestBuilding = 32, kMaxHubs = 16;
constexpr std::array<std::string_view, 4> kCommands{"acknowledge", "raw", "resend", "minutes"};
constexpr std::string_view kScheme = "tls://";

bool is_building(const std::string& name) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
  };
  return !name.empty() && name.size() <= kLongestBuilding && name != "all" &&
         std::all_of(name.begin(), name.end(), allowed);
}

/// Returns true for tls://HOST:PORT without user, path and blanks. A password would appear in logs.
bool is_hub(const std::string& url) {
  if (!url.starts_with(kScheme)) return false;
  const std::string rest = url.substr(kScheme.size());
  const std::size_t colon = rest.rfind(':');
  if (colon == std::string::npos || colon == 0 || rest.find_first_of("@/ ,\t") != rest.npos)
    return false;
  const auto port = drivers::parse_integer(rest.substr(colon + 1));
  return port && *port >= 1 && *port <= 65535;
}

}  // namespace

std::optional<FleetSettings> read_fleet(const TomlValue& document, bool has_history,
                                        std::vector<TextProblem>& problems) {
  if (!document.find("fleet")) return std::nullopt;
  ConfigSection section("fleet", document, problems);
  auto out = section.read<FleetSettings>();
  if (section.given("building") && !is_building(out.building))
    section.problem("building", "must be 1 to 32 of a-z, 0-9 and -, and not all");
  if (section.given("hubs")) {
    if (out.hubs.empty() || out.hubs.size() > kMaxHubs)
      section.problem("hubs", fmt::format("must be 1 to {} servers", kMaxHubs));
    for (const std::string& url : out.hubs)
      if (!is_hub(url)) section.problem("hubs", fmt::format("'{}' is not tls://HOST:PORT", url));
  }
  for (const char* key : {"certificate", "key", "ca"})
    if (section.given(key) && section.text(key).empty()) section.problem(key, "must not be empty");
  for (const std::string& command : out.accept)
    if (std::find(kCommands.begin(), kCommands.end(), command) == kCommands.end())
      section.problem(
          "accept", fmt::format("must be acknowledge, raw, resend or minutes, got '{}'", command));
  if (!has_history)
    problems.push_back(
        {section.where(), "fleet: needs [history], where messages wait for the hub"});
  return out;
}

}  // namespace framewatch::daemon
