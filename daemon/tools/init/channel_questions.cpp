// SPDX-License-Identifier: MIT
#include "daemon/tools/init/channel_questions.h"

#include <algorithm>

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

/// Returns the default name of a channel: "base-x", "F2-Y1".
std::string usual_name(const Structure& s, const Place& place) {
  if (place.story == 0) return place.direction == estimator::Direction::x ? "base-x" : "base-y";
  std::string frame = s.frame_name(place.frame);
  frame.front() = static_cast<char>(frame.front() - 'a' + 'A');
  return fmt::format("F{}-{}", place.story, frame);
}

/// Returns the LCM source: one node per floor if it has one accelerometer per direction, else one
/// node per channel.
std::string lcm_source(const Structure& s, const Place& place, std::size_t index) {
  const bool one_a_floor = s.n() == 1 && s.m() == 1;
  return fmt::format("{{ lcm = \"ACCEL\", node = {}, axis = \"{}\" }}",
                     one_a_floor ? static_cast<std::size_t>(place.story) : index,
                     letter(place.direction));
}

class ChannelPlacing {
 public:
  ChannelPlacing(const InitAnswers& answers, InitReading& reading)
      : answers_(answers),
        reading_(reading),
        structure_(reading.draft.plan.structure),
        columns_(reading.draft.columns),
        places_(places_of(structure_)),
        column_of_place_(places_.size()) {}

  void place() {
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

  void take_named() {
    for (const std::string& text : answers_.channels) {
      const std::size_t equals = text.rfind('=');
      if (equals == std::string::npos) {
        refuse(text, "write NAME=PLACE, such as acc3=2:y1");
        continue;
      }
      const auto column =
          std::find_if(columns_.begin(), columns_.end(),
                       [&](const ChannelColumn& c) { return c.name == text.substr(0, equals); });
      const std::optional<Place> place = parse_place(structure_, text.substr(equals + 1));
      if (column == columns_.end())
        refuse(text, "the file has no such column; columns without a place: " + names_left());
      else if (!place)
        refuse(text, "this building has no such place; its places are " +
                         place_option(structure_, places_.front()) + " (" +
                         place_text(structure_, places_.front()) + ") to " +
                         place_option(structure_, places_.back()));
      else
        put(*place, static_cast<std::size_t>(column - columns_.begin()), text);
    }
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
    const ColumnPlaces found = match_columns(structure_, titles, reading_.draft.reading);
    for (std::size_t p = 0; p < places_.size(); ++p)
      if (!column_of_place_[p] && found.column_of_place[p])
        column_of_place_[p] = column_of_title[*found.column_of_place[p]];
    const auto missing = std::count(column_of_place_.begin(), column_of_place_.end(), std::nullopt);
    if (missing == 0) return;
    if (columns_.size() < places_.size())
      open(
          "bays", "",
          fmt::format(
              "this building needs {} channels: those of the base and one for every frame of every "
              "floor. The file has {}. With 0x0, one frame stands for each direction{}",
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

  void fill() {
    BuildingDraft& d = reading_.draft;
    std::string list;
    for (std::size_t p = 0; p < places_.size(); ++p) {
      ChannelColumn column;
      if (columns_.empty()) column.name = usual_name(structure_, places_[p]);
      if (column_of_place_[p]) column = columns_[*column_of_place_[p]];
      if (d.live == "lcm") column.source = lcm_source(structure_, places_[p], p);
      list += fmt::format("\n     {:<16} {}", printable(column.name),
                          place_text(structure_, places_[p]));
      d.plan.channels.push_back({places_[p], column});
    }
    if (!columns_.empty() && names_left() != "none")
      list += "\n     left out         " + names_left();
    reading_.understood.push_back({"channel", "channels", list});
  }

  const InitAnswers& answers_;
  InitReading& reading_;
  const Structure& structure_;
  const std::vector<ChannelColumn>& columns_;
  std::vector<Place> places_;
  std::vector<std::optional<std::size_t>> column_of_place_;
};

}  // namespace

void place_channels(const InitAnswers& answers, InitReading& reading) {
  if (reading.draft.station) return StationPlacing(answers, reading).place();
  ChannelPlacing(answers, reading).place();
}

}  // namespace framewatch::daemon
