// SPDX-License-Identifier: MIT
#include "daemon/tools/commands/layout_warnings.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "daemon/base/words.h"
#include "estimator/identify/groups/layout_prediction.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {
namespace {

constexpr double kNeverSeen = 1;  // loss of the whole stiffness

struct Weakest {
  double loss = 0;
  int story = 0;
};

Weakest weakest(const estimator::LayoutPrediction& p, const estimator::PipelineConfig& c) {
  Weakest out;
  for (int story = 1; story <= c.structure.stories; ++story)
    for (int f = 0; f < c.structure.frames(); ++f) {
      const double loss = p.smallest_loss[static_cast<std::size_t>(c.structure.dof(story, f))];
      if (loss > out.loss) out = {loss, story};
    }
  return out;
}

/// Returns the channels of the highest measured floor, placed on another floor.
std::vector<estimator::SensorAxis> copied_to(const estimator::PipelineConfig& c, int from,
                                             int floor) {
  std::vector<estimator::SensorAxis> out;
  for (const estimator::SensorAxis& axis : c.axes) {
    if (axis.story != from) continue;
    out.push_back(axis);
    out.back().story = floor;
    out.back().name = fmt::format("{}-{}", axis.name, floor);
  }
  return out;
}

/// Returns the errors of the groups that reach the roof.
TopErrors top_errors(const estimator::LayoutPrediction& p, const estimator::PipelineConfig& c) {
  const estimator::ParameterTable table = c.parameters();
  TopErrors out;
  for (int i = 0; i < table.elements(); ++i) {
    if (table[i].kind != estimator::ParameterKind::frame_stiffness ||
        table[i].last_story != c.structure.stories)
      continue;
    const auto at = static_cast<std::size_t>(i);
    const double error = std::hypot(p.window_error[at], p.design_error[at], p.sensor_error[at]);
    const double damping = p.window_error[at + static_cast<std::size_t>(table.elements())];
    out.stiffness = std::max(out.stiffness, std::isfinite(error) ? error : INFINITY);
    out.damping = std::max(out.damping, std::isfinite(damping) ? damping : INFINITY);
  }
  return out;
}

/// An axis that is farther off the frames' directions measures both.
constexpr double kOblique_deg = 15;
constexpr double kSameSpot_m = 0.01, kParallel_rad = 0.02;

void groups_not_shown(const Config& config, const LayoutOutlook& outlook,
                      std::vector<std::string>& out) {
  const estimator::PipelineConfig& c = config.pipeline;
  // Judges every prediction on the scale of the gate.
  const double most = c.options.max_error_k;
  const auto poor = [&](const GroupOutlook& g, double error, const char* whose,
                        const char* advice) {
    if (error > most)
      out.push_back(
          fmt::format("{}: {} will put its value off by {:.2g} %, more than "
                      "estimator.max_error_k_ratio = {:g} ({:g} %){}",
                      g.parameter, whose, 100 * error, most, 100 * most, advice));
  };
  for (const GroupOutlook& g : outlook.groups) {
    if (!std::isfinite(g.window_error)) {
      out.push_back(
          fmt::format("{}: these sensors cannot show it: no value will be published", g.parameter));
      continue;
    }
    poor(g, g.window_error, "noise", ": under such shaking, no value will be shown");
    poor(g, g.design_error, "the design's tolerances", ": compare its values with each other only");
    poor(g, g.sensor_error, "errors of gain and time",
         ": its floors move nearly alike. Leave more stories between measured floors");
  }
  for (const auto direction : {estimator::Direction::x, estimator::Direction::y}) {
    if ((direction == estimator::Direction::x ? c.structure.n() : c.structure.m()) == 0) continue;
    const bool measured =
        std::any_of(c.axes.begin(), c.axes.end(), [&](const estimator::SensorAxis& axis) {
          return axis.story > 0 && (axis.frame >= 0 ? c.structure.direction(axis.frame)
                                                    : axis.direction) == direction;
        });
    if (!measured)
      out.push_back(fmt::format(
          "no channel above the base measures along {0}: the frames parallel to {0} are "
          "not identified, and their changes are not noticed",
          letter(direction)));
  }
}

/// Warns of a roof without a channel, with the errors that one there would change.
void free_top(const Config& config, const LayoutOutlook& outlook, std::vector<std::string>& out) {
  if (!outlook.top) return;
  const TopErrors &now = *outlook.top, &then = outlook.top_with_roof;
  const auto within = [](double error) {
    return error < 1 ? fmt::format("{:.2g} %", 100 * error) : std::string("unknown");
  };
  out.push_back(fmt::format(
      "no channel on the roof, floor {}: the stories above floor {} show only in the motion of "
      "that "
      "floor. Expected errors of their stiffness and damping are {} and {}; with a channel on the "
      "roof, {} and {}",
      config.pipeline.structure.stories, outlook.floors.back(), within(now.stiffness),
      within(now.damping), within(then.stiffness), within(then.damping)));
}

/// Returns the direction of an axis in rad, counter-clockwise from +x.
double angle_of(const estimator::Structure& s, const estimator::SensorAxis& axis) {
  if (axis.plan) return axis.plan->angle_rad;
  const auto along = axis.frame >= 0 ? s.direction(axis.frame) : axis.direction;
  return along == estimator::Direction::x ? 0 : M_PI / 2;
}

/// Returns the position of an axis across its direction, m. It distinguishes parallel axes of a
/// rigid floor.
double across_m(const estimator::Structure& s, const estimator::SensorAxis& axis) {
  if (!axis.plan) return axis.frame >= 0 ? line_position(s, axis.frame) : 0;
  return std::abs(std::sin(axis.plan->angle_rad)) > std::abs(std::cos(axis.plan->angle_rad))
             ? axis.plan->x_m
             : axis.plan->y_m;
}

void contradictions(const Config& config, std::vector<std::string>& out) {
  const estimator::PipelineConfig& c = config.pipeline;
  for (std::size_t a = 0; a < c.axes.size(); ++a)
    for (std::size_t b = a + 1; b < c.axes.size(); ++b) {
      const estimator::SensorAxis &one = c.axes[a], &two = c.axes[b];
      if (one.story != two.story || one.vertical || two.vertical ||
          std::abs(across_m(c.structure, one) - across_m(c.structure, two)) > kSameSpot_m)
        continue;
      // Two channels without a place do not share one.
      if (!one.plan && one.frame < 0 && !two.plan && two.frame < 0) continue;
      const double apart =
          std::remainder(angle_of(c.structure, one) - angle_of(c.structure, two), 2 * M_PI);
      if (M_PI - std::abs(apart) < kParallel_rad)
        out.push_back(fmt::format(
            "channels '{}' and '{}' measure the same motion of floor {} with opposite "
            "signs: unless one is mounted backwards, an azimuth is wrong and their mean "
            "is meaningless",
            one.name, two.name, one.story));
      else if (std::abs(apart) < kParallel_rad)
        out.push_back(
            fmt::format("channels '{}' and '{}' measure the same motion of floor {}: their mean is "
                        "used; if they differ, framewatch cannot tell which one is right",
                        one.name, two.name, one.story));
    }
}

void oblique(const Config& config, std::vector<std::string>& out) {
  for (const estimator::SensorAxis& axis : config.pipeline.axes) {
    if (!axis.plan || axis.vertical) continue;
    const double off = std::asin(std::min(std::abs(std::cos(axis.plan->angle_rad)),
                                          std::abs(std::sin(axis.plan->angle_rad)))) *
                       180 / M_PI;
    if (off <= kOblique_deg) continue;
    out.push_back(fmt::format(
        "channel '{}' points {:.0f} degrees off the frames of direction {} and so measures both "
        "directions; if this is not meant, correct its azimuth or azimuth_y_deg",
        axis.name, off, letter(axis.direction)));
  }
}

}  // namespace

