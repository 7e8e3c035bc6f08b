// SPDX-License-Identifier: MIT
#include "daemon/config/keys/suggest.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "daemon/config/keys/option_table.h"

namespace framewatch::daemon {
namespace {

/// Returns the number of insertions, deletions, replacements and swaps of neighbors that turn one
/// word into the other.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last, last(b.size() + 1), now(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      now[j] = std::min({last[j] + 1, now[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        now[j] = std::min(now[j], before_last[j - 2] + 1);
    }
    before_last = last;
    last = now;
  }
  return last.back();
}

/// Returns the key without its unit: node_mass for node_mass_kg. Empty if it has no unit.
std::string_view stem(std::string_view key) {
  constexpr std::string_view kUnits[] = {
      "_mps2_per_rthz", "_mps2", "_npm", "_kg", "_hz", "_m", "_s", "_bytes"};
  for (const std::string_view unit : kUnits)
    if (key.ends_with(unit)) return key.substr(0, key.size() - unit.size());
  return "";
}

/// Returns true for node_mass and node_mass_t, but not for node_massive.
bool is_stem_with_another_unit(std::string_view key, std::string_view stem_of_option) {
  if (stem_of_option.empty() || !key.starts_with(stem_of_option)) return false;
  const std::string_view rest = key.substr(stem_of_option.size());
  return rest.empty() || rest.front() == '_';
}

}  // namespace

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  std::string best;
  std::size_t least = std::min(std::max<std::size_t>(1, word.size() / 3) + 1, word.size());
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < least) {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates,
                         const char* quote) {
  const std::string meant = nearest(word, candidates);
  return meant.empty() ? "" : fmt::format(", did you mean {}{}{}?", quote, meant, quote);
}

std::string advice_on_unknown_key(std::string_view section, std::string_view key) {
  std::vector<std::string> keys;
  for (const Option& option : options()) {
    if (option.section != section) continue;
    if (is_stem_with_another_unit(key, stem(option.key)))
      return fmt::format("the unit is {}: write {}", option.unit, option.key);
    keys.emplace_back(option.key);
  }
  for (const Option& option : options())
    if (option.key == key) return fmt::format("it is a key of [{}]", option.section);
  if (const std::string meant = nearest(key, keys); !meant.empty())
    return fmt::format("did you mean {}?", meant);
  return fmt::format("the keys are {}", fmt::join(keys, ", "));
}

}  // namespace framewatch::daemon
