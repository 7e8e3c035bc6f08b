// SPDX-License-Identifier: MIT
#include "drivers/can/bus_load.h"

#include <gtest/gtest.h>

namespace framewatch::drivers {
namespace bus_load_test {

TEST(BusLoad, ComputesTheLongestFrames) {
  EXPECT_EQ(worst_classical_bits(8, false), 135);
  EXPECT_EQ(worst_classical_bits(8, true), 160);
  EXPECT_EQ(worst_classical_bits(0, false), 55);
  EXPECT_NEAR(worst_frame_s(8, false, false, 500000, 0), 270e-6, 1e-12);
  EXPECT_NEAR(worst_frame_s(64, false, true, 500000, 2000000), 407e-6, 1e-6);
}

TEST(BusLoad, EighteenNodesFillHalfOfFiveHundredKilobits) {
  CanMap map;
  map.buses.push_back({});
  for (int i = 0; i < 18; ++i) {
    CanNodeMap node;
    node.timing = CanTiming::sync;
    CanMessageMap message;
    message.length = 8;
    node.messages.push_back(message);
    map.nodes.push_back(node);
  }
  const BusLoad load = bus_load(map, 0);
  EXPECT_DOUBLE_EQ(load.frames_hz, 1900);
  EXPECT_NEAR(load.share, 18 * 0.027 + 0.011, 1e-9);
  map.nodes.push_back(map.nodes.back());
  EXPECT_GT(bus_load(map, 0).share, kHighBusLoad);
}

}  // namespace bus_load_test
}  // namespace framewatch::drivers
