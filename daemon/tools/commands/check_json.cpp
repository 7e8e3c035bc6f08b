#include <cmath>

#include <nlohmann/json.hpp>

#include "daemon/tools/commands/check_report.h"
#include "drivers/can/bus_load.h"
#include "estimator/structure/natural_frequencies.h"

namespace framewatch::daemon {
namespace {

using Json = nlohmann::ordered_json;

Json finite(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

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
                          {"window_error_ratio", finite(g.window_error)},
                          {"design_error_ratio", finite(g.design_error)},
                          {"damping_error_ratio", finite(g.damping_error)}});
      for (const AdvisedFloor& a : layout.advised)
        advice.push_back(
            {{"floor", a.floor}, {"least_seen_loss_ratio", finite(a.least_seen_loss)}});
      out["layout"] = {{"measured_floors", layout.floors},
                       {"shaking_rms_mps2", layout.shaking_mps2},
                       {"groups", groups},
                       {"least_seen_loss_ratio", finite(layout.least_seen_loss)},
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

}  // namespace framewatch::daemon
