// SPDX-License-Identifier: MIT
#include "daemon/page/view/event_ring.h"

#include <string>

#include <gtest/gtest.h>

namespace framewatch::daemon {
namespace event_ring_test {

std::string all(const EventRing& ring, EventRing::Cursor& cursor, std::size_t step) {
  std::string out, part(step, '\0');
  while (const std::size_t got = ring.read(cursor, part.data(), step)) out += part.substr(0, got);
  return out;
}

TEST(EventRing, EveryViewerReadsEverythingAtItsOwnPace) {
  EventRing ring(4);
  EventRing::Cursor a = ring.join("first\n\n"), b = ring.join("");
  std::string whole_a, whole_b, expected;
  for (int i = 0; i < 20; ++i) {
    ring.push("n", std::to_string(i));
    expected += "event: n\ndata: " + std::to_string(i) + "\n\n";
    whole_a += all(ring, a, 3);
    whole_b += all(ring, b, 1000);
  }
  EXPECT_EQ(whole_a, "first\n\n" + expected);
  EXPECT_EQ(whole_b, expected);
  EXPECT_EQ(a.dropped, 0u);
}

TEST(EventRing, TellsASlowViewerWhatItLost) {
  EventRing ring(4);
  EventRing::Cursor slow = ring.join("");
  ring.push("n", "0");
  char begun[5];
  ASSERT_EQ(ring.read(slow, begun, sizeof begun), sizeof begun);
  for (int i = 1; i < 100; ++i) ring.push("n", std::to_string(i));
  const std::string rest = all(ring, slow, 64);
  // The viewer gets the rest of the current event, the number of lost ones, then the newest.
  EXPECT_EQ(rest,
            ": n\ndata: 0\n\nevent: dropped\ndata: {\"events\":98}\n\nevent: n\ndata: 99\n\n");
  EXPECT_EQ(slow.dropped, 98u);
}

}  // namespace event_ring_test
}  // namespace framewatch::daemon
