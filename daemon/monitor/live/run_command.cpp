// SPDX-License-Identifier: MIT
#include "daemon/monitor/live/run_command.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <future>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/exit_code.h"
#include "daemon/base/file_digest.h"
#include "daemon/base/log.h"
#include "daemon/base/signals.h"
#include "daemon/base/stop_limit.h"
#include "daemon/base/utc_time.h"
#include "daemon/config/config.h"
#include "daemon/config/sections/config_problems.h"
#include "daemon/monitor/actions/acknowledge.h"
#include "daemon/monitor/actions/action_report.h"
#include "daemon/monitor/actions/note.h"
#include "daemon/monitor/estimation/state_file.h"
#include "daemon/monitor/events/event_messages.h"
#include "daemon/monitor/history/history.h"
#include "daemon/monitor/live/housekeeping.h"
#include "daemon/monitor/live/live_intake.h"
#include "daemon/monitor/live/raw_backlog.h"
#include "daemon/monitor/service/command_socket.h"
#include "daemon/monitor/service/service_manager.h"
#include "drivers/files/encoded.h"
#include "drivers/files/input_file.h"
#include "drivers/files/partial_file.h"
#include "drivers/lcm/message_check.h"

namespace framewatch::daemon {
namespace {

/// Handles the events of `framewatch run`: passes those of the estimation and of the history to the
/// receivers of [actions], and acknowledges them on request.
class LiveEvents {
 public:
  /// All arguments must outlive this.
  LiveEvents(const Config& config, const std::string& url, lcm::LCM& lcm, LiveEstimation& live,
             HistoryReport& history)
      : config_(config),
        live_(live),
        history_(history),
        actions_(config, url, lcm),
        desk_(config, lcm,
              [this](const event_t& event, const Acknowledgement& by) { acknowledged(event, by); }),
        commands_(config, "run", [this](const CommandPacket& command, const std::string& user) {
          return obey(command, user);
        }) {
    actions_.raised_before(live_.estimation().raised());
  }

  /// Handles new events and requests. Call it several times a second.
  void poll() {
    for (const event_t& event : live_.take_events()) {
      log(event.severity >= severity::warning ? LogLevel::warning : LogLevel::notice,
          fmt::format("{} {}: {}", event.kind, event.place, event.message));
      actions_.event(event, live_.estimation().raised().acknowledgement(event.id) != nullptr);
    }
    for (const std::vector<std::uint8_t>& request : live_.take_requests())
      desk_.heard(request, host_clock_us());
    for (const event_t& event : history_.update(host_clock_us()))
      actions_.event(event, history_.raised().acknowledgement(event.id) != nullptr);
    commands_.poll(steady_clock_us());
    desk_.update(raised(), host_clock_us());
    actions_.update(host_clock_us());
  }

  /// Continues with another configuration, of which [actions] may differ.
  void reconfigure(const Config& config) { actions_.reconfigure(config); }

  /// Returns the raised events of the estimation and of the history.
  AcknowledgeDesk::Raised raised() { return {&live_.estimation().raised(), &history_.raised()}; }

 private:
  void acknowledged(const event_t& event, const Acknowledgement& by) {
    actions_.acknowledged(event);
    if (history_.history() != nullptr) (void)store(event, by);
  }

  /// Stores an acknowledgement in the history. Returns it as a message.
  std::vector<std::uint8_t> store(const event_t& event, const Acknowledgement& by) {
    acknowledged_t message{};
    message.time_us = by.time_us;
    add_acknowledged(message, event, by);
    std::vector<std::uint8_t> bytes = drivers::encoded(message);
    history_.history()->message(config_.lcm.prefix + "ACKNOWLEDGED", bytes);
    return bytes;
  }

  CommandPacket keep_note(const CommandPacket& command, const std::string& user) {
    if (history_.history() == nullptr)
      return refused("there is no [history] that could keep a note");
    const auto request = drivers::decoded<acknowledge_t>(command.bytes);
    if (!request) return refused("cannot read the note: is it from another version?");
    std::string why;
    const std::optional<Note> note = note_of(*request, user, host_clock_us(), why);
    if (!note) return refused(why);
    log(LogLevel::notice, fmt::format("{} of {} by {}: {}", note->event.kind,
                                      utc_text(note->by.time_us), note->by.who, note->by.comment));
    return {"ACKNOWLEDGED", store(note->event, note->by)};
  }

