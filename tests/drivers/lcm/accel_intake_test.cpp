// SPDX-License-Identifier: MIT
#include "drivers/lcm/accel_intake.h"

#include <random>

#include <gtest/gtest.h>

#include "drivers/lcm/accel_codec.h"

namespace framewatch::drivers {
namespace accel_intake_test {

using Bytes = std::vector<std::uint8_t>;

Bytes table_bytes() {
  return AccelMessages({"one", "two", "three"}, {{"ACCEL", 1, 0}, {"ACCEL", 1, 1}, {"ACCEL", 2, 0}},
                       100)
      .tables(0)
      .front()
      .bytes;
}

void put_32(Bytes& bytes, std::size_t offset, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i)
    bytes[offset + i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
}

struct Fixture {
  std::vector<estimator::AccelSample> samples;
  AccelIntake intake;
  explicit Fixture(std::vector<WantedAxis> wanted)
      : intake(std::move(wanted),
               [this](const estimator::AccelSample& s) { samples.push_back(s); }) {}

  IntakeResult send(const std::string& channel, const Bytes& bytes) {
    return intake.message(channel, bytes.data(), bytes.size());
  }
  IntakeResult send_accel(std::int64_t sequence, std::int32_t node = 1) {
    return send(
        "ACCEL",
        encode_accel(
            {estimator::from_microseconds(10000 * sequence), sequence, node, {1.0, 2.0, 3.0}}));
  }
};

TEST(ChannelTable, RoundTrips) {
  const Bytes bytes = table_bytes();
  const auto table = decode_channel_table(bytes.data(), bytes.size());
  ASSERT_TRUE(table);
  EXPECT_EQ(table->rate_hz, 100);
  ASSERT_EQ(table->entries.size(), 3u);
  EXPECT_EQ(table->entries[1], (ChannelTable::Entry{"two", 1, 1}));
}

TEST(ChannelTable, RefusesEveryHostileLengthAndEveryPrefix) {
  const Bytes good = table_bytes();
  for (std::size_t size = 0; size < good.size(); ++size)
    EXPECT_FALSE(decode_channel_table(good.data(), size)) << size;
  for (const std::size_t offset : {24u, 28u})  // number of channels; length of the first name
    for (const std::uint32_t length : {0xffffffffu, 0x7fffffffu, 20000000u, 0u, 0xfffffffbu, 2u}) {
      Bytes bytes = good;
      put_32(bytes, offset, length);
      EXPECT_FALSE(decode_channel_table(bytes.data(), bytes.size())) << offset << " " << length;
    }
  Bytes longer = good;
  longer.push_back(0);
  EXPECT_FALSE(decode_channel_table(longer.data(), longer.size()));
  Bytes foreign = good;
  foreign[0] ^= 1;
  EXPECT_FALSE(decode_channel_table(foreign.data(), foreign.size()));
}

TEST(AccelIntake, DeliversTheConfiguredAxes) {
  Fixture f({{"x1", "ACCEL", 1, 0}, {"z1", "ACCEL", 1, 2}});
  EXPECT_EQ(f.send_accel(7), IntakeResult::samples);
  ASSERT_EQ(f.samples.size(), 2u);
  EXPECT_EQ(f.samples[0].axis, 0);
  EXPECT_EQ(f.samples[0].accel, 1.0);
  EXPECT_EQ(f.samples[1].axis, 1);
  EXPECT_EQ(f.samples[1].accel, 3.0);
  EXPECT_EQ(to_microseconds(f.samples[1].time), 70000);
}

TEST(AccelIntake, CountsForeignMalformedAndDuplicate) {
  Fixture f({{"x1", "ACCEL", 1, 0}});
  EXPECT_EQ(f.send("JOINT_TEST", {1, 2, 3}), IntakeResult::foreign);
  EXPECT_EQ(f.send("VIDEO_CHANNELS", {1, 2, 3}), IntakeResult::foreign);
  EXPECT_EQ(f.send_accel(1, 9), IntakeResult::foreign);  // node 9 is not configured
  EXPECT_EQ(f.send("ACCEL", {1, 2, 3}), IntakeResult::malformed);
  Bytes wrong = encode_accel({});
  wrong[3] ^= 0x40;
  EXPECT_EQ(f.send("ACCEL", wrong), IntakeResult::malformed);
  EXPECT_EQ(f.send("ACCEL_CHANNELS", {}), IntakeResult::malformed);
  EXPECT_EQ(f.send_accel(1), IntakeResult::samples);
  EXPECT_EQ(f.send_accel(1), IntakeResult::duplicate);
  EXPECT_EQ(f.samples.size(), 1u);
  EXPECT_EQ(f.intake.counters().messages, 8);
  EXPECT_EQ(f.intake.counters().foreign, 3);
  EXPECT_EQ(f.intake.counters().malformed, 3);
  EXPECT_EQ(f.intake.counters().duplicate, 1);
}

TEST(AccelIntake, CountsLossesPerNode) {
  Fixture f({{"x1", "ACCEL", 1, 0}, {"x2", "ACCEL", 2, 0}, {"x3", "ACCEL", 3, 0}});
  for (const std::int64_t s : {1, 2, 5}) f.send_accel(s, 1);
  for (const std::int64_t s : {1, 2, 4}) f.send_accel(s, 2);
  EXPECT_EQ(f.intake.node_of(0)->counter.lost, 2);
  EXPECT_EQ(f.intake.node_of(1)->counter.lost, 1);
  EXPECT_EQ(f.intake.node_of(2), nullptr);
  EXPECT_EQ(f.intake.lost(), 3);
}

TEST(AccelIntake, CountsSamplesSentDuringARestartApartFromNetworkLoss) {
  Fixture f({{"one", "ACCEL", 1, 0}});
  for (std::int64_t i = 0; i < 10; ++i) (void)f.send_accel(i);
  f.intake.came_up();
  for (const std::int64_t i : {200, 201, 205}) (void)f.send_accel(i);
  EXPECT_EQ(f.intake.lost(), 190 + 3);
  EXPECT_EQ(f.intake.node_of(0)->counts().lost, 3);
}

TEST(AccelIntake, TableInTheStreamBindsByName) {
  Fixture f({{"three", "", -1, 0}});
  EXPECT_EQ(f.send_accel(1, 2), IntakeResult::foreign);
  EXPECT_EQ(f.send("ACCEL_CHANNELS", table_bytes()), IntakeResult::table);
  EXPECT_EQ(f.send_accel(2, 2), IntakeResult::samples);
}

TEST(AccelIntake, SurvivesAnyBytes) {
  Fixture f({{"one", "ACCEL", 1, 0}});
  std::mt19937 random(7);
  std::uniform_int_distribution<int> byte(0, 255);
  for (int trial = 0; trial < 20000; ++trial) {
    Bytes bytes = trial % 2 == 0 ? table_bytes() : encode_accel({estimator::Time{}, trial, 1, {}});
    for (int i = 0; i < 3; ++i)
      bytes[std::uniform_int_distribution<std::size_t>(8, bytes.size() - 1)(random)] =
          static_cast<std::uint8_t>(byte(random));
    f.send(trial % 2 == 0 ? "ACCEL_CHANNELS" : "ACCEL", bytes);
  }
  EXPECT_EQ(f.intake.counters().messages, 20000);
  EXPECT_GT(f.intake.counters().malformed, 0);
}

}  // namespace accel_intake_test
}  // namespace framewatch::drivers
