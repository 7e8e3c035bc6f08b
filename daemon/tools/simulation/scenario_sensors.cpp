#include "daemon/tools/simulation/scenario_sensors.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/core.h>

#include "daemon/config/keys/section.h"

namespace framewatch::daemon {
namespace {

constexpr double kStandardGravity = 9.80665;
/// A delay is made by a filter that is longer by it at both ends.
constexpr double kLongestDelay_s = 1;

/// Keys that are given replace what `model` holds.
void read_sensor(ConfigSection& s, estimator::SensorModel& model, double& noise_ratio) {
  const auto take = [&](const char* key, double& value, double factor = 1) {
    if (s.given(key)) value = factor * s.number(key);
  };
  take("noise_mps2_per_rthz", model.noise_density);
  take("noise_ratio", noise_ratio);
  take("bias_mps2", model.bias);
  take("ramp_mps3", model.thermal_ramp);
  take("full_scale_g", model.full_scale, kStandardGravity);
  if (s.given("bits")) model.bits = s.integer("bits");
  take("loss_ratio", model.loss_ratio);
  take("dead_from_s", model.dead_from_s);
  take("dead_to_s", model.dead_to_s);
  for (const std::string& rule : problems(model)) s.problem("", rule);
}

/// Of what all sensors do only what has no unit of acceleration.
estimator::SensorModel of_force(const estimator::SensorModel& common) {
  estimator::SensorModel out;
  out.loss_ratio = common.loss_ratio;
  return out;
}

void refuse_acceleration(ConfigSection& s) {
  for (const char* key : {"noise_mps2_per_rthz", "bias_mps2", "ramp_mps3", "full_scale_g", "bits"})
    if (s.given(key))
      s.problem(key,
                "is of an accelerometer; a channel of a force has noise_ratio, loss_ratio, "
                "dead_from_s and dead_to_s");
}

}  // namespace

void read_sensors(const TomlValue* all, const std::vector<const TomlValue*>& single,
                  Scenario& scenario, std::vector<TextProblem>& problems) {
  estimator::SensorModel common;
  double common_ratio = 0;
  ConfigSection section("sensors", "sensors", all, {1, 1}, problems);
  read_sensor(section, common, common_ratio);
  // Empty when the building has a problem of its own: nothing is known of its channels then.
  const std::vector<estimator::SensorAxis>& axes = scenario.config.pipeline.axes;
  scenario.sensors.assign(axes.size(), common);
  scenario.noise_ratio.assign(axes.size(), common_ratio);
  for (std::size_t a = 0; a < axes.size(); ++a)
    if (axes[a].is_force) scenario.sensors[a] = of_force(common);
  for (const TomlValue* table : single) {
    ConfigSection one("sensor", "sensor", table, {}, problems);
    const std::string name = one.text("channel");
    const auto at = std::find_if(axes.begin(), axes.end(),
                                 [&](const estimator::SensorAxis& a) { return a.name == name; });
    if (at != axes.end()) {
      const auto index = static_cast<std::size_t>(at - axes.begin());
      read_sensor(one, scenario.sensors[index], scenario.noise_ratio[index]);
      if (axes[index].is_force) refuse_acceleration(one);
      continue;
    }
    if (!axes.empty() && one.given("channel"))
      one.problem("channel", fmt::format("no channel is named \"{}\"", name));
    estimator::SensorModel nobody;
    double ratio = 0;
    read_sensor(one, nobody, ratio);
  }
  for (const estimator::SensorAxis& axis : axes)
    if (std::abs(axis.delay) > kLongestDelay_s)
      problems.push_back({{},
                          fmt::format("channel \"{}\": a delay_s beyond {:g} s is not simulated",
                                      axis.name, kLongestDelay_s)});
}

}  // namespace framewatch::daemon
