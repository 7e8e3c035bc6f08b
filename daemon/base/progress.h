// SPDX-License-Identifier: MIT
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

/// Returns "8 s left", "4 min left" or "2 h 10 min left".
std::string time_left_text(double seconds);

/// A progress line on stderr: the current step, the share done and the time left. A separate thread
/// draws it twice a second if stderr is a terminal and the work takes over 2 s. The destructor
/// removes it.
class ProgressLine {
 public:
  ProgressLine(std::string command, bool quiet);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  bool is_on() const { return drawing_.joinable(); }
  /// Sets the current step and the share of the work that is done, 0..1. With share 0, the time
  /// left is unknown and not shown.
  void operator()(const std::string& what, double share);
  /// Calls `share` from the drawing thread whenever it draws the line.
  void follow(const std::string& what, std::function<double()> share);
  /// Shows how much of these files this process has read, if it reads each `times` times. Shows no
  /// time left for zstd files, whose content has an unknown size.
  void follow_reading(const std::string& what, const std::vector<std::string>& paths, int times);
  /// Starts a new part: later shares and times refer to it.
  void part_begins();
  double elapsed_s() const;  ///< since the part began

 private:
  using Clock = std::chrono::steady_clock;
  void draw(const std::stop_token& stop);
  std::string text() const;

  std::string command_;
  mutable std::mutex mutex_;  ///< guards the members below
  std::condition_variable_any wake_;
  std::string what_;
  double share_ = 0;
  std::function<double()> followed_;
  Clock::time_point start_ = Clock::now();
  bool shown_ = false;
  std::jthread drawing_;
};

/// Shows percent, rate and time left of counted work.
class Progress {
 public:
  /// `rate_unit`: unit of `done / scale`; the line shows it per second.
  Progress(std::string command, std::int64_t total, std::string rate_unit, double scale, bool quiet)
      : line_(std::move(command), quiet),
        rate_unit_(std::move(rate_unit)),
        total_(total),
        scale_(scale) {}

  /// Call it for every event; it is cheap.
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
