// SPDX-License-Identifier: MIT
#include "daemon/tools/session/record_command.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <deque>
#include <filesystem>
#include <optional>

#include <framewatch/session_status_t.hpp>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/exit_code.h"
#include "daemon/base/log.h"
#include "daemon/base/process.h"
#include "daemon/base/signals.h"
#include "daemon/config/sections/config_problems.h"
#include "daemon/monitor/live/live_intake.h"
#include "daemon/tools/session/recorder.h"
#include "daemon/tools/session/session_desk.h"
#include "daemon/tools/session/session_finish.h"
#include "drivers/files/descriptor.h"
#include "drivers/files/encoded.h"
#include "drivers/files/input_file.h"
#include "drivers/files/partial_file.h"

namespace framewatch::daemon {
namespace {

namespace fs = std::filesystem;
constexpr int kPoll_ms = 50;
constexpr std::int64_t kStatus_us = 1'000'000, kNoSamples_us = 10'000'000;

/// Returns the map without starting nodes and sending SYNC: the recorder only listens, `run` does
/// both.
drivers::CanMap listening(drivers::CanMap map) {
  for (drivers::CanBusMap& bus : map.buses) bus.send_sync = bus.nmt_start = false;
  return map;
}

/// Locks a folder so that only one recorder writes into it.
class FolderLock {
 public:
  /// Returns an empty string, or why the folder cannot be locked.
  std::string lock(const std::string& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    file_.reset(drivers::open_own_file(folder + "/.recorder", O_RDWR | O_CREAT));
    if (file_.get() < 0)
      return fmt::format("{}: cannot store sessions there: {}", folder, std::strerror(errno));
    if (::flock(file_.get(), LOCK_EX | LOCK_NB) == 0) return "";
    return fmt::format("{}: another framewatch record uses it; command that one with --send",
                       folder);
  }

 private:
  drivers::Descriptor file_;
};

class RecordCommand {
 public:
  RecordCommand(const RecordArguments& a, const Config& config, drivers::LcmProvider& lcm)
      : a_(a),
        config_(config),
        lcm_(lcm),
        recorder_(config, a.out, [this](const std::string& folder) { ended(folder); }),
        desk_(config, recorder_),
        can_map_(listening(config.can)),
        intake_(
            lcm, channels(), config.lcm.queue_capacity,
            [this](const drivers::LcmMessage& m) { message(m); }, can_map_, true,
            [this](int bus, const drivers::CanFrame& frame) { recorder_.frame(bus, frame); }) {}

  int run() {
    for (const std::string& note : intake_.open_buses()) log(LogLevel::warning, note);
    step_ = a_.standby ? Step::standby : a_.check ? Step::check : Step::begin;
    while (step_ != Step::done) {
      poll();
      desk_.poll();
      const std::int64_t now_us = host_clock_us();
      recorder_.tick(now_us);
      advance(now_us);
      poll_child();
      publish(now_us);
    }
    return exit_code_;
  }

 private:
  /// Without --standby: check, tap, begin, session, finishing, done. With it: standby until
  /// stopped.
  enum class Step { check, tap, begin, session, finishing, standby, done };

  std::vector<std::string> channels() const {
    std::vector<std::string> out = recorder_.channels();
    out.push_back(desk_.channel());
    return out;
  }

  void message(const drivers::LcmMessage& m) {
    if (m.channel == desk_.channel()) return desk_.heard(m.data, m.size, host_clock_us());
    recorder_.message(m.channel, m.data, m.size, m.received_us, m.sender);
  }

  void poll() {
    const bool good = intake_.poll(kPoll_ms);
    if (!good && config_.can.empty() && !stop_requested()) ::usleep(1000 * kPoll_ms);
  }

  void fail(const std::string& why) {
    log(LogLevel::error, why);
    exit_code_ = kFailed;
    step_ = Step::done;
  }

