// SPDX-License-Identifier: MIT
#include "daemon/tools/init/building_toml.h"

#include <algorithm>
#include <vector>

#include <fmt/core.h>

#include "daemon/base/printable.h"
#include "daemon/base/words.h"

namespace framewatch::daemon {
namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

std::string number(double value) {
  return fmt::format("{:.6g}", value);
}

std::string names(const std::vector<std::string>& items) {
  return bracketed(items, quoted);
}

std::string numbers(const std::vector<double>& items) {
  return bracketed(items, number);
}

bool all_equal(const std::vector<double>& items) {
  return std::all_of(items.begin(), items.end(), [&](double v) { return v == items.front(); });
}

/// Splits values into consecutive pieces of `size`.
std::vector<std::vector<double>> pieces(const std::vector<double>& items, std::size_t size) {
  std::vector<std::vector<double>> out;
  for (std::size_t i = 0; i < items.size(); i += size)
    out.emplace_back(items.begin() + static_cast<std::ptrdiff_t>(i),
                     items.begin() + static_cast<std::ptrdiff_t>(i + size));
  return out;
}

/// Returns a grid [story][y][x] with a line for each story.
std::string node_mass(const estimator::Structure& s) {
  if (all_equal(s.node_mass)) return number(s.node_mass.front());
  const auto row = static_cast<std::size_t>(std::max(s.m(), 1));
  const auto floor = row * static_cast<std::size_t>(std::max(s.n(), 1));
  return bracketed(
      pieces(s.node_mass, floor),
      [&](const std::vector<double>& nodes) { return bracketed(pieces(nodes, row), numbers); },
      ",\n  ");
}

/// Returns a grid [story][frame]: each story's stiffness divided among its frames by the plan.
std::string frame_stiffness(const std::vector<double>& stories, const std::vector<double>& spans) {
  const std::vector<double> shares = shares_of_frames(spans);
  if (all_equal(stories) && all_equal(shares)) return number(stories.front() * shares.front());
  return bracketed(stories, [&](double story) {
    std::vector<double> frames = shares;
    for (double& stiffness : frames) stiffness *= story;
    return numbers(frames);
  });
}

std::string head(const BuildingPlan& p) {
  std::string out =
      "# Made by `framewatch init`. Correct it if needed, then run `framewatch check` on this "
      "file.\n"
      "# What to look at first: node_mass_kg, which sets the scale of every stiffness, and where "
      "each\n"
      "# [[channel]] is. docs/configuration.md has every key.\n";
  if (!p.record.empty())
    out += fmt::format("# The channels are named as the columns of {}.\n", printable(p.record));
  return out;
}

std::string structure_section(const BuildingPlan& p) {
  const estimator::Structure& s = p.structure;
  std::string out =
      "\n# The building: floor i lies on top of story i, floor 0 is the base.\n[structure]\n";
  out += fmt::format("name = {}\nstories = {}\n", quoted(s.name), s.stories);
  out += fmt::format(
      "frames_x = {}  # vertical frames parallel to x, in order of y: they move along x\n"
      "frames_y = {}  # parallel to y, in order of x: they move along y\n",
      names(s.frames_x), names(s.frames_y));
  if (s.m() > 1)
    out += fmt::format("span_x_m = {}  # between the frames of frames_y\n", numbers(s.span_x));
  if (s.n() > 1)
    out += fmt::format("span_y_m = {}  # between the frames of frames_x\n", numbers(s.span_y));
  if (p.azimuth_y_deg)
    out += fmt::format(
        "azimuth_y_deg = {:g}  # where y points by the compass; x is 90 deg clockwise from it\n",
        *p.azimuth_y_deg);
  out += fmt::format("story_height_m = {}  # for drift ratios; stiffness does not depend on it\n",
                     numbers(s.story_height));
  out += fmt::format(
      "floor = \"{}\"  # \"flexible\": floor panels are found out too; \"rigid\": floors move as "
      "bodies\n",
      s.floor == estimator::FloorModel::rigid ? "rigid" : "flexible");
  out += fmt::format(
      "# {},\n# each node its share of the plan. An error in all masses is the same one in every "
      "stiffness.\n# One number for all nodes, or [story][y][x].\nnode_mass_kg = {}\n",
      p.mass_from, node_mass(s));
  return out;
}

std::string design_section(const BuildingPlan& p) {
  if (p.story_kx_npm.empty() && p.story_ky_npm.empty())
    return "\n# No [structure.design]: where tuning starts is found from the data. With a first "
           "natural\n"
           "# frequency, or stiffnesses from drawings, the first windows are better: kx_npm, "
           "ky_npm.\n";
  std::string out = fmt::format(
      "\n# Where tuning starts, never taken for truth:\n# {}.\n"
      "# Each frame as stiff as its share of the plan; the drawings' are better, "
      "[story][frame].{}\n"
      "[structure.design]\n",
      p.stiffness_from,
      p.structure.panels() > 0 ? "\n# As long as they are shares, check finds the plan symmetric: "
                                 "no finding about the building."
                               : "");
  if (!p.story_kx_npm.empty())
    out += fmt::format("kx_npm = {}  # N/m of each frame that moves along x\n",
                       frame_stiffness(p.story_kx_npm, p.structure.span_y));
  if (!p.story_ky_npm.empty())
    out += fmt::format("ky_npm = {}  # N/m of each frame that moves along y\n",
                       frame_stiffness(p.story_ky_npm, p.structure.span_x));
  return out + "damping_ratio = 0.02\n";
}

std::string can_section(const BuildingPlan& p) {
  if (p.can_interface.empty()) return "";
  return fmt::format(
      "\n# The CAN bus. What comes by its arrival is timed by it; a node with a clock, or one "
      "that\n"
      "# samples at the SYNC, needs a [[can_node]]: docs/can.md.\n"
      "[[can]]\ninterface = {}\ndbc = [{}]\nbit_rate = 500000\n",
      quoted(p.can_interface), quoted(p.dbc));
}

/// Returns a channel at a place in plan, with the header's description as a comment.
std::string station_channel_section(const PlannedChannel& channel) {
  const StationPlace& at = *channel.station;
  const drivers::AxisHeader& header = channel.column.header;
  std::string out =
      fmt::format("\n[[channel]]\nname = {}\nstory = {}{}\n", quoted(channel.column.name), at.story,
                  header.place.empty() ? "" : "  # " + printable(header.place));
  if (at.azimuth_deg)
    out += fmt::format("azimuth_deg = {:g}  # along {}\n", *at.azimuth_deg, at.along);
  else
    out += fmt::format("direction = \"{}\"\n", at.along);
  if (at.x_m && at.along != 'z') out += fmt::format("x_m = {:.6g}\n", *at.x_m);
  if (at.y_m && at.along != 'z') out += fmt::format("y_m = {:.6g}\n", *at.y_m);
  if (!at.why_unused.empty()) out += fmt::format("use = false  # {}\n", at.why_unused);
  return out;
}

std::string channel_section(const estimator::Structure& s, const PlannedChannel& channel) {
  if (channel.station) return station_channel_section(channel);
  std::string out = fmt::format("\n[[channel]]\nname = {}\nstory = {}\n",
                                quoted(channel.column.name), channel.place.story);
  const Place& place = channel.place;
  out += place.frame >= 0 ? fmt::format("frame = {}  # along {}\n",
                                        quoted(s.frame_name(place.frame)), letter(place))
                          : fmt::format("direction = \"{}\"\n", letter(place));
  if (place.at) out += fmt::format("x_m = {:.6g}\ny_m = {:.6g}\n", place.at->x_m, place.at->y_m);
  if (place.vertical) out += "use = false  # vertical\n";
  if (!channel.column.source.empty()) out += fmt::format("source = {}\n", channel.column.source);
  if (channel.column.scale != 1)
    out += fmt::format("scale = {:.10g}  # m/s^2 of one of the signal's\n", channel.column.scale);
  return out;
}

}  // namespace

