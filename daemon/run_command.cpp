#include "daemon/run_command.h"

#include <unistd.h>

#include <filesystem>
#include <optional>
#include <vector>

#include <fmt/core.h>

#include "daemon/baseline_keeper.h"
#include "daemon/can_complaints.h"
#include "daemon/can_monitor.h"
#include "daemon/clocks.h"
#include "daemon/gap_keeper.h"
#include "daemon/history_report.h"
#include "daemon/intake_complaints.h"
#include "daemon/log.h"
#include "daemon/service_report.h"
#include "daemon/start_count.h"
#include "daemon/state_file.h"
#include "daemon/state_keeper.h"
#include "daemon/stop_signal.h"

namespace framewatch::daemon {
namespace {

constexpr int kBadInput = 2;
constexpr int kPoll_ms = 100;

/// Goes on from a state file that is there; one that does not fit is put aside, and said. Whether
/// it goes on.
bool resume(const std::string& path, const Config& config, lcm::LCM& lcm,
            drivers::CanLogWriter* can_log, std::optional<LiveEstimation>& live) {
  std::error_code none;
  if (!std::filesystem::exists(path, none)) return false;
  bool touched = false;
  const LoadedState state = load_state(path, config, live->estimation(), touched);
  if (state.problem.empty()) {
    log(LogLevel::notice,
        fmt::format("goes on from {}: {} windows so far", path, live->estimation().windows()));
    return true;
  }
  const std::string aside = path + ".refused";
  std::filesystem::rename(path, aside, none);
  log(LogLevel::warning,
      fmt::format("{}: {}; starts anew, the file is now {}", path, state.problem, aside));
  if (touched) live.emplace(config, lcm, can_log);
  return false;
}

}  // namespace

int run(const RunArguments& a) {
  std::vector<ConfigProblem> problems;
  const std::optional<Config> config = load_config(a.config, problems);
  for (const ConfigProblem& p : problems) fmt::print(stderr, "{}: {}\n", p.where, p.message);
  if (!config) return kBadInput;

  const std::string& url = a.url.empty() ? config->lcm.url : a.url;
  std::string error;
  const auto lcm = drivers::open_lcm(url, config->lcm.receive_buffer_bytes, error);
  if (!lcm) {
    fmt::print(stderr, "framewatch run: {}\n", error);
    return kBadInput;
  }
  catch_stop_signals();

  drivers::CanLogWriter can_log;
  if (!a.can_log.empty() && !can_log.open(a.can_log)) {
    fmt::print(stderr, "framewatch run: {}: {}\n", a.can_log, can_log.error());
    return kBadInput;
  }
  drivers::CanLogWriter* const recorder = a.can_log.empty() ? nullptr : &can_log;
  std::optional<LiveEstimation> estimation(std::in_place, *config, *lcm, recorder);
  StartCount starts;
  bool resumed = false;
  if (!a.state.empty()) {
    starts = count_start(a.state, error);
    if (!error.empty()) log(LogLevel::error, fmt::format("starts are not counted: {}", error));
    resumed = resume(a.state, *config, *lcm, recorder, estimation);
  }
  LiveEstimation& live = *estimation;
  HistoryReport history(*config, *lcm);
  live.record_to(history.history());
  for (const std::string& note : live.open_buses()) log(LogLevel::warning, note);
  StateKeeper keeper(a.state, a.state_every_s, *config);
  IntakeComplaints complaints;
  CanComplaints can_complaints(*config);
  CanMonitor can_monitor(*config);
  BaselineKeeper baseline(*config);
  GapKeeper gap(*config);
  ServiceReport service(*config, starts, resumed);
  const ReloadCount reloads;
  RateLimitedLog failures(LogLevel::error);
  if (!a.quiet)
    log(LogLevel::info, fmt::format("{} {}: {} channels on {}", config->pipeline.structure.name,
                                    config->path, config->pipeline.axes.size(), url));
  while (!stop_requested()) {
    if (!live.poll(kPoll_ms) && !stop_requested()) {
      failures(host_clock_us(),
               can_log.error().empty() ? "LCM failed to deliver" : "CAN log: " + can_log.error());
      ::usleep(1000 * kPoll_ms);
    }
    complaints.look(live.estimation(), live.state(), host_clock_us());
    for (const std::string& news :
         can_complaints.look(live.estimation().can(), live.can(), host_clock_us()))
      log(LogLevel::warning, news);
    if (const auto buses = can_monitor.look(live.estimation().can(), live.can(), host_clock_us()))
      lcm->publish(config->lcm.prefix + "CAN", &*buses);
    keeper.look(live.estimation(), host_clock_us());
    baseline.look(live.estimation());
    gap.look(live.estimation(), host_clock_us());
    history.look(host_clock_us());
    if (const auto report = service.look(live, keeper, reloads, host_clock_us()))
      lcm->publish(config->lcm.prefix + "SERVICE", &*report);
  }
  // With a state the instants still open are given out by the next start.
  if (a.state.empty()) {
    live.finish();
  } else {
    keeper.keep(live.estimation());
    error = count_clean_stop(a.state, starts);
    if (!error.empty()) log(LogLevel::error, fmt::format("the stop is not counted: {}", error));
  }
  if (recorder != nullptr && !can_log.close()) {
    fmt::print(stderr, "framewatch run: {}: {}\n", a.can_log, can_log.error());
    return kBadInput;
  }
  if (!a.quiet) {
    const PipelineCounters counters = live.estimation().pipeline().counters();
    log(LogLevel::info,
        fmt::format("stopped: {} windows, {} gaps, {} messages lost", counters.windows,
                    counters.gaps, live.estimation().intake().lost()));
  }
  return 0;
}

}  // namespace framewatch::daemon