  void advance(std::int64_t now_us) {
    if (stop_requested() && !stopping_) return stop(now_us);
    switch (step_) {
      case Step::check:
        if (recorder_.checked()) return after_check(now_us);
        return wait_for_samples(now_us);
      case Step::tap:
        if (recorder_.state() == RecorderState::tapping && now_us < tap_until_us_) return;
        if (recorder_.state() == RecorderState::tapping) (void)recorder_.stop("", now_us);
        return judge_channels();
      case Step::begin: {
        const std::string why = recorder_.begin(a_.request, now_us);
        if (!why.empty()) return fail(why);
        step_ = Step::session;
        return;
      }
      case Step::session:
        if (recorder_.state() != RecorderState::waiting) return;
        step_ = Step::finishing;
        return;
      case Step::finishing:
        if (!child_ && to_finish_.empty()) step_ = Step::done;
        return;
      case Step::standby:
      case Step::done:
        return;
    }
  }

  /// Fails after --wait seconds without a sample, counted from the newest one.
  void wait_for_samples(std::int64_t now_us) {
    if (const double s = recorder_.checked_s(); started_us_ == 0 || s > heard_s_) {
      heard_s_ = s;
      started_us_ = now_us;
      next_word_us_ = now_us + kNoSamples_us;
    }
    if (now_us < std::min(next_word_us_, waits_until_us())) return;
    next_word_us_ = now_us + kNoSamples_us;
    if (now_us >= waits_until_us())
      return fail(fmt::format("no samples for {:g} s (--wait): nothing was recorded", a_.wait_s));
    log(LogLevel::warning,
        "no samples yet: do the sensors publish on this LCM URL? Press Ctrl-C to stop");
  }

  std::int64_t waits_until_us() const {
    return started_us_ + static_cast<std::int64_t>(1e6 * a_.wait_s);
  }

  void after_check(std::int64_t now_us) {
    if (a_.tap_s <= 0) return judge_channels();
    (void)recorder_.tap();
    tap_until_us_ = now_us + static_cast<std::int64_t>(1e6 * a_.tap_s);
    step_ = Step::tap;
  }

  void judge_channels() {
    const std::vector<ChannelResult> results = recorder_.channel_results();
    if (!a_.quiet) fmt::print("{}", channels_text(results));
    std::fflush(stdout);
    for (const ChannelResult& r : results)
      if (a_.strict && !r.problem.empty())
        return fail(fmt::format("{}: {}: nothing is recorded (--strict)", r.name, r.problem));
    step_ = Step::begin;
  }

  void stop(std::int64_t now_us) {
    stopping_ = true;
    const bool recording = recorder_.state() == RecorderState::recording;
    (void)recorder_.stop("signal", now_us);
    if (recording || step_ == Step::finishing || (step_ == Step::standby && child_)) {
      step_ = Step::session;
      return;
    }
    if (!a_.standby && !a_.quiet) log(LogLevel::notice, "nothing was recorded");
    exit_code_ = a_.standby ? 0 : kFailed;
    step_ = Step::done;
  }

  void ended(const std::string& folder) {
    if (!a_.quiet) log(LogLevel::info, fmt::format("recorded {}", folder));
    to_finish_.push_back(folder);
  }

  /// Starts and polls the process that finds stages, converts logs and writes the report. The logs
  /// are closed, so they survive whatever happens to it.
  void poll_child() {
    if (!child_ && !to_finish_.empty()) {
      finishing_ = to_finish_.front();
      to_finish_.pop_front();
      std::vector<std::string> arguments{"record", a_.config, "--finish", finishing_, "--quiet"};
      for (const auto& [wanted, option] :
           {std::pair{a_.csv, "--csv"}, std::pair{a_.mat, "--mat"}, std::pair{a_.split, "--split"},
            std::pair{!a_.report, "--no-report"}})
        if (wanted) arguments.push_back(option);
      if (!a_.reports.empty()) arguments.insert(arguments.end(), {"--reports", a_.reports});
      std::string error;
      child_ = ChildProcess::start(std::move(arguments), error);
      if (!child_) finished(kFailed, error);
    }
    if (!child_) return;
    if (const auto code = child_->ended()) {
      child_.reset();
      finished(*code, fmt::format("exit status {}", *code));
    }
  }

