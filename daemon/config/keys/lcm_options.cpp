#include "daemon/config/keys/lcm_options.h"

#include "daemon/config/keys/option_table.h"

namespace framewatch::daemon {
namespace {

using enum OptionType;
using enum Reach;

const Option kOptions[] = {
    {.section = "lcm",
     .key = "url",
     .type = text,
     .default_value = "\"udpm://239.255.76.67:7667?ttl=0\"",
     .meaning = "LCM provider, as LCM writes it; ttl=0 keeps what is sent on this machine.",
     .reload = restart,
     .target = into<&LcmSettings::url>},
    {.section = "lcm",
     .key = "prefix",
     .type = text,
     .default_value = "\"FRAMEWATCH_\"",
     .meaning = "Of the channels framewatch publishes on; two daemons on one bus need two.",
     .reload = restart,
     .target = into<&LcmSettings::prefix>},
    {.section = "lcm",
     .key = "interface",
     .type = texts,
     .default_value = "[\"lo\"]",
     .meaning =
         "Network interfaces over which messages of a udpm url are taken, whoever sends them. "
         "This machine's own always are; all others are dropped and counted.",
     .reload = restart,
     .target = into<&LcmSettings::reception, &drivers::LcmReception::interfaces>},
    {.section = "lcm",
     .key = "queue_capacity",
     .type = integer,
     .unit = "messages",
     .default_value = "10000",
     .min = 1,
     .max = 10000000,
     .meaning =
         "Messages of each channel that may wait for the estimator; more are counted and lost.",
     .reload = restart,
     .target = into<&LcmSettings::queue_capacity>},
    {.section = "lcm",
     .key = "receive_buffer_bytes",
     .type = integer,
     .unit = "bytes",
     .default_value = "4194304",
     .min = 4096,
     .max = 1073741824,
     .meaning = "Size of the socket's receive buffer.",
     .reload = restart,
     .target = into<&LcmSettings::reception, &drivers::LcmReception::receive_buffer_bytes>},
    {.section = "lcm",
     .key = "commands",
     .type = boolean,
     .default_value = "false",
     .meaning = "Commands (acknowledging, recording) are taken from LCM too: from whoever can send "
                "there, under any name. Otherwise over a socket alone ([commands]).",
     .reload = restart,
     .target = into<&LcmSettings::commands>},
    {.section = "lcm",
     .key = "boxplot_every",
     .type = integer,
     .unit = "windows",
     .default_value = "1",
     .min = 1,
     .max = 1000000,
     .meaning = "Boxplot statistics go out with every n-th window.",
     .reload = settings,
     .target = into<&LcmSettings::boxplot_every>},
    {.section = "lcm",
     .key = "two_senders",
     .type = choice,
     .default_value = "\"first\"",
     .choices = "first|none",
     .meaning = "Whose samples go on while two send under one node: those of the first, or none. "
                "Never a mixture: where nothing tells two apart, none.",
     .reload = settings,
     .target = into<&LcmSettings::two_senders>},
};

}  // namespace

std::span<const Option> lcm_options() {
  return kOptions;
}

}  // namespace framewatch::daemon
