#include "daemon/run_command.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <future>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "daemon/baseline_keeper.h"
#include "daemon/can_complaints.h"
#include "daemon/can_monitor.h"
#include "daemon/clocks.h"
#include "daemon/gap_keeper.h"
#include "daemon/log.h"
#include "daemon/state_file.h"
#include "daemon/stop_signal.h"

namespace framewatch::daemon {
namespace {

constexpr int kBadInput = 2;
constexpr int kPoll_ms = 100;
constexpr std::int64_t kReport_us = 1'000'000;

std::vector<std::string> channels_of(const Config& config) {
  std::vector<std::string> channels = drivers::ChannelBinding(wanted_axes(config)).streams();
  for (std::size_t i = 0, streams = channels.size(); i < streams; ++i)
    channels.push_back(channels[i] + "_CHANNELS");
  return channels;
}

/// Says once a second at most what went wrong since it last said so.
class Complaints {
 public:
  void look(const Estimation& estimation, const LiveState& state, std::int64_t now_us) {
    if (now_us < next_us_) return;
    next_us_ = now_us + kReport_us;
    const PipelineCounters pipeline = estimation.pipeline().counters();
    const drivers::IntakeCounters& intake = estimation.intake().counters();
    std::int64_t late = 0, rejected = 0;
    for (const AxisCounters& axis : pipeline.axes) {
      late += axis.late;
      rejected += axis.rejected;
    }
    std::string news;
    add(news, seen_[0], intake.malformed, "undecodable messages");
    add(news, seen_[1], intake.duplicate, "duplicate messages");
    add(news, seen_[2], estimation.intake().lost(), "messages lost");
    add(news, seen_[3], state.queue_dropped, "of them dropped by the full queue");
    add(news, seen_[4], late, "samples late");
    add(news, seen_[5], rejected, "samples rejected");
    add(news, seen_[6], estimation.intake().backwards(), "steps back in time");
    add(news, seen_[7], pipeline.gaps, "gaps that restarted the window");
    if (!news.empty()) log(LogLevel::warning, news);
    for (const std::string& name : estimation.intake().binding().unbound())
      if (!said_unbound_) log(LogLevel::warning, fmt::format("no message carries {} yet", name));
    said_unbound_ = true;
  }

 private:
  static void add(std::string& news, std::int64_t& seen, std::int64_t now, const char* what) {
    if (now > seen) news += fmt::format("{}{} {}", news.empty() ? "" : ", ", now - seen, what);
    seen = now;
  }

  std::int64_t next_us_ = 0;
  std::int64_t seen_[8] = {};
  bool said_unbound_ = false;
};

/// Goes on from a state file that is there; one that does not fit is put aside, and said.
void resume(const std::string& path, const Config& config, lcm::LCM& lcm,
            drivers::CanLogWriter* can_log, std::optional<LiveEstimation>& live) {
  std::error_code none;
  if (!std::filesystem::exists(path, none)) return;
  bool touched = false;
  const LoadedState state = load_state(path, config, live->estimation(), touched);
  if (state.problem.empty()) {
    log(LogLevel::notice,
        fmt::format("goes on from {}: {} windows so far", path, live->estimation().windows()));
    return;
  }
  const std::string aside = path + ".refused";
  std::filesystem::rename(path, aside, none);
  log(LogLevel::warning,
      fmt::format("{}: {}; starts anew, the file is now {}", path, state.problem, aside));
  if (touched) live.emplace(config, lcm, can_log);
}

/// Writes the state from time to time, in a thread: a slow disk delays no estimate.
class StateKeeper {
 public:
  StateKeeper(const RunArguments& a, const Config& config)
      : path_(a.state), every_us_(1'000'000LL * a.state_every_s), config_(config) {}
  ~StateKeeper() {
    if (writing_.valid()) writing_.wait();
  }
  StateKeeper(const StateKeeper&) = delete;
  StateKeeper& operator=(const StateKeeper&) = delete;

  void look(Estimation& estimation, std::int64_t now_us) {
    if (path_.empty()) return;
    if (next_us_ == 0) next_us_ = now_us + every_us_;
    if (now_us < next_us_ || !written()) return;
    next_us_ = now_us + every_us_;
    writing_ = std::async(std::launch::async,
                          [path = path_, bytes = state_bytes(config_, estimation, 0)]() mutable {
                            return write_state(path, std::move(bytes));
                          });
  }
  void keep(Estimation& estimation) {
    if (writing_.valid()) report(writing_.get());
    report(write_state(path_, state_bytes(config_, estimation, 0)));
  }

