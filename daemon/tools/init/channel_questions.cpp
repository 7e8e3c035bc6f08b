// SPDX-License-Identifier: MIT
#include "daemon/tools/init/channel_questions.h"

#include <algorithm>
#include <cctype>
#include <map>

#include <fmt/core.h>

#include "daemon/base/printable.h"
#include "daemon/tools/init/building_plan.h"
#include "daemon/tools/init/station_layout.h"

namespace framewatch::daemon {
namespace {

class StationPlacing {
 public:
  StationPlacing(const InitAnswers& answers, InitReading& reading)
      : answers_(answers), reading_(reading), columns_(reading.draft.columns) {}

  void place() {
    check_answers();
    std::string list;
    BuildingDraft& d = reading_.draft;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const auto at = place_of(c);
      if (!at) continue;
      list += fmt::format("\n     {:<18} {}", printable(columns_[c].name), station_place_text(*at));
      d.plan.channels.push_back({{}, columns_[c], at});
    }
    if (!reading_.open.empty()) return;
    d.plan.azimuth_y_deg = d.station->azimuth_y_deg;
    reading_.understood.push_back({"channel", "channels", list});
  }

 private:
  void refuse(const std::string& answer, const std::string& why) {
    reading_.open.push_back({"channel", "", "", printable(answer) + ": " + why, {}, answer, ""});
  }

  void check_answers() {
    for (const std::string& text : answers_.channels) {
      const std::size_t equals = text.rfind('=');
      const bool known = equals != std::string::npos &&
                         std::any_of(columns_.begin(), columns_.end(), [&](const auto& column) {
                           return column.name == text.substr(0, equals);
                         });
      if (equals == std::string::npos)
        refuse(text, "write NAME=PLACE, such as ch3=2, ch3=roof:x or ch3=unused");
      else if (!known)
        refuse(text, "the record has no such channel");
    }
  }

  /// Returns the answer about a channel, or an empty text.
  std::string answer_about(const std::string& name) const {
    for (const std::string& text : answers_.channels)
      if (const std::size_t equals = text.rfind('=');
          equals != std::string::npos && text.substr(0, equals) == name)
        return text;
    return {};
  }

  std::optional<StationPlace> place_of(std::size_t c) {
    const BuildingDraft& d = reading_.draft;
    const std::string& name = columns_[c].name;
    std::string why;
    const auto by_header = station_place(*d.station, columns_, c, d.station_plan, why);
    const std::string answer = answer_about(name);
    if (!answer.empty()) {
      const StationPlace known = place_on_floor(*d.station, columns_, c, d.station_plan);
      const auto at = parse_station_place(answer.substr(name.size() + 1), known, d.station_plan);
      if (!at)
        refuse(answer,
               fmt::format("write a floor (0 to {}), base or roof, with :x, :y or :z if the "
                           "header does not say the direction; or unused",
                           d.station_plan.stories));
      return at;
    }
    if (!by_header)
      reading_.open.push_back(
          {"channel",
           fmt::format(
               "Where is {}{}? {}. Give its floor (2, base, roof), with its direction if the "
               "header does not say it (2:x); or unused.",
               printable(name),
               columns_[c].header.place.empty()
                   ? ""
                   : fmt::format(" ({})", printable(columns_[c].header.place)),
               why),
           "",
           "",
           {},
           "",
           name});
    return by_header;
  }

