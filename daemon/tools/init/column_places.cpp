#include "daemon/tools/init/column_places.h"

#include <algorithm>
#include <string>
#include <utility>

#include "daemon/tools/init/title_words.h"

namespace framewatch::daemon {
namespace {

using estimator::Direction;
using Columns = std::vector<std::optional<std::size_t>>;

Direction along(char letter) {
  return letter == 'y' ? Direction::y : Direction::x;
}

std::optional<Place> on_floor(const estimator::Structure& s, int story, Direction direction) {
  if ((direction == Direction::x ? s.n() : s.m()) == 0) return std::nullopt;
  if (story == 0) return Place{0, -1, direction};
  const auto frame = only_frame(s, direction);
  return frame ? std::optional(Place{story, *frame, direction}) : std::nullopt;
}

/// "y1" is the frame of that name.
std::optional<Place> as_frame(const estimator::Structure& s, const TitleWords& words, int story) {
  const std::string name = words.letter + std::to_string(words.number);
  for (int f = 0; f < s.frames(); ++f) {
    if (s.frame_name(f) != name) continue;
    if (words.along != 0 && along(words.along) != s.direction(f)) return std::nullopt;
    return story == 0 ? Place{0, -1, s.direction(f)} : Place{story, f, s.direction(f)};
  }
  return std::nullopt;
}

/// "y1" is the first accelerometer along y.
std::optional<Place> as_direction(const estimator::Structure& s, const TitleWords& words,
                                  int story) {
  if (words.says_frame || (words.along != 0 && words.along != words.letter)) return std::nullopt;
  const Direction direction = along(words.letter);
  const int frames = direction == Direction::x ? s.n() : s.m();
  if (words.number < 1 || words.number > frames) return std::nullopt;
  if (story == 0) return Place{0, -1, direction};
  return Place{story, words.number - 1 + (direction == Direction::x ? 0 : s.n()), direction};
}

std::optional<Place> place_by(const estimator::Structure& s, const TitleWords& words,
                              TitleReading reading) {
  std::optional<int> story = words.is_roof ? std::optional(s.stories) : words.story;
  if (words.letter != 0 && !story) {  // "y0", "y1", "y2": along y on these floors
    if (reading == TitleReading::frames || words.says_frame || words.along != 0)
      return std::nullopt;
    if (words.number > s.stories) return std::nullopt;
    return on_floor(s, words.number, along(words.letter));
  }
  if (!story || *story > s.stories) return std::nullopt;
  if (words.letter != 0)
    return reading == TitleReading::frames ? as_frame(s, words, *story)
                                           : as_direction(s, words, *story);
  if (words.along != 0) return on_floor(s, *story, along(words.along));
  const bool one_direction = s.n() == 0 || s.m() == 0;
  return one_direction ? on_floor(s, *story, s.n() > 0 ? Direction::x : Direction::y)
                       : std::nullopt;
}

/// The columns of one reading; a place that two columns claim has none.
struct Assignment {
  Columns column_of_place;
  bool clash = false;
  bool complete() const {
    return !clash && std::all_of(column_of_place.begin(), column_of_place.end(),
                                 [](const auto& column) { return column.has_value(); });
  }
};

Assignment assign(const estimator::Structure& s, const std::vector<std::string>& titles,
                  TitleReading reading) {
  const std::vector<Place> places = places_of(s);
  Assignment out;
  out.column_of_place.resize(places.size());
  std::vector<int> claims(places.size(), 0);
  for (std::size_t c = 0; c < titles.size(); ++c) {
    const auto words = title_words(titles[c]);
    const auto place = words ? place_by(s, *words, reading) : std::nullopt;
    if (!place) continue;
    const auto at =
        static_cast<std::size_t>(std::find(places.begin(), places.end(), *place) - places.begin());
    ++claims[at];
    out.clash = out.clash || claims[at] > 1;
    out.column_of_place[at] = claims[at] == 1 ? std::optional(c) : std::nullopt;
  }
  return out;
}

/// The first column that the readings put into different places.
void find_ambiguous(const estimator::Structure& s, const std::vector<std::string>& titles,
                    ColumnPlaces& out) {
  for (std::size_t c = 0; c < titles.size(); ++c) {
    const auto words = title_words(titles[c]);
    if (!words) continue;
    const auto frame = place_by(s, *words, TitleReading::frames);
    const auto direction = place_by(s, *words, TitleReading::directions);
    if (!frame || !direction || *frame == *direction) continue;
    out.ambiguous = c;
    out.as_frame = place_text(s, *frame);
    out.as_direction = place_text(s, *direction);
    return;
  }
}

}  // namespace

ColumnPlaces match_columns(const estimator::Structure& s, const std::vector<std::string>& titles,
                           std::optional<TitleReading> reading) {
  ColumnPlaces out;
  if (reading) {
    out.column_of_place = assign(s, titles, *reading).column_of_place;
    return out;
  }
  Assignment frames = assign(s, titles, TitleReading::frames);
  Assignment directions = assign(s, titles, TitleReading::directions);
  if (frames.complete() != directions.complete()) {
    out.column_of_place = (frames.complete() ? frames : directions).column_of_place;
    return out;
  }
  find_ambiguous(s, titles, out);
  // What only one reading understands is taken where the other one does not contradict.
  for (std::size_t p = 0; p < frames.column_of_place.size(); ++p) {
    const auto& a = frames.column_of_place[p];
    const auto& b = directions.column_of_place[p];
    out.column_of_place.push_back(a == b ? a : std::nullopt);
  }
  return out;
}

}  // namespace framewatch::daemon
