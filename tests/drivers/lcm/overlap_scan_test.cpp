// SPDX-License-Identifier: MIT
#include "drivers/lcm/log_scan.h"

#include <cstddef>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace framewatch::drivers {
namespace overlap_scan_test {

using Stretches = std::vector<std::pair<std::int64_t, std::int64_t>>;

/// Computes the expected result by comparing all stretches.
std::int64_t by_looking(const Stretches& all, std::size_t first) {
  for (std::size_t i = first + 1; i < all.size(); ++i)
    if (all[i].second > all[first].second) return all[i].first;
  return OverlapScan::kNone;
}

std::int64_t up_to(std::mt19937& random, std::int64_t most) {
  return std::uniform_int_distribution<std::int64_t>(1, most)(random);
}

TEST(OverlapScan, FindsNoOverlapInDisjointStretches) {
  OverlapScan scan;
  EXPECT_EQ(scan.reached_over_at(), OverlapScan::kNone);
  scan.add(3, 10);
  EXPECT_EQ(scan.reached_over_at(), OverlapScan::kNone);
  scan.add(4, 10);
  EXPECT_EQ(scan.reached_over_at(), OverlapScan::kNone);
  scan.add(5, 11);
  EXPECT_EQ(scan.reached_over_at(), 5);
  scan.clear();
  EXPECT_EQ(scan.reached_over_at(), OverlapScan::kNone);
}

TEST(OverlapScan, AgreesWithAnExhaustiveSearch) {
  std::mt19937 random(20261123);
  for (int trial = 0; trial < 300; ++trial) {
    OverlapScan scan;
    Stretches all;
    std::size_t first = 0;
    for (int step = 0; step < 200; ++step) {
      if (random() % 3 == 0 && first < all.size()) {
        scan.drop_before(all[first].first + 1);
        ++first;
      } else {
        const std::int64_t start = all.empty() ? 0 : all.back().first + up_to(random, 5);
        all.emplace_back(start, start + up_to(random, 100));
        scan.add(start, all.back().second);
      }
      const std::int64_t expected =
          first < all.size() ? by_looking(all, first) : OverlapScan::kNone;
      ASSERT_EQ(scan.reached_over_at(), expected) << "trial " << trial << " step " << step;
    }
  }
}

}  // namespace overlap_scan_test
}  // namespace framewatch::drivers
