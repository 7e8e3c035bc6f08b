// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/config/config.h"
#include "drivers/can/can_encoder.h"

namespace framewatch::test {

constexpr std::int64_t kTrafficStart_us = 1'700'000'000'000'000;

/// Returns `configs/can/NAME.toml`.
inline daemon::Config can_example(const std::string& name) {
  std::vector<daemon::ConfigProblem> problems;
  const auto config =
      daemon::load_config(FRAMEWATCH_SOURCE_DIR "/configs/can/" + name + ".toml", problems);
  for (const auto& p : problems) ADD_FAILURE() << p.where << ": " << p.message;
  return config.value_or(daemon::Config{});
}

/// Returns a motion of 2.5 Hz, with a different phase for each axis.
inline double can_wave(std::size_t axis, double t_s) {
  return std::sin(2 * M_PI * 2.5 * t_s + 0.4 * static_cast<double>(axis));
}

/// Returns a building's stamped frames: instants at the configured rate, frames of a bus one after
/// the other.
inline std::vector<drivers::BusFrame> can_traffic(const daemon::Config& config, int instants,
                                                  double unit = 1) {
  drivers::CanEncoder encoder(config.can);
  std::vector<drivers::BusFrame> out;
  const double period_us = 1e6 / config.pipeline.options.rate_hz;
  for (int k = 0; k < instants; ++k) {
    std::vector<double> values;
    for (std::size_t a = 0; a < config.pipeline.axes.size(); ++a)
      values.push_back(can_wave(a, 1e-6 * period_us * k) / unit);
    std::map<int, int> on_bus;
    for (drivers::BusFrame& f : encoder.instant(values)) {
      f.frame.stamp_us =
          kTrafficStart_us + std::llround(period_us * k) + 135 + 270 * on_bus[f.bus]++;
      out.push_back(f);
    }
  }
  return out;
}

}  // namespace framewatch::test
