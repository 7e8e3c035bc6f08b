// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstddef>

#include "daemon/base/local_time.h"
#include "daemon/config/keys/section.h"
#include "daemon/config/sections/sections.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMostPeople = 20;
constexpr std::size_t kLongestTopic = 64;  // of ntfy

bool has_space_or_control(const std::string& text) {
  return std::any_of(text.begin(), text.end(),
                     [](unsigned char c) { return c <= ' ' || c == 127; });
}

/// Returns the part of an address behind the host, such as "/a/b?c"; may be empty.
std::string path_of(const std::string& url) {
  const auto at = url.find_first_of("/?#", url.find("://") + 3);
  return at == std::string::npos ? "" : url.substr(at);
}

/// Returns the rule that a webhook's address breaks, or an empty text.
std::string problem_of_address(const std::string& url, WebhookFormat format) {
  const auto scheme = url.find("://");
  if (!url.starts_with("http://") && !url.starts_with("https://"))
    return "must begin with http:// or https://";
  const auto host = url.substr(scheme + 3, url.find_first_of("/?#", scheme + 3) - scheme - 3);
  if (host.empty()) return "must name a host";
  if (host.find('@') != std::string::npos)
    return "must not contain a password: put it into webhook_header_file";
  if (has_space_or_control(url)) return "must not contain spaces";
  if (format != WebhookFormat::ntfy) return {};
  const std::string path = path_of(url);
  if (path.size() < 2 || path.size() > kLongestTopic + 1 ||
      path.find_first_of("/?#", 1) != std::string::npos)
    return "must end with the topic of ntfy, such as https://ntfy.sh/my-building";
  return {};
}

/// Returns the rule that an e-mail address breaks, or an empty text.
std::string problem_of_email(const std::string& address) {
  const auto at = address.find('@');
  if (at == std::string::npos || at == 0 || at + 1 == address.size() ||
      address.find('@', at + 1) != std::string::npos)
    return "must be an address such as owner@example.org";
  if (has_space_or_control(address) || address.find_first_of("<>,;\"") != std::string::npos)
    return "must be an address without a name, spaces or brackets";
  return {};
}

void check_webhook(ConfigSection& section, const ActionSettings& actions) {
  if (section.given("webhook") && section.good("webhook_format"))
    if (const std::string rule = problem_of_address(actions.webhook, actions.webhook_format);
        !rule.empty())
      section.problem("webhook", rule);
  if (section.given("webhook") && section.given("webhook_file"))
    section.problem("webhook_file", "cannot be combined with webhook");
  if (!section.good("webhook_format")) return;
  const bool pagerduty = actions.webhook_format == WebhookFormat::pagerduty;
  if (pagerduty && actions.webhook_key_file.empty())
    section.problem("webhook_format",
                    "pagerduty needs webhook_key_file, a file with the integration key");
  if (!pagerduty && section.given("webhook_key_file"))
    section.problem("webhook_key_file", "needs webhook_format = \"pagerduty\"");
  for (const char* key : {"webhook_header_file", "webhook_ca_file", "webhook_format"})
    if (section.given(key) && !actions.has_webhook()) section.problem(key, "needs a webhook");
}

void check_people(ConfigSection& section, const std::vector<std::string>& people,
                  bool has_account) {
  if (!section.given("email")) return;
  for (const std::string& address : people)
    if (const std::string rule = problem_of_email(address); !rule.empty())
      section.problem("email", "\"" + address + "\" " + rule);
  if (people.size() > kMostPeople) section.problem("email", "must be at most 20 addresses");
  if (!people.empty() && !has_account) section.problem("email", "needs a section [email]");
}

