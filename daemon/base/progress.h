#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace framewatch::daemon {

/// "8 s left", "4 min left", "2 h 10 min left".
std::string time_left_text(double seconds);

/// What a command is at, how much of it is done and how long the rest takes: a line on stderr,
/// drawn twice a second by a thread of its own, when that is a terminal and the work takes over
/// 2 s. It is gone when the work is done.
class ProgressLine {
 public:
  ProgressLine(std::string command, bool quiet);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  bool is_on() const { return drawing_.joinable(); }
  /// share: of the whole that is done, 0..1; 0: not known, and nothing is said of the time left.
  void operator()(const std::string& what, double share);
  /// From now on the share is asked for whenever the line is drawn, by its thread.
  void follow(const std::string& what, std::function<double()> share);
  /// How much of these files this process has read, each `times` over. A zstd file does not say how
  /// much is in it, and nothing is said of the time left.
  void follow_reading(const std::string& what, const std::vector<std::string>& paths, int times);
  /// From now on shares are of another whole, which begins now.
  void part_begins();
  double elapsed_s() const;  ///< of the part

 private:
  using Clock = std::chrono::steady_clock;
  void draw(const std::stop_token& stop);
  std::string text() const;

  std::string command_;
  mutable std::mutex mutex_;  ///< of what follows
  std::condition_variable_any wake_;
  std::string what_;
  double share_ = 0;
  std::function<double()> followed_;
  Clock::time_point start_ = Clock::now();
  bool shown_ = false;
  std::jthread drawing_;
};

/// Percent, rate and time left of work that is counted.
class Progress {
 public:
  /// rate_unit: what `done / scale` counts per second.
  Progress(std::string command, std::int64_t total, std::string rate_unit, double scale, bool quiet)
      : line_(std::move(command), quiet),
        rate_unit_(std::move(rate_unit)),
        total_(total),
        scale_(scale) {}

  /// May be called for every event.
  void operator()(std::int64_t done) {
    if (line_.is_on() && ++calls_ % 128 == 0) show(done);
  }

 private:
  void show(std::int64_t done);

  ProgressLine line_;
  std::string rate_unit_;
  std::int64_t total_, calls_ = 0;
  double scale_;
};

}  // namespace framewatch::daemon
