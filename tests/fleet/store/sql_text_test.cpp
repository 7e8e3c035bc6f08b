// SPDX-License-Identifier: MIT
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/base/clocks.h"
#include "fleet/store/database.h"
#include "fleet/store/fleet_schema.h"

namespace framewatch::fleet {
namespace sql_text_test {

TEST(SqlText, WritesArraysAsPostgresReadsThem) {
  EXPECT_EQ(sql_array(std::vector<std::int32_t>{1, -2}), "{1,-2}");
  EXPECT_EQ(sql_array(std::vector<std::int64_t>{}), "{}");
  EXPECT_EQ(sql_array(std::vector<double>{0.1, std::numeric_limits<double>::quiet_NaN(),
                                          -std::numeric_limits<double>::infinity()}),
            "{0.1,NaN,-Infinity}");
  EXPECT_EQ(sql_array(std::vector<float>{0.1F, std::numeric_limits<float>::infinity()}),
            "{0.1,Infinity}");
  EXPECT_EQ(sql_array(std::vector<std::string>{"a", "b\"c\\,{}", ""}),
            "{\"a\",\"b\\\"c\\\\,{}\",\"\"}");
  EXPECT_EQ(sql_bytes(std::vector<std::uint8_t>{0, 255, 16}), "\\x00ff10");
}

TEST(SqlText, PutsEveryTimeIntoItsMonth) {
  EXPECT_EQ(month_of(1'795'305'600'000'000).table, "summary_2026_11");
  EXPECT_EQ(month_of(0).table, "summary_1970_01");
  for (const std::int64_t time_us :
       {std::int64_t{0}, std::int64_t{1'798'761'599'999'999}, std::int64_t{1'798'761'600'000'000},
        std::int64_t{951'782'400'000'000}}) {
    const Month month = month_of(time_us);
    EXPECT_LE(month.from_us, time_us);
    EXPECT_LT(time_us, month.to_us);
    EXPECT_EQ(month_of(month.to_us).from_us, month.to_us);
    const std::int64_t days = (month.to_us - month.from_us) / daemon::kDay_us;
    EXPECT_TRUE(days >= 28 && days <= 31) << month.table;
  }
  EXPECT_EQ(month_of(1'798'761'599'999'999).table, "summary_2026_12");
  EXPECT_EQ(month_of(1'798'761'600'000'000).table, "summary_2027_01");
}

TEST(SqlText, ReportsAMissingServerWithoutThrowing) {
  Database database;
  EXPECT_FALSE(database.open("host=/nonexistent dbname=none"));
  EXPECT_NE(database.error().find("/nonexistent"), std::string::npos) << database.error();
  EXPECT_FALSE(database.execute("SELECT 1"));
  EXPECT_FALSE(database.query("SELECT 1"));
  EXPECT_FALSE(database.run_each("SELECT $1", {{"1"}}));
  EXPECT_FALSE(database.transaction([] { return true; }));
}

}  // namespace sql_text_test
}  // namespace framewatch::fleet
