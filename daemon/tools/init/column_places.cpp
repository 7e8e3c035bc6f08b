// SPDX-License-Identifier: MIT
#include "daemon/tools/init/column_places.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "drivers/files/number_text.h"

namespace framewatch::daemon {
namespace {

using Words = std::vector<std::string_view>;

// Words of titles, in English, German, Italian and Spanish, without accents.
constexpr auto kFloors = std::to_array<std::string_view>(
    {"story",   "storey", "floor", "level", "lvl",  "geschoss", "stockwerk", "stock",
     "etage",   "ebene",  "og",    "decke", "piso", "nivel",    "planta",    "piano",
     "livello", "solaio", "fl",    "f",     "s",    "l",        "a"});
constexpr auto kBases = std::to_array<std::string_view>(
    {"base",         "ground",     "gnd",         "table",       "foundation", "shaketable",
     "basis",        "fundament",  "eg",          "erdgeschoss", "tisch",      "rutteltisch",
     "ruetteltisch", "fondazione", "fondazioni",  "terra",       "terreno",    "suolo",
     "tavola",       "cimiento",   "cimentacion", "suelo",       "mesa",       "baja"});
constexpr auto kRoofs = std::to_array<std::string_view>(
    {"roof", "top", "rf", "dach", "tetto", "copertura", "sommita", "azotea", "techo", "cubierta"});
constexpr auto kFillers = std::to_array<std::string_view>({"acc",
                                                           "accel",
                                                           "acceleration",
                                                           "abs",
                                                           "absolute",
                                                           "along",
                                                           "dir",
                                                           "direction",
                                                           "axis",
                                                           "richtung",
                                                           "achse",
                                                           "beschl",
                                                           "beschleunigung",
                                                           "absolut",
                                                           "in",
                                                           "am",
                                                           "im",
                                                           "accelerazione",
                                                           "direzione",
                                                           "asse",
                                                           "assoluta",
                                                           "del",
                                                           "di",
                                                           "della",
                                                           "aceleracion",
                                                           "direccion",
                                                           "eje",
                                                           "absoluta",
                                                           "en",
                                                           "de",
                                                           "la",
                                                           "el"});
constexpr auto kOrdinals = std::to_array<std::string_view>(
    {"st", "nd", "rd", "th", "er", "do", "ro", "to", "mo", "vo", "no"});
/// Counts floors from 1, the ground, as Japanese does: "2 kai" is floor 1.
constexpr std::string_view kKai = "kai";

/// Replacements of Japanese words and of letters with accents, longest first.
constexpr auto kFolded = std::to_array<std::pair<std::string_view, std::string_view>>(
    {{"振動台", " base "}, {"加速度", " acc "}, {"屋上", " roof "}, {"屋根", " roof "},
     {"頂部", " roof "},   {"基礎", " base "},  {"地盤", " base "}, {"地表", " base "},
     {"方向", " dir "},    {"絶対", " abs "},   {"応答", " abs "},  {"階", " kai "},
     {"層", " story "},    {"床", " abs "},     {"ß", "ss"},        {"ä", "a"},
     {"Ä", "A"},           {"ö", "o"},          {"Ö", "O"},         {"ü", "u"},
     {"Ü", "U"},           {"à", "a"},          {"á", "a"},         {"è", "e"},
     {"é", "e"},           {"ì", "i"},          {"í", "i"},         {"ò", "o"},
     {"ó", "o"},           {"ù", "u"},          {"ú", "u"},         {"ñ", "n"},
     {"Á", "A"},           {"À", "A"},          {"É", "E"},         {"Í", "I"},
     {"Ó", "O"},           {"Ú", "U"},          {"Ñ", "N"},         {"°", " "},
     {"º", " "},           {"ª", " "},          {"　", " "}});

/// Returns the ASCII letter of a full-width one at `at` (U+FF01 to U+FF5E), or 0.
char half_width(std::string_view text, std::size_t at) {
  if (at + 2 >= text.size() || text[at] != '\xEF') return 0;
  const int high = static_cast<unsigned char>(text[at + 1]);
  const int low = static_cast<unsigned char>(text[at + 2]);
  const int letter = (high - 0xBC) * 0x40 + low - 0x80 + 0x20;
  return high >= 0xBC && high <= 0xBD && low >= 0x80 && letter > 0x20 && letter < 0x7F
             ? static_cast<char>(letter)
             : static_cast<char>(0);
}

/// Returns the title with the words and letters of kFolded in ASCII.
std::string folded(const std::string& title) {
  std::string out;
  for (std::size_t at = 0; at < title.size();) {
    const auto* const found = std::find_if(kFolded.begin(), kFolded.end(), [&](const auto& fold) {
      return title.compare(at, fold.first.size(), fold.first) == 0;
    });
    if (found != kFolded.end()) {
      out += found->second;
      at += found->first.size();
    } else if (const char ascii = half_width(title, at); ascii != 0) {
      out += ascii;
      at += 3;
    } else {
      out += title[at++];
    }
  }
  return out;
}

template <std::size_t N>
bool is_one(const std::array<std::string_view, N>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool is_number_word(std::string_view word) {
  return !word.empty() && std::isdigit(static_cast<unsigned char>(word.front()));
}

/// Splits a title into lower-case runs of letters and of digits. A capital after a small letter
/// begins a new run, and "basex" becomes "base" and "x". A run directly after another one begins
/// with '+'.
std::vector<std::string> runs_of(const std::string& title) {
  std::vector<std::string> out;
  char before = ' ';
  for (const char c : title) {
    const auto byte = static_cast<unsigned char>(c);
    const auto last = static_cast<unsigned char>(before);
    if (std::isalnum(byte)) {
      const bool goes_on = std::isalnum(last) && !std::isdigit(byte) == !std::isdigit(last) &&
                           !(std::isupper(byte) && std::islower(last));
      if (!goes_on) out.emplace_back(std::isalnum(last) ? "+" : "");
      out.back() += static_cast<char>(std::tolower(byte));
    } else if (byte >= 0x80) {
      out.emplace_back("?");
    }
    before = c;
  }
  return out;
}

std::vector<std::string> split_joined(const std::vector<std::string>& runs) {
  std::vector<std::string> out;
  for (const std::string& run : runs) {
    const std::string_view word = std::string_view(run).substr(run.front() == '+' ? 1 : 0);
    const std::string_view stem = word.substr(0, word.size() - 1);
    const bool joined = word.size() > 2 && (word.back() == 'x' || word.back() == 'y') &&
                        (is_one(kBases, stem) || is_one(kRoofs, stem) || stem == "acc");
    out.push_back(joined ? run.substr(0, run.size() - 1) : run);
    if (joined) out.push_back(std::string("+") + word.back());
  }
  return out;
}

/// Parses the words of one title.
class TitleWalk {
 public:
  explicit TitleWalk(const std::vector<std::string>& runs) {
    for (const std::string& run : runs) {
      joined_.push_back(run.front() == '+');
      words_.push_back(std::string_view(run).substr(run.front() == '+' ? 1 : 0));
    }
  }

  std::optional<TitleWords> walk() {
    while (at_ < words_.size())
      if (!step()) return std::nullopt;
    if (bare_a_ && out_.letter == 0) return std::nullopt;  // probably the number of a sensor
    return out_;
  }

 private:
  std::string_view word(std::size_t ahead = 0) const {
    return at_ + ahead < words_.size() ? words_[at_ + ahead] : std::string_view();
  }
  bool joined(std::size_t ahead) const {
    return at_ + ahead < joined_.size() && joined_[at_ + ahead];
  }

  bool set_story(int story) {
    if (out_.story || out_.is_roof) return false;
    out_.story = story;
    return true;
  }

  bool set_roof() {
    if (out_.story || out_.is_roof) return false;
    return out_.is_roof = true;
  }

  bool step() {
    const std::string_view w = word();
    if (is_number_word(w)) return ordinal();
    if (w == "x" || w == "y" || w == "z") return letter(w.front());
    if (w == "r" && word(1) == kKai) {
      at_ += 2;
      return set_roof();
    }
    if (is_one(kFloors, w)) return floor(w);
    ++at_;
    if (is_one(kBases, w)) {
      if (word() == "floor" && !is_number_word(word(1))) ++at_;
      return set_story(0);
    }
    if (is_one(kRoofs, w)) return set_roof();
    if (w == "frame") return out_.says_frame = true;
    return is_one(kFillers, w) && !is_number_word(word());
  }

  bool ordinal() {  // "2nd floor", "2. Geschoss"
    const auto number = drivers::parse_integer(word());
    if (!number || *number > 1000) return false;
    if (word(1) == kKai) {
      at_ += 2;
      return *number > 0 && set_story(static_cast<int>(*number) - 1);
    }
    const std::size_t ahead = joined(1) && is_one(kOrdinals, word(1)) ? 2 : 1;
    const std::string_view name = word(ahead);
    if (!is_one(kFloors, name) || (name.size() < 3 && name != "og")) return false;
    at_ += ahead + 1;
    return set_story(static_cast<int>(*number));
  }

  bool floor(std::string_view name) {
    if (name.size() > 2 && is_one(kBases, word(1))) {  // "piano terra", "planta baja"
      at_ += 2;
      return set_story(0);
    }
    const auto number = drivers::parse_integer(word(1));
    if (!number || *number > 1000 || (name.size() == 1 && !joined(1))) return false;
    bare_a_ = bare_a_ || name == "a";
    at_ += 2;
    return set_story(static_cast<int>(*number));
  }

  bool letter(char which) {
    const auto number = joined(1) ? drivers::parse_integer(word(1)) : std::nullopt;
    ++at_;
    if (!number) {
      if (out_.along != 0 || is_number_word(word())) return false;
      out_.along = which;
      return true;
    }
    if (out_.letter != 0 || *number > 1000 || which == 'z') return false;
    out_.letter = which;
    out_.number = static_cast<int>(*number);
    ++at_;
    return true;
  }

  Words words_;
  std::vector<bool> joined_;
  std::size_t at_ = 0;
  bool bare_a_ = false;  ///< "A2": of an accelerometer, unless the rest says its frame
  TitleWords out_;
};

using estimator::Direction;
using Columns = std::vector<std::optional<std::size_t>>;

Direction along(char letter) {
  return letter == 'y' ? Direction::y : Direction::x;
}

using Places = std::vector<Place>;

Places places_along(const Places& places, int story, char along) {
  Places out;
  for (const Place& place : places)
    if (place.story == story && letter(place) == along) out.push_back(place);
  return out;
}

/// Returns the only place on a floor along x, y or z.
std::optional<Place> on_floor(const Places& places, int story, char along) {
  const Places there = places_along(places, story, along);
  return there.size() == 1 ? std::optional(there.front()) : std::nullopt;
}

/// Reads "y1" as the frame of that name.
std::optional<Place> as_frame(const estimator::Structure& s, const Places& places,
                              const TitleWords& words, int story) {
  const std::string name = words.letter + std::to_string(words.number);
  for (int f = 0; f < s.frames(); ++f) {
    if (s.frame_name(f) != name) continue;
    if (words.along != 0 && along(words.along) != s.direction(f)) return std::nullopt;
    if (story == 0) return on_floor(places, 0, letter(s.direction(f))[0]);
    const auto at = std::find(places.begin(), places.end(), Place{story, f, s.direction(f)});
    return at == places.end() ? std::nullopt : std::optional(*at);
  }
  return std::nullopt;
}

/// Reads "y1" as the first accelerometer along y.
std::optional<Place> as_direction(const estimator::Structure& s, const Places& places,
                                  const TitleWords& words, int story) {
  if (words.says_frame || (words.along != 0 && words.along != words.letter)) return std::nullopt;
  const Places there = places_along(places, story, words.letter);
  const int frames = words.letter == 'x' ? s.n() : s.m();
  if (words.number < 1) return std::nullopt;
  if (story == 0 && there.size() == 1 && words.number <= frames) return there.front();
  if (words.number > static_cast<int>(there.size())) return std::nullopt;
  return there[static_cast<std::size_t>(words.number - 1)];
}

std::optional<Place> place_by(const estimator::Structure& s, const Places& places,
                              const TitleWords& words, TitleReading reading) {
  std::optional<int> story = words.is_roof ? std::optional(s.stories) : words.story;
  if (words.letter != 0 && !story) {  // "y0", "y1", "y2": along y on these floors
    if (reading == TitleReading::frames || words.says_frame || words.along != 0)
      return std::nullopt;
    if (words.number > s.stories) return std::nullopt;
    return on_floor(places, words.number, words.letter);
  }
  if (!story || *story > s.stories) return std::nullopt;
  if (words.letter != 0)
    return reading == TitleReading::frames ? as_frame(s, places, words, *story)
                                           : as_direction(s, places, words, *story);
  if (words.along != 0) return on_floor(places, *story, words.along);
  const bool one_direction = s.n() == 0 || s.m() == 0;
  return one_direction ? on_floor(places, *story, s.n() > 0 ? 'x' : 'y') : std::nullopt;
}

/// The column of each place in one reading. A place that two columns claim gets no column.
struct Assignment {
  Columns column_of_place;
  bool clash = false;
  bool complete() const {
    return !clash && std::all_of(column_of_place.begin(), column_of_place.end(),
                                 [](const auto& column) { return column.has_value(); });
  }
};

Assignment assign(const estimator::Structure& s, const Places& places,
                  const std::vector<std::string>& titles, TitleReading reading) {
  Assignment out;
  out.column_of_place.resize(places.size());
  std::vector<int> claims(places.size(), 0);
  for (std::size_t c = 0; c < titles.size(); ++c) {
    const auto words = title_words(titles[c]);
    const auto place = words ? place_by(s, places, *words, reading) : std::nullopt;
    if (!place) continue;
    const auto at =
        static_cast<std::size_t>(std::find(places.begin(), places.end(), *place) - places.begin());
    ++claims[at];
    out.clash = out.clash || claims[at] > 1;
    out.column_of_place[at] = claims[at] == 1 ? std::optional(c) : std::nullopt;
  }
  return out;
}

/// Returns the first column that the readings put into different places.
void find_ambiguous(const estimator::Structure& s, const Places& places,
                    const std::vector<std::string>& titles, ColumnPlaces& out) {
  for (std::size_t c = 0; c < titles.size(); ++c) {
    const auto words = title_words(titles[c]);
    if (!words) continue;
    const auto frame = place_by(s, places, *words, TitleReading::frames);
    const auto direction = place_by(s, places, *words, TitleReading::directions);
    if (!frame || !direction || *frame == *direction) continue;
    out.ambiguous = c;
    out.as_frame = place_text(s, *frame);
    out.as_direction = place_text(s, *direction);
    return;
  }
}

}  // namespace

std::optional<TitleWords> title_words(const std::string& title) {
  const std::vector<std::string> runs = split_joined(runs_of(folded(title)));
  if (runs.empty()) return std::nullopt;
  return TitleWalk(runs).walk();
}

ColumnPlaces match_columns(const estimator::Structure& s, const std::vector<Place>& places,
                           const std::vector<std::string>& titles,
                           std::optional<TitleReading> reading) {
  ColumnPlaces out;
  if (reading) {
    out.column_of_place = assign(s, places, titles, *reading).column_of_place;
    return out;
  }
  Assignment frames = assign(s, places, titles, TitleReading::frames);
  Assignment directions = assign(s, places, titles, TitleReading::directions);
  if (frames.complete() != directions.complete()) {
    out.column_of_place = (frames.complete() ? frames : directions).column_of_place;
    return out;
  }
  find_ambiguous(s, places, titles, out);
  // Use a title that only one reading understands if the other reading does not contradict.
  for (std::size_t p = 0; p < frames.column_of_place.size(); ++p) {
    const auto& a = frames.column_of_place[p];
    const auto& b = directions.column_of_place[p];
    out.column_of_place.push_back(a == b ? a : std::nullopt);
  }
  return out;
}

}  // namespace framewatch::daemon
