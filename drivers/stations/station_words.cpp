// SPDX-License-Identifier: MIT
#include "drivers/stations/station_words.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "drivers/files/number_text.h"

namespace framewatch::drivers {
namespace {

using Words = std::vector<std::string>;

constexpr std::array<std::string_view, 11> kOutside = {"free",     "freefield", "ff",       "dh",
                                                       "downhole", "borehole",  "bore",     "hole",
                                                       "pier",     "street",    "penthouse"};
constexpr std::array<std::string_view, 6> kBasements = {"basement", "bsmt",    "bsmnt",
                                                        "subbase",  "parkade", "subbasement"};
constexpr std::array<std::string_view, 6> kGround = {"ground", "grnd",       "gnd",
                                                     "lobby",  "foundation", "base"};
constexpr std::array<std::string_view, 9> kFloors = {"floor", "fl",  "flr",    "level", "lvl",
                                                     "story", "flo", "storey", "l"};
constexpr std::array<std::string_view, 4> kOrdinals = {"st", "nd", "rd", "th"};
struct SideWord {
  std::string_view letters, word;
  Side side;
};
constexpr std::array<SideWord, 8> kSideWords = {{{"n", "north", {0, 1}},
                                                 {"ne", "northeast", {1, 1}},
                                                 {"e", "east", {1, 0}},
                                                 {"se", "southeast", {1, -1}},
                                                 {"s", "south", {0, -1}},
                                                 {"sw", "southwest", {-1, -1}},
                                                 {"w", "west", {-1, 0}},
                                                 {"nw", "northwest", {-1, 1}}}};
constexpr int kHighest = 200;

template <std::size_t N>
bool is_one(const std::array<std::string_view, N>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// Returns the runs of letters and digits in lower case; "7th" is one of them.
Words words_of(const std::string& text) {
  Words out;
  bool inside = false;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool part = std::isalnum(byte) != 0 || (c == '.' && inside);
    if (part && !inside) out.emplace_back();
    if (part) out.back() += static_cast<char>(std::tolower(byte));
    inside = part;
  }
  return out;
}

std::optional<int> floor_number(std::string_view digits) {
  const auto number = parse_integer(digits);
  return number && *number >= 1 && *number <= kHighest ? std::optional(static_cast<int>(*number))
                                                       : std::nullopt;
}

/// Returns the floor that a word, alone or with the next one, names: "7th", "3f", "level 3", "fl.
/// 3".
std::optional<int> floor_at(const Words& words, std::size_t i) {
  const std::string_view word = words[i];
  const std::string_view ending =
      word.substr(std::min(word.size(), word.find_first_not_of("0123456789")));
  const std::string_view digits = word.substr(0, word.size() - ending.size());
  const std::string_view next = i + 1 < words.size() ? std::string_view(words[i + 1]) : "";
  const std::string_view plain_next = next.substr(0, next.find('.'));
  if (ending == "f" || ending == "fl") return floor_number(digits);
  if (is_one(kOrdinals, ending)) return floor_number(digits);
  if (ending.empty() && is_one(kFloors, plain_next)) return floor_number(digits);
  if (is_one(kFloors, word.substr(0, word.find('.')))) return floor_number(next);
  return std::nullopt;
}

bool says_basement(const Words& words) {
  return std::any_of(words.begin(), words.end(), [](const std::string& word) {
    const bool numbered = word.size() >= 2 && word.front() == 'b' &&
                          std::all_of(word.begin() + 1, word.end(),
                                      [](unsigned char c) { return std::isdigit(c) || c == 'f'; });
    return numbered || is_one(kBasements, word);
  });
}

}  // namespace

Level level_of(const AxisHeader& header) {
  const Words words = words_of(header.place);
  const auto any = [&](const auto& of) {
    return std::any_of(words.begin(), words.end(),
                       [&](const std::string& word) { return is_one(of, word); });
  };
  const auto says = [&](std::string_view wanted) {
    return std::find(words.begin(), words.end(), wanted) != words.end();
  };
  if (any(kOutside) || says("surface")) return {LevelKind::outside, 0};
  if (says("roof") || says("rf")) return {LevelKind::roof, 0};
  if (says_basement(words)) return {LevelKind::basement, 0};
  for (std::size_t i = 0; i < words.size(); ++i)
    if (const auto number = floor_at(words, i)) return {LevelKind::floor, *number};
  if (any(kGround)) return {LevelKind::floor, 1};
  if (header.floor && *header.floor >= 1 && *header.floor <= kHighest)
    return {LevelKind::floor, *header.floor};
  return {};
}

Side side_of(const AxisHeader& header) {
  Side out;
  for (const std::string& word : words_of(header.place)) {
    for (const SideWord& known : kSideWords) {
      if (word != known.letters && word != known.word) continue;
      const bool twice =
          (out.east != 0 && known.side.east != 0) || (out.north != 0 && known.side.north != 0);
      if (twice) return {};  // "from N to S" is not one side
      out.east += known.side.east;
      out.north += known.side.north;
    }
  }
  return out;
}

std::string level_text(const Level& level) {
  switch (level.kind) {
    case LevelKind::floor:
      return fmt::format("floor {}", level.number);
    case LevelKind::roof:
      return "roof";
    case LevelKind::basement:
      return "basement";
    case LevelKind::outside:
      return "outside the building";
    case LevelKind::unknown:
      break;
  }
  return "an unknown level";
}

}  // namespace framewatch::drivers
