// SPDX-License-Identifier: MIT
#include "daemon/config/keys/lcm_options.h"

#include "daemon/config/keys/option_table.h"

namespace framewatch::daemon {
namespace {

using enum Reach;

const Option kCommands[] = {
    {.key = "directory",
     .meaning =
         "Directory of the sockets `<prefix>run` and `<prefix>record`. Default: /run/framewatch "
         "for the service; else $XDG_RUNTIME_DIR/framewatch, or /tmp/framewatch-UID.",
     .is_path = true,
     .target = into<&CommandSettings::directory>},
};

const Option kLcm[] = {
    {.key = "url",
     .meaning = "LCM provider. ttl=0 keeps messages on this machine.",
     .target = into<&LcmSettings::url>},
    {.key = "prefix",
     .meaning = "Prefix of published channels; must differ between daemons on one bus.",
     .target = into<&LcmSettings::prefix>},
    {.key = "interface",
     .meaning = "Network interfaces for received udpm messages, besides this machine's own. Others "
                "are dropped and counted.",
     .target = into<&LcmSettings::reception, &drivers::LcmReception::interfaces>},
    {.key = "queue_capacity",
     .unit = "messages",
     .range = {1, 10000000},
     .meaning = "Queue length per channel; further messages are dropped and counted.",
     .target = into<&LcmSettings::queue_capacity>},
    {.key = "receive_buffer_bytes",
     .unit = "bytes",
     .range = {4096, 1073741824},
     .meaning = "Receive buffer of the socket.",
     .target = into<&LcmSettings::reception, &drivers::LcmReception::receive_buffer_bytes>},
    {.key = "commands",
     .meaning = "Accept commands over LCM too, from anyone who can send there.",
     .target = into<&LcmSettings::commands>},
    {.key = "boxplot_every",
     .unit = "windows",
     .range = {1, 1000000},
     .meaning = "Send boxplot statistics with every n-th window.",
     .reload = settings,
     .target = into<&LcmSettings::boxplot_every>},
    {.key = "two_senders",
     .choices = "first|none",
     .meaning = "Whose samples to use while two senders share a node number. If the senders are "
                "indistinguishable, both are ignored.",
     .reload = settings,
     .target = into<&LcmSettings::two_senders>},
};

}  // namespace

std::vector<OptionSection> lcm_options() {
  return {{"lcm", kLcm, Reach::restart}, {"commands", kCommands, Reach::restart}};
}

}  // namespace framewatch::daemon