  const InitAnswers& answers_;
  InitReading& reading_;
  const std::vector<ChannelColumn>& columns_;
};

using estimator::Structure;

/// A channel of the building before its column is known.
struct WantedChannel {
  Place place;
  std::string name;  ///< default name
  int sensor = 0;    ///< number of the sensor with this axis, from 0
};

/// Returns the default name of a channel: "base-x", "F2-Y1"; at a point in plan "F2-x".
std::string usual_name(const Structure& s, const Place& place) {
  const std::string level = place.story == 0 ? "base" : fmt::format("F{}", place.story);
  if (place.frame < 0) return fmt::format("{}-{}", level, letter(place));
  std::string frame = s.frame_name(place.frame);
  frame.front() = static_cast<char>(frame.front() - 'a' + 'A');
  return fmt::format("{}-{}", level, frame);
}

/// Adds places of one floor. An axis of each direction is one sensor, otherwise each axis is.
void add_level(const Structure& s, const std::vector<Place>& places,
               std::vector<WantedChannel>& out) {
  const auto repeats = [&](const Place& place, auto end) {
    return std::count_if(places.begin(), end, [&](const Place& other) {
      return usual_name(s, other) == usual_name(s, place);
    });
  };
  const bool one_sensor = std::all_of(places.begin(), places.end(), [&](const Place& place) {
    return std::count_if(places.begin(), places.end(),
                         [&](const Place& other) { return letter(other) == letter(place); }) == 1;
  });
  for (auto at = places.begin(); at != places.end(); ++at) {
    std::string name = usual_name(s, *at);
    if (repeats(*at, places.end()) > 1) name += fmt::format("{}", repeats(*at, at) + 1);
    const bool fresh = out.empty() || !one_sensor || at == places.begin();
    out.push_back({*at, name, out.empty() ? 0 : out.back().sensor + (fresh ? 1 : 0)});
  }
}

/// Splits NAME=2@(0,0):xyz into one answer for each direction: NAME-x=2@(0,0):x and so on. Other
/// answers stay as they are.
std::vector<std::string> single_axes(const std::string& answer) {
  const std::size_t equals = answer.rfind('='), colon = answer.rfind(':');
  const bool point = equals != std::string::npos && answer.find('@', equals) != std::string::npos;
  if (!point || colon == std::string::npos || answer.size() < colon + 3) return {answer};
  std::vector<std::string> out;
  for (const char along : answer.substr(colon + 1))
    out.push_back(fmt::format("{}-{}{}{}", answer.substr(0, equals), along,
                              answer.substr(equals, colon + 1 - equals), along));
  return out;
}

class ChannelPlacing {
 public:
  ChannelPlacing(const InitAnswers& answers, InitReading& reading)
      : answers_(answers),
        reading_(reading),
        structure_(reading.draft.plan.structure),
        columns_(reading.draft.columns) {}

  void place() {
    want();
    if (!reading_.open.empty()) return;
    if (!columns_.empty()) {
      take_named();
      take_reading();
      if (reading_.open.empty()) match();
      if (!reading_.open.empty()) return;
    }
    fill();
  }

 private:
  void open(const std::string& option, const std::string& ask, const std::string& problem,
            std::optional<Place> at = {}) {
    reading_.open.push_back({option, ask, "", problem, at, ""});
  }
  void refuse(const std::string& answer, const std::string& why) {
    reading_.open.push_back({"channel", "", "", printable(answer) + ": " + why, {}, answer});
  }

  /// Collects the places that need a channel: those that answers name, and those of the levels. The
  /// base has a channel in every direction.
  void want() {
    const BuildingDraft& d = reading_.draft;
    for (const std::string& text : answers_.channels) want_point(text);
    const bool levels = !d.levels.empty() || !d.per_level.empty();
    usual_ = !levels && wanted_.empty();
    for (int story = 0; story <= structure_.stories && (levels || usual_); ++story)
      if (d.levels.empty() || std::find(d.levels.begin(), d.levels.end(), story) != d.levels.end())
        want_level(story, d.per_level.empty() ? every_frame(story)
                                              : places_on_level(structure_, story, d.per_level));
    for (const Place& place : every_frame(0))
      if (std::none_of(wanted_.begin(), wanted_.end(), [&](const WantedChannel& w) {
            return w.place.story == 0 && letter(w.place) == letter(place);
          }))
        want_level(0, {place});
    std::stable_sort(wanted_.begin(), wanted_.end(),
                     [](const auto& a, const auto& b) { return a.place.story < b.place.story; });
    std::map<int, int> in_order;
    for (WantedChannel& w : wanted_) {
      w.sensor = in_order.try_emplace(w.sensor, static_cast<int>(in_order.size())).first->second;
      places_.push_back(w.place);
    }
    column_of_place_.resize(places_.size());
  }

