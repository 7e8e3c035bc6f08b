// SPDX-License-Identifier: MIT
#include "daemon/tools/session/session_finish.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/tools/replay/replay_command.h"
#include "daemon/tools/report/session_file.h"
#include "daemon/tools/report/session_motion.h"
#include "drivers/lcm/lcm_log.h"
#include "tests/daemon/tools/session/recorder_bench.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace session_finish_test {

namespace fs = std::filesystem;
using drivers::LcmLogReader;
using drivers::LogEvent;
using drivers::LogRead;

/// A session of a simulated test, recorded with or without its estimates.
std::string recorded(test::RecorderBench& b, bool estimates) {
  const std::string raw = b.directory.path("raw.lcmlog"), est = b.directory.path("est.lcmlog");
  test::record_table_test(raw, 12);
  EXPECT_EQ(replay({test::table_config(), {raw}, est, false, true, false}), 0);
  EXPECT_EQ(b.recorder.begin({"Kobe 10 %", "me", "a <note>"}, 0), "");
  for (const std::string& log : {raw, est}) {
    if (log == est && !estimates) break;
    LcmLogReader reader;
    LogEvent event;
    EXPECT_TRUE(reader.open(log));
    while (reader.next(event) == LogRead::event)
      b.recorder.message(event.channel, event.data.data(), event.data.size(), event.timestamp_us);
  }
  EXPECT_EQ(b.recorder.stop("command", 12'000'000), "");
  b.recorder.tick(13'000'000);
  EXPECT_EQ(b.ended.size(), 1u);
  return b.ended.at(0);
}

TEST(FinishSession, WritesReportAndOtherFormatsInStages) {
  test::RecorderBench b;
  const std::string folder = recorded(b, true);
  EXPECT_EQ(finish_session({test::table_config(), folder, "", true, true, true, true, true}), 0);
  std::string error;
  const auto session = read_session_file(folder + "/session.json", error);
  ASSERT_TRUE(session) << error;
  EXPECT_EQ(session->state, "finished");
  EXPECT_TRUE(session->finishing.empty()) << session->finishing.front();
  ASSERT_FALSE(session->stages.empty());
  const std::string page = test::read_file(folder + "/report.html");
  for (const char* text : {"Kobe 10 %", "a &lt;note&gt;", "polarity (tap test)", "<svg"})
    EXPECT_NE(page.find(text), std::string::npos) << text;
  for (const std::string& file : session->files)
    EXPECT_GT(fs::file_size(folder + "/" + file), 100u) << file;
  for (const char* name : {"raw.csv", "raw.mat", "estimates.csv", "estimates.mat"})
    EXPECT_TRUE(fs::exists(folder + "/" + name)) << name;
  // The joined stages equal the raw log.
  std::size_t samples = 0;
  for (const auto& file : fs::directory_iterator(folder))
    if (file.path().filename().string().starts_with("stage-"))
      samples += test::times_of(file.path().string()).size();
  EXPECT_EQ(samples, test::times_of(folder + "/raw.lcmlog").size());
}

TEST(FinishSession, ComputesMissingEstimates) {
  test::RecorderBench b;
  const std::string folder = recorded(b, false);
  EXPECT_EQ(finish_session({test::table_config(), folder, "", false, false, false, true, true}), 0);
  EXPECT_TRUE(fs::exists(folder + "/estimates-replayed.lcmlog"));
  EXPECT_TRUE(fs::exists(folder + "/report.html"));
  EXPECT_EQ(test::read_file(b.directory.path("est.lcmlog")).size(),
            fs::file_size(folder + "/estimates-replayed.lcmlog"));
}

TEST(FinishSession, KeepsTheLogIfTheReportFails) {
  test::RecorderBench b;
  const std::string folder = recorded(b, true);
  const std::string raw = test::read_file(folder + "/raw.lcmlog");
  EXPECT_EQ(finish_session({test::table_config(), folder, b.directory.path("no/such/folder"), false,
                            false, false, true, true}),
            1);
  EXPECT_EQ(test::read_file(folder + "/raw.lcmlog"), raw);
  std::string error;
  const auto session = read_session_file(folder + "/session.json", error);
  ASSERT_TRUE(session) << error;
  EXPECT_FALSE(session->finishing.empty());
  EXPECT_EQ(session->report, "");
  // Later, with a working disk.
  EXPECT_EQ(finish_session({test::table_config(), folder, "", false, false, false, true, true}), 0);
  EXPECT_TRUE(fs::exists(folder + "/report.html"));
  const auto again = read_session_file(folder + "/session.json", error);
  ASSERT_TRUE(again) << error;
  EXPECT_TRUE(again->finishing.empty());
  EXPECT_EQ(again->files, (std::vector<std::string>{"estimates.lcmlog", "raw.lcmlog"}));
}

TEST(SessionFile, ReadsBackItsTextAndRefusesOthers) {
  SessionFile s;
  s.state = "recorded";
  s.request = {"a \"test\"\n", "me", "ü", 10, 0.2, 5};
  s.stages = {{StageKind::free, 5, 7}};
  s.check.resize(1);
  s.check[0].noise_density = NAN;
  s.files = {"raw.lcmlog"};
  const test::TemporaryDirectory directory;
  const std::string path = directory.path("session.json");
  test::write_file(path, session_json(s));
  std::string error;
  const auto read = read_session_file(path, error);
  ASSERT_TRUE(read) << error;
  EXPECT_EQ(session_json(*read), session_json(s));
  for (const char* text : {"", "{}", "[]", "{\"schema\":\"framewatch.session/2\"}",
                           "{\"schema\":\"framewatch.session/1\"}", "\"x\""}) {
    test::write_file(path, text);
    EXPECT_FALSE(read_session_file(path, error)) << text;
  }
  EXPECT_EQ(session_folder_name(1795292492048061, "El Centro, 30 %/../"),
            "2026-11-21T20-21-32_El-Centro-30");
  EXPECT_EQ(session_folder_name(1795292492048061, "地震"), "2026-11-21T20-21-32");
  EXPECT_EQ(problems(SessionRequest{"t", "o", "n", -1, NAN, 61}).size(), 3u);
}

}  // namespace session_finish_test
}  // namespace framewatch::daemon