LayoutOutlook layout_outlook(const Config& config, int advise) {
  const estimator::PipelineConfig& c = config.pipeline;
  const estimator::ExpectedShaking shaking;
  LayoutOutlook out;
  out.shaking_mps2 = shaking.rms_mps2;
  std::set<int> floors;
  out.noise_configured = true;
  for (const estimator::SensorAxis& axis : c.axes) {
    if (axis.story > 0 && !axis.check) floors.insert(axis.story);
    out.noise_configured = out.noise_configured && axis.noise_density > 0;
  }
  out.floors.assign(floors.begin(), floors.end());
  const auto predicted = [&](const estimator::PipelineConfig& of) {
    return predict_layout(of, estimator::noise_densities(of.axes), shaking);
  };
  const estimator::LayoutPrediction now = predicted(c);
  const estimator::ParameterTable table = c.parameters();
  for (int p = 0; p < table.size(); ++p) {
    const auto i = static_cast<std::size_t>(p);
    const bool stiffness = table[p].kind == estimator::ParameterKind::frame_stiffness;
    if (!stiffness && table[p].kind != estimator::ParameterKind::bending_stiffness) continue;
    out.groups.push_back(
        {table[p].name, now.window_error[i], now.design_error[i], now.sensor_error[i],
         stiffness ? now.window_error[i + static_cast<std::size_t>(table.elements())] : NAN});
  }
  const Weakest place = weakest(now, c);
  out.least_seen_loss = place.loss;
  out.weakest_story = place.story;
  if (floors.empty()) return out;
  const auto with_floor = [&](int floor) {
    estimator::PipelineConfig more = c;
    for (const estimator::SensorAxis& axis : copied_to(c, *floors.rbegin(), floor))
      more.axes.push_back(axis);
    return more;
  };
  if (!floors.contains(c.structure.stories)) {
    const estimator::PipelineConfig more = with_floor(c.structure.stories);
    out.top = top_errors(now, c);
    out.top_with_roof = top_errors(predicted(more), more);
  }
  if (advise < 1) return out;
  for (int floor = 1; floor <= c.structure.stories; ++floor) {
    if (floors.contains(floor)) continue;
    const estimator::PipelineConfig more = with_floor(floor);
    AdvisedFloor advised{floor, {}, weakest(predicted(more), more).loss};
    for (std::size_t a = c.axes.size(); a < more.axes.size(); ++a)
      advised.channels.push_back(more.axes[a].name);
    out.advised.push_back(std::move(advised));
  }
  std::stable_sort(out.advised.begin(), out.advised.end(),
                   [](const AdvisedFloor& a, const AdvisedFloor& b) {
                     return a.least_seen_loss < b.least_seen_loss;
                   });
  if (out.advised.size() > static_cast<std::size_t>(advise))
    out.advised.resize(static_cast<std::size_t>(advise));
  return out;
}

