// SPDX-License-Identifier: MIT
#include "fleet/worker/worker.h"

#include <optional>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/fleet/worker/worker_fixture.h"

namespace framewatch::fleet {
namespace worker_test {

constexpr std::int64_t kStep_us = 100'000;
constexpr std::int64_t kMessages = 200;  // more is a flood

/// A database that fails on request.
struct Database {
  std::vector<FleetBatch> batches;
  std::string problem;
  std::set<std::int64_t> bad_events;  ///< ids that it refuses

  StoreOutcome store(const FleetBatch& batch) {
    if (!problem.empty()) return {problem, false};
    for (const ReceivedEvent& e : batch.events)
      if (bad_events.contains(e.event.id)) return {"no such number", true};
    batches.push_back(batch);
    return {};
  }
  std::multiset<std::int64_t> events() const {
    std::multiset<std::int64_t> out;
    for (const FleetBatch& batch : batches)
      for (const ReceivedEvent& e : batch.events) out.insert(e.event.id);
    return out;
  }
};

class WorkerTest : public testing::Test {
 protected:
  void pass(std::int64_t us) {
    for (const std::int64_t until_us = now_.steady_us + us; now_.steady_us < until_us;) {
      worker_.step(now_);
      now_.steady_us += kStep_us;
      now_.hub_us += kStep_us;
    }
  }