 private:
  bool written() {
    if (!writing_.valid()) return true;
    if (writing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
    report(writing_.get());
    return true;
  }
  void report(const std::string& problem) {
    if (!problem.empty())
      log(LogLevel::error, fmt::format("{}: state not written: {}", path_, problem));
  }

  std::string path_;
  std::int64_t every_us_, next_us_ = 0;
  const Config& config_;
  std::future<std::string> writing_;
};

}  // namespace

LiveEstimation::LiveEstimation(const Config& config, lcm::LCM& lcm, drivers::CanLogWriter* can_log)
    : config_(config),
      lcm_(lcm),
      can_log_(can_log),
      segments_(config),
      estimation_(
          config,
          [this](std::int64_t, const std::string& channel, const std::vector<std::uint8_t>& bytes) {
            lcm_.publish(channel, bytes.data(), static_cast<unsigned>(bytes.size()));
          }),
      source_(lcm, channels_of(config), config.lcm.queue_capacity,
              [this](const std::string& channel, const void* data, std::size_t size,
                     std::int64_t received_us) { on_message(channel, data, size, received_us); }),
      can_(config.can, can_log != nullptr,
           [this](int bus, const drivers::CanFrame& frame) { on_frame(bus, frame); }) {
  if (!config.gap || config.gap->store.empty()) return;
  estimation_.tap([this](const AccelSample& sample) { segments_.sample(sample); },
                  [this](const GapNews& news) {
                    if (news.state == AlarmState::raised) segments_.raised(news.id);
                  });
}

bool LiveEstimation::poll(int timeout_ms) {
  if (config_.can.empty()) return source_.handle(timeout_ms);
  std::vector<pollfd> waiting{{lcm_.getFileno(), POLLIN, 0}};
  can_.descriptors(waiting);
  ::poll(waiting.data(), waiting.size(), timeout_ms);
  can_.handle(steady_clock_us());
  for (std::size_t b = 0; b < config_.can.buses.size(); ++b) {
    const bool gone = !can_.state(static_cast<int>(b)).open;
    estimation_.notice(
        {drivers::CanNotice::Kind::interface_gone, static_cast<int>(b), !gone, 0, host_clock_us()});
  }
  return source_.handle(0) && !can_log_failed_;
}

void LiveEstimation::on_frame(int bus, const drivers::CanFrame& frame) {
  const std::string& interface = config_.can.buses[static_cast<std::size_t>(bus)].interface;
  if (can_log_ != nullptr && !can_log_->write(frame, interface)) can_log_failed_ = true;
  const std::int64_t windows = estimation_.windows();
  estimation_.frame(bus, frame);
  const std::int64_t dropped = can_.dropped();
  state_.queue_dropped += dropped - std::exchange(can_dropped_, dropped);
  if (estimation_.windows() > windows)
    state_.latency_s = 1e-6 * static_cast<double>(host_clock_us() - frame.stamp_us);
  estimation_.set_live(state_);
}

void LiveEstimation::on_message(const std::string& channel, const void* data, std::size_t size,
                                std::int64_t received_us) {
  const std::int64_t lost = estimation_.intake().lost();
  const std::int64_t windows = estimation_.windows();
  estimation_.message(channel, data, size);
  if (source_.queue_was_full())
    state_.queue_dropped += std::max<std::int64_t>(0, estimation_.intake().lost() - lost);
  state_.queue_high_water = static_cast<std::int32_t>(source_.backlog_high_water());
  if (estimation_.windows() > windows)
    state_.latency_s = 1e-6 * static_cast<double>(host_clock_us() - received_us);
  estimation_.set_live(state_);
}

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
  if (!a.state.empty()) resume(a.state, *config, *lcm, recorder, estimation);
  LiveEstimation& live = *estimation;
  for (const std::string& note : live.open_buses()) log(LogLevel::warning, note);
  StateKeeper keeper(a, *config);
  Complaints complaints;
  CanComplaints can_complaints(*config);
  CanMonitor can_monitor(*config);
  BaselineKeeper baseline(*config);
  GapKeeper gap(*config);
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
  }
  // With a state the instants still open are given out by the next start.
  if (a.state.empty())
    live.finish();
  else
    keeper.keep(live.estimation());
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
