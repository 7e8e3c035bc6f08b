#include <algorithm>
#include <filesystem>

#include "daemon/config_parts.h"
#include "daemon/config_section.h"
#include "daemon/event_words.h"

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
  const std::string severity = section.text("severity");
  out.severity = static_cast<int>(std::find(kSeverities.begin(), kSeverities.end(), severity) -
                                  kSeverities.begin());
  out.kinds = section.texts("kinds");
  out.changed_every_s = section.number("changed_every_s");
  out.per_minute = section.integer("per_minute");
  out.command = section.texts("command");
  out.command_timeout_s = section.number("command_timeout_s");
  if (section.given("webhook")) out.webhook = section.text("webhook");
  if (section.given("webhook_header_file"))
    out.webhook_header_file = section.text("webhook_header_file");
  if (section.given("webhook_ca_file")) out.webhook_ca_file = section.text("webhook_ca_file");
  out.webhook_timeout_s = section.number("webhook_timeout_s");
  out.webhook_patience_s = section.number("webhook_patience_s");
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

void place_actions(Config& config) {
  if (!config.actions) return;
  const std::filesystem::path beside = std::filesystem::path(config.path).parent_path();
  for (std::string* file : {&config.actions->webhook_header_file, &config.actions->webhook_ca_file})
    if (!file->empty()) *file = (beside / *file).string();
}

}  // namespace framewatch::daemon
