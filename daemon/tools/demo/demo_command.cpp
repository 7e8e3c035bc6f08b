// SPDX-License-Identifier: MIT
#include "daemon/tools/demo/demo_command.h"

#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/config/channel_addresses.h"
#include "daemon/monitor/estimation/estimation.h"
#include "daemon/monitor/events/change_words.h"
#include "daemon/page/view/live_view.h"
#include "daemon/page/web/web_server.h"
#include "daemon/page/web/web_socket.h"
#include "daemon/tools/demo/demo_network.h"
#include "daemon/tools/demo/demo_scenario.h"
#include "daemon/tools/demo/demo_view.h"
#include "daemon/tools/report/report_command.h"
#include "daemon/tools/simulation/scenario.h"
#include "daemon/tools/simulation/simulation.h"
#include "daemon/tools/simulation/simulation_output.h"
#include "drivers/can/can_source.h"
#include "drivers/lcm/lcm_log.h"
#include "drivers/lcm/lcm_source.h"

namespace framewatch::daemon {
namespace {

/// Logs of a demo with a report, in a temporary folder. Without a report nothing is stored.
class DemoLogs {
 public:
  /// `report`: page to write; empty for none.
  explicit DemoLogs(const std::string& report) : report_(report) {
    if (report_.empty()) return;
    char name[] = "/tmp/framewatch-demo-XXXXXX";
    if (const char* made = ::mkdtemp(name)) folder_ = made;
    open_ = !folder_.empty() && raw_.open(folder_ + "/raw.lcmlog") &&
            estimates_.open(folder_ + "/estimates.lcmlog");
    if (!open_) fmt::print(stderr, "framewatch demo: no log in /tmp, so no report\n");
  }
  ~DemoLogs() {
    std::error_code ignored;
    if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
  }
  DemoLogs(const DemoLogs&) = delete;
  DemoLogs& operator=(const DemoLogs&) = delete;

  void raw(const drivers::LcmMessage& m) {
    open_ = open_ && raw_.write(m.received_us, m.channel, m.data, m.size);
  }
  void estimate(std::int64_t time_us, const std::string& channel,
                const std::vector<std::uint8_t>& bytes) {
    open_ = open_ && estimates_.write(time_us, channel, bytes.data(), bytes.size());
  }

  /// Closes the logs and writes the report. `building`: the shaken building.
  void write_report(const DemoBuilding& building) {
    if (report_.empty()) return;
    const std::string config = folder_ + "/building.toml";
    std::ofstream(config) << building.config_text;
    if (!open_ || !raw_.close() || !estimates_.close()) return;
    ReportArguments a;
    a.estimates = folder_ + "/estimates.lcmlog";
    a.config = config;
    if (raw_.events() > 0) a.raw = {folder_ + "/raw.lcmlog"};
    a.out = report_;
    a.title = building.title;
    if (report(a) != 0) fmt::print(stderr, "framewatch demo: no report\n");
  }

 private:
  std::string report_, folder_;
  bool open_ = false;
  drivers::LcmLogWriter raw_, estimates_;
};

/// Returns a port other than LCM's usual one, so that demos and live systems do not mix.
int demo_port() {
  return 7700 + static_cast<int>(::getpid() % 1000);
}

constexpr double kDropAt_s = 20;
constexpr double kFlush_s = 0.05;

/// The four parties of the demo, each with a separate LCM instance if the provider allows it.
class DemoBus {
 public:
  bool open(const DemoNetwork& network, const drivers::LcmReception& reception,
            std::string& error) {
    for (std::unique_ptr<drivers::LcmProvider>& lcm : all_) {
      lcm = drivers::open_lcm(network.url, reception, error);
      if (!lcm) return false;
      if (network.in_process) break;
    }
    return true;
  }
  drivers::LcmProvider& building() { return *all_[0]; }
  drivers::LcmProvider& estimator() { return all_[1] ? *all_[1] : building(); }
  drivers::LcmProvider& view() { return all_[2] ? *all_[2] : building(); }
  drivers::LcmProvider& page() { return all_[3] ? *all_[3] : building(); }

 private:
  std::unique_ptr<drivers::LcmProvider> all_[4];
};

void introduce(const DemoBuilding& building, const DemoNetwork& network, double seconds,
               const std::string& page) {
  const Scenario& s = building.scenario;
  fmt::print("{}: {} accelerometers, a truth the estimator does not know, shaken for {:g} s.\n",
             s.config.pipeline.structure.name, s.config.pipeline.axes.size(), seconds);
  fmt::print("{}.\n", network.explanation);
  for (const drivers::CanBusMap& bus : s.config.can.buses)
    fmt::print("Samples come as frames of {} CANopen nodes on {}, estimates over LCM.\n",
               s.config.can.nodes.size(), bus.interface);
  if (!network.in_process) fmt::print("Listen with LCM_DEFAULT_URL='{}'.\n", network.url);
  if (!page.empty()) fmt::print("\n  Open {}\n\n", page);
  if (seconds > kDropAt_s)
    fmt::print("At {:g} s {} loses {:g} % of its stiffness: watch where it shows.\n", kDropAt_s,
               element_words(building.loses), 100 * building.loss_ratio);
  std::fflush(stdout);
}

/// The parties of the demo, each served in turn by one thread.
struct DemoLoop {
  const Scenario& scenario;
  double forgotten_s;  ///< time after the loss
  double seconds;
  SimulationOutput& sensors;
  drivers::LcmSource& source;
  drivers::CanSource& can;
  drivers::LcmSource& page_source;
  drivers::LcmSource& view_source;
  LiveView& live;
  WebServer& server;
  DemoView& view;

