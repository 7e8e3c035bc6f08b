#include "daemon/record_command.h"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <thread>

#include <gtest/gtest.h>

#include "daemon/recorder.h"
#include "daemon/replay_command.h"
#include "daemon/session_finish.h"
#include "daemon/session_motion.h"
#include "drivers/accel_log.h"
#include "drivers/encoded.h"
#include "drivers/lcm_log.h"
#include "drivers/lcm_source.h"
#include "drivers/message_check.h"
#include "tests/support/child.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace {

// Limits.
constexpr std::int64_t kInstant_us = 10'000;          // what a trigger may be late by
constexpr std::int64_t kOverPreTrigger_us = 700'000;  // stored from before the pre-trigger
constexpr double kLostByCrash_s = 1.5;                // at most, of what came before a kill

namespace fs = std::filesystem;
using drivers::LcmLogReader;
using drivers::LogEvent;
using drivers::LogRead;

Config table() {
  std::vector<ConfigProblem> problems;
  auto config = load_config(test::table_config(), problems);
  if (!config) throw std::runtime_error(problems.front().message);
  return *config;
}

/// A recorder without LCM: time is what the messages say.
struct Bench {
  test::TemporaryDirectory directory;
  Config config = table();
  std::vector<std::string> ended;
  Recorder recorder{config, directory.path("sessions"),
                    [this](const std::string& folder) { ended.push_back(folder); }};

