// SPDX-License-Identifier: MIT
#include "tests/soak/soak_run.h"

#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fmt/core.h>
#include <framewatch/event_t.hpp>
#include <framewatch/temperature_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/process.h"
#include "daemon/monitor/estimation/estimation.h"
#include "daemon/monitor/history/history.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/summary_query.h"
#include "drivers/files/encoded.h"
#include "drivers/lcm/accel_codec.h"
#include "drivers/lcm/message_check.h"
#include "tests/support/history_fixture.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

#ifdef __SANITIZE_ADDRESS__
extern "C" std::size_t __sanitizer_get_current_allocated_bytes();
#endif

namespace framewatch::soak {
namespace {

constexpr double kRate_hz = test::RestlessBuilding::kRate_hz;
constexpr std::int64_t kHour = 3600 * 100, kTick = 1000;  // instants
constexpr double kNoise = 2e-5;                           // m/s^2/sqrt(Hz)
constexpr double kHop_s = 1;
constexpr std::int64_t kBlockRows = 25;
constexpr double kSame = 1e-11;
constexpr std::int64_t kKept = 3000;  // instants that a second pipeline sees
constexpr double kCompared[] = {0.12, 0.32, 0.48, 0.75, 0.99};  // shares of the duration
constexpr std::int64_t kTemperature = 100 * 120;
// Delay from a rotation of the raw logs to the reading of memory. Until then a step of the clock,
// which may have caused the rotation, has been followed, and the new log's queue is still short.
constexpr std::int64_t kSettled = 30 * 100;
constexpr std::chrono::minutes kPatience{1};
constexpr std::int64_t kMaxQueued = 1 << 20;
constexpr int kReadings = 10;
constexpr std::chrono::milliseconds kBetweenReadings{100};

/// Returns the resident memory of the process. The address sanitizer keeps freed memory resident,
/// so under it this counts what is not freed.
std::int64_t bytes_in_use() {
#ifdef __SANITIZE_ADDRESS__
  return static_cast<std::int64_t>(__sanitizer_get_current_allocated_bytes());
#else
  return daemon::process_usage().resident_bytes;
#endif
}

void put(std::uint8_t* to, std::uint64_t value) {
  for (int i = 7; i >= 0; --i, value >>= 8) to[i] = static_cast<std::uint8_t>(value);
}

/// One node with one axis. Its message is changed in place.
struct Node {
  std::vector<std::uint8_t> message;
  std::int64_t sequence = 0;
  std::size_t accel_at;

  Node(int node, int axis)
      : message(drivers::encode_accel({{}, 0, node, {std::nan(""), std::nan(""), std::nan("")}})),
        accel_at(28 + 8 * static_cast<std::size_t>(axis)) {}
  void set(std::int64_t time_us, double accel) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &accel, sizeof bits);
    put(&message[8], static_cast<std::uint64_t>(time_us));
    put(&message[16], static_cast<std::uint64_t>(sequence++));
    put(&message[accel_at], bits);
  }
};

class Soak : private daemon::EstimationListener {
 public:
  explicit Soak(const SoakOptions& options)
      : options_(options),
        config_(configuration(options)),
        instants_(std::llround(options.days * 24 * static_cast<double>(kHour))),
        night_(config_.pipeline, instants_, options.seed),
        history_(std::make_unique<daemon::History>(config_)),
        estimation_(
            config_,
            [this](std::int64_t, const std::string& channel,
                   const std::vector<std::uint8_t>& bytes) { published(channel, bytes); },
            this) {
    for (const daemon::AxisSource& source : config_.sources)
      nodes_.emplace_back(source.sensor_node, source.axis);
  }

  SoakResult run() {
    const std::int64_t began_us = daemon::steady_clock_us();
    for (std::int64_t i = 0; i < instants_; ++i) step(i);
    estimation_.finish();
    result_.wall_s = 1e-6 * static_cast<double>(daemon::steady_clock_us() - began_us);
    result_.instants = instants_;
    for (const estimator::AxisCounters& axis : estimation_.pipeline().counters().axes)
      result_.samples += axis.received;
    result_.raw_dropped = history_->status().raw_dropped;
    result_.summary_dropped = history_->status().summary_dropped;
    result_.expected_windows = instants_ / std::llround(kHop_s * kRate_hz);
    history_.reset();
    look_at_history();
    return result_;
  }

 private:
  void step(std::int64_t i);
  void published(const std::string& channel, const std::vector<std::uint8_t>& bytes);
  void on_sample(const estimator::AccelSample& sample) override { history_->sample(sample); }
  void on_weather(const std::string& channel, std::int64_t time_us,
                  const std::vector<std::uint8_t>& bytes) override {
    history_->weather(channel, time_us, bytes);
  }
  void on_estimate(const estimator::WindowEstimate& e) override;
  void look_at_memory(std::int64_t time_us);
  void compare_sums(const estimator::WindowEstimate& e);
  double difference(const estimator::WindowEstimate& e, std::size_t from) const;
  void look_at_history();

