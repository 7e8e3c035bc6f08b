#include "daemon/replay_command.h"

#include <matio.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>

#include <gtest/gtest.h>

#include <framewatch/parameter_table_t.hpp>
#include <framewatch/status_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/convert_command.h"
#include "drivers/accel_codec.h"
#include "drivers/lcm_log.h"
#include "tests/support/data.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace {

using drivers::LcmLogReader;
using drivers::LcmLogWriter;
using drivers::LogEvent;
using drivers::LogRead;
using test::read_file;
using test::TemporaryDirectory;
using test::write_file;

struct Outcome {
  int exit_code;
  std::string out, err;
};

Outcome replay_of(std::vector<std::string> inputs, const std::string& out = "", bool json = false,
                  const std::string& config = test::table_config()) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const int code = replay({config, std::move(inputs), out, false, false, json});
  return {code, testing::internal::GetCapturedStdout(), testing::internal::GetCapturedStderr()};
}

/// replay --salvage of one log.
Outcome salvage_of(const std::string& input, const std::string& out) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const int code = replay({test::table_config(), {input}, out, true, false, false});
  return {code, testing::internal::GetCapturedStdout(), testing::internal::GetCapturedStderr()};
}

std::vector<LogEvent> events_of(const std::string& path) {
  LcmLogReader reader;
  EXPECT_TRUE(reader.open(path));
  std::vector<LogEvent> events;
  LogEvent event;
  while (reader.next(event) == LogRead::event) events.push_back(event);
  return events;
}

std::vector<std::vector<std::uint8_t>> payloads(const std::string& path,
                                                const std::string& channel) {
  std::vector<std::vector<std::uint8_t>> found;
  for (const LogEvent& event : events_of(path))
    if (event.channel == channel) found.push_back(event.data);
  return found;
}

/// A copy of the log with every event changed or, when `change` says false, left out.
template <typename Change>
void rewrite(const std::string& from, const std::string& to, Change change) {
  LcmLogWriter writer;
  ASSERT_TRUE(writer.open(to));
  for (LogEvent event : events_of(from)) {
    if (!change(event)) continue;
    ASSERT_TRUE(
        writer.write(event.timestamp_us, event.channel, event.data.data(), event.data.size()));
  }
  ASSERT_TRUE(writer.close());
}

class Replay : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    directory_ = new TemporaryDirectory;
    test::record_table_test(directory_->path("rec.lcmlog"));
    test::record_table_test(directory_->path("rec.csv"));
  }
  static void TearDownTestSuite() { delete directory_; }

  static std::string log() { return directory_->path("rec.lcmlog"); }
  static std::string csv() { return directory_->path("rec.csv"); }
  std::string path(const std::string& name) const { return own_.path(name); }

  /// Nothing but what the test itself put there.
  void expect_refused(const std::string& input, const std::string& rule) {
    const Outcome o = replay_of({input}, path("est.lcmlog"));
    EXPECT_EQ(o.exit_code, 2);
    EXPECT_NE(o.err.find(rule), std::string::npos) << o.err;
    EXPECT_NE(o.err.find(input), std::string::npos) << o.err;
    EXPECT_TRUE(o.out.empty());
    for (const std::string& name : own_.names()) EXPECT_EQ(name.find("est"), std::string::npos);
  }

  TemporaryDirectory own_;

 private:
  inline static TemporaryDirectory* directory_ = nullptr;
};

TEST_F(Replay, TwoReplaysAreByteIdenticalAndHoldNoWallClock) {
  ASSERT_EQ(replay_of({log()}, path("a.lcmlog")).exit_code, 0);
  ASSERT_EQ(replay_of({log()}, path("b.lcmlog")).exit_code, 0);
  EXPECT_GT(read_file(path("a.lcmlog")).size(), 100000u);
  EXPECT_EQ(read_file(path("a.lcmlog")), read_file(path("b.lcmlog")));
  for (const auto& bytes : payloads(path("a.lcmlog"), "FRAMEWATCH_STATUS")) {
    framewatch::status_t status{};
    ASSERT_GT(status.decode(bytes.data(), 0, static_cast<int>(bytes.size())), 0);
    EXPECT_EQ(status.latency_s, 0);
  }
}

