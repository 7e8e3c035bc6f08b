#pragma once

#include <optional>
#include <string>

namespace framewatch::daemon {

/// What the words of a column's title say of its place, before a building is known.
struct TitleWords {
  std::optional<int> story;  ///< "story 2", "F2", "2nd floor"; "base": 0
  bool is_roof = false;
  char letter = 0;  ///< 'x' or 'y' with a number behind it, "y1"
  int number = 0;   ///< that number
  char along = 0;   ///< 'x' or 'y' alone
  bool says_frame = false;
};

/// Empty when a word or number has no meaning here: such a title says no place.
std::optional<TitleWords> title_words(const std::string& title);

}  // namespace framewatch::daemon
