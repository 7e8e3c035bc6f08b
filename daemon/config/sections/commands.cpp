#include "daemon/config/keys/section.h"
#include "daemon/config/sections/sections.h"

namespace framewatch::daemon {

CommandSettings read_commands(const TomlValue& document, std::vector<TextProblem>& problems) {
  const TomlEntry* entry = document.find("commands");
  ConfigSection section("commands", "commands", entry ? &entry->value : nullptr, {1, 1}, problems);
  CommandSettings out;
  section.read_into(out);
  return out;
}

}  // namespace framewatch::daemon
