#include "daemon/tools/commands/layout_outlook.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/core.h>

#include "estimator/identify/groups/layout_prediction.h"

namespace framewatch::daemon {
namespace {

constexpr double kNeverSeen = 1;  // all of the stiffness

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

/// The channels of the highest measured floor, on another one.
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

std::string percent(double ratio) {
  return std::isfinite(ratio) ? fmt::format("{:.2g} %", 100 * ratio) : "-";
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
  const estimator::LayoutPrediction now =
      predict_layout(c, estimator::noise_densities(c.axes), shaking);
  const estimator::ParameterTable table = c.parameters();
  for (int p = 0; p < table.size(); ++p) {
    const auto i = static_cast<std::size_t>(p);
    const bool stiffness = table[p].kind == estimator::ParameterKind::frame_stiffness;
    if (!stiffness && table[p].kind != estimator::ParameterKind::bending_stiffness) continue;
    out.groups.push_back(
        {table[p].name, now.window_error[i], now.design_error[i],
         stiffness ? now.window_error[i + static_cast<std::size_t>(table.elements())] : NAN});
  }
  const Weakest place = weakest(now, c);
  out.least_seen_loss = place.loss;
  out.weakest_story = place.story;
  if (advise < 1 || floors.empty()) return out;
  for (int floor = 1; floor <= c.structure.stories; ++floor) {
    if (floors.contains(floor)) continue;
    estimator::PipelineConfig more = c;
    AdvisedFloor advised{floor, {}, 0};
    for (const estimator::SensorAxis& axis : copied_to(c, *floors.rbegin(), floor)) {
      advised.channels.push_back(axis.name);
      more.axes.push_back(axis);
    }
    advised.least_seen_loss =
        weakest(predict_layout(more, estimator::noise_densities(more.axes), shaking), more).loss;
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
  std::string floors;
  for (const int floor : o.floors) floors += fmt::format("{}{}", floors.empty() ? "" : ", ", floor);
  std::string out = fmt::format(
      "identifiable groups of stories between the measured floors {} of {} (docs/partial.md)\n"
      "            expected while the base shakes with {:g} m/s2 rms, sensors' noise {}:\n"
      "            {:<16} {:>14} {:>17} {:>14}\n",
      floors, s.stories, o.shaking_mps2, o.noise_configured ? "as configured" : "1e-4 m/s2/rtHz",
      "stiffness", "+- one window", "+- by the design", "+- damping");
  for (const GroupOutlook& g : o.groups)
    out += fmt::format("            {:<16} {:>14} {:>17} {:>14}\n", g.parameter,
                       percent(g.window_error), percent(g.design_error), percent(g.damping_error));
  out +=
      "            by the design: stories' shares in their group off by 5 %, masses by 2 %; the "
      "same in every window\n";
  if (o.least_seen_loss < kNeverSeen)
    out += fmt::format(
        "            by that noise alone, a story that loses {} of its stiffness is seen wherever "
        "it "
        "is; story {} needs so much\n",
        percent(o.least_seen_loss), o.weakest_story);
  else
    out += fmt::format("            no loss of stiffness in story {} is seen by these sensors\n",
                       o.weakest_story);
  for (const AdvisedFloor& a : o.advised)
    out += fmt::format("advice      with channels on floor {}: {}\n", a.floor,
                       a.least_seen_loss < kNeverSeen
                           ? percent(a.least_seen_loss) + " is seen everywhere"
                           : "places without any remain");
  return out;
}

}  // namespace framewatch::daemon