TEST_F(Replay, PublishesTableAndStatusEverySecondAndEveryWindow) {
  ASSERT_EQ(replay_of({log()}, path("est.lcmlog")).exit_code, 0);
  const std::vector<LogEvent> events = events_of(path("est.lcmlog"));
  EXPECT_EQ(events.front().channel, "FRAMEWATCH_PARAMETERS");
  EXPECT_EQ(payloads(path("est.lcmlog"), "FRAMEWATCH_PARAMETERS").size(), 14u);  // 0 to 12 s, end
  EXPECT_EQ(payloads(path("est.lcmlog"), "FRAMEWATCH_STATUS").size(), 14u);
  std::int64_t sequence = 0;
  for (const auto& bytes : payloads(path("est.lcmlog"), "FRAMEWATCH_ESTIMATE")) {
    framewatch::window_estimate_t estimate{};
    ASSERT_EQ(estimate.decode(bytes.data(), 0, static_cast<int>(bytes.size())),
              static_cast<int>(bytes.size()));
    EXPECT_EQ(estimate.sequence, sequence++);
  }
  EXPECT_GT(sequence, 600);
  for (const LogEvent& event : events) EXPECT_LE(event.timestamp_us, 12'000'000);
}

TEST_F(Replay, ARecordGivesTheEstimatesOfItsLog) {
  ASSERT_EQ(replay_of({log()}, path("of_log.lcmlog")).exit_code, 0);
  ASSERT_EQ(replay_of({csv()}, path("of_csv.lcmlog")).exit_code, 0);
  const auto from_log = payloads(path("of_log.lcmlog"), "FRAMEWATCH_ESTIMATE");
  EXPECT_GT(from_log.size(), 600u);
  EXPECT_EQ(from_log, payloads(path("of_csv.lcmlog"), "FRAMEWATCH_ESTIMATE"));
}

TEST_F(Replay, ALogInTwoPartsGivesTheSame) {
  const std::string bytes = read_file(log());
  // After the table and 500 instants of ten nodes: the parts share no instant.
  const auto cut = static_cast<std::size_t>(events_of(log())[5001].offset);
  write_file(path("1"), bytes.substr(0, cut));
  write_file(path("2"), bytes.substr(cut));
  ASSERT_EQ(replay_of({log()}, path("whole.lcmlog")).exit_code, 0);
  const Outcome parts = replay_of({path("1"), path("2")}, path("parts.lcmlog"));
  ASSERT_EQ(parts.exit_code, 0) << parts.err;
  EXPECT_EQ(read_file(path("whole.lcmlog")), read_file(path("parts.lcmlog")));
}

