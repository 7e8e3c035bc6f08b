#include "daemon/config/keys/action_options.h"

#include "daemon/config/keys/option_table.h"

namespace framewatch::daemon {
namespace {

using enum OptionType;
using enum Reach;

const Option kOptions[] = {
    {.section = "actions",
     .key = "severity",
     .type = choice,
     .choices = "information|warning|alarm",
     .meaning = "Least severity of notified events. Their end is notified too.",
     .reload = settings,
     .target = into<&ActionSettings::severity>},
    {.section = "actions",
     .key = "kinds",
     .type = texts,
     .meaning = "Kinds of events, such as \"stiffness_change\", \"gap\", \"bus_off\". Empty: all.",
     .reload = settings,
     .target = into<&ActionSettings::kinds>},
    {.section = "actions",
     .key = "changed_every_s",
     .unit = "s",
     .min = 0,
     .max = 86400,
     .meaning = "Least time between notifications of one event's changes; the newest change is "
                "always sent.",
     .reload = settings,
     .target = into<&ActionSettings::changed_every_s>},
    {.section = "actions",
     .key = "per_minute",
     .type = integer,
     .unit = "1/min",
     .min = 1,
     .max = 6000,
     .meaning = "Most events per minute, each for the command and the webhook. Others wait, the "
                "most severe first.",
     .reload = settings,
     .target = into<&ActionSettings::per_minute>},
    {.section = "actions",
     .key = "command",
     .type = texts,
     .meaning = "Program and arguments, run once per event without a shell. The event is JSON on "
                "standard input and FRAMEWATCH_* in the environment.",
     .reload = settings,
     .target = into<&ActionSettings::command>},
    {.section = "actions",
     .key = "command_timeout_s",
     .unit = "s",
     .min = 0.1,
     .max = 3600,
     .meaning = "The command's process group is ended after this time.",
     .reload = settings,
     .target = into<&ActionSettings::command_timeout_s>},
    {.section = "actions",
     .key = "webhook",
     .type = text,
     .meaning = "http:// or https:// address for a POST with JSON per event.",
     .reload = settings,
     .target = into<&ActionSettings::webhook>},
    {.section = "actions",
     .key = "webhook_header_file",
     .type = text,
     .meaning = "File of further request headers, one per line, relative to this file: "
                "\"Authorization: Bearer ...\". Read for each request.",
     .reload = settings,
     .is_path = true,
     .target = into<&ActionSettings::webhook_header_file>},
    {.section = "actions",
     .key = "webhook_ca_file",
     .type = text,
     .meaning = "CA certificates (PEM) for the server, instead of the system's.",
     .reload = settings,
     .is_path = true,
     .target = into<&ActionSettings::webhook_ca_file>},
    {.section = "actions",
     .key = "webhook_timeout_s",
     .unit = "s",
     .min = 0.1,
     .max = 300,
     .meaning = "Timeout of one request, including the connection.",
     .reload = settings,
     .target = into<&ActionSettings::webhook_timeout_s>},
    {.section = "actions",
     .key = "webhook_patience_s",
     .unit = "s",
     .min = 0,
     .max = 604800,
     .meaning = "How long to retry, after 1 s, 2 s, 4 s and so on up to 60 s. Then the event is "
                "lost and counted.",
     .reload = settings,
     .target = into<&ActionSettings::webhook_patience_s>},
};

}  // namespace

std::span<const Option> action_options() {
  return kOptions;
}

}  // namespace framewatch::daemon
