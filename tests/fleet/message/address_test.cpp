// SPDX-License-Identifier: MIT
#include "fleet/message/address.h"

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace framewatch::fleet {
namespace address_test {

TEST(Key, DependsOnTheContent) {
  event_t e{};
  e.kind = "stiffness_change";
  e.id = 7;
  e.time_us = 1'700'000'000'000'001;
  e.state = 2;
  EXPECT_EQ(message_key("kobe-03", event_key(e)),
            "kobe-03/event/stiffness_change/7/1700000000000001/2");
  EXPECT_EQ(message_key("kobe-03", SummaryKey{600, -600'000'000}),
            "kobe-03/summary/600/-600000000");
  EXPECT_EQ(raw_key("kobe-03", "r17", 3), "kobe-03/raw/r17/3");
}

TEST(Key, AMalformedKindCannotImitateAnotherKey) {
  const std::string key = message_key("a", EventKey{"x/1\r\nNats-Msg-Id: y%", 2, 3, 0});
  EXPECT_EQ(key, "a/event/x%2F1%0D%0ANats-Msg-Id:%20y%25/2/3/0");
  EXPECT_NE(message_key("a", EventKey{"x", 1, 2, 0}), message_key("a", EventKey{"x/1", 2, 0, 0}));
}

TEST(Key, IsSealedBySecretAndContent) {
  const std::vector<std::uint8_t> content{1, 2, 3}, other{1, 2, 4};
  const std::string key = "kobe-03/summary/600/0", sealed = sealed_key(key, "mine", content);
  EXPECT_EQ(sealed, sealed_key(key, "mine", content));
  EXPECT_NE(sealed, sealed_key(key, "yours", content));
  EXPECT_NE(sealed, sealed_key(key, "mine", other));
  EXPECT_TRUE(sealed.starts_with(key + "~"));
  EXPECT_EQ(key_of_sealed(sealed), key);
  EXPECT_EQ(key_of_sealed(key), key);
  // A kind may have the sign itself.
  const std::string odd = message_key("a", EventKey{"x~0123456789abcdef01234567", 1, 2, 0});
  EXPECT_EQ(key_of_sealed(odd), odd);
  EXPECT_EQ(key_of_sealed(sealed_key(odd, "mine", content)), odd);
}

TEST(Key, PartsNameItsBuilding) {
  const auto parts = key_parts("kobe-03/summary/600/0");
  ASSERT_TRUE(parts);
  EXPECT_EQ(parts->building, "kobe-03");
  EXPECT_EQ(parts->kind, "summary");
  for (const char* bad :
       {"", "kobe", "kobe/", "/event/x", "kobe//x", "kobe/event", "kobe/event/", "Kobe/event/x"})
    EXPECT_FALSE(key_parts(bad)) << bad;
}

}  // namespace address_test

namespace subject_test {

TEST(Subject, NamesBuildingAndKind) {
  EXPECT_EQ(up_subject("kobe-03", "summary.600"), "fw.up.kobe-03.summary.600");
  EXPECT_EQ(down_subject("all", "minutes"), "fw.down.all.minutes");
  const auto up = up_parts("fw.up.kobe-03.summary.600");
  ASSERT_TRUE(up);
  EXPECT_EQ(up->building, "kobe-03");
  EXPECT_EQ(up->kind, "summary.600");
  const auto down = down_parts("fw.down.all.minutes");
  ASSERT_TRUE(down);
  EXPECT_EQ(down->building, "all");
}

TEST(Subject, RefusesMalformedBuildings) {
  for (const char* good : {"a", "kobe-03", "0", "abcdefghijklmnopqrstuvwxyz012345"})
    EXPECT_TRUE(is_building_name(good)) << good;
  for (const char* bad : {"", "all", "Kobe", "kobe 3", "kobe.3", "kobe*", "kob\xc3\xa9", ">",
                          "abcdefghijklmnopqrstuvwxyz0123456"})
    EXPECT_FALSE(is_building_name(bad)) << bad;
}

TEST(Subject, AMalformedSubjectHasNoParts) {
  for (const char* bad : {"", "fw.up", "fw.up.", "fw.up.kobe", "fw.up.kobe.", "fw.up..event",
                          "fw.up.kobe..event", "fw.up.kobe.event.", "fw.up.kobe.*",
                          "fw.up.all.event", "fw.down.kobe.ping", "$JS.API.INFO", "fw.up.kobe.a b"})
    EXPECT_FALSE(up_parts(bad)) << bad;
  EXPECT_FALSE(down_parts("fw.up.kobe.ping"));
}

}  // namespace subject_test

}  // namespace framewatch::fleet
