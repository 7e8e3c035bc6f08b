// SPDX-License-Identifier: MIT
#include "fleet/store/fleet_store.h"

#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/base/process.h"
#include "fleet/store/fleet_schema.h"

namespace framewatch::fleet {
namespace fleet_store_test {

// Limits.
constexpr double kMinPerSecond = 1000;  // summaries of 120 parameters, a second of processor

constexpr std::int64_t kStart_us = 1'795'305'600'000'000;  // 2026-11-22T00:00:00Z

/// Tests with a real server: ./test --fleet starts one and sets FRAMEWATCH_POSTGRES.
class FleetStoreOnServer : public testing::Test {
 protected:
  void SetUp() override {
    const char* const where = std::getenv("FRAMEWATCH_POSTGRES");
    if (where == nullptr) GTEST_SKIP() << "no PostgreSQL (./test --fleet starts one)";
    where_ = where;
    ASSERT_TRUE(look_.open(where_)) << look_.error();
    ASSERT_TRUE(look_.execute("DROP SCHEMA public CASCADE; CREATE SCHEMA public")) << look_.error();
  }
  std::string number(const std::string& sql) {
    const auto rows = look_.query(sql);
    EXPECT_TRUE(rows) << look_.error();
    return rows && !rows->empty() ? rows->front().front().value_or("NULL") : "";
  }

  std::string where_;
  Database look_;
};

event_t event(std::int64_t id) {
  event_t e{};
  e.kind = "gap";
  e.id = id;
  e.time_us = kStart_us;
  e.message = "it \"is\" \\ \xff odd";
  return e;
}

summary_t summary(std::int64_t start_us, int windows = 10, std::size_t parameters = 2) {
  summary_t s{};
  s.start_us = start_us;
  s.period_s = 600;
  s.windows = windows;
  s.config_sha256 = std::string(64, 'a');
  s.observable.assign(parameters, 3);
  for (auto* list : {&s.median, &s.q1, &s.q3, &s.std_error}) list->assign(parameters, 1.25F);
  return s;
}

TEST_F(FleetStoreOnServer, StoresARepeatedMessageOnce) {
  FleetStore store;
  ASSERT_EQ(store.open(where_), "");
  FleetBatch batch;
  batch.events = {{"kobe", event(1)}, {"kobe", event(1)}, {"osaka", event(1)}};
  batch.summaries = {{"kobe", summary(kStart_us)},
                     {"kobe", summary(kStart_us + 40 * 86'400'000'000)}};
  batch.newest = {{"kobe", "service", "service_t", {1, 2}}, {"kobe", "service", "service_t", {3}}};
  batch.others = {{"s", "k", "", "t", "v", {1}}, {"s", "k", "bad", "t", "v", {1}}};
  batch.floods = {{"kobe", kStart_us, 5, 100}};
  for (int i = 0; i < 2; ++i) ASSERT_EQ(store.add(batch), "");
  EXPECT_EQ(number("SELECT count(*) FROM event"), "2");
  EXPECT_EQ(number("SELECT message FROM event LIMIT 1"), "it \"is\" \\ ? odd");
  EXPECT_EQ(number("SELECT count(*) FROM summary"), "2");
  EXPECT_EQ(number("SELECT count(*) FROM summary_2026_11"), "1");
  EXPECT_EQ(number("SELECT median[2] FROM summary_2026_11"), "1.25");
  EXPECT_EQ(number("SELECT content FROM newest"), "\\x03");
  EXPECT_EQ(number("SELECT count(*) FROM unknown"), "1");
  EXPECT_EQ(number("SELECT messages FROM flooding"), "10");
  EXPECT_EQ(number("SELECT count(*) FROM building"), "2");
}

TEST_F(FleetStoreOnServer, ReplacesAPeriodOnlyByOneWithMoreWindows) {
  FleetStore store;
  ASSERT_EQ(store.open(where_), "");
  FleetBatch batch;
  for (const int windows : {10, 20, 5}) {
    batch.summaries = {{"kobe", summary(kStart_us, windows)}};
    ASSERT_EQ(store.add(batch), "");
  }
  EXPECT_EQ(number("SELECT windows FROM summary"), "20");
}

TEST_F(FleetStoreOnServer, StoresABatchWholeOrNotAtAll) {
  FleetStore store;
  ASSERT_EQ(store.open(where_), "");
  FleetBatch batch;
  batch.events = {{"kobe", event(1)}};
  batch.summaries = {{"kobe", summary(kStart_us)}};
  batch.summaries[0].summary.config_sha256 = "no digest";
  EXPECT_NE(store.add(batch), "");
  EXPECT_TRUE(store.is_of_values());
  EXPECT_EQ(number("SELECT count(*) FROM event"), "0");
  batch.summaries.clear();
  ASSERT_EQ(store.open(where_), "");
  EXPECT_EQ(store.add(batch), "");
  EXPECT_FALSE(store.is_of_values());
}

TEST_F(FleetStoreOnServer, SeveralWorkersStartAtOnce) {
  std::vector<std::thread> workers;
  std::vector<std::string> problems(4);
  for (std::size_t w = 0; w < problems.size(); ++w)
    workers.emplace_back([&, w] {
      FleetStore store;
      problems[w] = store.open(where_);
      for (int i = 0; i < 20 && problems[w].empty(); ++i) {
        FleetBatch batch;
        batch.events = {{"b" + std::to_string(i), event(i)}};
        batch.summaries = {{"b" + std::to_string(i), summary(kStart_us + i * 86'400'000'000 * 20)}};
        problems[w] = store.add(batch);
      }
    });
  for (std::thread& worker : workers) worker.join();
  for (const std::string& problem : problems) EXPECT_EQ(problem, "");
  EXPECT_EQ(number("SELECT count(*) FROM event"), "20");
  EXPECT_EQ(number("SELECT count(*) FROM summary"), "20");
}

TEST_F(FleetStoreOnServer, LeavesANewerDatabaseAlone) {
  FleetStore store;
  ASSERT_EQ(store.open(where_), "");
  ASSERT_TRUE(look_.execute("UPDATE schema_version SET version = 99"));
  FleetStore older;
  EXPECT_NE(older.open(where_).find("a newer framewatch"), std::string::npos);
}

TEST_F(FleetStoreOnServer, IsFastEnough) {
  FleetStore store;
  ASSERT_EQ(store.open(where_), "");
  constexpr int kBatches = 10, kEach = 500;
  std::vector<FleetBatch> batches(kBatches);
  for (int b = 0; b < kBatches; ++b)
    for (int i = 0; i < kEach; ++i)
      batches[static_cast<std::size_t>(b)].summaries.push_back(
          {"b" + std::to_string(i), summary(kStart_us + b * 600'000'000, 10, 120)});
  const double began_s = daemon::process_usage().cpu_s;
  for (const FleetBatch& batch : batches) ASSERT_EQ(store.add(batch), "");
  // Processor time, because the machine may be busy.
  const double took_s = daemon::process_usage().cpu_s - began_s;
  const double rate = kBatches * kEach / took_s;
  std::printf("%.0f summaries a second of processor\n", rate);
  EXPECT_GT(rate, kMinPerSecond);
}

}  // namespace fleet_store_test
}  // namespace framewatch::fleet
