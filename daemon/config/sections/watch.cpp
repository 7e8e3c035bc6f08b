#include "daemon/config/keys/section.h"
#include "daemon/config/sections/sections.h"

namespace framewatch::daemon {

std::optional<WatchSettings> read_watch(const TomlValue& document,
                                        std::vector<TextProblem>& problems) {
  const TomlEntry* entry = document.find("watch");
  if (entry == nullptr) return std::nullopt;
  ConfigSection section("watch", "watch", &entry->value, {1, 1}, problems);
  WatchSettings out;
  section.read_into(out);
  out.options.temperature = !out.temperature_channel.empty();
  return out;
}

}  // namespace framewatch::daemon
