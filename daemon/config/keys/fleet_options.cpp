// SPDX-License-Identifier: MIT
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
     .meaning = "Name at the hub and in the certificate: 1 to 32 of a-z, 0-9 and -.",
     .reload = settings,
     .target = into<&FleetSettings::building>},
    {.section = "fleet",
     .key = "hubs",
     .type = texts,
     .required = true,
     .meaning =
         "1 to 16 servers of the hub, such as `tls://hub1.example.org:4222`; any one suffices.",
     .reload = settings,
     .target = into<&FleetSettings::hubs>},
    {.section = "fleet",
     .key = "certificate",
     .type = text,
     .required = true,
     .meaning = "Certificate file (PEM). For this and the next two, a systemd credential of the "
                "same name takes precedence.",
     .reload = settings,
     .is_path = true,
     .target = into<&FleetSettings::certificate>},
    {.section = "fleet",
     .key = "key",
     .type = text,
     .required = true,
     .meaning = "Private key file of the certificate.",
     .reload = settings,
     .is_path = true,
     .target = into<&FleetSettings::key>},
    {.section = "fleet",
     .key = "ca",
     .type = text,
     .required = true,
     .meaning = "Certificate file that identifies the hub's servers.",
     .reload = settings,
     .is_path = true,
     .target = into<&FleetSettings::ca>},
    {.section = "fleet",
     .key = "accept",
     .type = texts,
     .meaning = "Accepted hub commands: `acknowledge`, `raw`, `resend`, `minutes`. `ping` is "
                "always accepted.",
     .reload = settings,
     .target = into<&FleetSettings::accept>},
    {.section = "fleet",
     .key = "raw_kbit_s",
     .unit = "kbit/s",
     .min = 1,
     .max = 1e6,
     .meaning = "Largest rate for raw samples that the hub requests.",
     .reload = settings,
     .target = into<&FleetSettings::raw_kbit_s>},
    {.section = "fleet",
     .key = "send_config",
     .type = boolean,
     .meaning = "Send this file to the hub, at start and on change.",
     .reload = settings,
     .target = into<&FleetSettings::send_config>},
};

}  // namespace

std::span<const Option> fleet_options() {
  return kOptions;
}

}  // namespace framewatch::daemon