  HubLink hub_;
  Database database_;
  std::optional<std::vector<std::int64_t>> missing_;
  Worker worker_{hub_, [this](const FleetBatch& batch) { return database_.store(batch); },
                 [this](const std::string&) { return missing_; },
                 FloodGate(kMessages, FloodGate::kBytes)};
  WorkerTime now_{1'000'000, kHub_us};
};

TEST_F(WorkerTest, StoresAndThenAcknowledges) {
  for (int id = 0; id < 100; ++id) hub_.hold(event_message("kobe", id));
  hub_.hold(summary_message("osaka", 600, kHub_us));
  pass(400'000);
  EXPECT_EQ(hub_.held(), 101u);  // the batch is not complete yet
  pass(1'000'000);
  EXPECT_EQ(hub_.held(), 0u);
  EXPECT_EQ(database_.events().size(), 100u);
  EXPECT_EQ(worker_.counters().stored, 101);
  EXPECT_EQ(worker_.counters().batches, 1);
}

TEST_F(WorkerTest, AcknowledgesAndLosesNothingWithoutTheDatabase) {
  database_.problem = "connection refused";
  for (int id = 0; id < 10; ++id) hub_.hold(event_message("kobe", id));
  pass(20'000'000);
  EXPECT_EQ(hub_.held(), 10u);
  EXPECT_EQ(worker_.counters().trouble, "connection refused");
  const int requests = hub_.requests();
  hub_.time_is_over();
  pass(600'000);
  EXPECT_LE(hub_.requests(), requests + 4);  // it requests nothing while it waits
  database_.problem.clear();
  hub_.time_is_over();
  pass(60'000'000);
  EXPECT_EQ(hub_.held(), 0u);
  EXPECT_EQ(database_.events().size(), 10u);
  EXPECT_EQ(worker_.counters().trouble, "");
}

TEST_F(WorkerTest, OneRefusedMessageStopsNoOther) {
  database_.bad_events = {3};
  for (int id = 0; id < 10; ++id) hub_.hold(event_message("kobe", id));
  pass(2'000'000);
  EXPECT_EQ(hub_.held(), 0u);
  EXPECT_EQ(database_.events().size(), 9u);
  std::string reason;
  for (const FleetBatch& batch : database_.batches)
    for (const ReceivedOther& other : batch.others) reason = other.reason;
  EXPECT_EQ(reason, "the database rejects it: no such number");
  EXPECT_EQ(worker_.counters().refused, 1);
}

TEST_F(WorkerTest, AcknowledgesRefusedMessages) {
  Message forged = event_message("kobe", 1);
  forged.subject = "fw.up.osaka.event";
  hub_.hold(forged);
  pass(2'000'000);
  EXPECT_EQ(hub_.held(), 0u);
  EXPECT_EQ(worker_.counters().refused, 1);
  EXPECT_TRUE(database_.events().empty());
}

TEST_F(WorkerTest, AsksAgainAfterANewConnection) {
  pass(500'000);
  const int requests = hub_.requests();
  pass(500'000);
  EXPECT_EQ(hub_.requests(), requests);
  hub_.cut();
  pass(200'000);
  EXPECT_EQ(hub_.requests(), requests + 4);
}

TEST_F(WorkerTest, RepeatsAfterADatabaseOutageAreNoFlood) {
  for (std::int64_t id = 0; id < kMessages / 2; ++id) hub_.hold(event_message("kobe", id));
  database_.problem = "connection refused";
  for (int i = 0; i < 5; ++i) {
    pass(60'000'000);
    hub_.time_is_over();
  }
  database_.problem.clear();
  pass(60'000'000);
  EXPECT_EQ(database_.events().size(), static_cast<std::size_t>(kMessages / 2));
  EXPECT_EQ(worker_.counters().flooding, 0);
}

TEST_F(WorkerTest, AcknowledgesAndCountsAFlood) {
  const auto more = kMessages + 20;
  for (std::int64_t id = 0; id < more; ++id) hub_.hold(event_message("kobe", id));
  hub_.hold(event_message("osaka", 1));
  pass(30'000'000);
  EXPECT_EQ(hub_.held(), 0u);
  EXPECT_EQ(database_.events().size(), static_cast<std::size_t>(kMessages) + 1);
  std::int64_t floods = 0;
  for (const FleetBatch& batch : database_.batches)
    for (const ReceivedFlood& flood : batch.floods) {
      EXPECT_EQ(flood.building, "kobe");
      floods += flood.messages;
    }
  EXPECT_EQ(floods, 20);
}

TEST_F(WorkerTest, StoresNoFloodAlongWithARefusedMessage) {
  database_.bad_events = {3};
  const auto more = kMessages + 20;
  for (std::int64_t id = 0; id < more; ++id) hub_.hold(event_message("kobe", id));
  pass(30'000'000);
  EXPECT_EQ(hub_.held(), 0u);
  EXPECT_EQ(database_.events().size(), static_cast<std::size_t>(kMessages) - 1);
  std::int64_t floods = 0;
  for (const FleetBatch& batch : database_.batches)
    for (const ReceivedFlood& flood : batch.floods) floods += flood.messages;
  EXPECT_EQ(floods, 20);
  EXPECT_EQ(worker_.counters().flooding, 20);
}

TEST_F(WorkerTest, ReturnsUnstoredMessagesAndStoresThemLater) {
  database_.problem = "connection refused";
  for (int id = 0; id < 10; ++id) hub_.hold(event_message("kobe", id));
  pass(1'000'000);
  EXPECT_EQ(hub_.given_back(), 10);
  database_.problem.clear();
  pass(8'000'000);  // no timeout has passed
  EXPECT_EQ(database_.events().size(), 10u);
  EXPECT_EQ(hub_.held(), 0u);
}

TEST_F(WorkerTest, StoresEveryMessageOnce) {
  for (int id = 0; id < 10; ++id) hub_.hold(event_message("kobe", id));
  pass(2'000'000);
  EXPECT_EQ(worker_.counters().stored, 10);
}

TEST_F(WorkerTest, RequestsDaysThatTheDatabaseLacks) {
  const Message inventory = packed(up_subject("kobe", "inventory"),
                                   newest_key("kobe", "inventory", 1), "json", {'{', '}'}, "");
  missing_ = std::vector<std::int64_t>(7, kHub_us - 86'400'000'000);
  hub_.hold(inventory);
  pass(60'000'000);
  EXPECT_TRUE(hub_.commands().empty());  // requested messages may still come
  pass(1'800'000'000);
  ASSERT_EQ(hub_.commands().size(), Worker::kMaxResent_days);
  const Message& asked = hub_.commands().front();
  EXPECT_EQ(asked.subject, "fw.down.kobe.resend");
  EXPECT_EQ(std::string(asked.bytes.begin(), asked.bytes.end()),
            R"({"from_us":1795219200000000,"to_us":1795305600000000})");
  EXPECT_EQ(asked.header(header::kWho), "worker");
  EXPECT_EQ(worker_.counters().resends, 5);
  pass(3'600'000'000);
  EXPECT_EQ(hub_.commands().size(), Worker::kMaxResent_days);  // once for an inventory
}

TEST_F(WorkerTest, RequestsNothingWithoutNeedOrDatabase) {
  for (const char* name : {"kobe", "osaka"}) {
    hub_.hold(packed(up_subject(name, "inventory"), newest_key(name, "inventory", 1), "json",
                     {'{', '}'}, ""));
    pass(2'000'000'000);
    EXPECT_TRUE(hub_.commands().empty());
    missing_.emplace();
  }
}

TEST(FloodGateTest, ResetsEveryHour) {
  FloodGate gate(kMessages);
  for (std::int64_t i = 0; i < kMessages; ++i) EXPECT_TRUE(gate.takes("a", 1, kHub_us));
  EXPECT_FALSE(gate.takes("a", 7, kHub_us));
  EXPECT_TRUE(gate.takes("b", 1, kHub_us));
  EXPECT_FALSE(gate.takes("c", FloodGate::kBytes + 1, kHub_us));
  EXPECT_TRUE(gate.takes("a", 1, kHub_us + 3'600'000'000));
  const auto floods = gate.take_floods();
  ASSERT_EQ(floods.size(), 2u);  // of the hour that is over
  EXPECT_EQ(floods[0].bytes, 7);
  EXPECT_EQ(floods[0].hour_us, kHub_us);
  EXPECT_TRUE(gate.take_floods().empty());
}

}  // namespace worker_test
}  // namespace framewatch::fleet
