// SPDX-License-Identifier: MIT
#include "daemon/tools/replay/replay_command.h"

#include <filesystem>
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "drivers/lcm/accel_codec.h"
#include "drivers/lcm/lcm_log.h"
#include "tests/daemon/tools/replay/replay_fixture.h"
#include "tests/support/data.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace replay_refusal_test {

using drivers::LogEvent;
using test::events_of;
using test::read_file;
using test::replay_of;
using test::rewrite;
using test::salvage_of;
using test::write_file;
using Outcome = test::ReplayOutcome;

class ReplayRefusal : public test::ReplayFixture {};

TEST_F(ReplayRefusal, TruncatedLogIsRefusedOrSalvagedUpToItsEnd) {
  const std::string bytes = read_file(log());
  write_file(path("cut"), bytes.substr(0, bytes.size() - 10));
  expect_refused(path("cut"), "--salvage uses the intact parts");
  const Outcome o = salvage_of(path("cut"), path("est.lcmlog"));
  EXPECT_EQ(o.exit_code, 0);
  EXPECT_NE(o.err.find("truncated, "), std::string::npos) << o.err;
  EXPECT_NE(o.err.find("cut: byte "), std::string::npos) << o.err;
}

TEST_F(ReplayRefusal, SalvagedDamageCostsOnlyItsEvents) {
  std::string bytes = read_file(log());
  const auto offset = static_cast<std::size_t>(events_of(log())[3000].offset);
  bytes.erase(offset + 40, 1);
  write_file(path("bad"), bytes);
  expect_refused(path("bad"), "byte " + std::to_string(offset) + ": damaged");
  const Outcome o = salvage_of(path("bad"), path("est.lcmlog"));
  EXPECT_EQ(o.exit_code, 0);
  EXPECT_NE(o.err.find("byte " + std::to_string(offset) + ": damaged"), std::string::npos) << o.err;
  EXPECT_NE(o.out.find("lost messages 1,"), std::string::npos) << o.out;
}

TEST_F(ReplayRefusal, RefusesMissingFiles) {
  expect_refused("/nonexistent.lcmlog", "No such file or directory");
  write_file(path("empty"), "");
  expect_refused(path("empty"), "is empty");
  write_file(path("noise"), std::string(5000, 'Z'));
  expect_refused(path("noise"), "no intact LCM event");
}

TEST_F(ReplayRefusal, RefusesALogOfOthersNamingItsChannels) {
  FRAMEWATCH_DATA_OR_SKIP(joints, "lcm_logs/lcm-proj_example.lcmlog");
  expect_refused(joints, "it has JOINT_TEST (10)");
}

TEST_F(ReplayRefusal, RefusesWrongFingerprints) {
  rewrite(log(), path("wrong"), [](LogEvent& event) {
    if (event.channel == "ACCEL") event.data[2] ^= 0x10;
    return true;
  });
  expect_refused(path("wrong"), "not the accel_t");
}

TEST_F(ReplayRefusal, RefusesAnotherSamplingRateNamingBoth) {
  rewrite(log(), path("slow"), [](LogEvent& event) {
    if (event.channel != "ACCEL") return true;
    auto sample = *drivers::decode_accel(event.data.data(), event.data.size());
    sample.time = estimator::from_microseconds(2 * to_microseconds(sample.time));
    event.data = drivers::encode_accel(sample);
    return true;
  });
  expect_refused(path("slow"), "sampled at 50 Hz, but");
  EXPECT_NE(replay_of({path("slow")}).err.find("rate_hz = 100"), std::string::npos);
}

TEST_F(ReplayRefusal, RefusesOverlapButReadsTimeRunningBackwards) {
  rewrite(log(), path("back"), [](LogEvent& event) {
    if (event.channel != "ACCEL") return true;
    auto sample = *drivers::decode_accel(event.data.data(), event.data.size());
    if (sample.sequence >= 600) sample.time -= std::chrono::seconds(3);
    event.data = drivers::encode_accel(sample);
    return true;
  });
  const Outcome back = replay_of({path("back")}, path("est.lcmlog"));
  EXPECT_EQ(back.exit_code, 0) << back.err;
  EXPECT_NE(back.err.find("time runs backwards"), std::string::npos) << back.err;
  const Outcome twice = replay_of({log(), log()}, path("est.lcmlog"));
  EXPECT_EQ(twice.exit_code, 2);
  EXPECT_NE(twice.err.find("is not after " + log() + ", which ends at 12.000000 s"),
            std::string::npos)
      << twice.err;
  EXPECT_EQ(twice.err.find("time runs backwards"), std::string::npos) << twice.err;
}

