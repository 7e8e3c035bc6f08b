#include "daemon/config/keys/command_options.h"

#include "daemon/config/keys/option_table.h"

namespace framewatch::daemon {
namespace {

using enum OptionType;
using enum Reach;

const Option kOptions[] = {
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

}  // namespace

std::span<const Option> command_options() {
  return kOptions;
}

}  // namespace framewatch::daemon