  void want_level(int story, const std::vector<Place>& places) {
    const bool told = std::any_of(wanted_.begin(), wanted_.end(), [&](const WantedChannel& w) {
      return w.place.story == story && w.place.at;
    });
    if (!told || story == 0) add_level(structure_, places, wanted_);
  }

  std::vector<Place> every_frame(int story) const {
    std::vector<Place> out;
    for (const Place& place : places_of(structure_))
      if (place.story == story) out.push_back(place);
    return out;
  }

  /// Adds the places of NAME=2@(0,0):xyz, one sensor; leaves other answers to take_named().
  void want_point(const std::string& text) {
    const std::size_t equals = text.rfind('=');
    if (equals == std::string::npos || text.find('@', equals) == std::string::npos) return;
    const int sensor = wanted_.empty() ? 0 : wanted_.back().sensor + 1;
    for (const std::string& answer : single_axes(text)) {
      const std::size_t at = answer.rfind('=');
      const auto place = parse_place(structure_, answer.substr(at + 1));
      if (!place)
        refuse(text,
               "write NAME=FLOOR@(X,Y):x, with x, y, z or several of them, X and Y in m from "
               "the first frames; the floors are base, 1 to " +
                   std::to_string(structure_.stories) + " and roof");
      else if (at == 0)
        refuse(text, "the channel needs a name");
      else
        wanted_.push_back({*place, answer.substr(0, at), sensor});
      if (!place) return;
    }
  }

  void take_named() {
    for (const std::string& given : answers_.channels)
      for (const std::string& text : single_axes(given)) take_one(text);
  }

  void take_one(const std::string& text) {
    const std::size_t equals = text.rfind('=');
    if (equals == std::string::npos) return refuse(text, "write NAME=PLACE, such as acc3=2:y1");
    const auto column = std::find_if(columns_.begin(), columns_.end(), [&](const ChannelColumn& c) {
      return same_title(c.name, text.substr(0, equals));
    });
    const std::optional<Place> place = parse_place(structure_, text.substr(equals + 1));
    if (column == columns_.end())
      refuse(text, "the file has no such column; columns without a place: " + names_left());
    else if (!place || std::find(places_.begin(), places_.end(), *place) == places_.end())
      refuse(text, "this building has no such place; its places are " +
                       place_option(structure_, places_.front()) + " (" +
                       place_text(structure_, places_.front()) + ") to " +
                       place_option(structure_, places_.back()));
    else
      put(*place, static_cast<std::size_t>(column - columns_.begin()), text);
  }

  /// True for equal titles; the direction of a sensor with several may follow any separator: N1-x,
  /// N1_X.
  static bool same_title(const std::string& column, const std::string& name) {
    const auto plain = [](const std::string& text) {
      std::string out;
      for (const char c : text)
        if (std::isalnum(static_cast<unsigned char>(c)) || c < 0)
          out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      return out;
    };
    return column == name || (!plain(name).empty() && plain(column) == plain(name));
  }

  void put(const Place& place, std::size_t column, const std::string& text) {
    const auto at = std::find(places_.begin(), places_.end(), place) - places_.begin();
    std::optional<std::size_t>& there = column_of_place_[static_cast<std::size_t>(at)];
    if (there)
      refuse(text, printable(columns_[*there].name) + " already has this place");
    else if (is_used(column))
      refuse(text, "the column already has a place");
    else
      there = column;
  }

  bool is_used(std::size_t column) const {
    return std::find(column_of_place_.begin(), column_of_place_.end(), std::optional(column)) !=
           column_of_place_.end();
  }

  std::string names_left() const {
    std::string out;
    for (std::size_t c = 0; c < columns_.size(); ++c)
      if (!is_used(c)) out += (out.empty() ? "" : ", ") + printable(columns_[c].name);
    return out.empty() ? "none" : out;
  }

  void take_reading() {
    const auto answer = answers_.by_option.find("titles");
    if (answer == answers_.by_option.end()) return;
    if (answer->second == "frames")
      reading_.draft.reading = TitleReading::frames;
    else if (answer->second == "directions")
      reading_.draft.reading = TitleReading::directions;
    else
      open("titles", "frames or directions?", "frames or directions");
  }

