#include <fmt/core.h>

#include "daemon/config/keys/section.h"
#include "daemon/config/sections/sections.h"

namespace framewatch::daemon {

LcmSettings read_lcm(const TomlValue& document, std::vector<TextProblem>& problems) {
  const TomlEntry* entry = document.find("lcm");
  ConfigSection section("lcm", "lcm", entry ? &entry->value : nullptr, {1, 1}, problems);
  LcmSettings out;
  section.read_into(out);
  if (section.good("url") && out.url.find("://") == std::string::npos)
    section.problem("url", fmt::format("expected a provider such as udpm://, memq:// or "
                                       "file://, got \"{}\"",
                                       out.url));
  constexpr std::size_t kLongestSuffix = 24;
  if (out.prefix.size() + kLongestSuffix > 63)
    section.problem("prefix", fmt::format("at most {} characters: LCM allows a channel 63",
                                          63 - kLongestSuffix));
  return out;
}

}  // namespace framewatch::daemon
