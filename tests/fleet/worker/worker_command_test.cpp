// SPDX-License-Identifier: MIT
#include "fleet/worker/worker_command.h"

#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "daemon/base/clocks.h"
#include "tests/fleet/worker/worker_fixture.h"

namespace framewatch::fleet {
namespace worker_command_test {

std::string day(const std::string& rest) {
  return R"({"format":"framewatch.inventory/1","days":[{"day":"2026-11-20",)" + rest + "]}";
}

TEST(MissingDays, ReadsAnInventory) {
  const auto days =
      inventory_days(day(R"("from_us":172800000000,"events":3,"periods":{"600":144,"3600":24}},)"
                         R"({"from_us":86400000000,"events":0,"periods":{}})"));
  ASSERT_EQ(days.size(), 2u);
  EXPECT_EQ(days[0].from_us, 86'400'000'000);
  EXPECT_EQ(days[1].counts.events, 3);
  EXPECT_EQ(days[1].counts.periods.at(600), 144);
}

TEST(MissingDays, AMalformedInventoryNamesNoDay) {
  for (const std::string& bad :
       {std::string(""), std::string("[]"), std::string("{}"),
        std::string(R"({"format":1,"days":[]})"), day(R"("from_us":"x","events":3,"periods":{}})"),
        day(R"("from_us":1,"events":1.5,"periods":{}})"),
        day(R"("from_us":1,"events":1,"periods":[]})"),
        day(R"("from_us":1,"events":1,"periods":{"x":1}})"),
        day(R"("from_us":9223372036854775807,"events":1,"periods":{}})"), day("")})
    EXPECT_TRUE(inventory_days(bad).empty()) << bad;
}

TEST(MissingDaysOnServer, AreTheDaysThatTheDatabaseLacks) {
  const char* const where = std::getenv("FRAMEWATCH_POSTGRES");
  if (where == nullptr) GTEST_SKIP() << "no PostgreSQL (./test --fleet starts one)";
  Database look;
  ASSERT_TRUE(look.open(where)) << look.error();
  ASSERT_TRUE(look.execute("DROP SCHEMA public CASCADE; CREATE SCHEMA public")) << look.error();
  FleetStore store;
  ASSERT_EQ(store.open(where), "");
  const std::int64_t today_us = kHub_us, day_us = daemon::kDay_us;
  std::string text = R"({"format":"framewatch.inventory/1","days":[)";
  for (int before = 4; before >= 0; --before)
    text += R"({"from_us":)" + std::to_string(today_us - before * day_us) +
            R"(,"events":1,"periods":{"600":1}})" + (before > 0 ? "," : "]}");
  FleetBatch batch;
  batch.newest = {{"kobe", "inventory", "json", {text.begin(), text.end()}}};
  for (const int before : {4, 3, 2}) {
    event_t e = event(before);
    e.time_us = today_us - before * day_us + 5;
    summary_t s{};
    s.period_s = 600;
    s.start_us = e.time_us;
    s.config_sha256 = std::string(64, 'a');
    if (before != 3) batch.summaries.push_back({"kobe", s});
    batch.events.push_back({"kobe", e});
  }
  ASSERT_EQ(store.add(batch), "");
  const auto days = missing_days(store, "kobe");
  ASSERT_TRUE(days);
  // Yesterday has nothing, three days ago no summary; today is not over.
  EXPECT_EQ(*days, (std::vector<std::int64_t>{today_us - day_us, today_us - 3 * day_us}));
  EXPECT_TRUE(missing_days(store, "osaka")->empty());
}

}  // namespace worker_command_test
}  // namespace framewatch::fleet
