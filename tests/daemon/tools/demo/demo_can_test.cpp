// SPDX-License-Identifier: MIT
#include "daemon/tools/demo/demo_scenario.h"

#include <set>

#include <gtest/gtest.h>

#include "drivers/can/can_intake.h"
#include "tests/support/can_traffic.h"

namespace framewatch::daemon {
namespace demo_can_test {

constexpr double kQuantum_mps2 = 1e-5;

TEST(DemoCan, EveryAccelerometerIsASendingNode) {
  Config config = demo_scenario().config;
  put_on_can(config, "vcan0");
  ASSERT_EQ(config.can.nodes.size(), config.pipeline.axes.size());
  constexpr int kInstants = 500;
  std::set<int> axes;
  std::size_t count = 0;
  drivers::CanIntake intake(
      config.can, [&](const estimator::AccelSample&) { ++count; },
      [&](const drivers::CanIntake::Decoded& d) {
        axes.insert(d.axis);
        EXPECT_NEAR(
            d.value,
            test::can_wave(static_cast<std::size_t>(d.axis), 0.01 * static_cast<double>(d.number)),
            kQuantum_mps2);
      });
  for (const drivers::BusFrame& f : test::can_traffic(config, kInstants))
    intake.frame(f.bus, f.frame);
  intake.finish();
  EXPECT_EQ(axes.size(), config.pipeline.axes.size());
  EXPECT_EQ(count, kInstants * config.pipeline.axes.size());
}

}  // namespace demo_can_test
}  // namespace framewatch::daemon
