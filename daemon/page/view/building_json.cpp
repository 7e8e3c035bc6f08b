#include "daemon/page/view/page_json.h"

#include <nlohmann/json.hpp>

#include "daemon/base/json.h"
#include "estimator/structure/group_design.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {

std::string building_json(const Config& config, double rate_hz) {
  const estimator::Structure& s = config.pipeline.structure;
  const estimator::ParameterTable table = config.pipeline.parameters();
  Json parameters = Json::array();
  const Eigen::VectorXd design =
      table.grouped() && config.pipeline.design.size() > 0
          ? group_parameters(s, table, {config.pipeline.design, config.pipeline.bending_nmprad})
          : config.pipeline.design;
  for (int p = 0; p < table.size(); ++p)
    parameters.push_back({{"name", table[p].name},
                          {"unit", table[p].unit},
                          {"kind", static_cast<int>(table[p].kind)},
                          {"story", table[p].story},
                          {"last_story", table[p].last_story},
                          {"frames", table[p].frames},
                          {"direction", letter(table[p].direction)},
                          {"frame", table[p].frame},
                          {"panel", table[p].panel},
                          {"design", design.size() > p ? Json(design[p]) : Json(nullptr)}});
  Json axes = Json::array();
  for (const estimator::SensorAxis& a : config.pipeline.axes) {
    axes.push_back(
        {{"name", a.name}, {"story", a.story}, {"direction", letter(a)}, {"frame", a.frame}});
    if (a.plan) axes.back().update({{"x_m", a.plan->x_m}, {"y_m", a.plan->y_m}});
  }
  const estimator::EstimatorOptions& o = config.pipeline.options;
  return json_line({{"name", s.name},
                    {"stories", s.stories},
                    {"frames_x", s.frames_x},
                    {"frames_y", s.frames_y},
                    {"span_x_m", s.span_x},
                    {"span_y_m", s.span_y},
                    {"story_height_m", s.story_height},
                    {"rigid", s.floor == estimator::FloorModel::rigid},
                    {"grouped", table.grouped()},
                    {"parameters", parameters},
                    {"axes", axes},
                    {"rate_hz", rate_hz},
                    {"window_s", o.window_s},
                    {"high_pass_hz", o.high_pass_hz},
                    {"watch", config.watch.has_value()},
                    {"version", FRAMEWATCH_VERSION},
                    {"config_sha256", config.sha256}});
}

}  // namespace framewatch::daemon
