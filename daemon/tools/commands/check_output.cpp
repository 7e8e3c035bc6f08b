// SPDX-License-Identifier: MIT
#include <algorithm>
#include <numeric>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/json.h"
#include "daemon/base/words.h"
#include "daemon/tools/commands/check_report.h"
#include "drivers/can/bus_load.h"
#include "estimator/structure/natural_frequencies.h"

namespace framewatch::daemon {
namespace {

Json channels(const Config& config) {
  Json out = Json::array();
  for (std::size_t i = 0; i < config.sources.size(); ++i) {
    const estimator::SensorAxis& axis = config.pipeline.axes[i];
    const AxisSource& source = config.sources[i];
    Json channel{{"name", axis.name}, {"story", axis.story}, {"direction", letter(axis)}};
    if (axis.frame >= 0) channel["frame"] = config.pipeline.structure.frame_name(axis.frame);
    if (axis.plan)
      channel["plan"] = {
          {"x_m", axis.plan->x_m}, {"y_m", axis.plan->y_m}, {"angle_rad", axis.plan->angle_rad}};
    if (!source.can.empty())
      channel["source"] = {{"can", source.can}, {"dbc_signal", source.dbc_signal}};
    if (!source.can_node.empty()) channel["source"]["can_node"] = source.can_node;
    if (source.sensor_node >= 0)
      channel["source"] = {{"lcm", source.lcm_channel},
                           {"node", source.sensor_node},
                           {"axis", std::string(1, "xyz"[source.axis])}};
    out.push_back(channel);
  }
  return out;
}

/// Returns the drifts at which damage begins, for each story that differs from the one below.
std::string fragility_text(const Config& config) {
  if (!config.fragility)
    return "fragility   not configured: reports give drifts without damage (see [fragility] "
           "type)\n";
  const FragilitySettings& f = *config.fragility;
  std::string out = fmt::format("fragility   {}\n", f.source);
  for (std::size_t i = 0; i < f.by_story.size(); ++i) {
    const estimator::Fragility& one = f.by_story[i];
    if (i > 0 && one.median == f.by_story[i - 1].median &&
        one.dispersion == f.by_story[i - 1].dispersion)
      continue;
    out += fmt::format(
        "            {}slight {:g} %, moderate {:g} %, extensive {:g} %, complete "
        "{:g} % of the height; dispersion {:g}, {:g}, {:g}, {:g}\n",
        i == 0 ? "" : fmt::format("from story {}: ", i + 1), 100 * one.median[0],
        100 * one.median[1], 100 * one.median[2], 100 * one.median[3], one.dispersion[0],
        one.dispersion[1], one.dispersion[2], one.dispersion[3]);
  }
  return out + fmt::format(
                   "placard     restricted use from {:g} % for moderate damage, unsafe from {:g} % "
                   "for extensive damage, of any story\n",
                   100 * f.rules.restricted, 100 * f.rules.unsafe);
}

std::string frames_text(const std::vector<std::string>& frames) {
  return frames.empty() ? "none" : listed(frames);
}

std::string structure_text(const estimator::Structure& s) {
  const double mass = std::accumulate(s.node_mass.begin(), s.node_mass.end(), 0.0);
  const char* floor =
      s.panels() > 0 ? "flexible floors"
                     : (s.floor == estimator::FloorModel::rigid ? "rigid floors" : "no panels");
  return fmt::format(
      "structure   {}: {} stories, x-parallel frames {}, y-parallel frames {}, {}\n"
      "            {:.6g} kg, {} degrees of freedom\n",
      s.name, s.stories, frames_text(s.frames_x), frames_text(s.frames_y), floor, mass,
      s.degrees_of_freedom());
}

std::string design_text(const CheckReport& r) {
  if (r.config.pipeline.design.size() == 0)
    return "design      none: the filters find their frequencies from the data\n";
  if (r.design_hz.empty()) return "design      given; too large a building to list frequencies\n";
  constexpr std::size_t kListed = 8;
  std::string list;
  for (std::size_t i = 0; i < std::min(kListed, r.design_hz.size()); ++i)
    list += fmt::format("{}{:.3f}", i ? ", " : "", r.design_hz[i]);
  if (r.design_hz.size() > kListed) list += fmt::format(" ... {:.3f}", r.design_hz.back());
  return fmt::format("design      natural frequencies {} Hz\n", list);
}

std::string channel_text(const estimator::Structure& s, const estimator::SensorAxis& axis,
                         const AxisSource& source) {
  const std::string place = axis.story == 0 ? "base" : fmt::format("story {}", axis.story);
  const std::string frame = axis.frame >= 0 ? fmt::format(", frame {}", s.frame_name(axis.frame))
                            : axis.plan
                                ? fmt::format(", at {:g}, {:g} m", axis.plan->x_m, axis.plan->y_m)
                                : "";
  const std::string from =
      !source.can.empty()      ? fmt::format("{}, {}{}", source.can, source.dbc_signal,
                                        source.can_node.empty() ? "" : " of " + source.can_node)
      : source.sensor_node < 0 ? std::string("files only")
                               : fmt::format("LCM {}, node {}, axis {}", source.lcm_channel,
                                             source.sensor_node, "xyz"[source.axis]);
  return fmt::format("  {:<16} {}{}, along {}; {}\n", axis.name, place, frame, letter(axis), from);
}

std::string identifiable_text(const CheckReport& r) {
  const estimator::Structure& s = r.config.pipeline.structure;
  std::string out = fmt::format(
      "identifiable stiffness and damping of all {} frame stories: every place has a channel\n",
      s.stories * s.frames());
  if (s.panels() == 0) return out;
  if (r.panels.empty())
    return out +
           "            floor panels where ground motion shears them: not judged without a "
           "design of moderate size\n";
  const auto [least, most] = std::minmax_element(
      r.panels.begin(), r.panels.end(),
      [](const auto& a, const auto& b) { return a.shear_ratio < b.shear_ratio; });
  return out + fmt::format(
                   "            floor panels shear {:.1f} % ({}) to {:.1f} % ({}) of what "
                   "the frames do\n",
                   100 * least->shear_ratio, least->parameter, 100 * most->shear_ratio,
                   most->parameter);
}

}  // namespace

std::string to_json(const std::string& path, const std::optional<CheckReport>& report,
                    const std::vector<ConfigProblem>& problems) {
  Json out{{"schema", "framewatch.check/1"}, {"config", path}, {"good", report.has_value()}};
  out["problems"] = Json::array();
  for (const ConfigProblem& p : problems)
    out["problems"].push_back({{"where", p.where}, {"message", p.message}});
  if (report) {
    const estimator::PipelineConfig& c = report->config.pipeline;
    out["sha256"] = report->config.sha256;
    out["degrees_of_freedom"] = c.structure.degrees_of_freedom();
    out["parameters"] = report->parameters;
    out["rate_hz"] = c.options.rate_hz;
    out["window_samples"] = report->window_rows;
    out["hop_samples"] = report->hop_rows;
    out["design_natural_frequencies_hz"] = report->design_hz;
    out["memory_bytes"] = report->memory_bytes;
    out["panel_shear_ratio"] = Json::object();
    for (const PanelOutlook& panel : report->panels)
      out["panel_shear_ratio"][panel.parameter] = panel.shear_ratio;
    if (report->layout) {
      const LayoutOutlook& layout = *report->layout;
      Json groups = Json::array(), advice = Json::array();
      for (const GroupOutlook& g : layout.groups)
        groups.push_back({{"parameter", g.parameter},
                          {"window_error_ratio", json_value(g.window_error)},
                          {"design_error_ratio", json_value(g.design_error)},
                          {"sensor_error_ratio", json_value(g.sensor_error)},
                          {"damping_error_ratio", json_value(g.damping_error)}});
      for (const AdvisedFloor& a : layout.advised)
        advice.push_back(
            {{"floor", a.floor}, {"least_seen_loss_ratio", json_value(a.least_seen_loss)}});
      out["layout"] = {{"measured_floors", layout.floors},
                       {"shaking_rms_mps2", layout.shaking_mps2},
                       {"groups", groups},
                       {"least_seen_loss_ratio", json_value(layout.least_seen_loss)},
                       {"weakest_story", layout.weakest_story},
                       {"advice", advice}};
    }
    out["fragility"] = nullptr;
    if (const auto& f = report->config.fragility) {
      out["fragility"] = {{"source", f->source},
                          {"restricted_probability", f->rules.restricted},
                          {"unsafe_probability", f->rules.unsafe},
                          {"stories", Json::array()}};
      for (const estimator::Fragility& one : f->by_story)
        out["fragility"]["stories"].push_back(
            {{"median_drift_ratio", one.median}, {"dispersion", one.dispersion}});
    }
    out["unused_channels"] = Json::array();
    for (const UnusedChannel& unused : report->config.unused)
      out["unused_channels"].push_back({{"name", unused.name}, {"reason", unused.reason}});
    out["lcm_url"] = report->config.lcm.url;
    out["can"] = Json::array();
    for (std::size_t b = 0; b < report->config.can.buses.size(); ++b) {
      const drivers::BusLoad load = drivers::bus_load(report->config.can, static_cast<int>(b));
      out["can"].push_back({{"interface", report->config.can.buses[b].interface},
                            {"frames_hz", load.frames_hz},
                            {"worst_load_ratio", load.share}});
    }
    out["channels"] = channels(report->config);
    out["warnings"] = report->warnings;
  }
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string to_text(const CheckReport& r) {
  const estimator::EstimatorOptions& o = r.config.pipeline.options;
  std::string out = fmt::format("{}: good, sha256 {}\n", r.config.path, r.config.sha256);
  out += structure_text(r.config.pipeline.structure);
  out += fmt::format("parameters  {}: {} ... {}\n", r.parameters.size(), r.parameters.front(),
                     r.parameters.back());
  out += design_text(r);
  out += fmt::format(
      "estimator   {}, {:g} Hz, window {} samples ({:g} s), hop {} samples ({:.4g} s)\n",
      o.variant == estimator::Variant::paper ? "paper" : "matched", o.rate_hz, r.window_rows,
      r.window_rows / o.rate_hz, r.hop_rows, r.hop_rows / o.rate_hz);
  if (r.memory_bytes > 0)
    out +=
        fmt::format("memory      {:.1f} MB of the estimator's, taken at the start and never more\n",
                    1e-6 * static_cast<double>(r.memory_bytes));
  out += fmt::format("lcm         {}, publishes on {}*\n", r.config.lcm.url, r.config.lcm.prefix);
  for (std::size_t b = 0; b < r.config.can.buses.size(); ++b) {
    const drivers::CanBusMap& bus = r.config.can.buses[b];
    const drivers::BusLoad load = drivers::bus_load(r.config.can, static_cast<int>(b));
    out += fmt::format("{:<11} {:g} kbit/s{}, {:g} frames/s, at most {:.1f} % of the bus\n",
                       bus.interface, 1e-3 * bus.bit_rate,
                       bus.fd ? fmt::format(" and {:g} kbit/s", 1e-3 * bus.data_bit_rate) : "",
                       load.frames_hz, 100 * load.share);
  }
  out += fmt::format("channels    {}\n", r.config.pipeline.axes.size());
  for (std::size_t i = 0; i < r.config.sources.size(); ++i)
    out +=
        channel_text(r.config.pipeline.structure, r.config.pipeline.axes[i], r.config.sources[i]);
  out += fragility_text(r.config);
  out += r.layout ? layout_text(*r.layout, r.config.pipeline.structure) : identifiable_text(r);
  return out;
}

}  // namespace framewatch::daemon
