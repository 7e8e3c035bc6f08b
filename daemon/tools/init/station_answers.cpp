#include "daemon/tools/init/station_answers.h"

#include <fmt/core.h>

#include "drivers/files/number_text.h"

namespace framewatch::daemon {

std::string ask_base(const BuildingDraft&) {
  return "Which level is the base, whose motion drives the stories above it: ground (the first "
         "floor) "
         "or\nbasement?";
}

bool asks_base(const BuildingDraft& d) {
  return d.station && d.station->ground_can_be_base && d.station->basement_can_be_base;
}

std::string understood_base(const BuildingDraft& d) {
  return d.station_plan.base_is_basement ? "basement" : "ground";
}

std::string ask_plan(const BuildingDraft&) {
  return "Lengths of the plan along x and y, m, such as 40x25? Sensors are said to be at its "
         "sides.";
}

std::string understood_plan(const BuildingDraft& d) {
  return fmt::format("{:g} m along x, {:g} m along y", d.station_plan.x_m, d.station_plan.y_m);
}

std::string ask_stories(const BuildingDraft& d) {
  std::string out = "How many stories does it have above its base?";
  if (d.station && d.station->highest_floor > 0)
    out += fmt::format(" The headers name floors up to {}{}.", d.station->highest_floor,
                       d.station->has_roof ? ", and a roof" : "");
  return out;
}

std::string take_base(const std::string& text, BuildingDraft& d, ColumnCache&) {
  if (text != "ground" && text != "basement") return "ground or basement";
  d.station_plan.base_is_basement = text == "basement";
  return "";
}

std::string initial_directions(const BuildingDraft& d) {
  if (!d.station || d.station->along_x == d.station->along_y) return "both";
  return d.station->along_x ? "x" : "y";
}

std::string take_plan(const std::string& text, BuildingDraft& d, ColumnCache&) {
  const std::size_t by = text.find('x');
  const auto x_m = drivers::parse_number(drivers::trimmed(text.substr(0, by)));
  const auto y_m = by == std::string::npos
                       ? std::nullopt
                       : drivers::parse_number(drivers::trimmed(text.substr(by + 1)));
  const auto possible = [](double length_m) { return length_m > 0 && length_m <= 1000; };
  if (!x_m || !y_m || !possible(*x_m) || !possible(*y_m))
    return "lengths along x and along y in m, such as 40x25";
  d.station_plan.x_m = *x_m;
  d.station_plan.y_m = *y_m;
  return "";
}

bool asks_plan(const BuildingDraft& d) {
  return d.station && ((d.station->needs_plan_x && d.plan.structure.m() < 2) ||
                       (d.station->needs_plan_y && d.plan.structure.n() < 2));
}

}  // namespace framewatch::daemon