TEST_F(Replay, SummaryCountsAndJson) {
  const Outcome text = replay_of({log()});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_NE(text.out.find("gaps 0, lost messages 0"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("kx_1_y1"), std::string::npos);
  const Outcome json = replay_of({log()}, "", true);
  EXPECT_NE(json.out.find("\"name\": \"Gk_2_x1y1\", \"unit\": \"N/(rad*m)\""), std::string::npos);
}

TEST_F(Replay, TruncatedLogIsRefusedOrSalvagedUpToItsEnd) {
  const std::string bytes = read_file(log());
  write_file(path("cut"), bytes.substr(0, bytes.size() - 10));
  expect_refused(path("cut"), "--salvage uses what is intact");
  const Outcome o = salvage_of(path("cut"), path("est.lcmlog"));
  EXPECT_EQ(o.exit_code, 0);
  EXPECT_NE(o.err.find("truncated, "), std::string::npos) << o.err;
  EXPECT_NE(o.err.find("cut: byte "), std::string::npos) << o.err;
}

TEST_F(Replay, SalvagedDamageCostsItsEventsOnly) {
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

TEST_F(Replay, CountsLostMessagesBySequence) {
  int n = 0, dropped = 0;
  rewrite(log(), path("lossy"), [&](LogEvent&) {
    const bool keep = ++n % 1000 != 0;
    dropped += !keep;
    return keep;
  });
  const Outcome o = replay_of({path("lossy")});
  EXPECT_EQ(dropped, 12);
  EXPECT_NE(o.out.find("lost messages 12,"), std::string::npos) << o.out;
}

TEST_F(Replay, ForeignChannelsAreCountedAndIgnored) {
  LcmLogWriter writer;
  ASSERT_TRUE(writer.open(path("mixed")));
  for (const LogEvent& e : events_of(log())) {
    ASSERT_TRUE(writer.write(e.timestamp_us, e.channel, e.data.data(), e.data.size()));
    ASSERT_TRUE(writer.write(e.timestamp_us, "CAMERA", "jpeg", 4));
  }
  ASSERT_TRUE(writer.close());
  ASSERT_EQ(replay_of({log()}, path("pure.lcmlog")).exit_code, 0);
  ASSERT_EQ(replay_of({path("mixed")}, path("mixed_est.lcmlog")).exit_code, 0);
  EXPECT_EQ(payloads(path("pure.lcmlog"), "FRAMEWATCH_ESTIMATE"),
            payloads(path("mixed_est.lcmlog"), "FRAMEWATCH_ESTIMATE"));
}

TEST_F(Replay, RefusesWhatIsNotThere) {
  expect_refused("/nonexistent.lcmlog", "No such file or directory");
  write_file(path("empty"), "");
  expect_refused(path("empty"), "is empty");
  write_file(path("noise"), std::string(5000, 'Z'));
  expect_refused(path("noise"), "no intact LCM event");
}

TEST_F(Replay, RefusesALogOfOthersNamingItsChannels) {
  FRAMEWATCH_DATA_OR_SKIP(joints, "lcm_logs/lcm-proj_example.lcmlog");
  expect_refused(joints, "it has JOINT_TEST (10)");
}

TEST_F(Replay, RefusesWrongFingerprints) {
  rewrite(log(), path("wrong"), [](LogEvent& event) {
    if (event.channel == "ACCEL") event.data[2] ^= 0x10;
    return true;
  });
  expect_refused(path("wrong"), "no accel_t");
}

TEST_F(Replay, RefusesAnotherSamplingRateNamingBoth) {
  rewrite(log(), path("slow"), [](LogEvent& event) {
    if (event.channel != "ACCEL") return true;
    auto sample = *drivers::decode_accel(event.data.data(), event.data.size());
    sample.time = from_microseconds(2 * to_microseconds(sample.time));
    event.data = drivers::encode_accel(sample);
    return true;
  });
  expect_refused(path("slow"), "sampled at 50 Hz, but");
  EXPECT_NE(replay_of({path("slow")}).err.find("rate_hz = 100"), std::string::npos);
}

TEST_F(Replay, RefusesTimeRunningBackwards) {
  rewrite(log(), path("back"), [](LogEvent& event) {
    if (event.channel != "ACCEL") return true;
    auto sample = *drivers::decode_accel(event.data.data(), event.data.size());
    if (sample.sequence >= 600) sample.time -= std::chrono::seconds(3);
    event.data = drivers::encode_accel(sample);
    return true;
  });
  expect_refused(path("back"), "time runs backwards");
  const Outcome twice = replay_of({log(), log()}, path("est.lcmlog"));
  EXPECT_EQ(twice.exit_code, 2);
  EXPECT_NE(twice.err.find("is not after " + log() + ", which ends at 12.000000 s"),
            std::string::npos)
      << twice.err;
  EXPECT_EQ(twice.err.find("time runs backwards"), std::string::npos) << twice.err;
}

TEST_F(Replay, RefusesARecordWithoutOurChannels) {
  write_file(path("other.csv"), "time_s,roof\n0,1\n0.01,2\n0.02,3\n");
  expect_refused(path("other.csv"), "no column is named like a channel");
}

TEST_F(Replay, RefusesOrSalvagesInfiniteSamples) {
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

TEST_F(Replay, NeverWritesOverItsInputs) {
  const std::string before = read_file(log());
  EXPECT_EQ(replay_of({log()}, log()).exit_code, 2);
  EXPECT_EQ(read_file(log()), before);
  const Outcome config = replay_of({log()}, path("own.lcmlog"), false, path("own.lcmlog"));
  EXPECT_EQ(config.exit_code, 2);
  EXPECT_NE(config.err.find("is input and output"), std::string::npos) << config.err;
}

TEST_F(Replay, RefusesAnOutputOfNoKnownFormat) {
  const Outcome o = replay_of({log()}, path("est.xlsx"));
  EXPECT_EQ(o.exit_code, 2);
  EXPECT_NE(o.err.find("must end in .lcmlog, .csv, .csv.gz or .mat"), std::string::npos) << o.err;
  EXPECT_TRUE(own_.names().empty());
}

TEST_F(Replay, CsvIsWhatConvertMakesOfTheLog) {
  ASSERT_EQ(replay_of({log()}, path("est.lcmlog")).exit_code, 0);
  ASSERT_EQ(replay_of({log()}, path("est.csv")).exit_code, 0);
  ConvertArguments to_csv;
  to_csv.inputs = {path("est.lcmlog")};
  to_csv.out = path("converted.csv");
  to_csv.channel = "FRAMEWATCH_ESTIMATE";
  ASSERT_EQ(convert(to_csv), 0);
  EXPECT_GT(read_file(path("est.csv")).size(), 100000u);
  EXPECT_EQ(read_file(path("est.csv")), read_file(path("converted.csv")));
}

TEST_F(Replay, MatHoldsTheValuesOfTheLog) {
  ASSERT_EQ(replay_of({log()}, path("est.lcmlog")).exit_code, 0);
  ASSERT_EQ(replay_of({log()}, path("est.mat")).exit_code, 0);
  ASSERT_EQ(replay_of({log()}, path("again.mat")).exit_code, 0);
  EXPECT_EQ(read_file(path("est.mat")), read_file(path("again.mat")));
  const auto messages = payloads(path("est.lcmlog"), "FRAMEWATCH_ESTIMATE");
  mat_t* file = Mat_Open(path("est.mat").c_str(), MAT_ACC_RDONLY);
  ASSERT_NE(file, nullptr);
  matvar_t* values = Mat_VarRead(file, "value");
  ASSERT_NE(values, nullptr);
  const std::size_t windows = values->dims[0], parameters = values->dims[1];
  ASSERT_EQ(windows, messages.size());
  const auto* data = static_cast<const double*>(values->data);
  int compared = 0;
  for (std::size_t w = 0; w < windows; w += 50) {
    framewatch::window_estimate_t e{};
    ASSERT_GT(e.decode(messages[w].data(), 0, static_cast<int>(messages[w].size())), 0);
    ASSERT_EQ(parameters, e.value.size());
    for (std::size_t p = 0; p < parameters; ++p) {
      const double found = data[p * windows + w];
      EXPECT_TRUE(found == e.value[p] || (std::isnan(found) && std::isnan(e.value[p])));
      compared += !std::isnan(found);
    }
  }
  EXPECT_GT(compared, 50);
  Mat_VarFree(values);
  Mat_Close(file);
}

TEST_F(Replay, CompressedLogGivesTheSameAndACutOneIsRefused) {
  ASSERT_EQ(std::system(("zstd -q " + log() + " -o " + path("rec.lcmlog.zst")).c_str()), 0);
  ASSERT_EQ(replay_of({log()}, path("plain.lcmlog")).exit_code, 0);
  ASSERT_EQ(replay_of({path("rec.lcmlog.zst")}, path("packed.lcmlog")).exit_code, 0);
  EXPECT_EQ(read_file(path("plain.lcmlog")), read_file(path("packed.lcmlog")));
  const std::string bytes = read_file(path("rec.lcmlog.zst"));
  write_file(path("cut.zst"), bytes.substr(0, bytes.size() / 2));
  expect_refused(path("cut.zst"), "the zstd file is cut off at its byte ");
  const Outcome o = salvage_of(path("cut.zst"), path("salvaged.lcmlog"));
  EXPECT_EQ(o.exit_code, 0) << o.err;
}

TEST_F(Replay, SpanIsAsIfTheLogWereCutThere) {
  const std::vector<LogEvent> events = events_of(log());
  LcmLogWriter writer;
  ASSERT_TRUE(writer.open(path("part")));
  for (const LogEvent& e : events) {
    const auto sample = drivers::decode_accel(e.data.data(), e.data.size());
    if (sample &&
        (to_microseconds(sample->time) < 2'000'000 || to_microseconds(sample->time) >= 10'000'000))
      continue;
    ASSERT_TRUE(writer.write(e.timestamp_us, e.channel, e.data.data(), e.data.size()));
  }
  ASSERT_TRUE(writer.close());
  ASSERT_EQ(replay_of({path("part")}, path("of_part.lcmlog")).exit_code, 0);
  ReplayArguments a{test::table_config(), {log()}, path("of_span.lcmlog"), false, true, false};
  a.span = {2, 10};
  ASSERT_EQ(replay(a), 0);
  EXPECT_EQ(read_file(path("of_part.lcmlog")), read_file(path("of_span.lcmlog")));
  a.span = {100, 200};
  testing::internal::CaptureStderr();
  EXPECT_EQ(replay(a), 2);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("no sample of the input lies there"),
            std::string::npos);
}

TEST_F(Replay, PaceDoesNotChangeAByte) {
  ASSERT_EQ(replay_of({log()}, path("fast.lcmlog")).exit_code, 0);
  ReplayArguments a{test::table_config(), {log()}, path("paced.lcmlog"), false, true, false};
  a.speed = 40;
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(replay(a), 0);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  EXPECT_GE(took.count(), 11.9 / 40);
  EXPECT_EQ(read_file(path("fast.lcmlog")), read_file(path("paced.lcmlog")));
}

TEST_F(Replay, RotatedLogsMayBeCutInsideAnInstant) {
  const std::string bytes = read_file(log());
  const auto cut = static_cast<std::size_t>(events_of(log())[5004].offset);
  write_file(path("1"), bytes.substr(0, cut));
  write_file(path("2"), bytes.substr(cut));
  ASSERT_EQ(replay_of({log()}, path("whole.lcmlog")).exit_code, 0);
  const Outcome parts = replay_of({path("1"), path("2")}, path("parts.lcmlog"));
  ASSERT_EQ(parts.exit_code, 0) << parts.err;
  EXPECT_EQ(read_file(path("whole.lcmlog")), read_file(path("parts.lcmlog")));
}

TEST_F(Replay, AFuzzedLogIsRefusedOrSalvagedAndNeverCrashes) {
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

TEST_F(Replay, SaysThatANewerTypeIsOne) {
  rewrite(log(), path("newer"), [](LogEvent& event) {
    if (event.channel == "ACCEL") event.data[0] ^= 0x55;
    return true;
  });
  expect_refused(path("newer"), "a newer framewatch wrote them with a newer accel_t");
}

TEST_F(Replay, RefusesABadConfigurationOrOutput) {
  EXPECT_EQ(replay_of({log()}, path("est.lcmlog"), false, "/nonexistent.toml").exit_code, 2);
  const Outcome o = replay_of({log()}, path("no/such/directory/est.lcmlog"));
  EXPECT_EQ(o.exit_code, 2);
  EXPECT_NE(o.err.find("No such file or directory"), std::string::npos);
}

}  // namespace
}  // namespace framewatch::daemon