std::string building_toml(const BuildingPlan& p) {
  std::string out = head(p) + structure_section(p) + design_section(p);
  out += fmt::format("\n# How estimates are made.\n[estimator]\nrate_hz = {}{}\n",
                     fmt::format("{:.10g}", p.rate_hz),
                     p.rate_from.empty() ? "" : "  # " + p.rate_from);
  out += can_section(p);
  if (p.azimuth_y_deg)
    out +=
        "\n# The accelerometers, where the record's headers say they are: azimuth_deg is where the "
        "positive\n# axis points, x_m and y_m are from the first frames; `framewatch check` says "
        "what they show.\n# noise_mps2_per_rthz (data sheet) is worth giving.\n";
  else
    out += std::string(
               p.every_frame
                   ? "\n# The accelerometers: every frame has one on every floor, the base one "
                     "in each direction. An\n"
                   : "\n# The accelerometers: on a frame, or at x_m, y_m from the first frames. "
                     "Stories between measured\n# floors are identified together "
                     "(docs/partial.md); `framewatch check` says what they show. An\n") +
           "# axis mounted backwards has polarity = -1; noise_mps2_per_rthz (data sheet) is worth "
           "giving.\n";
  const auto lcm = std::find_if(p.channels.begin(), p.channels.end(), [](const auto& channel) {
    return channel.column.source.find("lcm") != std::string::npos;
  });
  if (lcm != p.channels.end())
    out +=
        "# Nodes are numbered from 0 in this order: write what your nodes send, or number them "
        "so.\n";
  for (const PlannedChannel& channel : p.channels) out += channel_section(p.structure, channel);
  return out;
}

}  // namespace framewatch::daemon