  /// Shakes the building in real time. Prints the error and returns false if a party failed.
  bool shake() {
    Simulation simulation(scenario);
    double next_flush_s = 0;
    bool changed = false;
    for (std::int64_t left = instants(scenario); left > 0; --left) {
      const std::vector<double>& raw = simulation.next();
      if (!sensors.put(simulation.time_s(), raw)) {
        fmt::print(stderr, "framewatch demo: {}\n", sensors.error());
        return false;
      }
      // All messages of this instant are sent; the next instant follows when it is due.
      if (!source.handle(1)) {
        fmt::print(stderr, "framewatch demo: LCM failed\n");
        return false;
      }
      can.handle(steady_clock_us());
      (void)view_source.handle(0);
      if (!page_source.handle(0))
        fmt::print(stderr, "framewatch demo: the page gets no messages\n");
      if (simulation.time_s() >= next_flush_s) {
        next_flush_s += kFlush_s;
        live.flush();
        server.wake();
      }
      if (!changed && simulation.time_s() > kDropAt_s + forgotten_s) {
        changed = true;
        view.set_truth(truth_of(scenario, scenario.changes.front().theta));
      }
      view.update(simulation.time_s(), seconds);
    }
    return true;
  }

  /// Waits for the last messages, which can be late on a busy machine.
  void receive_rest(const Estimation& estimation) {
    for (std::int64_t seen = -1; seen != estimation.intake().counters().messages;) {
      seen = estimation.intake().counters().messages;
      if (!source.handle(300)) break;
      can.handle(steady_clock_us());
      (void)view_source.handle(0);
    }
  }
};

}  // namespace

int demo(const DemoArguments& a) {
  DemoBuilding building = demo_building(a.building);
  Scenario& scenario = building.scenario;
  if (!a.can.empty()) put_on_can(scenario.config, a.can);
  scenario.duration_s = a.seconds;
  scenario.changes.push_back({kDropAt_s, after_loss(building)});
  // Start the page before the private network, so that browsers outside reach it.
  std::string no_page;
  int socket = listen_on("127.0.0.1", a.port, no_page);
  if (socket < 0) socket = listen_on("127.0.0.1", 0, no_page);
  const DemoNetwork network = open_demo_network(demo_port());
  const LcmSettings& settings = scenario.config.lcm;
  DemoBus bus;
  std::string error;
  if (!bus.open(network, settings.reception, error)) {
    fmt::print(stderr, "framewatch demo: {}\n", error);
    return 2;
  }
  DemoLogs logs(a.report);
  WebSettings web;
  web.token = random_token();
  LiveView live(
      scenario.config,
      [&](std::int64_t, const std::string& channel, const std::vector<std::uint8_t>& bytes) {
        bus.page().publish(channel, bytes.data(), static_cast<unsigned>(bytes.size()));
      },
      [](const std::string&, const CommandPacket&) -> CommandAnswer {
        return {true, "the demo has no daemon to tell", {}};
      });
  WebServer server(web, live);
  // The page draws LCM samples. With --can it would stay empty.
  const bool served = a.can.empty() && socket >= 0 && server.start(socket, no_page);
  if (!served && a.can.empty()) fmt::print(stderr, "framewatch demo: no page: {}\n", no_page);
  if (!a.quiet)
    introduce(building, network, a.seconds,
              served ? page_address(web, server.port(), web.token) : std::string());

  const auto sensors =
      a.can.empty() ? live_output(scenario, bus.building(), 1) : can_output(scenario, "", 1, error);
  if (!sensors) {
    fmt::print(stderr, "framewatch demo: {}\n", error);
    return 2;
  }
  Estimation estimation(scenario.config, [&](std::int64_t time_us, const std::string& channel,
                                             const std::vector<std::uint8_t>& bytes) {
    logs.estimate(time_us, channel, bytes);
    bus.estimator().publish(channel, bytes.data(), static_cast<unsigned>(bytes.size()));
  });
  drivers::CanSource can(
      scenario.config.can, false,
      [&](int index, const drivers::CanFrame& frame) { estimation.frame(index, frame); });
  for (const std::string& note : can.open()) fmt::print(stderr, "framewatch demo: {}\n", note);
  std::vector<std::string> inputs;
  for (const drivers::AxisAddress& at : addresses(scenario.config.sources))
    if (std::find(inputs.begin(), inputs.end(), at.lcm_channel) == inputs.end())
      inputs.push_back(at.lcm_channel);
  drivers::LcmSource source(
      bus.estimator(), inputs, settings.queue_capacity, [&](const drivers::LcmMessage& m) {
        logs.raw(m);
        estimation.message(m.channel, m.data, m.size, m.sender, m.received_us);
      });
  drivers::LcmSource page_source(bus.page(), live.channels(), settings.queue_capacity,
                                 [&](const drivers::LcmMessage& m) {
                                   live.message(m.channel, m.data, m.size, m.sender, m.received_us);
                                 });
  DemoView view(truth_of(scenario, scenario.truth), ::isatty(STDOUT_FILENO) == 1, a.quiet);
  drivers::LcmSource view_source(bus.view(), DemoView::channels(settings.prefix),
                                 settings.queue_capacity,
                                 [&](const drivers::LcmMessage& m) { view.message(m); });

  DemoLoop loop{scenario,    building.forgotten_s, a.seconds, *sensors, source, can,
                page_source, view_source,          live,      server,   view};
  if (!loop.shake()) return 2;
  loop.receive_rest(estimation);
  estimation.finish();
  (void)view_source.handle(200);
  logs.write_report(building);
  return view.finish();
}

}  // namespace framewatch::daemon
