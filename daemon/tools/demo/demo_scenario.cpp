// SPDX-License-Identifier: MIT
#include "daemon/tools/demo/demo_scenario.h"

#include <cstdint>
#include <cstdlib>
#include <optional>
#include <utility>

#include "daemon/config/sections/config_problems.h"
#include "daemon/tools/lab/demo_files.h"
#include "estimator/structure/group_design.h"

namespace framewatch::daemon {
namespace {

constexpr drivers::CanField kAccel{0, 24, true, true, drivers::CanValue::integer, 1e-5, 0};
constexpr drivers::CanField kCount{24, 16, true, false, drivers::CanValue::integer, 1, 0};
constexpr int kLength_bytes = 5;
constexpr std::uint32_t kFirstTpdo = 0x181;

Scenario built_in(const char* config_text, const char* scenario_text) {
  std::vector<ConfigProblem> problems;
  const auto config = parse_config("built-in configuration", config_text, problems);
  std::optional<Scenario> scenario;
  if (config) scenario = read_scenario(scenario_text, "built-in scenario", problems, &*config);
  if (scenario) return *std::move(scenario);
  print_problems(problems);
  std::abort();
}

}  // namespace

void put_on_can(Config& config, const std::string& interface) {
  const double period_us = 1e6 / config.pipeline.options.rate_hz;
  drivers::CanBusMap bus;
  bus.interface = interface;
  bus.sync_period_us = period_us;
  bus.sync_overflow = 240;
  config.can = {};
  config.can.buses = {bus};
  config.can.grid_period_us = period_us;
  for (std::size_t i = 0; i < config.sources.size(); ++i) {
    const std::string& name = config.pipeline.axes[i].name;
    config.sources[i] = {"", -1, 0, interface, "Accel.X", name};
    drivers::CanMessageMap message;
    message.name = "Accel";
    message.id = kFirstTpdo + static_cast<std::uint32_t>(i);
    message.mask = 0x7FF;
    message.length = kLength_bytes;
    message.readings = {{kAccel, static_cast<int>(i), 0, "X"}};
    message.counter = kCount;
    drivers::CanNodeMap node;
    node.name = name;
    node.timing = drivers::CanTiming::sync;
    node.period_us = period_us;
    node.canopen_id = static_cast<int>(i) + 1;
    node.messages = {std::move(message)};
    config.can.nodes.push_back(std::move(node));
  }
}

Scenario demo_scenario() {
  return built_in(kDemoConfig, kDemoScenario);
}

Scenario tall_demo_scenario() {
  return built_in(kTallDemoConfig, kTallDemoScenario);
}

DemoBuilding demo_building(int stories) {
  if (stories == 20)
    return {tall_demo_scenario(),
            "kx_6to10_y2",
            0.2,
            12,
            kTallDemoConfig,
            "Demo: twenty stories, accelerometers on five levels"};
  return {demo_scenario(),
          "kx_1_y2",
          0.15,
          6,
          kDemoConfig,
          "Demo: a frame loses 15 % of its stiffness"};
}

Eigen::VectorXd after_loss(const DemoBuilding& b) {
  const estimator::PipelineConfig& c = b.scenario.config.pipeline;
  const estimator::ParameterTable table = c.parameters(), stories(c.structure);
  const estimator::Parameter& lost = table[table.find(b.loses).value()];
  Eigen::VectorXd theta = b.scenario.truth;
  for (int story = lost.story; story <= lost.last_story; ++story)
    for (const int f : lost.frames) theta[stories.frame_stiffness(story, f)] *= 1 - b.loss_ratio;
  return theta;
}

std::map<std::string, double> truth_of(const Scenario& s, const Eigen::VectorXd& theta) {
  const estimator::PipelineConfig& c = s.config.pipeline;
  const estimator::ParameterTable table = c.parameters();
  const Eigen::VectorXd values =
      table.grouped() ? group_parameters(c.structure, table, {theta, c.bending_nmprad}) : theta;
  std::map<std::string, double> out;
  for (int i = 0; i < table.size(); ++i) out[table[i].name] = values[i];
  return out;
}

}  // namespace framewatch::daemon
