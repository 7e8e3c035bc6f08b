#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace framewatch::daemon {

/// Percent, rate and time left on stderr, when that is a terminal and the work takes over 2 s.
class Progress {
 public:
  /// rate_unit: what `done / scale` counts per second.
  Progress(std::string command, std::int64_t total, std::string rate_unit, double scale,
           bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// May be called for every event: it looks at the clock now and then only.
  void operator()(std::int64_t done) {
    if (on_ && ++calls_ % 128 == 0) show(done);
  }

 private:
  void show(std::int64_t done);

  std::string command_, rate_unit_;
  std::int64_t total_, calls_ = 0;
  double scale_;
  bool on_, shown_ = false;
  double next_s_ = 2;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace framewatch::daemon
