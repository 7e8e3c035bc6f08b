// SPDX-License-Identifier: MIT
#include "daemon/tools/replay/repair_command.h"

#include <algorithm>
#include <chrono>
#include <random>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "drivers/lcm/accel_codec.h"
#include "drivers/lcm/lcm_log.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace repair_command_test {

using drivers::LcmLogReader;
using drivers::LcmLogWriter;
using drivers::LogEvent;
using drivers::LogRead;
using test::read_file;
using test::TemporaryDirectory;
using test::write_file;

constexpr int kEvents = 10;
constexpr int kFuzzedLogs = 300;
constexpr unsigned kSeed = 6;

/// Returns the ten events of recipes.md, section 2: one node, a sample every 10 ms.
std::string ten_events() {
  const TemporaryDirectory directory;
  LcmLogWriter writer;
  EXPECT_TRUE(writer.open(directory.path("log")));
  for (int i = 0; i < kEvents; ++i) {
    const auto bytes = drivers::encode_accel(
        {estimator::from_microseconds(10'000 * i), 100 + i, 7, {1.0 * i, 2, 3}});
    EXPECT_TRUE(writer.write(10'000 * i, "ACCEL", bytes.data(), bytes.size()));
  }
  EXPECT_TRUE(writer.close());
  return read_file(directory.path("log"));
}

const std::size_t kEventBytes = 28 + 5 + drivers::kAccelBytes;
std::size_t start_of(int event) {
  return static_cast<std::size_t>(event) * kEventBytes;
}

struct Repaired {
  int exit_code;
  nlohmann::json report;
  std::vector<int> intact;  ///< which of the ten are in the repaired log
  std::string bytes;        ///< of the repaired log
};

Repaired repaired(const std::string& bytes) {
  const TemporaryDirectory directory;
  write_file(directory.path("bad.lcmlog"), bytes);
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const int code = repair({directory.path("bad.lcmlog"), "", false, true});
  (void)testing::internal::GetCapturedStderr();
  Repaired out{
      code, nlohmann::json::parse(testing::internal::GetCapturedStdout(), nullptr, false), {}, {}};
  EXPECT_EQ(read_file(directory.path("bad.lcmlog")), bytes);
  LcmLogReader reader;
  if (!reader.open(directory.path("bad.repaired.lcmlog"))) return out;
  out.bytes = read_file(directory.path("bad.repaired.lcmlog"));
  LogEvent event;
  LogRead read;
  while ((read = reader.next(event)) == LogRead::event) {
    const auto sample = drivers::decode_accel(event.data.data(), event.data.size());
    if (sample && event.number == sample->sequence - 100) out.intact.push_back(int(event.number));
  }
  EXPECT_EQ(read, LogRead::end) << "a repaired log is whole";
  return out;
}

std::vector<int> all_but(const std::vector<int>& missing) {
  std::vector<int> out;
  for (int i = 0; i < kEvents; ++i)
    if (std::find(missing.begin(), missing.end(), i) == missing.end()) out.push_back(i);
  return out;
}

std::string with_length(int event, std::size_t field, std::uint32_t length) {
  std::string log = ten_events();
  for (std::size_t i = 0; i < 4; ++i)
    log[start_of(event) + field + i] = static_cast<char>(length >> (24 - 8 * i) & 0xff);
  return log;
}

TEST(Repair, LeavesAnIntactLogAlone) {
  const Repaired r = repaired(ten_events());
  EXPECT_EQ(r.exit_code, 0);
  EXPECT_TRUE(r.bytes.empty());
  EXPECT_EQ(r.report["events"], kEvents);
  EXPECT_TRUE(r.report["out"].is_null());
}

TEST(Repair, EveryDamageCostsOnlyTheEventsItHits) {
  const std::string good = ten_events();
  struct Case {
    const char* name;
    std::string bytes;
    std::vector<int> lost;
    std::int64_t offset;
  };
  const auto garbage = [&](std::size_t n) {
    std::string log = good;
    return log.insert(start_of(5), std::string(n, '\x55'));
  };
  std::string missing = good;
  missing.erase(start_of(4) + 40, 1);
  const auto at = [](int event) { return static_cast<std::int64_t>(start_of(event)); };
  const std::vector<Case> cases{
      {"truncated payload", good.substr(0, good.size() - 5), {9}, at(9)},
      {"truncated header", good.substr(0, start_of(9) + 12), {9}, at(9)},
      {"truncated sync word", good.substr(0, start_of(9) + 2), {9}, at(9)},
      {"zero-filled tail", good + std::string(300, '\0'), {}, at(10)},
      {"4 bytes of garbage", garbage(4), {}, at(5)},
      {"1 byte of garbage", garbage(1), {}, at(5)},
      {"1 byte missing", missing, {4}, at(4)},
      {"channel length -1", with_length(4, 20, 0xffffffff), {4}, at(4)},
      {"payload length -1", with_length(4, 24, 0xffffffff), {4}, at(4)},
      {"payload length 256 MB", with_length(4, 24, 256u << 20), {4}, at(4)},
      {"payload length INT_MAX", with_length(4, 24, 0x7fffffff), {4}, at(4)},
  };
  for (const Case& c : cases) {
    const Repaired r = repaired(c.bytes);
    EXPECT_EQ(r.exit_code, 0) << c.name;
    EXPECT_EQ(r.intact, all_but(c.lost)) << c.name;
    ASSERT_EQ(r.report["damage"].size(), 1u) << c.name << r.report;
    const auto& damage = r.report["damage"][0];
    EXPECT_EQ(damage["byte"], c.offset) << c.name;
    if (c.offset >= at(9)) continue;  // nothing after it shows how much was lost
    EXPECT_EQ(damage["events"], c.lost.size()) << c.name << damage;
    if (!c.lost.empty()) {
      EXPECT_EQ(damage["after_us"], 30'000) << c.name;
      EXPECT_EQ(damage["before_us"], 50'000) << c.name;
      EXPECT_EQ(damage["lost"][0]["node"], 7) << c.name;
      EXPECT_EQ(damage["lost"][0]["samples"], 1) << c.name;
    }
  }
}

TEST(Repair, PayloadLengthOneShortKeepsAllOtherEvents) {
  const Repaired r = repaired(with_length(4, 24, drivers::kAccelBytes - 1));
  EXPECT_EQ(r.exit_code, 0);
  EXPECT_EQ(r.intact, all_but({4}));
}

TEST(Repair, AFuzzedLogNeverLosesAnUntouchedEventAndRepairsOnce) {
  std::mt19937 random(kSeed);
  const std::string good = ten_events();
  for (int run = 0; run < kFuzzedLogs; ++run) {
    std::string bytes = good;
    std::vector<int> touched;
    for (int hit = 1 + static_cast<int>(random() % 3); hit > 0; --hit) {
      const std::size_t at = random() % good.size();
      bytes[at] = static_cast<char>(random());
      touched.push_back(static_cast<int>(at / kEventBytes));
    }
    const Repaired r = repaired(bytes);
    if (r.bytes.empty()) continue;  // whole: only payload bytes were hit
    for (const int event : all_but(touched))
      EXPECT_NE(std::find(r.intact.begin(), r.intact.end(), event), r.intact.end())
          << "run " << run << " lost event " << event;
    EXPECT_TRUE(repaired(r.bytes).bytes.empty()) << "run " << run;
  }
}

/// After one whole event, 2 MB in which every 64 bytes look like an event that reaches nearly to
/// the end. Reading it took hours.
std::string crafted_log() {
  constexpr std::size_t kBytes = 2'000'000;
  std::string log = ten_events().substr(0, kEventBytes);
  std::string event = log.substr(0, 64);
  while (log.size() + 64 < kBytes) {
    const std::size_t end = kBytes - log.size() <= 192 ? kBytes - 50 : kBytes - 100;
    const std::size_t length = end - log.size() - 33;
    for (std::size_t i = 0; i < 4; ++i) event[24 + i] = static_cast<char>(length >> (24 - 8 * i));
    log += event;
  }
  log.resize(kBytes, 'Z');
  return log;
}

TEST(Repair, ACraftedLogTakesSeconds) {
  const std::string log = crafted_log();
  const auto start = std::chrono::steady_clock::now();
  const Repaired r = repaired(log);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_LT(took.count(), 30);  // measured 0.5 s in Debug
  EXPECT_EQ(r.exit_code, 0);
  EXPECT_EQ(r.report["events"], 2);
  EXPECT_LE(r.report["damage"].size(), LogSurvey::kMaxStretches);
  std::int64_t bytes = 0;
  for (const auto& damage : r.report["damage"]) bytes += damage["bytes"].get<std::int64_t>();
  EXPECT_EQ(bytes, r.report["damaged_bytes"]);
  EXPECT_GT(r.report["damage"].back()["places"], 10'000);
}

TEST(Repair, CheckReportsAndWritesNothing) {
  const TemporaryDirectory directory;
  const std::string good = ten_events();
  write_file(directory.path("cut"), good.substr(0, good.size() - 1));
  testing::internal::CaptureStdout();
  EXPECT_EQ(repair({directory.path("cut"), "", true, false}), 1);
  const std::string out = testing::internal::GetCapturedStdout();
  EXPECT_NE(out.find("byte " + std::to_string(start_of(9)) + ": truncated, "), std::string::npos)
      << out;
  EXPECT_NE(out.find("after 0.080000 s"), std::string::npos) << out;
  EXPECT_EQ(directory.names().size(), 1u);
}

TEST(Repair, RefusesFilesThatAreNotALog) {
  const TemporaryDirectory directory;
  write_file(directory.path("text"), std::string(5000, 'Z'));
  testing::internal::CaptureStderr();
  EXPECT_EQ(repair({directory.path("text"), "", false, false}), 2);
  EXPECT_EQ(repair({"/nonexistent", directory.path("out"), false, false}), 2);
  EXPECT_EQ(repair({directory.path("text"), directory.path("text"), false, false}), 2);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("holds no intact LCM event"),
            std::string::npos);
  EXPECT_EQ(directory.names().size(), 1u);
}

}  // namespace repair_command_test
}  // namespace framewatch::daemon