  /// Base channels at a level from `from_s` to `to_s`; the rest rests.
  void play(double from_s, double to_s, const std::function<double(double)>& base) {
    for (auto i = std::llround(100 * from_s); i < std::llround(100 * to_s); ++i) {
      const double t = 0.01 * static_cast<double>(i);
      for (std::int32_t node = 0; node < 10; ++node) {
        const double value = node < 2 ? base(t) : 1e-3 * std::sin(40 * t + node);
        const auto bytes =
            drivers::encode_accel({from_microseconds(10'000 * i), i, node, {value, value, NAN}});
        recorder.message("ACCEL", bytes.data(), bytes.size(), 10'000 * i + 500);
      }
      recorder.tick(10'000 * i + 600);
    }
  }
};

std::vector<std::int64_t> times_of(const std::string& log) {
  std::vector<std::int64_t> out;
  LcmLogReader reader;
  LogEvent event;
  EXPECT_TRUE(reader.open(log)) << reader.error();
  std::int64_t number = 0;
  for (auto read = reader.next(event); read != LogRead::end && read != LogRead::error;
       read = reader.next(event)) {
    if (read != LogRead::event) continue;
    EXPECT_EQ(event.number, number++);
    if (const auto t = drivers::accel_time_us(event.data.data(), event.data.size()))
      out.push_back(*t);
  }
  return out;
}

double at_rest(double t) {
  return 1e-3 * std::sin(50 * t);
}

TEST(Recorder, ATriggerBringsTheSecondsBeforeItAndEndsAtItsLength) {
  Bench b;
  b.play(0, 4, at_rest);
  ASSERT_TRUE(b.recorder.checked());
  SessionRequest request{"sweep 1", "me", "", 3, 0.2, 1.5};
  ASSERT_EQ(b.recorder.begin(request, 4'000'000), "");
  EXPECT_EQ(b.recorder.state(), RecorderState::armed);
  b.play(4, 6, at_rest);
  EXPECT_EQ(b.recorder.state(), RecorderState::armed);
  b.play(6, 12, [](double t) { return std::sin(20 * (t - 6)); });
  EXPECT_EQ(b.recorder.state(), RecorderState::waiting);
  ASSERT_EQ(b.ended.size(), 1u);
  EXPECT_NE(b.ended[0].find("_sweep-1"), std::string::npos);
  const auto times = times_of(b.ended[0] + "/raw.lcmlog");
  std::string error;
  const auto session = read_session_file(b.ended[0] + "/session.json", error);
  ASSERT_TRUE(session) << error;
  // 0.2 of a 1 m/s^2 sine of 20 rad/s: 10 ms after 6 s.
  EXPECT_NEAR(static_cast<double>(session->trigger_us), 6'010'000, 2 * kInstant_us);
  EXPECT_LE(times.front(), session->trigger_us - 1'500'000);
  EXPECT_GT(times.front(), session->trigger_us - 1'500'000 - kOverPreTrigger_us);
  EXPECT_GE(times.back(), session->trigger_us + 3'000'000);
  EXPECT_EQ(session->triggered_by, "base-x");
  EXPECT_EQ(session->ended_by, "length");
  EXPECT_EQ(session->messages, static_cast<std::int64_t>(times.size()));
  EXPECT_EQ(session->lost + session->dropped, 0);
  // Every sample of every node in between.
  std::map<std::int64_t, int> nodes;
  for (const std::int64_t t : times) ++nodes[t];
  for (std::int64_t t = times.front() + kInstant_us; t < times.back(); t += kInstant_us)
    EXPECT_EQ(nodes[t], 10) << t;
  EXPECT_NEAR(session->run[0].peak, 1, 0.01);
  EXPECT_LT(session->check[0].peak, 0.01);
}

TEST(Recorder, ATemperatureStandsAmongTheSamples) {
  Bench b;
  b.config.watch.emplace().temperature_channel = "OUTSIDE";
  const auto channels = b.recorder.channels();
  EXPECT_EQ(std::count(channels.begin(), channels.end(), "OUTSIDE"), 1);
  ASSERT_EQ(b.recorder.begin({"t", "me", "", 0, 0, 0}, 0), "");
  b.play(0, 1, at_rest);
  const auto bytes = drivers::encoded(temperature_t{1'000'000, 21.5});
  b.recorder.message("OUTSIDE", bytes.data(), bytes.size(), 1'000'500);
  b.play(1, 2, at_rest);
  ASSERT_EQ(b.recorder.stop("asked", 2'000'000), "");
  b.recorder.tick(10'000'000);
  LcmLogReader reader;
  ASSERT_EQ(b.ended.size(), 1u);
  ASSERT_TRUE(reader.open(b.ended[0] + "/raw.lcmlog"));
  std::int64_t before = 0, after = 0, heard = 0;
  for (LogEvent e; reader.next(e) == LogRead::event;) {
    if (e.channel == "OUTSIDE") ++heard;
    if (e.channel == "ACCEL") ++(heard == 0 ? before : after);
  }
  EXPECT_EQ(heard, 1);
  EXPECT_EQ(before, 1000);
  EXPECT_EQ(after, 1000);
}

TEST(Recorder, CommandsAreObeyedOnceAndRefusedWithAReason) {
  Bench b;
  b.play(0, 4, at_rest);
  session_command_t c{};
  const auto tell = [&](std::int64_t id, const char* verb, double level) {
    c.id = id;
    c.verb = verb;
    c.trigger_mps2 = level;
    b.recorder.obey(c, 4'000'000);
    return b.recorder.status(4'000'000).refused;
  };
  EXPECT_NE(tell(1, "stop", 0), "");
  EXPECT_NE(tell(2, "arm", 0), "");
  EXPECT_NE(tell(3, "explode", 0), "");
  EXPECT_EQ(tell(4, "arm", 0.3), "");
  EXPECT_EQ(b.recorder.state(), RecorderState::armed);
  EXPECT_EQ(tell(5, "stop", 0), "");
  EXPECT_EQ(b.recorder.state(), RecorderState::waiting);
  EXPECT_EQ(tell(6, "start", 0), "");
  EXPECT_EQ(b.recorder.state(), RecorderState::recording);
  EXPECT_NE(tell(7, "start", 0), "");
  EXPECT_NE(tell(8, "tap", 0), "");
  EXPECT_EQ(tell(9, "stop", 0), "");
  EXPECT_EQ(tell(9, "stop", 0), "");  // sent again, not done again
  b.play(4, 5, at_rest);
  EXPECT_EQ(b.recorder.state(), RecorderState::waiting);
  EXPECT_EQ(b.ended.size(), 1u);
  c.notes.assign(5000, 'x');
  EXPECT_NE(tell(10, "start", 0), "");
  EXPECT_EQ(b.recorder.status(0).answered, 10);
}

TEST(Recorder, ATapTestFindsTheReversedChannel) {
  Bench b;
  b.play(0, 4, at_rest);
  ASSERT_EQ(b.recorder.tap(), "");
  b.play(4, 6, [](double t) { return t >= 5 && t < 5.02 ? -1.0 : at_rest(t); });
  // Both base channels felt it alike.
  EXPECT_NE(b.recorder.news().find("next to one sensor"), std::string::npos) << b.recorder.news();
  for (const double at_s : {6.0, 7.0}) {
    for (auto i = std::llround(100 * at_s); i < std::llround(100 * at_s) + 100; ++i)
      for (std::int32_t node = 0; node < 10; ++node) {
        const bool blow = i % 100 == 50 && node == (at_s < 7 ? 0 : 4);
        const double value =
            blow ? (node == 0 ? -2.0 : 2.0) : 1e-3 * std::sin(0.4 * static_cast<double>(i) + node);
        const auto bytes =
            drivers::encode_accel({from_microseconds(10'000 * i), i, node, {value, value, NAN}});
        b.recorder.message("ACCEL", bytes.data(), bytes.size(), 10'000 * i);
      }
  }
  const auto results = b.recorder.channel_results();
  EXPECT_EQ(results[0].polarity, -1);
  EXPECT_NE(results[0].problem.find("reversed"), std::string::npos);
  EXPECT_EQ(results[4].polarity, 1);
  EXPECT_EQ(results[4].problem, "");
  EXPECT_EQ(results[1].polarity, 0);
}

/// A session of a simulated test, recorded with or without its estimates.
std::string recorded(Bench& b, bool estimates) {
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

TEST(FinishSession, StagesReportAndOtherFormats) {
  Bench b;
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
  // The stages together are the raw log.
  std::size_t samples = 0;
  for (const auto& file : fs::directory_iterator(folder))
    if (file.path().filename().string().starts_with("stage-"))
      samples += times_of(file.path().string()).size();
  EXPECT_EQ(samples, times_of(folder + "/raw.lcmlog").size());
}

TEST(FinishSession, MissingEstimatesAreMadeAgain) {
  Bench b;
  const std::string folder = recorded(b, false);
  EXPECT_EQ(finish_session({test::table_config(), folder, "", false, false, false, true, true}), 0);
  EXPECT_TRUE(fs::exists(folder + "/estimates-replayed.lcmlog"));
  EXPECT_TRUE(fs::exists(folder + "/report.html"));
  EXPECT_EQ(test::read_file(b.directory.path("est.lcmlog")).size(),
            fs::file_size(folder + "/estimates-replayed.lcmlog"));
}

TEST(FinishSession, AReportThatCannotBeWrittenCostsNoLog) {
  Bench b;
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
  // Later, with a disk.
  EXPECT_EQ(finish_session({test::table_config(), folder, "", false, false, false, true, true}), 0);
  EXPECT_TRUE(fs::exists(folder + "/report.html"));
  const auto again = read_session_file(folder + "/session.json", error);
  ASSERT_TRUE(again) << error;
  EXPECT_TRUE(again->finishing.empty());
  EXPECT_EQ(again->files, (std::vector<std::string>{"estimates.lcmlog", "raw.lcmlog"}));
}

TEST(SessionFile, ReadsWhatItWritesAndRefusesWhatIsNone) {
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

/// Three processes over LCM; `during` happens in the middle of the recording.
struct LiveSession {
  test::TemporaryDirectory directory;
  std::string folder;
  int exit_code = -1;

  LiveSession(const std::vector<std::string>& options,
              const std::function<void(test::Child& estimator, test::Child& recorder)>& during) {
    test::Child estimator({FRAMEWATCH_PROGRAM, "run", test::table_config(), "--quiet"});
    std::vector<std::string> command{FRAMEWATCH_PROGRAM,         "record",
                                     test::table_config(),       "--out",
                                     directory.path("sessions"), "--quiet"};
    command.insert(command.end(), options.begin(), options.end());
    test::Child recorder(command);
    test::Child building({FRAMEWATCH_PROGRAM, "simulate",
                          FRAMEWATCH_SOURCE_DIR "/configs/scenario_table_two_story.toml", "--lcm",
                          "--seconds", "24", "--speed", "2", "--quiet"});
    std::this_thread::sleep_for(std::chrono::seconds(3));
    during(estimator, recorder);
    exit_code = recorder.wait();
    for (const auto& entry : fs::directory_iterator(directory.path("sessions")))
      if (entry.is_directory()) folder = entry.path().string();
    building.stop(SIGINT);
    estimator.stop(SIGKILL);
  }
};

bool no_multicast(std::string& error) {
  if (const char* reason = std::getenv("FRAMEWATCH_NO_MULTICAST")) error = reason;
  return !error.empty() || !drivers::open_lcm(table().lcm.url, 1 << 20, error);
}

/// Samples of one node that are missing between the first and the last.
std::int64_t gaps_in(const std::vector<std::int64_t>& times) {
  const std::map<std::int64_t, int> nodes = [&] {
    std::map<std::int64_t, int> count;
    for (const std::int64_t t : times) ++count[t];
    return count;
  }();
  std::int64_t missing = 0;
  for (auto at = std::next(nodes.begin()); at != nodes.end(); ++at)
    missing += (at->first - std::prev(at)->first) / kInstant_us - 1;
  return missing;
}

TEST(Record, TheEstimatorsDeathCostsNoSample) {
  std::string why;
  if (no_multicast(why)) GTEST_SKIP() << why;
  const LiveSession live({"--no-check", "--seconds", "14"},
                         [](test::Child& estimator, test::Child&) { estimator.stop(SIGKILL); });
  EXPECT_EQ(live.exit_code, 0);
  const auto times = times_of(live.folder + "/raw.lcmlog");
  EXPECT_GT(times.size(), 13000u);
  EXPECT_EQ(gaps_in(times), 0);
  // The report is there all the same.
  EXPECT_TRUE(fs::exists(live.folder + "/estimates-replayed.lcmlog"));
  EXPECT_TRUE(fs::exists(live.folder + "/report.html"));
}

TEST(Record, ARecorderThatIsKilledLeavesAllButTheLastSecond) {
  std::string why;
  if (no_multicast(why)) GTEST_SKIP() << why;
  std::int64_t killed_us = 0;
  const LiveSession live({"--no-check", "--seconds", "100"},
                         [&](test::Child&, test::Child& recorder) {
                           killed_us = std::chrono::duration_cast<std::chrono::microseconds>(
                                           std::chrono::system_clock::now().time_since_epoch())
                                           .count();
                           recorder.signal(SIGKILL);
                         });
  EXPECT_EQ(live.exit_code, 128 + SIGKILL);
  EXPECT_FALSE(fs::exists(live.folder + "/raw.lcmlog"));
  EXPECT_EQ(
      finish_session({test::table_config(), live.folder, "", false, false, false, true, true}), 0);
  LcmLogReader reader;
  ASSERT_TRUE(reader.open(live.folder + "/raw.lcmlog"));
  LogEvent event;
  std::int64_t last_us = 0;
  while (reader.next(event) == LogRead::event) last_us = event.timestamp_us;
  EXPECT_GT(static_cast<double>(last_us), static_cast<double>(killed_us) - 1e6 * kLostByCrash_s);
  EXPECT_EQ(gaps_in(times_of(live.folder + "/raw.lcmlog")), 0);
  EXPECT_TRUE(fs::exists(live.folder + "/report.html"));
}

TEST(Record, AnswersToCommandsFromAnotherTerminal) {
  std::string why;
  if (no_multicast(why)) GTEST_SKIP() << why;
  const auto send = [](const char* verb) {
    return test::Child({FRAMEWATCH_PROGRAM, "record", test::table_config(), "--send", verb}).wait();
  };
  EXPECT_EQ(send("start"), 1);  // nobody there
  const LiveSession live({"--standby", "--no-report"}, [&](test::Child&, test::Child& recorder) {
    EXPECT_EQ(send("stop"), 1);
    EXPECT_EQ(send("start"), 0);
    std::this_thread::sleep_for(std::chrono::seconds(1));
    EXPECT_EQ(send("start"), 1);
    EXPECT_EQ(send("stop"), 0);
    std::this_thread::sleep_for(std::chrono::seconds(2));
    recorder.signal(SIGTERM);
  });
  EXPECT_EQ(live.exit_code, 0);
  EXPECT_GT(times_of(live.folder + "/raw.lcmlog").size(), 1000u);
}

TEST(Record, RefusesWhatCannotBe) {
  RecordArguments a;
  a.config = "/nonexistent.toml";
  EXPECT_EQ(record(a), 2);
  a.config = test::table_config();
  a.request.length_s = -1;
  EXPECT_EQ(record(a), 2);
  a.request.length_s = 0;
  a.url = "bogus://";
  EXPECT_EQ(record(a), 2);
  a.finish = "/nonexistent";
  EXPECT_EQ(record(a), 2);
}

}  // namespace
}  // namespace framewatch::daemon
