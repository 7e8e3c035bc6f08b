// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace framewatch::daemon {

/// Body of a webhook's request: framewatch's own JSON, or that of a service.
enum class WebhookFormat { generic, slack, teams, ntfy, pagerduty };

/// How a connection to the mail server is encrypted: after a STARTTLS command, from the first byte
/// on, or not at all.
enum class EmailTls { starttls, tls, none };

/// [email]: the account that sends e-mail, docs/actions.md.
struct EmailSettings {
  std::string server;  ///< host of the mail server; empty without [email]
  int port = 0;        ///< 0: 587 for starttls, 465 for tls, 25 for none
  EmailTls tls = EmailTls::starttls;
  std::string from;           ///< address of the sender
  std::string login_file;     ///< file with the user in line 1, the password in line 2; empty: none
  std::string ca_file;        ///< trusted certificates; empty for the system's
  double timeout_s = 30;      ///< timeout of one attempt
  double patience_s = 14400;  ///< a failed delivery is repeated for this long
};

/// [report]: a report every month, docs/years.md.
struct ReportSettings {
  bool monthly = false;
  std::string directory;           ///< where the pages are written
  std::string weather;             ///< table as for `framewatch history --weather`; empty: none
  std::vector<std::string> email;  ///< addresses of people; empty for no e-mail
};

/// [actions]: notifications of `framewatch run` when an event is raised, changes or is cleared,
/// docs/actions.md.
struct ActionSettings {
  int severity = 1;                ///< lowest event_t::severity of delivered events
  std::vector<std::string> kinds;  ///< kinds of delivered events; empty for all
  double changed_every_s = 60;     ///< shortest time between two deliveries of an event's changes
  int per_minute = 12;             ///< most deliveries by each receiver

  std::vector<std::string> command;  ///< program and arguments; empty for no command
  double command_timeout_s = 30;

  std::string webhook;       ///< URL; empty for no webhook, or the default of the format
  std::string webhook_file;  ///< file with the URL, when the URL is a secret
  WebhookFormat webhook_format = WebhookFormat::generic;
  std::string webhook_key_file;      ///< file with PagerDuty's integration key
  std::string webhook_header_file;   ///< file with further headers, one per line
  std::string webhook_ca_file;       ///< trusted certificates; empty for the system's
  double webhook_timeout_s = 10;     ///< timeout of one attempt
  double webhook_patience_s = 3600;  ///< a failed delivery is repeated for this long

  std::string quiet_hours;  ///< such as "22:00-07:00"; empty for none
  int quiet_severity = 2;   ///< lowest event_t::severity of events delivered in quiet hours
  std::string time_zone;    ///< of quiet_hours and well_at, such as "Europe/Rome"
  std::string well_at;      ///< time of the daily message, such as "08:00"; empty for none

  std::vector<std::string> escalate;  ///< receivers in their order; empty: all at once
  double escalate_after_min = 30;     ///< time until the next receiver

  std::vector<std::string> email;  ///< addresses of people; empty for no e-mail
  EmailSettings account = {};      ///< from [email]; not a key

  /// Names of receivers, as in `escalate`.
  static constexpr const char* kCommand = "command";
  static constexpr const char* kWebhook = "webhook";
  static constexpr const char* kEmail = "email";

  bool has_webhook() const {
    return !webhook.empty() || !webhook_file.empty() || webhook_format == WebhookFormat::pagerduty;
  }
  /// Returns true if the receiver of this name is configured.
  bool has(std::string_view receiver) const {
    return (receiver == kCommand && !command.empty()) || (receiver == kWebhook && has_webhook()) ||
           (receiver == kEmail && !email.empty());
  }
};

}  // namespace framewatch::daemon
