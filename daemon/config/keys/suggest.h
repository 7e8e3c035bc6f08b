#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace framewatch::daemon {

/// The candidate that `word` was most likely meant to be; empty when none is near.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// What to tell a person about a key that `section` does not have: its unit is another one, it
/// belongs to another section, it is misspelt, or (last) which keys there are.
std::string advice_on_unknown_key(std::string_view section, std::string_view key);

}  // namespace framewatch::daemon
