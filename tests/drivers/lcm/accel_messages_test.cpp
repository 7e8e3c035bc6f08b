// SPDX-License-Identifier: MIT
#include "drivers/lcm/accel_codec.h"

#include <chrono>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <framewatch/channel_table_t.hpp>

namespace framewatch::drivers {
namespace accel_messages_test {

constexpr double kLost = std::numeric_limits<double>::quiet_NaN();

AccelMessages three_channels() {
  return {{"a", "b", "c"}, {{"ACCEL", 4, 0}, {"ACCEL", 4, 2}, {"ROOF", 1, 1}}, 100};
}

TEST(AccelMessages, PutsEveryValueOnItsNodeAndAxis) {
  AccelMessages messages = three_channels();
  const auto sent = messages.samples(1500, {1.5, -2.5, 3.5});
  ASSERT_EQ(sent.size(), 2u);
  EXPECT_EQ(sent[0].channel, "ACCEL");
  EXPECT_EQ(sent[1].channel, "ROOF");
  const auto first = decode_accel(sent[0].bytes.data(), sent[0].bytes.size());
  const auto second = decode_accel(sent[1].bytes.data(), sent[1].bytes.size());
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->node, 4);
  EXPECT_EQ(to_microseconds(first->time), 1500);
  EXPECT_EQ(first->accel_abs_mps2[0], 1.5);
  EXPECT_TRUE(std::isnan(first->accel_abs_mps2[1]));
  EXPECT_EQ(first->accel_abs_mps2[2], -2.5);
  EXPECT_EQ(second->accel_abs_mps2[1], 3.5);
}

TEST(AccelMessages, SkipsASequenceNumberForALoss) {
  AccelMessages messages = three_channels();
  EXPECT_EQ(messages.samples(0, {1, 1, 1}).size(), 2u);
  EXPECT_EQ(messages.samples(10, {1, kLost, kLost}).size(), 1u);
  const auto sent = messages.samples(20, {1, 1, 1});
  ASSERT_EQ(sent.size(), 2u);
  EXPECT_EQ(decode_accel(sent[0].bytes.data(), sent[0].bytes.size())->sequence, 2);
  EXPECT_EQ(decode_accel(sent[1].bytes.data(), sent[1].bytes.size())->sequence, 2);
}

TEST(AccelMessages, TheTableNamesTheChannels) {
  const auto tables = three_channels().tables(7);
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_EQ(tables[0].channel, "ACCEL_CHANNELS");
  channel_table_t table{};
  ASSERT_GT(table.decode(tables[0].bytes.data(), 0, static_cast<int>(tables[0].bytes.size())), 0);
  EXPECT_EQ(table.name, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(table.node, (std::vector<std::int32_t>{4, 4}));
  EXPECT_EQ(table.axis, (std::vector<std::int32_t>{0, 2}));
  EXPECT_EQ(table.rate_hz, 100);
  EXPECT_EQ(table.time_us, 7);
}

TEST(AccelMessages, ManyChannelsTakeSeconds) {
  constexpr std::int32_t kMany = 200'000;
  std::vector<AxisAddress> addresses;
  for (std::int32_t i = 0; i < kMany; ++i) addresses.push_back({"ACCEL", i, 0});
  const auto start = std::chrono::steady_clock::now();
  AccelMessages messages(std::vector<std::string>(kMany, "a"), addresses, 100);
  EXPECT_EQ(messages.samples(0, std::vector<double>(kMany, 1.0)).size(), std::size_t{kMany});
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_LT(took.count(), 30);  // measured 0.5 s in Debug; a search among all nodes took longer
}

}  // namespace accel_messages_test
}  // namespace framewatch::drivers
