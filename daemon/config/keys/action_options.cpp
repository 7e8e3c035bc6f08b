// SPDX-License-Identifier: MIT
#include "daemon/config/keys/action_options.h"

#include "daemon/config/keys/option_table.h"

namespace framewatch::daemon {
namespace {

const Option kActions[] = {
    {.key = "severity",
     .choices = "information|warning|alarm",
     .meaning = "Least severity of notified events. Their end is notified too.",
     .target = into<&ActionSettings::severity>},
    {.key = "kinds",
     .meaning = "Kinds of events, such as \"stiffness_change\", \"gap\", \"bus_off\". Empty: all.",
     .target = into<&ActionSettings::kinds>},
    {.key = "changed_every_s",
     .unit = "s",
     .range = {0, 86400},
     .meaning = "Least time between notifications of one event's changes; the newest change is "
                "always sent.",
     .target = into<&ActionSettings::changed_every_s>},
    {.key = "per_minute",
     .unit = "1/min",
     .range = {1, 6000},
     .meaning = "Most events per minute for each receiver: command, webhook, e-mail. Others wait, "
                "the most severe first.",
     .target = into<&ActionSettings::per_minute>},
    {.key = "command",
     .meaning = "Program and arguments, run once per event without a shell. The event is JSON on "
                "standard input and FRAMEWATCH_* in the environment.",
     .target = into<&ActionSettings::command>},
    {.key = "command_timeout_s",
     .unit = "s",
     .range = {0.1, 3600},
     .meaning = "The command's process group is ended after this time.",
     .target = into<&ActionSettings::command_timeout_s>},
    {.key = "webhook",
     .meaning = "http:// or https:// address for a POST per event. For ntfy it ends with the "
                "topic; for PagerDuty it may be absent.",
     .target = into<&ActionSettings::webhook>},
    {.key = "webhook_file",
     .meaning = "File whose first line is the address, instead of webhook, when the address is a "
                "secret, as for Slack and Teams. Read for each request.",
     .is_path = true,
     .target = into<&ActionSettings::webhook_file>},
    {.key = "webhook_format",
     .choices = "generic|slack|teams|ntfy|pagerduty",
     .meaning = "What the webhook is: generic gets framewatch's JSON; slack an incoming webhook, "
                "teams a workflow, ntfy a topic, pagerduty Events API v2.",
     .target = into<&ActionSettings::webhook_format>},
    {.key = "webhook_key_file",
     .meaning = "File whose first line is PagerDuty's integration key. Read for each request.",
     .is_path = true,
     .target = into<&ActionSettings::webhook_key_file>},
    {.key = "webhook_header_file",
     .meaning = "File of further request headers, one per line, relative to this file: "
                "\"Authorization: Bearer ...\". Read for each request.",
     .is_path = true,
     .target = into<&ActionSettings::webhook_header_file>},
    {.key = "webhook_ca_file",
     .meaning = "CA certificates (PEM) for the server, instead of the system's.",
     .is_path = true,
     .target = into<&ActionSettings::webhook_ca_file>},
    {.key = "webhook_timeout_s",
     .unit = "s",
     .range = {0.1, 300},
     .meaning = "Timeout of one request, including the connection.",
     .target = into<&ActionSettings::webhook_timeout_s>},
    {.key = "webhook_patience_s",
     .unit = "s",
     .range = {0, 604800},
     .meaning = "How long to retry, after 1 s, 2 s, 4 s and so on up to 60 s, or after the time "
                "that the server asks for. Then the event is lost and counted.",
     .target = into<&ActionSettings::webhook_patience_s>},
    {.key = "email",
     .meaning = "Addresses that get an e-mail per event, each its own. Needs [email].",
     .target = into<&ActionSettings::email>},
    {.key = "quiet_hours",
     .meaning = "Part of every day, such as \"22:00-07:00\", in which only events of "
                "quiet_severity are notified. Others wait until it ends. Needs time_zone.",
     .target = into<&ActionSettings::quiet_hours>},
    {.key = "quiet_severity",
     .choices = "information|warning|alarm",
     .meaning = "Least severity of events that are notified in quiet hours.",
     .target = into<&ActionSettings::quiet_severity>},
    {.key = "time_zone",
     .meaning = "Time zone of quiet_hours and well_at, such as \"Europe/Rome\" or \"UTC\".",
     .target = into<&ActionSettings::time_zone>},
    {.key = "escalate",
     .meaning = "Receivers in their order: \"command\", \"webhook\", \"email\". The first is "
                "notified at once, each other one while the event is not acknowledged. "
                "Receivers that are not listed are notified at once. Empty: all at once.",
     .target = into<&ActionSettings::escalate>},
    {.key = "escalate_after_min",
     .unit = "min",
     .range = {0.1, 10080},
     .meaning = "Time without an acknowledgement until the next receiver of escalate is notified.",
     .target = into<&ActionSettings::escalate_after_min>},
    {.key = "well_at",
     .meaning = "Time of a daily message that all is well, or what is not, such as \"08:00\". "
                "Its absence says that framewatch or its machine has stopped. Needs time_zone.",
     .target = into<&ActionSettings::well_at>},
};

const Option kEmail[] = {
    {.key = "server",
     .required = true,
     .meaning = "Host of the mail server that takes the messages (SMTP).",
     .target = into<&EmailSettings::server>},
    {.key = "port",
     .range = {0, 65535},
     .meaning = "Port of the server. 0: 587 for starttls, 465 for tls, 25 for none.",
     .target = into<&EmailSettings::port>},
    {.key = "tls",
     .choices = "starttls|tls|none",
     .meaning = "How the connection is encrypted. With none, framewatch does not log in.",
     .target = into<&EmailSettings::tls>},
    {.key = "from",
     .required = true,
     .meaning = "Address of the sender.",
     .target = into<&EmailSettings::from>},
    {.key = "login_file",
     .meaning = "File with the user in line 1 and the password in line 2. Read for each message. "
                "Default: the environment variables FRAMEWATCH_EMAIL_USER and "
                "FRAMEWATCH_EMAIL_PASSWORD; if they are not set, framewatch does not log in.",
     .is_path = true,
     .target = into<&EmailSettings::login_file>},
    {.key = "ca_file",
     .meaning = "CA certificates (PEM) for the server, instead of the system's.",
     .is_path = true,
     .target = into<&EmailSettings::ca_file>},
    {.key = "timeout_s",
     .unit = "s",
     .range = {0.1, 300},
     .meaning = "Timeout of one attempt, including the connection.",
     .target = into<&EmailSettings::timeout_s>},
    {.key = "patience_s",
     .unit = "s",
     .range = {0, 604800},
     .meaning = "How long to retry, after 1 s, 2 s, 4 s and so on up to 60 s. Then the event is "
                "lost and counted.",
     .target = into<&EmailSettings::patience_s>},
};

const Option kReport[] = {
    {.key = "monthly",
     .meaning = "true: on the first day of each month, `framewatch run` writes a page about the "
                "month before, such as 2026-11.html. Needs [history].",
     .target = into<&ReportSettings::monthly>},
    {.key = "directory",
     .required = true,
     .meaning = "Directory, relative to this file; created if missing.",
     .is_path = true,
     .target = into<&ReportSettings::directory>},
    {.key = "weather",
     .meaning = "Table of weather as for `framewatch history --weather`, which another program "
                "keeps up to date. Empty: the weather of the history.",
     .is_path = true,
     .target = into<&ReportSettings::weather>},
    {.key = "email",
     .meaning = "Addresses that get the report. Needs [email].",
     .target = into<&ReportSettings::email>},
};

}  // namespace

std::vector<OptionSection> action_options() {
  return {{"actions", kActions, Reach::settings},
          {"email", kEmail, Reach::settings},
          {"report", kReport, Reach::settings}};
}

}  // namespace framewatch::daemon