std::string layout_text(const LayoutOutlook& o, const estimator::Structure& s) {
  std::string out = fmt::format(
      "identifiable groups of stories between the measured floors {} of {} (docs/partial.md)\n"
      "            expected while the base shakes with {:g} m/s2 rms, sensors' noise {}:\n"
      "            {:<16} {:>14} {:>17} {:>14} {:>14}\n",
      fmt::join(o.floors, ", "), s.stories, o.shaking_mps2,
      o.noise_configured ? "as configured" : "1e-4 m/s2/rtHz", "stiffness", "+- one window",
      "+- by the design", "+- by sensors", "+- damping");
  for (const GroupOutlook& g : o.groups)
    out += fmt::format(
        "            {:<16} {:>14} {:>17} {:>14} {:>14}\n", g.parameter,
        or_dash(100 * g.window_error, "{:.2g} %"), or_dash(100 * g.design_error, "{:.2g} %"),
        or_dash(100 * g.sensor_error, "{:.2g} %"), or_dash(100 * g.damping_error, "{:.2g} %"));
  out +=
      "            by the design: error if the stories' shares of their group are wrong by 5 % and "
      "masses by 2 %; by sensors: if gains are wrong by 0.2 % and clocks by 0.1 ms. Both are the "
      "same in every window\n";
  if (o.least_seen_loss < kNeverSeen)
    out += fmt::format(
        "            with this noise, the loss of {} of one story's stiffness is seen in every "
        "story; story {} needs the most\n",
        or_dash(100 * o.least_seen_loss, "{:.2g} %"), o.weakest_story);
  else
    out += fmt::format("            these sensors do not show any loss of stiffness in story {}\n",
                       o.weakest_story);
  for (const AdvisedFloor& a : o.advised)
    out += fmt::format("advice      with channels on floor {}: {}\n", a.floor,
                       a.least_seen_loss < kNeverSeen
                           ? or_dash(100 * a.least_seen_loss, "{:.2g} %") + " is seen everywhere"
                           : "some stories still show no loss");
  return out;
}

std::vector<std::string> layout_warnings(const Config& config, const LayoutOutlook& outlook) {
  std::vector<std::string> out;
  groups_not_shown(config, outlook, out);
  free_top(config, outlook, out);
  contradictions(config, out);
  oblique(config, out);
  for (const UnusedChannel& unused : config.unused)
    out.push_back(fmt::format("channel '{}' is not used: {}", unused.name, unused.reason));
  return out;
}

}  // namespace framewatch::daemon
