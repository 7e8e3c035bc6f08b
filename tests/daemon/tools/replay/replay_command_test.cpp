// SPDX-License-Identifier: MIT
#include "daemon/tools/replay/replay_command.h"

#include <matio.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include <framewatch/parameter_table_t.hpp>
#include <framewatch/status_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/tools/commands/convert_command.h"
#include "drivers/lcm/accel_codec.h"
#include "drivers/lcm/lcm_log.h"
#include "tests/daemon/tools/replay/replay_fixture.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace replay_command_test {

using drivers::LcmLogWriter;
using drivers::LogEvent;
using test::events_of;
using test::payloads;
using test::read_file;
using test::replay_of;
using test::rewrite;
using test::salvage_of;
using test::write_file;
using Outcome = test::ReplayOutcome;

class Replay : public test::ReplayFixture {};

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

TEST_F(Replay, WritesTheSameCsvAsConvert) {
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

TEST_F(Replay, ReadsACompressedLogAndRefusesATruncatedOne) {
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

TEST_F(Replay, ASpanGivesTheEstimatesOfACutLog) {
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

}  // namespace replay_command_test
}  // namespace framewatch::daemon
