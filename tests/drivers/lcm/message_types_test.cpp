// SPDX-License-Identifier: MIT
#include "drivers/lcm/message_check.h"

#include <set>
#include <type_traits>

#include <gtest/gtest.h>

#include <framewatch/accel_t.hpp>
#include <framewatch/message_layouts.hpp>

#include "drivers/files/encoded.h"
#include "drivers/lcm/accel_codec.h"
#include "drivers/lcm/lcm_log.h"
#include "tests/drivers/lcm/example_messages.h"

namespace framewatch::drivers {
namespace message_types_test {

// Logs of the first release must stay readable: a message with new fields is a new type, and this
// number never changes.
constexpr std::uint64_t kAccelFingerprint = 0xecb49719e8cabe05;

const std::string kFirstLog = FRAMEWATCH_SOURCE_DIR "/tests/golden/every_type.lcmlog";

TEST(Schema, ReadsEveryExampleFromALogOfTheFirstRelease) {
  LcmLogReader reader;
  ASSERT_TRUE(reader.open(kFirstLog)) << reader.error();
  LogEvent event;
  std::int64_t timestamp_us = 0;
  examples::for_each([&](const char* lcm_channel, const auto& message) {
    ASSERT_EQ(reader.next(event), LogRead::event) << lcm_channel;
    EXPECT_EQ(event.channel, lcm_channel);
    EXPECT_EQ(event.timestamp_us, timestamp_us);
    EXPECT_EQ(event.data, encoded(message)) << lcm_channel;
    EXPECT_STREQ(known_type(*fingerprint(event.data)), type_of_lcm_channel(event.channel));
    timestamp_us += 1000;
  });
  EXPECT_EQ(reader.next(event), LogRead::end);
}

TEST(Schema, EveryMessageDecodesToWhatWasEncoded) {
  examples::for_each([](const char* lcm_channel, const auto& message) {
    const std::vector<std::uint8_t> bytes = encoded(message);
    const auto again = decoded<std::decay_t<decltype(message)>>(bytes);
    ASSERT_TRUE(again) << lcm_channel;
    EXPECT_EQ(encoded(*again), bytes) << lcm_channel;
  });
}

TEST(Schema, NoMessageDecodesFromAnotherSize) {
  examples::for_each([](const char* lcm_channel, const auto& message) {
    using Type = std::decay_t<decltype(message)>;
    const std::vector<std::uint8_t> bytes = encoded(message);
    for (std::size_t size = 0; size < bytes.size(); ++size)
      EXPECT_FALSE(decoded<Type>(std::span(bytes).first(size))) << lcm_channel << " " << size;
    std::vector<std::uint8_t> longer = bytes;
    longer.push_back(0);
    EXPECT_FALSE(decoded<Type>(longer)) << lcm_channel;
  });
}

TEST(Schema, EveryLayoutHasAnExample) {
  std::set<std::int64_t> seen;
  examples::for_each([&](const char*, const auto& message) { seen.insert(message.getHash()); });
  for (const MessageLayout& layout : kMessageLayouts)
    EXPECT_TRUE(seen.contains(layout.fingerprint())) << layout.type;
  EXPECT_EQ(seen.size(), std::size(kMessageLayouts));
}

TEST(Schema, ReadsAccelerationsInPlace) {
  const std::vector<std::uint8_t> bytes = encoded(examples::accel());
  const auto sample = decode_accel(bytes.data(), bytes.size());
  ASSERT_TRUE(sample);
  EXPECT_EQ(to_microseconds(sample->time), examples::accel().time_us);
  EXPECT_EQ(sample->sequence, 77);
  EXPECT_EQ(sample->node, 3);
  EXPECT_EQ(sample->accel_abs_mps2, (std::array{0.125, -9.75, 1e-9}));
  EXPECT_EQ(accel_time_us(bytes.data(), bytes.size()), examples::accel().time_us);
}

TEST(Schema, ChannelTablesGiveTheirEntries) {
  const std::vector<std::uint8_t> bytes = encoded(examples::channel_table());
  const auto table = decode_channel_table(bytes.data(), bytes.size());
  ASSERT_TRUE(table);
  EXPECT_EQ(table->entries[1], (ChannelTable::Entry{"F1-Y1", 2, 1}));
}

TEST(Schema, KeepsTheFingerprintsOfTheFirstRelease) {
  EXPECT_EQ(static_cast<std::uint64_t>(accel_t::getHash()), kAccelFingerprint);
}

TEST(Schema, NamesTheActualTypeOfAWrongPayload) {
  const auto bytes = encoded(examples::accel());
  EXPECT_EQ(why_not("window_estimate_t", bytes), "accel_t where window_estimate_t belongs");
  auto longer = encoded(examples::window_estimate());
  longer.push_back(0);
  EXPECT_NE(why_not("window_estimate_t", longer).find("its lengths do not fit"), std::string::npos);
  EXPECT_EQ(why_not("accel_t", std::vector<std::uint8_t>(3)), "3 bytes are too few for accel_t");
}

TEST(Schema, NamesANewerType) {
  auto bytes = encoded(examples::window_estimate());
  bytes[0] ^= 0x40;
  const std::string why = why_not("window_estimate_t", bytes);
  EXPECT_NE(why.find("not the window_estimate_t of framewatch "), std::string::npos) << why;
  EXPECT_NE(why.find("a newer framewatch wrote them"), std::string::npos) << why;
  EXPECT_EQ(known_type(*fingerprint(bytes)), nullptr);
}

TEST(Schema, FindsATypeByItsChannel) {
  EXPECT_STREQ(type_of_lcm_channel("ACCEL_ROOF"), "accel_t");
  EXPECT_STREQ(type_of_lcm_channel("ROOF_CHANNELS"), "channel_table_t");
  EXPECT_STREQ(type_of_lcm_channel("FRAMEWATCH_ESTIMATE_2.5S"), "window_estimate_t");
  EXPECT_STREQ(type_of_lcm_channel("B7_STATUS", "B7_"), "status_t");
  EXPECT_STREQ(type_of_lcm_channel("B7_CHANNELS", "B7_"), "channel_table_t");
  EXPECT_EQ(type_of_lcm_channel("FRAMEWATCH_STATUS", "B7_"), nullptr);
  EXPECT_EQ(type_of_lcm_channel("FRAMEWATCH_STATUS_2"), nullptr);
  EXPECT_EQ(type_of_lcm_channel("_CHANNELS"), nullptr);
  EXPECT_EQ(type_of_lcm_channel("CAMERA"), nullptr);
}

}  // namespace message_types_test
}  // namespace framewatch::drivers
