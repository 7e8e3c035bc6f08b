#include "fleet/message/subject.h"

#include <gtest/gtest.h>

namespace framewatch::fleet {
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

TEST(Subject, WhatIsNoBuildingIsRefused) {
  for (const char* good : {"a", "kobe-03", "0", "abcdefghijklmnopqrstuvwxyz012345"})
    EXPECT_TRUE(is_building_name(good)) << good;
  for (const char* bad : {"", "all", "Kobe", "kobe 3", "kobe.3", "kobe*", "kob\xc3\xa9", ">",
                          "abcdefghijklmnopqrstuvwxyz0123456"})
    EXPECT_FALSE(is_building_name(bad)) << bad;
}

TEST(Subject, WhatIsNoSubjectHasNoParts) {
  for (const char* bad : {"", "fw.up", "fw.up.", "fw.up.kobe", "fw.up.kobe.", "fw.up..event",
                          "fw.up.kobe..event", "fw.up.kobe.event.", "fw.up.kobe.*",
                          "fw.up.all.event", "fw.down.kobe.ping", "$JS.API.INFO", "fw.up.kobe.a b"})
    EXPECT_FALSE(up_parts(bad)) << bad;
  EXPECT_FALSE(down_parts("fw.up.kobe.ping"));
}

}  // namespace subject_test
}  // namespace framewatch::fleet