  CommandPacket obey(const CommandPacket& command, const std::string& user) {
    if (command.channel == kNoteCommand) return keep_note(command, user);
    if (command.channel != "ACKNOWLEDGE")
      return refused("framewatch run takes no other commands than acknowledge and note");
    const auto answer = desk_.obey(command.bytes, user, raised(), host_clock_us());
    if (!answer) return refused("cannot read the request: is it from another version?");
    return {"ACKNOWLEDGED", drivers::encoded(*answer)};
  }

  const Config& config_;
  LiveEstimation& live_;
  HistoryReport& history_;
  ActionReport actions_;
  AcknowledgeDesk desk_;
  CommandSocket commands_;
};

constexpr int kPoll_ms = 100;

/// Parts of a stop, and what becomes of them if the disk is too slow.
constexpr const char* kStateLeft = "the state (the next start resumes from an older one)";
constexpr const char* kHistoryLeft = "the history (the next start closes its raw log)";
constexpr const char* kNotificationsLeft = "notifications";

/// Logs which sections of a state were not loaded, why, and the consequence. Keeps a copy of the
/// file.
void log_lost(const std::string& path, const std::vector<LostSection>& lost) {
  if (lost.empty()) return;
  for (const LostSection& l : lost)
    log(LogLevel::warning,
        fmt::format("{}: section {} {}: {}", path, l.name, l.why, without_section(l.name)));
  const std::string aside = path + ".refused";
  std::error_code none;
  std::filesystem::copy_file(path, aside, std::filesystem::copy_options::overwrite_existing, none);
  log(LogLevel::notice, none ? fmt::format("cannot copy {} to {}: {}", path, aside, none.message())
                             : fmt::format("kept a copy of the file as {}", aside));
}

/// Loads every section of the state file that fits, if the file exists. Renames a file of which
/// nothing fits and logs why. Returns true if the window was resumed.
bool resume(const std::string& path, const Config& config, drivers::LcmProvider& lcm,
            drivers::CanLogWriter* can_log, std::optional<LiveEstimation>& live) {
  std::error_code none;
  if (drivers::is_absent(path)) return false;
  const auto anew = [&]() -> Estimation& {
    return live.emplace(config, lcm, can_log).estimation();
  };
  const LoadedState state = load_what_fits(path, config, live->estimation(), anew);
  if (state.problem.empty()) {
    log(LogLevel::notice,
        fmt::format("resumed from {}: {} windows so far", path, live->estimation().windows()));
    log_lost(path, state.lost);
    return std::ranges::find(state.lost, "window", &LostSection::name) == state.lost.end();
  }
  const std::string aside = path + ".refused";
  std::filesystem::rename(path, aside, none);
  log(LogLevel::warning,
      none ? fmt::format("{}: {}; started without it, and cannot rename it {}: {}", path,
                         state.problem, aside, none.message())
           : fmt::format("{}: {}; started without it and renamed it {}", path, state.problem,
                         aside));
  return false;
}

/// Returns the stored raw samples that the estimation has to get first.
RawBacklog missed_samples(const Config& config, const Estimation& estimation, bool resumed) {
  std::vector<std::string> notes;
  RawBacklog out = RawBacklog::read(config, estimation.newest_us(), resumed, notes);
  for (const std::string& note : notes)
    log(LogLevel::warning, fmt::format("stored samples: {}", note));
  if (!out.empty())
    log(LogLevel::notice, fmt::format("reading {:.1f} s of stored samples first, from {} on",
                                      out.seconds(), sensor_time_text(out.first_us())));
  return out;
}

void log_summary(const Estimation& estimation) {
  const estimator::PipelineCounters counters = estimation.pipeline().counters();
  log(LogLevel::info,
      fmt::format("stopped: {} windows, {} interruptions, {} messages lost", counters.windows,
                  counters.interruptions, estimation.intake().lost()));
}

/// Reads a configuration file and logs its doubts. Returns nullopt, with the problems printed, if
/// it is invalid; otherwise sets `text` to the contents of the file.
std::optional<Config> read_configuration(const std::string& path, std::string& text) {
  std::vector<ConfigProblem> problems;
  std::string error;
  const std::optional<std::string> contents = read_text_file(path, error);
  if (!contents) problems.push_back({path, error});
  std::optional<Config> config = contents ? parse_config(path, *contents, problems) : std::nullopt;
  print_problems(problems);
  if (!config) return std::nullopt;
  log_doubts(config->doubts);
  text = *contents;
  return config;
}

/// Publishes what is open, and writes the history and the state. Logs failures.
void end_run(const RunArguments& a, const StartCount& starts, LiveEstimation& live,
             Housekeeping& housekeeping, HistoryReport& history, LiveEvents& events,
             StopLimit& limit) {
  limit.left({kStateLeft, kHistoryLeft, kNotificationsLeft});
  // With a state file, open instants are published after the next start.
  if (a.state.empty()) {
    live.finish();
    events.poll();
  }
  live.record_to(nullptr);
  // The state is written meanwhile: each of the two may wait for a slow disk.
  const std::future<void> closing =
      std::async(std::launch::async | std::launch::deferred, [&history, &limit] {
        history.close();
        limit.done(kHistoryLeft);
      });
  if (!a.state.empty()) {
    housekeeping.write_state(live);
    const std::string error = count_clean_stop(a.state, starts);
    if (!error.empty())
      log(LogLevel::error,
          fmt::format("cannot record this stop: {}; the next start will count as unclean", error));
  }
  limit.done(kStateLeft);
  closing.wait();
}

}  // namespace

int run(const RunArguments& a) {
  std::string text, error;
  const std::optional<Config> config = read_configuration(a.config, text);
  if (!config) return kBadInput;
  if (const std::string why = nothing_to_hear(*config, a.by_name); !why.empty())
    return refuse("run", why);
  if (const std::string names = channels_without_source(*config, a.by_name); !names.empty())
    log(LogLevel::warning,
        fmt::format(
            "{}: channels without a source: {}. They get no samples unless a node names them",
            config->path, names));
  if (!a.state.empty() && !drivers::is_absent(a.state))  // a device would be renamed and replaced
    if (const std::string why = drivers::why_no_file(a.state); !why.empty())
      return refuse("run", fmt::format("{}: {}", a.state, why));

  catch_stop_signals();
  StopLimit limit(&stop_requested, std::chrono::seconds(a.stop_within_s));
  catch_reload_signal();
  ServiceManager manager;
  const auto lcm = open_lcm_with_retry(*config, a.url, manager, error);
  if (!lcm) return stop_requested() ? 0 : refuse("run", error);

  drivers::CanLogWriter can_log;
  if (const std::string kept = a.can_log.empty() ? "" : drivers::keep_cut_off(a.can_log);
      !kept.empty())
    log(LogLevel::warning,
        fmt::format("a run that was cut off left CAN frames: kept them in {}", kept));
  if (!a.can_log.empty() && !can_log.open(a.can_log))
    return refuse("run", a.can_log + ": " + can_log.error());
  drivers::CanLogWriter* const recorder = a.can_log.empty() ? nullptr : &can_log;
  std::optional<LiveEstimation> estimation(std::in_place, *config, *lcm, recorder);
  StartCount starts;
  bool resumed = false;
  if (!a.state.empty()) {
    starts = count_start(a.state, error);
    if (!error.empty()) log(LogLevel::error, fmt::format("cannot count this start: {}", error));
    resumed = resume(a.state, *config, *lcm, recorder, estimation);
  }
  LiveEstimation& live = *estimation;
  RawBacklog missed = missed_samples(*config, live.estimation(), resumed);
  HistoryReport history(*config, *lcm);
  live.record_to(history.history());
  LiveEvents events(*config, a.url, *lcm, live, history);
  live.catch_up(std::move(missed));
  for (const std::string& note : live.open_buses()) log(LogLevel::warning, note);
  live.connect_mqtt();
  Housekeeping housekeeping(*config, text, a.state, a.state_every_s, starts, resumed);
  if (!a.quiet)
    log(LogLevel::info,
        fmt::format("{} {}: {} channels on {}", config->pipeline.structure.name, config->path,
                    config->pipeline.axes.size(), a.url.empty() ? config->lcm.url : a.url));
  manager.ready();
  RateLimitedLog failures(LogLevel::error);
  while (!stop_requested()) {
    if (!live.poll(kPoll_ms) && !stop_requested()) {
      failures(host_clock_us(),
               can_log.error().empty() ? "LCM failed to deliver" : "CAN log: " + can_log.error());
      ::usleep(1000 * kPoll_ms);
    }
    housekeeping.update(live, *lcm, manager, events.raised());
    events.poll();
    if (reload_requested() && housekeeping.reload(live, manager)) events.reconfigure(live.config());
  }
  manager.stopping();
  end_run(a, starts, live, housekeeping, history, events, limit);
  if (recorder != nullptr && !can_log.close())
    return refuse("run", a.can_log + ": " + can_log.error());
  if (!a.quiet) log_summary(live.estimation());
  return 0;
}

}  // namespace framewatch::daemon
