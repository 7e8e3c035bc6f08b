// SPDX-License-Identifier: MIT
#include "daemon/config/keys/fleet_options.h"

#include "daemon/config/keys/option_table.h"

namespace framewatch::daemon {
namespace {

const Option kFleet[] = {
    {.key = "building",
     .required = true,
     .meaning = "Name at the hub and in the certificate: 1 to 32 of a-z, 0-9 and -.",
     .target = into<&FleetSettings::building>},
    {.key = "hubs",
     .required = true,
     .meaning =
         "1 to 16 servers of the hub, such as `tls://hub1.example.org:4222`; any one suffices.",
     .target = into<&FleetSettings::hubs>},
    {.key = "certificate",
     .required = true,
     .meaning = "Certificate file (PEM). For this and the next two, a systemd credential of the "
                "same name takes precedence.",
     .is_path = true,
     .target = into<&FleetSettings::certificate>},
    {.key = "key",
     .required = true,
     .meaning = "Private key file of the certificate.",
     .is_path = true,
     .target = into<&FleetSettings::key>},
    {.key = "ca",
     .required = true,
     .meaning = "Certificate file that identifies the hub's servers.",
     .is_path = true,
     .target = into<&FleetSettings::ca>},
    {.key = "accept",
     .meaning = "Accepted hub commands: `acknowledge`, `raw`, `resend`, `minutes`. `ping` is "
                "always accepted.",
     .target = into<&FleetSettings::accept>},
    {.key = "raw_kbit_s",
     .unit = "kbit/s",
     .range = {1, 1e6},
     .meaning = "Largest rate for raw samples that the hub requests.",
     .target = into<&FleetSettings::raw_kbit_s>},
    {.key = "send_config",
     .meaning = "Send this file to the hub, at start and on change.",
     .target = into<&FleetSettings::send_config>},
};

}  // namespace

std::vector<OptionSection> fleet_options() {
  return {{"fleet", kFleet, Reach::settings}};
}

}  // namespace framewatch::daemon
