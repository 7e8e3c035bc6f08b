#include <algorithm>

#include "daemon/config/keys/section.h"
#include "daemon/config/sections/sections.h"

namespace framewatch::daemon {
namespace {

/// Rule that the address breaks; empty when it is good.
std::string problem_of_address(const std::string& url) {
  const auto scheme = url.find("://");
  if (!url.starts_with("http://") && !url.starts_with("https://"))
    return "must begin with http:// or https://";
  const auto host = url.substr(scheme + 3, url.find_first_of("/?#", scheme + 3) - scheme - 3);
  if (host.empty()) return "must name a host";
  if (host.find('@') != std::string::npos)
    return "must not hold a password: put it into webhook_header_file";
  if (std::any_of(url.begin(), url.end(), [](char c) { return c <= ' ' || c == 127; }))
    return "must not hold spaces";
  return {};
}

}  // namespace

std::optional<ActionSettings> read_actions(const TomlValue& document,
                                           std::vector<TextProblem>& problems) {
  const TomlEntry* entry = document.find("actions");
  if (entry == nullptr) return std::nullopt;
  ConfigSection section("actions", "actions", &entry->value, {1, 1}, problems);
  ActionSettings out;
  section.read_into(out);
  if (!out.command.empty() && out.command.front().empty())
    section.problem("command", "must begin with the name of a program");
  if (section.given("webhook"))
    if (const std::string rule = problem_of_address(out.webhook); !rule.empty())
      section.problem("webhook", rule);
  for (const char* key : {"webhook_header_file", "webhook_ca_file"})
    if (section.given(key) && out.webhook.empty()) section.problem(key, "needs a webhook");
  if (section.good("command") && section.good("webhook") && out.command.empty() &&
      out.webhook.empty())
    section.problem("", "needs a command or a webhook");
  return out;
}

}  // namespace framewatch::daemon
