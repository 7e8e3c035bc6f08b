// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/can/can_intake.h"
#include "tests/support/can_traffic.h"

namespace framewatch::drivers {

inline constexpr std::int64_t kStart_us = test::kTrafficStart_us;
inline constexpr double kWaveError_mps2 = 0.01;  ///< quantisation of the coarsest example is 0.01

using Traffic = std::vector<BusFrame>;

struct Result {
  std::map<std::pair<int, std::int64_t>, double> samples;  ///< by axis and microsecond
  std::vector<CanNodeCounters> nodes;
  std::vector<CanBusCounters> buses;
};

inline Result run(const CanMap& map, const Traffic& traffic) {
  Result out;
  CanIntake intake(map, [&](const estimator::AccelSample& s) {
    EXPECT_TRUE(out.samples.emplace(std::pair(s.axis, to_microseconds(s.time)), s.accel).second);
  });
  for (const BusFrame& f : traffic) intake.frame(f.bus, f.frame);
  intake.finish();
  for (std::size_t n = 0; n < map.nodes.size(); ++n) out.nodes.push_back(intake.node(n));
  out.buses = intake.buses();
  return out;
}

}  // namespace framewatch::drivers
