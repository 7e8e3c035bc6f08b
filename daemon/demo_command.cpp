#include "daemon/demo_command.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "daemon/demo_files.h"
#include "daemon/demo_network.h"
#include "daemon/demo_view.h"
#include "daemon/estimation.h"
#include "daemon/scenario.h"
#include "daemon/simulation_output.h"
#include "drivers/lcm_source.h"

namespace framewatch::daemon {
namespace {

/// Beside LCM's usual port, so that a demo and a live system or another demo do not mix.
int demo_port() {
  return 7700 + static_cast<int>(::getpid() % 1000);
}

std::map<std::string, double> truth_of(const Scenario& s) {
  const ParameterTable table(s.config.pipeline.structure);
  std::map<std::string, double> out;
  for (int i = 0; i < table.size(); ++i) out[table[i].name] = s.truth[i];
  return out;
}

/// The three parties of the demo, each with its own LCM where the provider allows it.
class DemoBus {
 public:
  bool open(const DemoNetwork& network, int receive_buffer_bytes, std::string& error) {
    for (std::unique_ptr<lcm::LCM>& lcm : all_) {
      lcm = drivers::open_lcm(network.url, receive_buffer_bytes, error);
      if (!lcm) return false;
      if (network.in_process) break;
    }
    return true;
  }
  lcm::LCM& building() { return *all_[0]; }
  lcm::LCM& estimator() { return all_[1] ? *all_[1] : building(); }
  lcm::LCM& view() { return all_[2] ? *all_[2] : building(); }

 private:
  std::unique_ptr<lcm::LCM> all_[3];
};

void introduce(const Scenario& s, const DemoNetwork& network, double seconds) {
  fmt::print("{}: {} accelerometers, a truth the estimator does not know, shaken for {:g} s.\n",
             s.config.pipeline.structure.name, s.config.pipeline.axes.size(), seconds);
  fmt::print("{}.\n", network.explanation);
  if (!network.in_process) fmt::print("Listen with LCM_DEFAULT_URL='{}'.\n", network.url);
  std::fflush(stdout);
}

}  // namespace

Scenario demo_scenario() {
  std::vector<ConfigProblem> problems;
  const auto config = parse_config("built-in configuration", kDemoConfig, problems);
  std::optional<Scenario> scenario;
  if (config) scenario = read_scenario(kDemoScenario, "built-in scenario", problems, &*config);
  if (scenario) return *std::move(scenario);
  for (const ConfigProblem& p : problems) fmt::print(stderr, "{}: {}\n", p.where, p.message);
  std::abort();
}

int demo(const DemoArguments& a) {
  Scenario scenario = demo_scenario();
  scenario.duration_s = a.seconds;
  const DemoNetwork network = open_demo_network(demo_port());
  const LcmSettings& settings = scenario.config.lcm;
  DemoBus bus;
  std::string error;
  if (!bus.open(network, settings.receive_buffer_bytes, error)) {
    fmt::print(stderr, "framewatch demo: {}\n", error);
    return 2;
  }
  if (!a.quiet) introduce(scenario, network, a.seconds);

  const auto sensors = live_output(scenario, bus.building(), 1);
  Estimation estimation(scenario.config, [&](std::int64_t, const std::string& channel,
                                             const std::vector<std::uint8_t>& bytes) {
    bus.estimator().publish(channel, bytes.data(), static_cast<unsigned>(bytes.size()));
  });
  std::vector<std::string> inputs;
  for (const drivers::ChannelAddress& at : addresses(scenario.config.sources))
    inputs.push_back(at.lcm_channel);
  drivers::LcmSource source(bus.estimator(), inputs, settings.queue_capacity,
                            [&](const std::string& channel, const void* data, std::size_t size,
                                std::int64_t) { estimation.message(channel, data, size); });
  DemoView view(truth_of(scenario), ::isatty(STDOUT_FILENO) == 1, a.quiet);
  view.subscribe(bus.view(), settings.prefix);

  Simulation simulation(scenario);
  const std::int64_t count = instants(scenario);
  const auto look = [&] {
    while (bus.view().handleTimeout(0) > 0) {
    }
  };
  for (std::int64_t i = 0; i < count; ++i) {
    const std::vector<double>& raw = simulation.next();
    if (!sensors->put(simulation.time_s(), raw)) {
      fmt::print(stderr, "framewatch demo: {}\n", sensors->error());
      return 2;
    }
    // All messages of this instant are on their way; the next one is put when it is due.
    if (!source.handle(1)) {
      fmt::print(stderr, "framewatch demo: LCM failed\n");
      return 2;
    }
    look();
    view.update(simulation.time_s(), a.seconds);
  }
  // The last messages may still be on their way on a busy machine.
  for (std::int64_t seen = -1; seen != estimation.intake().counters().messages;) {
    seen = estimation.intake().counters().messages;
    if (!source.handle(300)) break;
    look();
  }
  estimation.finish();
  while (bus.view().handleTimeout(200) > 0) {
  }
  return view.finish();
}

}  // namespace framewatch::daemon
