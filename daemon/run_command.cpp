#include "daemon/run_command.h"

#include <unistd.h>

#include <filesystem>
#include <optional>
#include <vector>

#include <fmt/core.h>

#include "daemon/acknowledge_desk.h"
#include "daemon/action_report.h"
#include "daemon/baseline_keeper.h"
#include "daemon/can_complaints.h"
#include "daemon/can_monitor.h"
#include "daemon/clocks.h"
#include "daemon/config_problems.h"
#include "daemon/exit_code.h"
#include "daemon/file_digest.h"
#include "daemon/gap_keeper.h"
#include "daemon/history_report.h"
#include "daemon/intake_complaints.h"
#include "daemon/log.h"
#include "daemon/patient_lcm.h"
#include "daemon/progress_watch.h"
#include "daemon/reload_signal.h"
#include "daemon/reloader.h"
#include "daemon/service_manager.h"
#include "daemon/service_report.h"
#include "daemon/start_count.h"
#include "daemon/state_file.h"
#include "daemon/state_keeper.h"
#include "daemon/stop_signal.h"
#include "drivers/encoded.h"

namespace framewatch::daemon {
namespace {

constexpr int kPoll_ms = 100;
constexpr std::int64_t kSilent_s = 2;

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

/// What `systemctl status` shows.
std::string status_line(const LiveEstimation& live, const Config& config, std::int64_t now_us) {
  const LiveTimes& times = live.times();
  const std::size_t raised = live.estimation().raised().all().size();
  const std::string events = raised > 0 ? fmt::format("{} events raised; ", raised) : "";
  if (times.received_us == 0) return events + "waits for the first sample";
  const std::int64_t silent_s = (now_us - times.received_us) / 1'000'000;
  if (silent_s > kSilent_s) return fmt::format("{}no samples for {} s", events, silent_s);
  return fmt::format("{}estimates {} from {} channels, {} windows so far", events,
                     config.pipeline.structure.name, config.pipeline.axes.size(),
                     live.estimation().windows());
}

/// Everything beside the estimation that is to be looked after while it runs.
class Watchman {
 public:
  Watchman(const RunArguments& a, const Config& config, const std::string& text,
           const StartCount& starts, bool resumed)
      : state_(a.state, a.state_every_s, config),
        can_complaints_(config),
        can_monitor_(config),
        baseline_(config),
        gap_(config),
        reloader_(config, text),
        report_(config, starts, resumed),
        config_(config) {}

  void look(LiveEstimation& live, lcm::LCM& lcm, ServiceManager& manager) {
    const std::int64_t now_us = host_clock_us();
    Estimation& estimation = live.estimation();
    complaints_.look(estimation, live.state(), now_us);
    for (const std::string& news : can_complaints_.look(estimation.can(), live.can(), now_us))
      log(LogLevel::warning, news);
    if (const auto buses = can_monitor_.look(estimation.can(), live.can(), now_us))
      lcm.publish(config_.lcm.prefix + "CAN", &*buses);
    state_.look(estimation, now_us);
    baseline_.look(estimation);
    gap_.look(estimation, now_us);
    if (const auto report = report_.look(live, state_, reloader_.count(), now_us)) {
      lcm.publish(config_.lcm.prefix + "SERVICE", &*report);
      manager.status(status_line(live, config_, now_us));
    }
    const std::int64_t steady_us = steady_clock_us();
    if (progress_.well(estimation.pipeline().counters(), steady_us)) manager.alive(steady_us);
  }

  void reload(LiveEstimation& live, Config& config, ServiceManager& manager) {
    manager.reloading();
    if (const auto fresh = reloader_.read()) {
      live.reconfigure(config, fresh->config, fresh->reach);
      baseline_ = BaselineKeeper(config);
      state_.soon();
    }
    manager.ready();
  }

  void keep(Estimation& estimation) { state_.keep(estimation); }

 private:
  StateKeeper state_;
  IntakeComplaints complaints_;
  CanComplaints can_complaints_;
  CanMonitor can_monitor_;
  BaselineKeeper baseline_;
  GapKeeper gap_;
  Reloader reloader_;
  ServiceReport report_;
  ProgressWatch progress_;
  const Config& config_;
};

}  // namespace

int run(const RunArguments& a) {
  std::vector<ConfigProblem> problems;
  std::string error;
  const std::optional<std::string> text = read_text_file(a.config, error);
  if (!text) problems.push_back({a.config, error});
  std::optional<Config> config;
  if (text) config = parse_config(a.config, *text, problems);
  print_problems(problems);
  if (!config) return kBadInput;

  catch_stop_signals();
  catch_reload_signal();
  ServiceManager manager;
  const auto lcm = open_lcm_patiently(*config, a.url, manager, error);
  if (!lcm) {
    if (stop_requested()) return 0;
    fmt::print(stderr, "framewatch run: {}\n", error);
    return kBadInput;
  }

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
  ActionReport actions(*config, *lcm);
  actions.raised_before(live.estimation().raised());
  live.tell([&](const event_t& event) {
    actions.event(event, live.estimation().raised().acknowledgement(event.id) != nullptr);
  });
  AcknowledgeDesk desk(*config, *lcm);
  const auto acknowledged = [&](const event_t& event, const Acknowledgement& by) {
    actions.acknowledged(event);
    if (history.history() != nullptr)
      history.history()->message(config->lcm.prefix + "ACKNOWLEDGED",
                                 drivers::encoded(one_acknowledged(event, by)));
  };
  for (const std::string& note : live.open_buses()) log(LogLevel::warning, note);
  Watchman watchman(a, *config, *text, starts, resumed);
  RateLimitedLog failures(LogLevel::error);
  if (!a.quiet)
    log(LogLevel::info,
        fmt::format("{} {}: {} channels on {}", config->pipeline.structure.name, config->path,
                    config->pipeline.axes.size(), a.url.empty() ? config->lcm.url : a.url));
  manager.ready();
  while (!stop_requested()) {
    if (!live.poll(kPoll_ms) && !stop_requested()) {
      failures(host_clock_us(),
               can_log.error().empty() ? "LCM failed to deliver" : "CAN log: " + can_log.error());
      ::usleep(1000 * kPoll_ms);
    }
    watchman.look(live, *lcm, manager);
    for (const event_t& event : history.look(host_clock_us()))
      actions.event(event, history.raised().acknowledgement(event.id) != nullptr);
    desk.look({&live.estimation().raised(), &history.raised()}, acknowledged, host_clock_us());
    actions.look(host_clock_us());
    if (reload_requested()) {
      watchman.reload(live, *config, manager);
      actions.reconfigure();
    }
  }
  manager.stopping();
  // With a state the instants still open are given out by the next start.
  if (a.state.empty()) {
    live.finish();
  } else {
    watchman.keep(live.estimation());
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