  SoakOptions options_;
  daemon::Config config_;
  std::int64_t instants_;
  SoakNight night_;
  std::unique_ptr<daemon::History> history_;
  daemon::Estimation estimation_;
  std::vector<Node> nodes_;
  std::deque<std::pair<std::int64_t, std::vector<double>>> kept_;  ///< before a comparison
  std::size_t next_compared_ = 0;
  std::int64_t at_ = 0, turn_ = 0, turned_at_ = 0, phase_ = 0;
  std::optional<estimator::Time> last_end_;
  SoakResult result_;
};

void Soak::step(std::int64_t i) {
  at_ = i;
  const Instant instant = night_.next();
  if (i % kTemperature == 0) {
    const std::vector<std::uint8_t> bytes =
        drivers::encoded(temperature_t{instant.time_us, night_.degc()});
    estimation_.message("TEMPERATURE", bytes.data(), bytes.size());
  }
  if (next_compared_ < std::size(kCompared) &&
      static_cast<double>(i + 2 * kKept) >
          kCompared[next_compared_] * static_cast<double>(instants_)) {
    kept_.emplace_back(instant.time_us, *instant.accel);
    if (std::ssize(kept_) > kKept) kept_.pop_front();
  }
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    if (std::isnan((*instant.accel)[n])) continue;
    nodes_[n].set(instant.time_us, (*instant.accel)[n]);
    estimation_.message("ACCEL", nodes_[n].message.data(), nodes_[n].message.size());
  }
  if (i % kTick == 0) {
    history_->tick(daemon::steady_clock_us());
    // At the pace of a real building, no disk is this far behind.
    (void)test::comes_true([&] { return history_->status().raw_queue_bytes < kMaxQueued; },
                           kPatience);
  }
  look_at_memory(instant.time_us);
}

void Soak::look_at_memory(std::int64_t time_us) {
  const std::int64_t turn = time_us / (1'000'000 * options_.rotate_s);
  if (turn != std::exchange(turn_, turn)) turned_at_ = at_;
  if (at_ != turned_at_ + kSettled || at_ * 100 < instants_) return;
  // A thread of idle priority closes the rotated log.
  const auto open_logs = [&] {
    int count = 0;
    std::error_code none;
    for (const auto& entry :
         std::filesystem::directory_iterator(daemon::raw_folder(options_.directory), none))
      count += entry.path().extension() == ".partial" ? 1 : 0;
    return count;
  };
  (void)test::comes_true(
      [&] { return open_logs() <= 1 && history_->status().raw_queue_bytes == 0; }, kPatience);
  // The least value of a second: buffers in use by a thread are not growth.
  std::int64_t resident = INT64_MAX;
  for (int i = 0; i < kReadings; ++i) {
    std::this_thread::sleep_for(kBetweenReadings);
    ::malloc_trim(0);
    resident = std::min(resident, bytes_in_use());
  }
  result_.resident.push_back(resident);
  if (options_.looked)
    options_.looked(static_cast<double>(at_) / (24 * kHour), result_.resident.back(),
                    result_.alarms);
}

void Soak::published(const std::string& channel, const std::vector<std::uint8_t>& bytes) {
  history_->message(channel, bytes);
  if (channel.ends_with("_EVENT")) {
    const auto event = drivers::decoded<event_t>(bytes);
    if (!event || event->kind != "stiffness_change") return;
    if (event->state == 1) ++result_.alarms;
    result_.told.push_back(
        fmt::format("{:.2f} h: {}", static_cast<double>(at_) / kHour, event->message));
  }
  if (channel.find("ESTIMATE_") == std::string::npos ||
      !channel.ends_with(fmt::format("{:g}S", options_.quiet_window_s)))
    return;
  const auto estimate = drivers::decoded<window_estimate_t>(bytes);
  ++result_.long_windows;
  result_.long_values += estimate && estimate->status == 1 ? 1 : 0;
}

void Soak::on_estimate(const estimator::WindowEstimate& e) {
  ++result_.windows;
  if (last_end_) {
    const auto hop = std::chrono::duration<double>(e.end - *last_end_).count();
    if (std::abs(hop - kHop_s) > 1e-3) ++result_.breaks;
  }
  last_end_ = e.end;
  if (next_compared_ < std::size(kCompared) && std::ssize(kept_) == kKept &&
      static_cast<double>(at_) > kCompared[next_compared_] * static_cast<double>(instants_))
    compare_sums(e);
}

