#include "daemon/tools/init/station_questions.h"

#include <algorithm>

#include <fmt/core.h>

#include "daemon/base/printable.h"
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
        refuse(text, "there is no such channel");
    }
  }

  /// What a person said of it; empty: nothing.
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
        refuse(answer, fmt::format("a place is a floor, 0 to {}, base or roof, with :x, :y or :z "
                                   "where the header does not say the direction; or unused",
                                   d.station_plan.stories));
      return at;
    }
    if (!by_header)
      reading_.open.push_back(
          {"channel",
           fmt::format(
               "Where is {}{}? {}. Its floor (2, base, roof), with its direction where that "
               "is not said (2:x), or unused.",
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

}  // namespace

void place_station(const InitAnswers& answers, InitReading& reading) {
  StationPlacing(answers, reading).place();
}

}  // namespace framewatch::daemon
