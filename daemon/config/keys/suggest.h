// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace framewatch::daemon {

/// The candidate that `word` was most likely meant to be; empty when none is near.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// Returns advice about a key that `section` does not have: another unit, another section, a
/// misspelling, or else the keys there are.
std::string advice_on_unknown_key(std::string_view section, std::string_view key);

/// Returns ", did you mean X?" with `quote` around X, or an empty text if no candidate is close.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates,
                         const char* quote = "");

}  // namespace framewatch::daemon
