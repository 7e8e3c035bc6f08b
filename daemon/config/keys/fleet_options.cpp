#include "daemon/config/keys/fleet_options.h"

#include "daemon/config/keys/option_table.h"

namespace framewatch::daemon {
namespace {

using enum OptionType;
using enum Reach;

const Option kOptions[] = {
    {.section = "fleet",
     .key = "building",
     .type = text,
     .required = true,
     .meaning = "What the hub knows this building by, and the name in its certificate: 1 to 32 of "
                "a-z, 0-9 and -.",
     .reload = settings,
     .target = into<&FleetSettings::building>},
    {.section = "fleet",
     .key = "hubs",
     .type = texts,
     .required = true,
     .meaning =
         "Servers of the hub, as `tls://hub1.example.org:4222`; 1 to 16. Any of them will do.",
     .reload = settings,
     .target = into<&FleetSettings::hubs>},
    {.section = "fleet",
     .key = "certificate",
     .type = text,
     .required = true,
     .meaning = "File with this building's certificate (PEM). Under systemd a credential of the "
                "same name goes first, here and for the next two.",
     .reload = settings,
     .is_path = true,
     .target = into<&FleetSettings::certificate>},
    {.section = "fleet",
     .key = "key",
     .type = text,
     .required = true,
     .meaning = "File with the certificate's private key, which never leaves the building.",
     .reload = settings,
     .is_path = true,
     .target = into<&FleetSettings::key>},
    {.section = "fleet",
     .key = "ca",
     .type = text,
     .required = true,
     .meaning = "File with the certificate that servers of the hub are known by.",
     .reload = settings,
     .is_path = true,
     .target = into<&FleetSettings::ca>},
    {.section = "fleet",
     .key = "accept",
     .type = texts,
     .default_value = "[]",
     .meaning = "Commands of the hub that are obeyed, of `acknowledge`, `raw`, `resend` and "
                "`minutes`; others are refused. `ping` is always answered.",
     .reload = settings,
     .target = into<&FleetSettings::accept>},
    {.section = "fleet",
     .key = "raw_kbit_s",
     .unit = "kbit/s",
     .default_value = "2000",
     .min = 1,
     .max = 1e6,
     .meaning = "Raw samples that the hub asked for go out at this rate at most.",
     .reload = settings,
     .target = into<&FleetSettings::raw_kbit_s>},
    {.section = "fleet",
     .key = "send_config",
     .type = boolean,
     .default_value = "false",
     .meaning = "This file goes to the hub, at the start and when it has changed.",
     .reload = settings,
     .target = into<&FleetSettings::send_config>},
};

}  // namespace

std::span<const Option> fleet_options() {
  return kOptions;
}

}  // namespace framewatch::daemon