  void match() {
    std::vector<std::string> titles;
    std::vector<std::size_t> column_of_title;
    for (std::size_t c = 0; c < columns_.size(); ++c)
      if (!is_used(c)) {
        titles.push_back(columns_[c].name);
        column_of_title.push_back(c);
      }
    const ColumnPlaces found = match_columns(structure_, places_, titles, reading_.draft.reading);
    for (std::size_t p = 0; p < places_.size(); ++p)
      if (!column_of_place_[p] && found.column_of_place[p])
        column_of_place_[p] = column_of_title[*found.column_of_place[p]];
    drop_verticals();
    const auto missing = std::count(column_of_place_.begin(), column_of_place_.end(), std::nullopt);
    if (missing == 0) return;
    if (columns_.size() < places_.size())
      open(
          "bays", "",
          fmt::format(
              "this building needs {} channels: those of the base and one for every frame of every "
              "floor. The file has {}. With 0x0, one frame stands for each direction; --sensors "
              "and "
              "--per-level say which floors have which accelerometers{}",
              places_.size(), columns_.size(),
              reading_.draft.live == "can" ? ". If several nodes send the same message, write a "
                                             "[[can_node]] for each: docs/can.md"
                                           : ""));
    else if (found.ambiguous)
      ask_reading(found, column_of_title[*found.ambiguous]);
    else
      for (std::size_t p = 0; p < places_.size(); ++p)
        if (!column_of_place_[p]) ask_place(places_[p]);
  }

  void ask_reading(const ColumnPlaces& found, std::size_t column) {
    open(
        "titles",
        fmt::format("{} can be read in two ways:\n  frames      {}\n  directions  {}\nWhich one is "
                    "meant: frames or directions?",
                    printable(columns_[column].name), found.as_frame, found.as_direction),
        "");
  }

  void ask_place(const Place& place) {
    open("channel",
         fmt::format("Which column belongs to {}? Columns without a place: {}.",
                     place_text(structure_, place), names_left()),
         "", place);
  }

  /// Forgets vertical places without a column: nothing needs them.
  void drop_verticals() {
    for (std::size_t p = places_.size(); p-- > 0;)
      if (places_[p].vertical && !column_of_place_[p]) {
        const auto at = static_cast<std::ptrdiff_t>(p);
        wanted_.erase(wanted_.begin() + at);
        places_.erase(places_.begin() + at);
        column_of_place_.erase(column_of_place_.begin() + at);
      }
  }

  void fill() {
    BuildingDraft& d = reading_.draft;
    const bool one_a_floor = structure_.n() == 1 && structure_.m() == 1;
    std::string list;
    for (std::size_t p = 0; p < places_.size(); ++p) {
      ChannelColumn column;
      if (columns_.empty()) column.name = wanted_[p].name;
      if (column_of_place_[p]) column = columns_[*column_of_place_[p]];
      if (d.live == "lcm")
        column.source = fmt::format(
            "{{ lcm = \"ACCEL\", node = {}, axis = \"{}\" }}",
            usual_ && !one_a_floor ? static_cast<int>(p) : wanted_[p].sensor, letter(places_[p]));
      list += fmt::format("\n     {:<16} {}", printable(column.name),
                          place_text(structure_, places_[p]));
      d.plan.channels.push_back({places_[p], column});
    }
    if (!columns_.empty() && names_left() != "none")
      list += "\n     left out         " + names_left();
    d.plan.every_frame = places_ == places_of(structure_);
    reading_.understood.push_back({"channel", "channels", list});
  }

  const InitAnswers& answers_;
  InitReading& reading_;
  const Structure& structure_;
  const std::vector<ChannelColumn>& columns_;
  bool usual_ = true;  ///< no answer says where accelerometers are: every frame has one
  std::vector<WantedChannel> wanted_;
  std::vector<Place> places_;  ///< of wanted_
  std::vector<std::optional<std::size_t>> column_of_place_;
};

}  // namespace

void place_channels(const InitAnswers& answers, InitReading& reading) {
  if (reading.draft.station) return StationPlacing(answers, reading).place();
  ChannelPlacing(answers, reading).place();
}

}  // namespace framewatch::daemon
