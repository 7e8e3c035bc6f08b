// SPDX-License-Identifier: MIT
#include "daemon/config/keys/lcm_options.h"

#include "daemon/config/keys/option_table.h"

namespace framewatch::daemon {
namespace {

using enum OptionType;
using enum Reach;

const Option kCommands[] = {
    {.section = "commands",
     .key = "directory",
     .type = text,
     .meaning =
         "Directory of the sockets `<prefix>run` and `<prefix>record`. Default: /run/framewatch "
         "for the service; else $XDG_RUNTIME_DIR/framewatch, or /tmp/framewatch-UID.",
     .reload = restart,
     .is_path = true,
     .target = into<&CommandSettings::directory>},
};

using enum OptionType;
using enum Reach;

const Option kLcm[] = {
    {.section = "lcm",
     .key = "url",
     .type = text,
     .meaning = "LCM provider. ttl=0 keeps messages on this machine.",
     .reload = restart,
     .target = into<&LcmSettings::url>},
    {.section = "lcm",
     .key = "prefix",
     .type = text,
     .meaning = "Prefix of published channels; must differ between daemons on one bus.",
     .reload = restart,
     .target = into<&LcmSettings::prefix>},
    {.section = "lcm",
     .key = "interface",
     .type = texts,
     .meaning = "Network interfaces for received udpm messages, besides this machine's own. Others "
                "are dropped and counted.",
     .reload = restart,
     .target = into<&LcmSettings::reception, &drivers::LcmReception::interfaces>},
    {.section = "lcm",
     .key = "queue_capacity",
     .type = integer,
     .unit = "messages",
     .min = 1,
     .max = 10000000,
     .meaning = "Queue length per channel; further messages are dropped and counted.",
     .reload = restart,
     .target = into<&LcmSettings::queue_capacity>},
    {.section = "lcm",
     .key = "receive_buffer_bytes",
     .type = integer,
     .unit = "bytes",
     .min = 4096,
     .max = 1073741824,
     .meaning = "Receive buffer of the socket.",
     .reload = restart,
     .target = into<&LcmSettings::reception, &drivers::LcmReception::receive_buffer_bytes>},
    {.section = "lcm",
     .key = "commands",
     .type = boolean,
     .meaning = "Accept commands over LCM too, from anyone who can send there.",
     .reload = restart,
     .target = into<&LcmSettings::commands>},
    {.section = "lcm",
     .key = "boxplot_every",
     .type = integer,
     .unit = "windows",
     .min = 1,
     .max = 1000000,
     .meaning = "Send boxplot statistics with every n-th window.",
     .reload = settings,
     .target = into<&LcmSettings::boxplot_every>},
    {.section = "lcm",
     .key = "two_senders",
     .type = choice,
     .choices = "first|none",
     .meaning = "Whose samples to use while two senders share a node number. If the senders are "
                "indistinguishable, both are ignored.",
     .reload = settings,
     .target = into<&LcmSettings::two_senders>},
};

}  // namespace

std::span<const Option> command_options() {
  return kCommands;
}

std::span<const Option> lcm_options() {
  return kLcm;
}

}  // namespace framewatch::daemon
