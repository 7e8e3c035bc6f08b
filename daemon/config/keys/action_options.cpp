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
     .default_value = "\"warning\"",
     .choices = "information|warning|alarm",
     .meaning = "Events of at least this severity are told. What was told is also told to be over.",
     .reload = settings,
     .target = into<&ActionSettings::severity>},
    {.section = "actions",
     .key = "kinds",
     .type = texts,
     .default_value = "[]",
     .meaning =
         "Only events of these kinds, \"stiffness_change\", \"gap\", \"history\", \"bus_off\" "
         "and so on; empty: of every kind.",
     .reload = settings,
     .target = into<&ActionSettings::kinds>},
    {.section = "actions",
     .key = "changed_every_s",
     .unit = "s",
     .default_value = "60",
     .min = 0,
     .max = 86400,
     .meaning = "A change of an event is told no sooner than this after the last that was told of "
                "it; the newest one is.",
     .reload = settings,
     .target = into<&ActionSettings::changed_every_s>},
    {.section = "actions",
     .key = "per_minute",
     .type = integer,
     .unit = "1/min",
     .default_value = "12",
     .min = 1,
     .max = 6000,
     .meaning = "The command and the webhook are told no more events than this in a minute each. "
                "The others wait, the most severe first.",
     .reload = settings,
     .target = into<&ActionSettings::per_minute>},
    {.section = "actions",
     .key = "command",
     .type = texts,
     .default_value = "[]",
     .meaning = "A program and its arguments, run once for each event, without a shell: the event "
                "is JSON on its standard input and FRAMEWATCH_* in its environment.",
     .reload = settings,
     .target = into<&ActionSettings::command>},
    {.section = "actions",
     .key = "command_timeout_s",
     .unit = "s",
     .default_value = "30",
     .min = 0.1,
     .max = 3600,
     .meaning = "It is ended, with its process group, when it takes longer.",
     .reload = settings,
     .target = into<&ActionSettings::command_timeout_s>},
    {.section = "actions",
     .key = "webhook",
     .type = text,
     .meaning = "http:// or https:// address that each event is sent to: POST, JSON.",
     .reload = settings,
     .target = into<&ActionSettings::webhook>},
    {.section = "actions",
     .key = "webhook_header_file",
     .type = text,
     .meaning = "File with further headers of the request, one a line: \"Authorization: Bearer "
                "...\". Read for each request; beside this file unless the path says otherwise.",
     .reload = settings,
     .is_path = true,
     .target = into<&ActionSettings::webhook_header_file>},
    {.section = "actions",
     .key = "webhook_ca_file",
     .type = text,
     .meaning = "Certificates (PEM) that the server's must descend from, in place of the system's.",
     .reload = settings,
     .is_path = true,
     .target = into<&ActionSettings::webhook_ca_file>},
    {.section = "actions",
     .key = "webhook_timeout_s",
     .unit = "s",
     .default_value = "10",
     .min = 0.1,
     .max = 300,
     .meaning = "For one request, connecting included.",
     .reload = settings,
     .target = into<&ActionSettings::webhook_timeout_s>},
    {.section = "actions",
     .key = "webhook_patience_s",
     .unit = "s",
     .default_value = "3600",
     .min = 0,
     .max = 604800,
     .meaning =
         "An event that the server does not take is sent again, after 1 s, 2 s, 4 s and so on "
         "up to 60 s, until this has passed; then it is lost, and counted.",
     .reload = settings,
     .target = into<&ActionSettings::webhook_patience_s>},
};

}  // namespace

std::span<const Option> action_options() {
  return kOptions;
}

}  // namespace framewatch::daemon
