// SPDX-License-Identifier: MIT
#include "daemon/tools/init/questions.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <tuple>

#include <fmt/core.h>

#include "daemon/base/printable.h"
#include "daemon/tools/init/answer_text.h"
#include "drivers/files/number_text.h"

namespace framewatch::daemon {
namespace {

using Draft = BuildingDraft;

constexpr int kMaxStories = 200;  ///< no building has more

bool always(const Draft&) {
  return true;
}
std::string must(const Draft&) {
  return "";
}

std::string take_name(const std::string& text, Draft& d, ColumnCache&) {
  if (text.empty() || printable(text) != text) return "a name on one line";
  d.plan.structure.name = text;
  return "";
}

std::string file_name(const std::string& path) {
  return path.substr(path.rfind('/') + 1);
}

std::string take_record(const std::string& text, Draft& d, ColumnCache& files) {
  if (text == "none") return "";
  RecordAnswer answer = parse_record_answer(text);
  if (!answer.problem.empty()) return answer.problem;
  if (!answer.arguments.any()) answer.arguments = d.record_arguments;
  const ChannelColumns& read = files.records(answer.paths, answer.arguments);
  if (!read.problem.empty()) return read.problem;
  d.columns = read.columns;
  d.station = read_station(d.columns);
  if (d.station) d.station_plan.base_is_basement = !d.station->ground_can_be_base;
  d.notes.insert(d.notes.end(), read.notes.begin(), read.notes.end());
  d.plan.record_files = static_cast<int>(answer.paths.size());
  d.plan.record =
      d.plan.record_files == 1
          ? shell_word(answer.paths.front()) + options_text(answer.arguments)
          : fmt::format("{} files, {} to {}", answer.paths.size(), file_name(answer.paths.front()),
                        file_name(answer.paths.back()));
  d.plan.rate_hz = read.rate_hz;
  d.plan.rate_from = "as the record's times say";
  return "";
}

std::string understood_record(const Draft& d) {
  if (d.plan.record.empty()) return "none";
  return fmt::format("{}, {} columns, {:g} samples a second", d.plan.record, d.columns.size(),
                     d.plan.rate_hz);
}

std::string take_live(const std::string& text, Draft& d, ColumnCache&) {
  if (text != "lcm" && text != "can" && text != "none") return "lcm, can or none";
  if (text == "can" && !d.plan.record.empty())
    return "can reads the channels from the DBC file: answer none for the record";
  d.live = text;
  return "";
}

std::string take_interface(const std::string& text, Draft& d, ColumnCache&) {
  if (text.empty() || text.size() > 15 || text.find_first_of("\"\\/ ") != std::string::npos)
    return "the name of a network interface, such as can0";
  d.plan.can_interface = text;
  return "";
}

std::string take_dbc(const std::string& text, Draft& d, ColumnCache& files) {
  if (printable(text) != text) return "a file's name on one line";
  const ChannelColumns& read = files.dbc(text, d.plan.can_interface);
  if (!read.problem.empty()) return read.problem;
  d.columns = read.columns;
  d.plan.dbc = text;
  return "";
}

std::string take_stories(const std::string& text, Draft& d, ColumnCache&) {
  const auto number = drivers::parse_integer(text);
  if (!number || *number < 1 || *number > kMaxStories)
    return fmt::format("a whole number from 1 to {}", kMaxStories);
  d.plan.structure.stories = d.station_plan.stories = static_cast<int>(*number);
  d.stories_known = true;
  return "";
}

std::string take_directions(const std::string& text, Draft& d, ColumnCache&) {
  if (text != "x" && text != "y" && text != "both") return "x, y or both";
  d.has_x = text != "y";
  d.has_y = text != "x";
  d.station_plan.has_x = d.has_x;
  d.station_plan.has_y = d.has_y;
  if (!d.has_x) d.plan.structure.frames_x.clear();
  if (!d.has_y) d.plan.structure.frames_y.clear();
  return "";
}

/// Parses floors such as "0, 4, 8, roof", once each.
std::string take_sensors(const std::string& text, Draft& d, ColumnCache&) {
  if (text == "all") return "";
  std::vector<std::string_view> words;
  drivers::split_commas(text, words);
  for (const std::string_view word : words) {
    const auto story = parse_story(d.plan.structure, drivers::trimmed(word));
    if (!story && !d.stories_known) return "";
    if (!story)
      return fmt::format("{}: floors from 0 (base) to {} (roof), such as base, 4, 8, roof; or all",
                         printable(std::string(word)), d.plan.structure.stories);
    d.levels.push_back(*story);
  }
  std::sort(d.levels.begin(), d.levels.end());
  if (std::adjacent_find(d.levels.begin(), d.levels.end()) != d.levels.end())
    return "the same floor twice";
  return d.levels.back() > 0 ? "" : "one floor above the base at least";
}

std::string understood_sensors(const Draft& d) {
  if (d.levels.empty()) return "on all floors";
  std::string out;
  for (const int level : d.levels) out += fmt::format("{}{}", out.empty() ? "" : ", ", level);
  return "on floors " + out + (d.levels.front() > 0 ? ", and the base" : "");
}

std::string take_per_level(const std::string& text, Draft& d, ColumnCache&) {
  if (text == "frames") return "";
  if (text.empty() || text.size() > 40 || text.find_first_not_of("xyz") != std::string::npos ||
      text.find_first_of("xy") == std::string::npos)
    return "a letter for each channel on a floor: xy, xxy, xyz; or frames";
  d.per_level = text;
  if (!d.bays_known) return "";
  const estimator::Structure& s = d.plan.structure;
  for (const auto& [along, frames, bays] :
       {std::tuple('x', s.n(), "0x1"), std::tuple('y', s.m(), "1x0")}) {
    const auto channels = std::count(text.begin(), text.end(), along);
    if (frames == 0 && channels > 0) return fmt::format("no frame moves along {}", along);
    if (frames > 0 && channels == 0)
      return fmt::format("no channel along {0}: --directions {1} leaves that direction out", along,
                         along == 'x' ? 'y' : 'x');
    if (channels > std::max(frames, 1))
      return fmt::format(
          "{} channels along {}, but {} along it: give more --bays (two frames are {}), or places "
          "by --channel NAME=1@(0,2.5):{}",
          channels, along, frames == 1 ? "one frame moves" : fmt::format("{} frames move", frames),
          bays, along);
  }
  return "";
}

/// Returns the bays that the channels of a level need: a frame for each of several along a
/// direction, and two frames of the other direction then.
std::string bays_of_level(const std::string& per_level) {
  const auto x = std::count(per_level.begin(), per_level.end(), 'x');
  const auto y = std::count(per_level.begin(), per_level.end(), 'y');
  if (x < 2 && y < 2) return "0x0";
  return fmt::format("{}x{}", std::max(y - 1, std::ptrdiff_t{1}),
                     std::max(x - 1, std::ptrdiff_t{1}));
}

std::string ask_bays(const Draft& d) {
  if (d.station)
    return "How many bays has the plan along x and along y, such as 2x1? With 0x0, one frame "
           "stands "
           "for all\nframes of its direction; torsion then stays unknown.";
  std::string out =
      "How many bays has the plan along x and along y, such as 2x1? Every frame needs an "
      "accelerometer\non every floor: ";
  out += d.has_x && d.has_y
             ? "1x1 needs 4 per floor, 2x1 needs 5, 0x0 needs 2 (one for each direction)"
         : d.has_x ? "0x0 needs 1 per floor, 0x1 needs 2, 0x2 needs 3"
                   : "0x0 needs 1 per floor, 1x0 needs 2, 2x0 needs 3";
  return out +
         (d.columns.empty() ? "." : fmt::format(". The record has {} columns.", d.columns.size()));
}

std::string take_bays(const std::string& text, Draft& d, ColumnCache&) {
  const auto bays = parse_bays(text);
  if (!bays) return "write the bays along x, an x and the bays along y, such as 2x1; 0x0 to 20x20";
  estimator::Structure& s = d.plan.structure;
  s.frames_x.clear();
  s.frames_y.clear();
  for (int i = 0; i <= bays->y && d.has_x; ++i) s.frames_x.push_back(fmt::format("y{}", i + 1));
  for (int i = 0; i <= bays->x && d.has_y; ++i) s.frames_y.push_back(fmt::format("x{}", i + 1));
  d.bays_known = true;
  return "";
}

std::string moving(const std::vector<std::string>& frames, const char* along) {
  return frames.size() == 1
             ? fmt::format("frame {} moves along {}", frames.front(), along)
             : fmt::format("frames {} to {} move along {}", frames.front(), frames.back(), along);
}

std::string understood_bays(const Draft& d) {
  const estimator::Structure& s = d.plan.structure;
  std::string out;
  if (d.has_x) out = moving(s.frames_x, "x");
  if (d.has_y) out += (d.has_x ? ", " : "") + moving(s.frames_y, "y");
  return out;
}

/// Parses positive numbers in m: one or `count`.
std::string take_lengths(const std::string& text, int count, bool count_known,
                         std::vector<double>& out) {
  const auto quantity = parse_quantity(text);
  if (!quantity || (!quantity->unit.empty() && quantity->unit != "m"))
    return why_no_quantity(text, "lengths in m, separated by commas: 3.5 or 4.2, 3.5, 3.5");
  if (!count_known) return "";
  const auto values = spread(quantity->values, static_cast<std::size_t>(count));
  if (!values)
    return fmt::format("there are {} numbers: give one for all, or {}", quantity->values.size(),
                       count);
  out = *values;
  return "";
}

std::string take_span_x(const std::string& text, Draft& d, ColumnCache&) {
  return take_lengths(text, d.plan.structure.m() - 1, d.bays_known, d.plan.structure.span_x);
}
std::string take_span_y(const std::string& text, Draft& d, ColumnCache&) {
  return take_lengths(text, d.plan.structure.n() - 1, d.bays_known, d.plan.structure.span_y);
}
std::string take_heights(const std::string& text, Draft& d, ColumnCache&) {
  return take_lengths(text, d.plan.structure.stories, d.stories_known,
                      d.plan.structure.story_height);
}

std::string understood_heights(const Draft& d) {
  const std::vector<double>& heights = d.plan.structure.story_height;
  return fmt::format("{} m, {:g} m in all", list_text(heights),
                     std::accumulate(heights.begin(), heights.end(), 0.0));
}

std::string take_floors(const std::string& text, Draft& d, ColumnCache&) {
  if (text != "flexible" && text != "rigid") return "flexible or rigid";
  d.plan.structure.floor =
      text == "rigid" ? estimator::FloorModel::rigid : estimator::FloorModel::flexible;
  return "";
}

/// Returns masses in kg: of the floors if they are given in kg/m2 and the area is known.
std::vector<double> floor_masses(const Draft& d) {
  double factor = 1;
  if (d.mass_unit == "t") factor = 1000;
  if (d.mass_unit == "kg/m2") factor = d.area_m2.value_or(0);
  std::vector<double> out = d.mass;
  for (double& mass : out) mass *= factor;
  return out;
}

void settle_masses(Draft& d) {
  const std::vector<double> masses = floor_masses(d);
  d.plan.structure.node_mass = node_masses(d.plan.structure, masses);
  d.plan.mass_from = list_text(masses) + " kg a floor";
  if (d.mass_unit == "kg/m2")
    d.plan.mass_from += fmt::format(" ({} kg/m^2 of {:.6g} m^2)", list_text(d.mass), *d.area_m2);
}

std::string take_mass(const std::string& text, Draft& d, ColumnCache&) {
  auto quantity = parse_quantity(text);
  if (!quantity)
    return why_no_quantity(
        text, "the mass of a floor in kg (one or a list), or a density: 18000, 18 t, 500 kg/m2");
  if (quantity->unit == "kg/m^2") quantity->unit = "kg/m2";
  if (quantity->unit.empty()) quantity->unit = "kg";
  if (quantity->unit != "kg" && quantity->unit != "t" && quantity->unit != "kg/m2")
    return fmt::format("unknown unit {}: use kg, t or kg/m2", quantity->unit);
  d.mass_unit = quantity->unit;
  d.area_m2 = floor_area_m2(d.plan.structure) > 0 ? std::optional(floor_area_m2(d.plan.structure))
                                                  : std::nullopt;
  if (!d.stories_known || !d.bays_known) return "";
  const auto values = spread(quantity->values, static_cast<std::size_t>(d.plan.structure.stories));
  if (!values)
    return fmt::format("there are {} numbers: give one for all floors, or {}",
                       quantity->values.size(), d.plan.structure.stories);
  d.mass = *values;
  if (d.mass_unit != "kg/m2" || d.area_m2) settle_masses(d);
  return "";
}

std::string take_area(const std::string& text, Draft& d, ColumnCache&) {
  const auto quantity = parse_quantity(text);
  const bool unit =
      quantity && (quantity->unit.empty() || quantity->unit == "m2" || quantity->unit == "m^2");
  if (!quantity || !unit || quantity->values.size() != 1)
    return why_no_quantity(text, "one number, in m^2");
  d.area_m2 = quantity->values.front();
  if (!d.mass.empty()) settle_masses(d);
  return "";
}

std::string take_rate(const std::string& text, Draft& d, ColumnCache&) {
  const auto quantity = parse_quantity(text);
  if (!quantity || quantity->values.size() != 1 ||
      (!quantity->unit.empty() && quantity->unit != "Hz"))
    return why_no_quantity(text, "samples a second, such as 100");
  d.plan.rate_hz = quantity->values.front();
  return "";
}

std::string initial_directions(const Draft& d) {
  const bool x = d.wanted_per_level.find('x') != std::string::npos;
  const bool y = d.wanted_per_level.find('y') != std::string::npos;
  if (d.wanted_per_level != "frames" && x != y) return x ? "x" : "y";
  if (!d.station || d.station->along_x == d.station->along_y) return "both";
  return d.station->along_x ? "x" : "y";
}

std::string ask_stories(const Draft& d) {
  std::string out = "How many stories does it have above its base?";
  if (d.station && d.station->highest_floor > 0)
    out += fmt::format(" The headers name floors up to {}{}.", d.station->highest_floor,
                       d.station->has_roof ? ", and a roof" : "");
  return out;
}

std::string take_base(const std::string& text, Draft& d, ColumnCache&) {
  if (text != "ground" && text != "basement") return "ground or basement";
  d.station_plan.base_is_basement = text == "basement";
  return "";
}

std::string take_plan(const std::string& text, Draft& d, ColumnCache&) {
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

bool asks_plan(const Draft& d) {
  return d.station && ((d.station->needs_plan_x && d.plan.structure.m() < 2) ||
                       (d.station->needs_plan_y && d.plan.structure.n() < 2));
}

/// True unless one frame stands for each direction.
bool asks_per_level(const Draft& d) {
  const estimator::Structure& s = d.plan.structure;
  return !d.station && (s.n() > 1 || s.m() > 1 || !d.wanted_per_level.empty());
}

template <const char* Text>
std::string fixed(const Draft&) {
  return Text;
}

// Questions and defaults that do not depend on earlier answers.
constexpr char kAskRecord[] =
    "Is there a record of its accelerometers, such as a CSV file? Its header names the channels. "
    "Give the\nfile name and options for what the file does not say (my.csv --unit g), or none";
constexpr char kAskLive[] = "Where do live samples come from: lcm, can, or none (files only)?";
constexpr char kAskInterface[] = "Which network interface is the CAN bus?";
constexpr char kAskDbc[] = "Which DBC file describes the bus?";
constexpr char kAskName[] = "What is the building called?";
constexpr char kAskDirections[] =
    "Which horizontal directions do the accelerometers measure: x, y or both?";
constexpr char kAskSpanX[] =
    "How long are the spans along x, in m (one number for all, or a list)?";
constexpr char kAskSpanY[] =
    "How long are the spans along y, in m (one number for all, or a list)?";
constexpr char kAskHeights[] =
    "How high are the stories, in m, from the bottom (one number for all, or a list: 4.2, 3.5, "
    "3.5)?";
constexpr char kAskFloors[] =
    "Are the floors flexible in their plane (framewatch then estimates their stiffness too), or "
    "rigid,\n"
    "such as slabs without large openings: flexible or rigid?";
constexpr char kAskMass[] =
    "What is the mass of each floor with its load: 18000 (kg) or 18 t, one number for all or a "
    "list; or\na density, such as 500 kg/m2?";
constexpr char kAskArea[] = "What is the area of a floor, in m^2?";
constexpr char kAskBase[] =
    "Which level is the base, whose motion drives the stories above it: ground (the first "
    "floor)\nor basement?";
constexpr char kAskPlan[] =
    "How long is the plan along x and y, in m, such as 40x25? The headers place sensors at its "
    "sides.";
constexpr char kAskSensors[] =
    "Which floors have accelerometers: all, or a list such as 0, 4, 8, 12 (0 is the base)?";
constexpr char kAskPerLevel[] =
    "Which channels has each of these floors: one on every frame (frames), or a letter for each,\n"
    "such as xxy: two along x, on the first and the last frame, and one along y?";
constexpr char kAskRate[] = "How many samples per second does each accelerometer give?";
constexpr char kNone[] = "none", kCan0[] = "can0", kBuilding[] = "building", k100[] = "100",
               kGround[] = "ground", kAll[] = "all", kFrames[] = "frames";

const InitQuestion kQuestions[] = {
    {"record", "record", fixed<kAskRecord>, always, fixed<kNone>, take_record, understood_record},
    {"live", "live samples", fixed<kAskLive>, always,
     [](const Draft& d) { return std::string(d.plan.record.empty() ? "" : "none"); }, take_live,
     [](const Draft& d) { return d.live; }},
    {"interface", "CAN bus", fixed<kAskInterface>, [](const Draft& d) { return d.live == "can"; },
     fixed<kCan0>, take_interface, [](const Draft& d) { return d.plan.can_interface; }},
    {"dbc", "DBC file", fixed<kAskDbc>, [](const Draft& d) { return d.live == "can"; }, must,
     take_dbc,
     [](const Draft& d) {
       return fmt::format("{}, {} signals of acceleration", d.plan.dbc, d.columns.size());
     }},
    {"building", "name", fixed<kAskName>, always, fixed<kBuilding>, take_name,
     [](const Draft& d) { return d.plan.structure.name; }},
    {"base", "base", fixed<kAskBase>,
     [](const Draft& d) {
       return d.station && d.station->ground_can_be_base && d.station->basement_can_be_base;
     },
     fixed<kGround>, take_base,
     [](const Draft& d) {
       return std::string(d.station_plan.base_is_basement ? "basement" : "ground");
     }},
    {"stories", "stories", ask_stories, always, must, take_stories,
     [](const Draft& d) { return fmt::format("{}", d.plan.structure.stories); }},
    {"directions", "directions", fixed<kAskDirections>, always, initial_directions, take_directions,
     [](const Draft& d) {
       return std::string(!d.has_y ? "x" : !d.has_x ? "y" : "x and y");
     }},
    {"bays", "bays", ask_bays, always,
     [](const Draft& d) {
       if (d.wanted_per_level.find_first_not_of("xyz") == std::string::npos &&
           !d.wanted_per_level.empty())
         return bays_of_level(d.wanted_per_level);
       return std::string(d.has_x && d.has_y && !d.station ? "" : "0x0");
     },
     take_bays, understood_bays},
    {"span-x", "spans along x", fixed<kAskSpanX>,
     [](const Draft& d) { return d.plan.structure.m() > 1; }, must, take_span_x,
     [](const Draft& d) { return list_text(d.plan.structure.span_x) + " m"; }},
    {"span-y", "spans along y", fixed<kAskSpanY>,
     [](const Draft& d) { return d.plan.structure.n() > 1; }, must, take_span_y,
     [](const Draft& d) { return list_text(d.plan.structure.span_y) + " m"; }},
    {"plan", "lengths of the plan", fixed<kAskPlan>, asks_plan, must, take_plan,
     [](const Draft& d) {
       return fmt::format("{:g} m along x, {:g} m along y", d.station_plan.x_m, d.station_plan.y_m);
     }},
    {"heights", "story heights", fixed<kAskHeights>, always, must, take_heights,
     understood_heights},
    {"floors", "floors", fixed<kAskFloors>,
     [](const Draft& d) {
       return d.station || d.plan.structure.n() > 1 || d.plan.structure.m() > 1;
     },
     [](const Draft& d) {
       const bool partial = !d.wanted_per_level.empty() && d.wanted_per_level != "frames";
       return std::string(d.station || partial || d.wants_points ? "rigid" : "flexible");
     },
     take_floors,
     [](const Draft& d) {
       return std::string(d.plan.structure.floor == estimator::FloorModel::rigid ? "rigid"
                                                                                 : "flexible");
     }},
    {"sensors", "accelerometers", fixed<kAskSensors>, [](const Draft& d) { return !d.station; },
     fixed<kAll>, take_sensors, understood_sensors},
    {"per-level", "on each floor", fixed<kAskPerLevel>, asks_per_level, fixed<kFrames>,
     take_per_level,
     [](const Draft& d) {
       return d.per_level.empty() ? std::string("one channel on every frame") : d.per_level;
     }},
    {"mass", "mass", fixed<kAskMass>, always, must, take_mass,
     [](const Draft& d) { return d.plan.mass_from.empty() ? "a density" : d.plan.mass_from; }},
    {"area", "floor area", fixed<kAskArea>,
     [](const Draft& d) { return d.mass_unit == "kg/m2" && floor_area_m2(d.plan.structure) <= 0; },
     must, take_area, [](const Draft& d) { return fmt::format("{:g} m^2", *d.area_m2); }},
    {"start", "starting stiffness", ask_start, always, initial_start, take_start,
     [](const Draft& d) { return d.plan.stiffness_from; }},
    {"rate", "samples a second", fixed<kAskRate>,
     [](const Draft& d) { return d.plan.record.empty(); }, fixed<k100>, take_rate,
     [](const Draft& d) { return fmt::format("{:g}", d.plan.rate_hz); }},
};

}  // namespace

std::span<const InitQuestion> init_questions() {
  return kQuestions;
}

}  // namespace framewatch::daemon
