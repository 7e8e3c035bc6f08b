#include "daemon/keys/lcm_options.h"

#include "daemon/keys/option_table.h"

namespace framewatch::daemon {
namespace {

using enum OptionType;
using enum Reach;

const Option kOptions[] = {
    {.section = "lcm",
     .key = "url",
     .type = text,
     .default_value = "\"udpm://239.255.76.67:7667?ttl=0\"",
     .meaning = "LCM provider, as LCM writes it; ttl=0 keeps the traffic on this machine.",
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
     .key = "queue_capacity",
     .type = integer,
     .unit = "messages",
     .default_value = "10000",
     .min = 1,
     .max = 10000000,
     .meaning = "Messages that may wait for the estimator; more are counted and lost.",
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
     .target = into<&LcmSettings::receive_buffer_bytes>},
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
};

}  // namespace

std::span<const Option> lcm_options() {
  return kOptions;
}

}  // namespace framewatch::daemon