void check_times(ConfigSection& section, const ActionSettings& actions) {
  if (section.given("quiet_hours") && !actions.quiet_hours.empty() &&
      !read_daily_span(actions.quiet_hours))
    section.problem("quiet_hours", "must be two different times, such as \"22:00-07:00\"");
  if (section.given("well_at") && !actions.well_at.empty() && !read_clock_time(actions.well_at))
    section.problem("well_at", "must be a time, such as \"08:00\"");
  if (section.given("time_zone") && !TimeZone::find(actions.time_zone))
    section.problem("time_zone",
                    "must be a time zone that this machine knows, such as \"Europe/Rome\"");
  for (const char* key : {"quiet_hours", "well_at"})
    if (section.given(key) && section.good("time_zone") && actions.time_zone.empty())
      section.problem(key, "needs time_zone, such as \"Europe/Rome\"");
  const auto quiet = read_daily_span(actions.quiet_hours);
  const auto at = read_clock_time(actions.well_at);
  if (quiet && at && quiet->holds(*at))
    section.problem("well_at", "must not be within quiet_hours");
  const bool only_pagerduty = actions.webhook_format == WebhookFormat::pagerduty &&
                              actions.command.empty() && actions.email.empty();
  if (section.given("well_at") && !actions.well_at.empty() && only_pagerduty)
    section.problem("well_at", "needs a command or an email: PagerDuty would open an incident");
}

void check_escalation(ConfigSection& section, const ActionSettings& actions) {
  if (!section.given("escalate")) return;
  for (auto name = actions.escalate.begin(); name != actions.escalate.end(); ++name) {
    if (*name != ActionSettings::kCommand && *name != ActionSettings::kWebhook &&
        *name != ActionSettings::kEmail)
      section.problem("escalate", "\"" + *name + "\" is not command, webhook or email");
    else if (!actions.has(*name))
      section.problem("escalate", "\"" + *name + "\" is not configured in [actions]");
    else if (std::find(actions.escalate.begin(), name, *name) != name)
      section.problem("escalate", "\"" + *name + "\" is there twice");
  }
  if (actions.escalate.size() == 1) section.problem("escalate", "must be two receivers or more");
}

std::optional<EmailSettings> read_email(const TomlValue& document,
                                        std::vector<TextProblem>& problems) {
  if (!document.find("email")) return std::nullopt;
  ConfigSection section("email", document, problems);
  auto out = section.read<EmailSettings>();
  if (section.given("server") && (out.server.empty() || has_space_or_control(out.server) ||
                                  out.server.find_first_of("/@?#:") != std::string::npos))
    section.problem("server", "must be the name of a host, without a port");
  if (section.given("from"))
    if (const std::string rule = problem_of_email(out.from); !rule.empty())
      section.problem("from", rule);
  if (section.good("tls") && out.tls == EmailTls::none && section.given("login_file"))
    section.problem("login_file", "needs tls = \"starttls\" or \"tls\"");
  return out;
}

std::optional<ReportSettings> read_report(const TomlValue& document, bool has_account,
                                          std::vector<TextProblem>& problems) {
  if (!document.find("report")) return std::nullopt;
  ConfigSection section("report", document, problems);
  auto out = section.read<ReportSettings>();
  if (section.given("directory") && out.directory.empty())
    section.problem("directory", "must not be empty");
  check_people(section, out.email, has_account);
  if (out.monthly && document.find("history") == nullptr)
    section.problem("monthly", "needs a section [history]");
  return out;
}

std::optional<ActionSettings> read_actions(const TomlValue& document, bool has_account,
                                           std::vector<TextProblem>& problems) {
  if (!document.find("actions")) return std::nullopt;
  ConfigSection section("actions", document, problems);
  auto out = section.read<ActionSettings>();
  if (!out.command.empty() && out.command.front().empty())
    section.problem("command", "must begin with the name of a program");
  check_webhook(section, out);
  check_people(section, out.email, has_account);
  check_times(section, out);
  check_escalation(section, out);
  if (section.good("command") && section.good("webhook") && section.good("webhook_file") &&
      section.good("webhook_format") && section.good("email") && out.command.empty() &&
      !out.has_webhook() && out.email.empty())
    section.problem("", "needs a command, a webhook or an email");
  return out;
}

}  // namespace

void read_notifications(const TomlValue& document, Config& config,
                        std::vector<TextProblem>& problems) {
  config.email = read_email(document, problems);
  const bool has_account = document.find("email") != nullptr;
  config.actions = read_actions(document, has_account, problems);
  config.report = read_report(document, has_account, problems);
}

}  // namespace framewatch::daemon