  void finished(int code, const std::string& how) {
    const fs::path folder(finishing_);
    std::string unread;
    const auto session = read_session_file(finishing_ + "/" + kSessionJson, unread);
    const bool page = drivers::why_no_file((folder / kReportPage).string()).empty();
    const std::string report =
        session && !session->report.empty() ? session->report : std::string();
    if (!a_.quiet && !report.empty()) fmt::print("{}\n", report);
    std::fflush(stdout);
    std::string news = "the report is ready";
    if (code != 0) {
      news = fmt::format(
          "the logs are complete, but finishing the session failed ({}); try framewatch record {} "
          "--finish {}",
          how, a_.config, finishing_);
      log(LogLevel::error, news);
      exit_code_ = kFailed;
    } else if (!a_.report) {
      news = "recorded";
    }
    if (session && session->dropped > 0) exit_code_ = kFailed;
    recorder_.finished(page ? folder.filename().string() : std::string(), news);
  }

  void publish(std::int64_t now_us) {
    const session_status_t status = recorder_.status(now_us);
    const bool changed = status.state != said_.state || status.message != said_.message ||
                         status.answered != said_.answered || status.report != said_.report;
    if (!changed && now_us < next_status_us_) return;
    if (changed && !a_.quiet) log_changes(status);
    said_ = status;
    next_status_us_ = now_us + kStatus_us;
    drivers::encode_into(bytes_, status);
    lcm_.publish(config_.lcm.prefix + "SESSION", bytes_.data(),
                 static_cast<unsigned>(bytes_.size()));
  }

  void log_changes(const session_status_t& s) const {
    if (s.answered != said_.answered && !s.refused.empty())
      log(LogLevel::warning, "refused: " + s.refused);
    if (s.state != said_.state && s.state == static_cast<int>(RecorderState::armed))
      log(LogLevel::info, fmt::format("armed: triggers {:g} m/s^2 from rest", s.trigger_mps2));
    if (s.state != said_.state && s.state == static_cast<int>(RecorderState::recording))
      log(LogLevel::info, fmt::format("recording {}/{}{}", a_.out, s.session,
                                      s.length_s > 0 ? fmt::format(" for {:g} s", s.length_s)
                                                     : "; Ctrl-C or --send stop ends it"));
    if (s.message != said_.message && !s.message.empty()) log(LogLevel::info, s.message);
  }

  const RecordArguments& a_;
  const Config& config_;
  drivers::LcmProvider& lcm_;
  Recorder recorder_;
  SessionDesk desk_;
  drivers::CanMap can_map_;
  LiveIntake intake_;
  Step step_ = Step::standby;
  int exit_code_ = 0;
  bool stopping_ = false;
  double heard_s_ = 0;
  std::int64_t started_us_ = 0, next_word_us_ = 0, tap_until_us_ = 0, next_status_us_ = 0;
  std::deque<std::string> to_finish_;
  std::string finishing_;
  std::optional<ChildProcess> child_;
  session_status_t said_{};  ///< the newest one that was published
  std::vector<std::uint8_t> bytes_;
};

}  // namespace

int record(const RecordArguments& a) {
  if (!a.finish.empty())
    return finish_session(
        {a.config, a.finish, a.reports, a.csv, a.mat, a.split, a.report, a.quiet});
  std::vector<ConfigProblem> config_problems;
  const auto config = load_config(a.config, config_problems);
  print_problems(config_problems);
  std::vector<std::string> wrong = problems(a.request);
  if (a.standby && (!a.send.empty() || a.tap_s > 0))
    wrong.push_back("--standby waits for commands: remove --send and --tap-test");
  if (!a.send.empty() && !a.url.empty())
    wrong.push_back("--send uses the recorder's socket, not LCM: remove --url");
  if (config && a.send.empty()) wrong.push_back(nothing_to_hear(*config, a.by_name));
  std::erase(wrong, "");
  for (const std::string& why : wrong) (void)refuse("record", why);
  if (!config || !wrong.empty()) return kBadInput;
  if (!a.send.empty()) return send_session_command(*config, a.send, a.request);
  std::string error;
  const auto lcm =
      drivers::open_lcm(a.url.empty() ? config->lcm.url : a.url, config->lcm.reception, error);
  if (!lcm) return refuse("record", error);
  FolderLock lock;
  error = lock.lock(a.out);
  if (!error.empty()) return refuse("record", error);
  catch_stop_signals();
  return RecordCommand(a, *config, *lcm).run();
}

}  // namespace framewatch::daemon