/// Returns the difference of this window's solution from that of a pipeline that starts at a kept
/// instant.
double Soak::difference(const estimator::WindowEstimate& e, std::size_t from) const {
  estimator::PipelineConfig config = config_.pipeline;
  config.design = estimation_.pipeline().theta0();
  config.options.self_tune = false;
  config.options.long_window_s = 0;
  config.options.hop_s = 0.01;
  double least = 1;
  const auto take = [&](const estimator::WindowEstimate& other) {
    if (other.end != e.end || other.status == estimator::WindowStatus::warming_up) return;
    double most = 0;
    for (std::size_t p = 0; p < e.solution.size(); ++p)
      most = std::max(most, std::abs(e.solution[p] / other.solution[p] - 1));
    least = most;
  };
  estimator::Pipeline pipeline(config);
  for (std::size_t i = from; i < kept_.size(); ++i)
    for (std::size_t a = 0; a < kept_[i].second.size(); ++a)
      if (!std::isnan(kept_[i].second[a]))
        estimator::each_main_window(pipeline.push({estimator::from_microseconds(kept_[i].first),
                                                   static_cast<int>(a), kept_[i].second[a]}),
                                    take);
  estimator::each_main_window(pipeline.finish(), take);
  return least;
}

void Soak::compare_sums(const estimator::WindowEstimate& e) {
  // Blocks start where a pipeline, or a newly tuned one, started: at one of several instants. The
  // last one is tried first.
  double least = 1;
  for (std::int64_t i = 0; i < kBlockRows && least > kSame; ++i) {
    const std::int64_t front = at_ + 1 - std::ssize(kept_);
    const std::int64_t from = (phase_ + i - front % kBlockRows + kBlockRows) % kBlockRows;
    least = std::min(least, difference(e, static_cast<std::size_t>(from)));
    if (least <= kSame) phase_ = (front + from) % kBlockRows;
  }
  result_.sum_error = std::max(result_.sum_error, least);
  ++result_.sums_compared;
  ++next_compared_;
  kept_.clear();
}

void Soak::look_at_history() {
  daemon::SqliteFile file;
  if (!file.open_to_read(daemon::summary_file(options_.directory))) {
    result_.history_trouble = file.error();
    return;
  }
  auto check = file.prepare("PRAGMA integrity_check");
  if (!check.row() || check.text(0) != "ok") result_.history_trouble = "integrity_check";
  daemon::SummaryQuery query;
  if (const std::string problem = query.open(options_.directory); !problem.empty()) {
    result_.history_trouble = problem;
    return;
  }
  const auto windows = [&](std::int64_t period_s) {
    std::int64_t sum = 0;
    for (const daemon::SummaryRow& row :
         query.rows(query.parameters().front().id, period_s, INT64_MIN / 2, INT64_MAX / 2))
      sum += row.windows;
    return sum;
  };
  result_.summarised_windows = windows(options_.summary_s);
  result_.hourly_windows = windows(60 * options_.summary_s);
  if (!query.problem().empty()) result_.history_trouble = query.problem();
}

}  // namespace

std::int64_t SoakResult::growth() const {
  const auto fifth = resident.begin() + static_cast<std::ptrdiff_t>((resident.size() + 4) / 5);
  if (fifth == resident.end()) return 0;
  return *std::max_element(fifth, resident.end()) - *std::max_element(resident.begin(), fifth);
}

daemon::Config configuration(const SoakOptions& o) {
  std::vector<daemon::ConfigProblem> problems;
  std::string text = test::read_file(test::table_config());
  const std::string noise = "noise_mps2_per_rthz = 5e-4";
  for (std::size_t at = 0; (at = text.find(noise, at)) != std::string::npos;)
    text.replace(at, noise.size(), fmt::format("noise_mps2_per_rthz = {}", kNoise));
  const std::string hop = "hop_s = 0.01";
  text.replace(text.find(hop), hop.size(), fmt::format("hop_s = {:.1f}", kHop_s));
  text += fmt::format(
      "\n[lcm]\nboxplot_every = 60\n[watch]\nalarms_per_year = {}\nshaking_hours_per_year = 8766\n"
      "quiet_window_s = {}\n"
      "quiet_learn_hours = {}\ntemperature_channel = \"TEMPERATURE\"\n[history]\n"
      "directory = \"{}\"\nkeep_gb = 1\nrotate_mb = 4000\ncompress = false\nrotate_s = {}\n"
      "summary_s = [{}, {}, {}]\n",
      o.alarms_per_year, o.quiet_window_s, o.quiet_learn_hours, o.directory, o.rotate_s,
      o.summary_s, 10 * o.summary_s, 60 * o.summary_s);
  auto config = daemon::parse_config("soak.toml", text, problems);
  if (!config) throw std::runtime_error(problems.front().message);
  return *config;
}

SoakResult run_soak(const SoakOptions& options) {
  return Soak(options).run();
}

}  // namespace framewatch::soak