TEST_F(ReplayRefusal, RefusesARecordWithoutOurChannels) {
  write_file(path("other.csv"), "time_s,roof\n0,1\n0.01,2\n0.02,3\n");
  expect_refused(path("other.csv"), "no column is named like a channel");
}

TEST_F(ReplayRefusal, RefusesOrSalvagesInfiniteSamples) {
  rewrite(log(), path("inf"), [](LogEvent& event) {
    if (event.channel != "ACCEL") return true;
    auto sample = *drivers::decode_accel(event.data.data(), event.data.size());
    if (sample.sequence == 300) sample.accel_abs_mps2.fill(INFINITY);
    event.data = drivers::encode_accel(sample);
    return true;
  });
  expect_refused(path("inf"), "infinite acceleration");
  const Outcome o = salvage_of(path("inf"), path("est.lcmlog"));
  EXPECT_EQ(o.exit_code, 0);
  EXPECT_NE(o.err.find("infinite acceleration"), std::string::npos) << o.err;
}

TEST_F(ReplayRefusal, NeverOverwritesItsInputs) {
  const std::string before = read_file(log());
  EXPECT_EQ(replay_of({log()}, log()).exit_code, 2);
  EXPECT_EQ(read_file(log()), before);
  const Outcome config = replay_of({log()}, path("own.lcmlog"), false, path("own.lcmlog"));
  EXPECT_EQ(config.exit_code, 2);
  EXPECT_NE(config.err.find("is input and output"), std::string::npos) << config.err;
}

TEST_F(ReplayRefusal, RefusesAnUnknownOutputFormat) {
  const Outcome o = replay_of({log()}, path("est.xlsx"));
  EXPECT_EQ(o.exit_code, 2);
  EXPECT_NE(o.err.find("must end in .lcmlog, .csv, .csv.gz, .mat or .sqlite"), std::string::npos)
      << o.err;
  EXPECT_TRUE(own_.names().empty());
}

TEST_F(ReplayRefusal, AFuzzedLogIsRefusedOrSalvagedAndNeverCrashes) {
  constexpr int kRuns = 25;
  std::mt19937 random(6);
  const std::string good = read_file(log());
  int refused = 0;
  for (int run = 0; run < kRuns; ++run) {
    std::string bytes = good.substr(0, good.size() / 4);
    for (int hit = 0; hit < 1 + run; ++hit) {
      const std::size_t at = random() % bytes.size();
      switch (random() % 4) {
        case 0:
          bytes[at] = static_cast<char>(random());
          break;
        case 1:
          bytes.erase(at, 1 + random() % 200);
          break;
        case 2:
          bytes.insert(at, std::string(1 + random() % 200, static_cast<char>(random())));
          break;
        default:
          bytes.replace(at, 8, std::string(8, '\xff'));
      }
    }
    write_file(path("bad"), bytes);
    const Outcome plain = replay_of({path("bad")}, path("est.lcmlog"));
    EXPECT_TRUE(plain.exit_code == 0 || plain.exit_code == 2) << run;
    EXPECT_EQ(std::filesystem::exists(path("est.lcmlog")), plain.exit_code == 0);
    refused += plain.exit_code == 2;
    const Outcome salvaged = salvage_of(path("bad"), path("salvaged.lcmlog"));
    EXPECT_TRUE(salvaged.exit_code == 0 || salvaged.exit_code == 2) << run;
    std::filesystem::remove(path("est.lcmlog"));
    std::filesystem::remove(path("salvaged.lcmlog"));
  }
  EXPECT_GT(refused, kRuns / 2);
}

TEST_F(ReplayRefusal, NamesANewerType) {
  rewrite(log(), path("newer"), [](LogEvent& event) {
    if (event.channel == "ACCEL") event.data[0] ^= 0x55;
    return true;
  });
  expect_refused(path("newer"), "a newer framewatch wrote them with a newer accel_t");
}

TEST_F(ReplayRefusal, RefusesABadConfigurationOrOutput) {
  EXPECT_EQ(replay_of({log()}, path("est.lcmlog"), false, "/nonexistent.toml").exit_code, 2);
  const Outcome o = replay_of({log()}, path("no/such/directory/est.lcmlog"));
  EXPECT_EQ(o.exit_code, 2);
  EXPECT_NE(o.err.find("No such file or directory"), std::string::npos);
}

}  // namespace replay_refusal_test
}  // namespace framewatch::daemon
