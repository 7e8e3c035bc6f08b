#include "daemon/config/keys/section.h"
#include "daemon/config/sections/sections.h"

namespace framewatch::daemon {

std::optional<GapSettings> read_gap(const TomlValue& document, std::vector<TextProblem>& problems) {
  const TomlEntry* entry = document.find("gap");
  if (entry == nullptr) return std::nullopt;
  ConfigSection section("gap", "gap", &entry->value, {1, 1}, problems);
  GapSettings out;
  section.read_into(out);
  return out;
}

}  // namespace framewatch::daemon
