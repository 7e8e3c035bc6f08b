// SPDX-License-Identifier: MIT
#include "drivers/lcm/count_block.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <framewatch/accel_counts_t.hpp>

#include "drivers/lcm/accel_codec.h"
#include "drivers/lcm/message_check.h"
#include "estimator/numeric/nan.h"

namespace framewatch::drivers {
namespace count_block_test {

constexpr double kStep = 1e-6;

estimator::AccelSample sample(std::int64_t time_us, int axis, double accel) {
  return {estimator::from_microseconds(time_us), axis, accel};
}

TEST(CountBlock, HoldsSamplesInTheOrderAdded) {
  CountBlock block(kStep);
  block.add(sample(1'000'000, 3, 9.806651));
  block.add(sample(999'000, 0, -0.25));  // from a late node
  block.add(sample(1'010'000, 3, estimator::kNaN));
  EXPECT_EQ(block.size(), 3u);
  const auto block_read = decoded<accel_counts_t>(block.encode());
  ASSERT_TRUE(block_read);
  EXPECT_TRUE(block.empty());
  EXPECT_EQ(block_read->time_us, 1'000'000);
  EXPECT_EQ(block_read->resolution_mps2, kStep);
  EXPECT_EQ(block_read->offset_us, (std::vector<std::int32_t>{0, -1000, 10'000}));
  EXPECT_EQ(block_read->channel, (std::vector<std::int16_t>{3, 0, 3}));
  EXPECT_EQ(block_read->count, (std::vector<std::int32_t>{9'806'651, -250'000, kNoCount}));
}

TEST(CountBlock, DoesNotWrapValuesBeyondTheRange) {
  EXPECT_EQ(count_of(1e9, kStep), kMaxCount);
  EXPECT_EQ(count_of(-1e9, kStep), -kMaxCount);
  EXPECT_EQ(count_of(std::numeric_limits<double>::infinity(), kStep), kMaxCount);
  EXPECT_EQ(count_of(2147.483646, kStep), kMaxCount - 1);
  EXPECT_EQ(count_of(estimator::kNaN, kStep), kNoCount);
}

TEST(CountBlock, KeepsTheIntegersOfAConverterStep) {
  constexpr double kConverter = 3.9e-6 * 9.80665;
  for (std::int32_t count = -524288; count < 524288; count += 997)
    EXPECT_EQ(count_of(count * kConverter, kConverter), count);
}

TEST(CountBlock, RefusesATimeItCannotEncode) {
  CountBlock block(kStep);
  EXPECT_TRUE(block.takes(sample(INT64_MIN, 0, 0)));
  block.add(sample(0, 0, 0));
  EXPECT_TRUE(block.takes(sample(INT32_MAX, 0, 0)));
  EXPECT_FALSE(block.takes(sample(std::int64_t{INT32_MAX} + 1, 0, 0)));
  EXPECT_FALSE(block.takes(sample(INT64_MIN, 0, 0)));
}

TEST(CountBlock, RefusesDamagedMessages) {
  CountBlock block(kStep);
  block.add(sample(0, 0, 1));
  block.add(sample(0, 1, 1));
  const std::vector<std::uint8_t> good = block.encode();
  ASSERT_TRUE(decoded<accel_counts_t>(good));
  auto longer = good, shorter = good, many = good, foreign = good;
  longer.push_back(0);
  shorter.pop_back();
  many[24] = 0x7f;  // claims two billion samples
  foreign[0] ^= 1;
  for (const auto& bytes : {longer, shorter, many, foreign, std::vector<std::uint8_t>{}})
    EXPECT_FALSE(decoded<accel_counts_t>(bytes));
}

TEST(CountBlock, TheTableNamesTheChannels) {
  const auto bytes = count_table({"base-x", "F1-Y1"}, 100, 5);
  const auto table = decode_channel_table(bytes.data(), bytes.size());
  ASSERT_TRUE(table);
  EXPECT_EQ(table->rate_hz, 100);
  EXPECT_EQ(table->entries[1], (ChannelTable::Entry{"F1-Y1", 1, 0}));
}

}  // namespace count_block_test
}  // namespace framewatch::drivers
