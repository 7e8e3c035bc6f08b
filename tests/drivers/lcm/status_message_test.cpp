// SPDX-License-Identifier: MIT
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <framewatch/event_t.hpp>
#include <framewatch/status_t.hpp>

#include "drivers/files/encoded.h"
#include "drivers/lcm/message_check.h"

namespace framewatch::drivers {
namespace status_message_test {

TEST(MessageCheck, StatusAndEventSurviveARoundTripAndRefuseTruncation) {
  status_t s{};
  s.channels = 1;
  s.name = {"a"};
  s.received = s.lost = s.late = s.repaired = s.rejected = s.stuck = s.clipped = {3};
  s.noise_mps2_per_rthz = {0.5};
  std::vector<std::uint8_t> bytes = encoded(s);
  ASSERT_TRUE(decoded<status_t>(bytes));
  EXPECT_EQ(decoded<status_t>(bytes)->noise_mps2_per_rthz[0], 0.5);
  event_t e{};
  e.place = "kx_1_y1";
  std::vector<std::uint8_t> more = encoded(e);
  ASSERT_TRUE(decoded<event_t>(more));
  EXPECT_EQ(decoded<event_t>(more)->place, "kx_1_y1");
  for (auto* all_bytes : {&bytes, &more}) all_bytes->pop_back();
  EXPECT_FALSE(decoded<status_t>(bytes));
  EXPECT_FALSE(decoded<event_t>(more));
  EXPECT_FALSE(decoded<event_t>(bytes));
}

}  // namespace status_message_test
}  // namespace framewatch::drivers
