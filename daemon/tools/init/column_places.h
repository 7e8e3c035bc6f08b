// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/tools/init/building_plan.h"

namespace framewatch::daemon {

/// The place in a column's title, before the building is known.
struct TitleWords {
  std::optional<int> story;  ///< "story 2", "F2", "2. OG", "3階"; "base": 0
  bool is_roof = false;
  char letter = 0;  ///< 'x' or 'y' with a number behind it, "y1"
  int number = 0;   ///< that number
  char along = 0;   ///< 'x', 'y' or 'z' alone
  bool says_frame = false;
};

/// Empty when a word or number has no meaning here: such a title says no place.
std::optional<TitleWords> title_words(const std::string& title);

/// Meaning of "y1" in a column's title unless stated otherwise.
enum class TitleReading {
  frames,      ///< the frame y1, which moves along x
  directions,  ///< the first accelerometer along y; with one a floor: along y on floor 1
};

/// Columns as places of a building, by their titles.
struct ColumnPlaces {
  /// Parallel to the places: index of the column; empty where no title says it.
  std::vector<std::optional<std::size_t>> column_of_place;
  /// A column whose title is one place as a frame and another as a direction while both readings
  /// fit the building, if any.
  std::optional<std::size_t> ambiguous;
  std::string as_frame, as_direction;  ///< of that column, in words
};

/// Matches titles such as "base_x", "y1 story 2", "A2Y1", "roof_x", "floor 2 frame y1", and the
/// like in German, Italian, Spanish and Japanese. A place gets a column only when every reading of
/// the titles that fits the building agrees and no other column is of the same place; all else is
/// left to a person. `places`: those that need a column. `reading`: the only one to be tried.
ColumnPlaces match_columns(const estimator::Structure& structure, const std::vector<Place>& places,
                           const std::vector<std::string>& titles,
                           std::optional<TitleReading> reading);

}  // namespace framewatch::daemon
