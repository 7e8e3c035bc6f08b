// SPDX-License-Identifier: MIT
#include "daemon/page/web/session_playback.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <framewatch/accel_t.hpp>
#include <framewatch/parameter_table_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/page/view/page_watch.h"
#include "daemon/tools/report/session_file.h"
#include "daemon/tools/session/recorder.h"
#include "daemon/tools/session/session_finish.h"
#include "drivers/files/encoded.h"
#include "tests/daemon/page/web/served.h"
#include "tests/support/can_traffic.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace session_playback_test {

constexpr std::int64_t kHost_us = 1'700'000'000'000'000, kSecond = 1'000'000;
constexpr int kSeconds = 6;
constexpr double kCanStep_mps2 = 0.0006;  // half a count of the frames

/// One event of the played text.
struct Played {
  double at_s;  ///< of the newest "time"
  std::string name;
  nlohmann::json data;
};

std::vector<Played> played(SessionPlayback& playback, std::size_t part = 1000) {
  std::string text, buffer(part, '\0');
  for (std::size_t got; (got = playback.read(buffer.data(), part)) > 0;)
    text.append(buffer, 0, got);
  std::vector<Played> out;
  double at_s = 0;
  for (std::size_t from = 0, to; (to = text.find("\n\n", from)) != std::string::npos;
       from = to + 2) {
    const std::string event = text.substr(from, to - from);
    if (!event.starts_with("event: ")) continue;
    const std::size_t line = event.find("\ndata: ");
    const std::string name = event.substr(7, line - 7);
    const auto data = nlohmann::json::parse(event.substr(line + 7));
    if (name == "time") at_s = data;
    out.push_back({at_s, name, data});
  }
  return out;
}

template <typename Message>
void append(std::string& log, std::int64_t at_us, const std::string& channel,
            const Message& message) {
  const std::vector<std::uint8_t> bytes = drivers::encoded(message);
  drivers::append_log_event(log, 0, at_us, channel, bytes.data(), bytes.size());
}

/// Node 2 of kGoodConfig, which moves as a sine, and an estimate each second. The host's clock is 2
/// s behind the sensors'.
struct Recorded {
  Recorded() : config(test::good(test::kGoodConfig)) {
    for (int i = 0; i < 100 * kSeconds; ++i) {
      accel_t sample{};
      sample.time_us = kHost_us + 2 * kSecond + 10'000 * i;
      sample.sequence = i;
      sample.node = 2;
      sample.accel_abs_mps2[0] = std::sin(0.1 * i);
      append(raw, kHost_us + 10'000 * i, "ACCEL", sample);
    }
    parameter_table_t table{};
    table.name = parameter_names(config);
    const std::size_t n = table.name.size();
    table.parameters = static_cast<std::int32_t>(n);
    table.kind.assign(n, 0);
    table.unit.assign(n, "N/m");
    table.story.assign(n, 1);
    table.design.assign(n, 1.0);
    append(estimates, kHost_us, "FRAMEWATCH_PARAMETERS", table);
    for (int s = 1; s <= kSeconds; ++s) {
      window_estimate_t e{};
      e.window_end_us = kHost_us + (s + 2) * kSecond;
      e.parameters = static_cast<std::int32_t>(n);
      e.status = 1;
      e.reason.assign(n, 0);
      e.value.assign(n, 1000.0 + s);
      e.std_error.assign(n, 1.0);
      e.snr = e.prior_share = e.noise_share = std::vector<float>(n, 1.0f);
      append(estimates, kHost_us + s * kSecond - 1, "FRAMEWATCH_ESTIMATE", e);
    }
    session.state = "finished";
    session.request.test = "sine";
    session.config_sha256 = config.sha256;
    session.trigger_us = kHost_us + 2 * kSecond;
    session.end_us = session.trigger_us + kSeconds * kSecond;
    for (const estimator::SensorAxis& axis : config.pipeline.axes)
      session.run.emplace_back().name = axis.name;
  }
  void write() const {
    std::filesystem::create_directories(folder + "/a");
    test::write_file(folder + "/a/session.json", session_json(session));
    test::write_file(folder + "/a/raw.lcmlog", raw);
    test::write_file(folder + "/a/estimates.lcmlog", estimates);
  }
  std::unique_ptr<SessionPlayback> open(const std::string& name = "a") {
    return SessionPlayback::open(config, folder, name, why);
  }
  /// Returns why the session is refused; empty if it is shown.
  std::string refusal(const std::string& name = "a") {
    why.clear();
    return open(name) ? "" : why;
  }

  const test::TemporaryDirectory directory;
  const std::string folder = directory.path("sessions");
  Config config;
  SessionFile session;
  std::string raw, estimates, why;
};

TEST(SessionPlayback, GivesTheEventsOfTheLivePageInTheirTime) {
  Recorded r;
  r.write();
  const auto playback = r.open();
  ASSERT_TRUE(playback) << r.why;
  const std::vector<Played> events = played(*playback);
  ASSERT_GT(events.size(), 10u);
  EXPECT_EQ(events.front().name, "begin");
  EXPECT_EQ(events.front().data["test"], "sine");
  EXPECT_EQ(events.front().data["seconds"], kSeconds);
  EXPECT_EQ(events.front().data["same_config"], true);
  EXPECT_EQ(events.back().name, "end");
  EXPECT_TRUE(events.back().data["notes"].empty()) << events.back().data;
  int rows = 0, estimates = 0;
  for (const Played& e : events) {
    if (e.name == "motion")
      for (const auto& row : e.data["rows"]) {
        const double t_s =
            1e-6 * static_cast<double>(e.data["first_us"].get<std::int64_t>() +
                                       row[0].get<std::int64_t>() - kHost_us - 2 * kSecond);
        EXPECT_NEAR(row[1][2].get<double>(), std::sin(0.1 * std::round(100 * t_s)), 1e-4);
        EXPECT_LT(t_s, e.at_s + 0.01);
        EXPECT_GT(t_s, e.at_s - 1);
        ++rows;
      }
    if (e.name != "estimate") continue;
    ++estimates;
    EXPECT_EQ(e.data["value"][0], 1000 + estimates);
    EXPECT_NEAR(e.at_s, estimates, 0.06);
  }
  EXPECT_GT(rows, 100 * kSeconds - 110);
  EXPECT_EQ(estimates, kSeconds);
}

TEST(SessionPlayback, IsTheSameInPartsOfAnySize) {
  Recorded r;
  r.write();
  const auto whole = r.open(), bytewise = r.open();
  const std::vector<Played> a = played(*whole, 1 << 20), b = played(*bytewise, 1);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].data, b[i].data);
}

TEST(SessionPlayback, NamesWhereARecordingIsCutOff) {
  Recorded r;
  r.raw.resize(r.raw.size() / 2 + 7);
  r.write();
  const auto playback = r.open();
  ASSERT_TRUE(playback) << r.why;
  const std::vector<Played> events = played(*playback);
  ASSERT_EQ(events.back().name, "end");
  ASSERT_EQ(events.back().data["notes"].size(), 1u) << events.back().data;
  const std::string note = events.back().data["notes"][0];
  EXPECT_NE(note.find("raw.lcmlog: byte"), std::string::npos) << note;
  EXPECT_NE(note.find("cut off"), std::string::npos) << note;
}

TEST(SessionPlayback, ShowsALongPauseAsAShortOne) {
  Recorded r;
  accel_t late{};
  late.node = 2;
  late.sequence = 100 * kSeconds;
  late.time_us = kHost_us + 3600 * kSecond;
  append(r.raw, kHost_us + 3600 * kSecond, "ACCEL", late);
  r.write();
  const std::vector<Played> events = played(*r.open());
  EXPECT_LT(events.back().at_s, kSeconds + 11);
}

TEST(SessionPlayback, RefusesAnEmptySession) {
  Recorded r;
  r.raw.clear();
  r.write();
  EXPECT_EQ(r.refusal(), "it holds no samples");
  std::filesystem::remove(r.folder + "/a/raw.lcmlog");
  EXPECT_NE(r.refusal().find("it has no raw.lcmlog or raw.can.log that can be read"),
            std::string::npos);
  test::write_file(r.folder + "/a/raw.lcmlog", "this is no log");
  EXPECT_NE(r.refusal().find("it has no raw.lcmlog or raw.can.log that can be read"),
            std::string::npos);
}

TEST(SessionPlayback, RefusesAnotherBuilding) {
  Recorded r;
  r.session.config_sha256 = "other";
  r.write();
  const auto changed = r.open();
  ASSERT_TRUE(changed) << "the same building with another configuration: " << r.why;
  EXPECT_EQ(played(*changed).front().data["same_config"], false);
  r.session.run[2].name = "roof";
  r.write();
  EXPECT_EQ(r.refusal(),
            "this session is of another building: of its channels, this page lacks roof; of the "
            "channels of this page, the session lacks F1-Y1. Open it with framewatch serve and its "
            "own configuration");
  r.session.run.clear();
  parameter_table_t table{};
  table.name = {"kx_1_y7"};
  table.parameters = 1;
  table.kind = {0};
  table.unit = {"N/m"};
  table.story = {1};
  table.design = {1};
  r.estimates.clear();
  append(r.estimates, kHost_us, "FRAMEWATCH_PARAMETERS", table);
  r.write();
  EXPECT_NE(r.refusal().find("of its parameters, this page lacks kx_1_y7; of"), std::string::npos);
}

TEST(SessionPlayback, RefusesWhatIsNoFinishedSessionOfTheFolder) {
  Recorded r;
  r.session.state = "recording";
  r.write();
  EXPECT_NE(r.refusal().find("--finish"), std::string::npos);
  test::write_file(r.folder + "/a/session.json", "{");
  EXPECT_NE(r.refusal().find("its session.json cannot be read"), std::string::npos);
  r.session.state = "finished";
  r.write();
  ASSERT_EQ(r.refusal(), "");
  for (const char* name : {"", ".", "..", "../sessions/a", "a/", "b"})
    EXPECT_EQ(r.refusal(name), "there is no such session") << name;
  namespace fs = std::filesystem;
  fs::create_directory_symlink("a", r.folder + "/c");
  EXPECT_EQ(r.refusal("c"), "there is no such session");
  fs::rename(r.folder + "/a/raw.lcmlog", r.folder + "/elsewhere");
  fs::create_symlink("../elsewhere", r.folder + "/a/raw.lcmlog");
  EXPECT_NE(r.refusal().find("it has no raw.lcmlog or raw.can.log that can be read"),
            std::string::npos);
}

/// A session of 8 s of the CAN tower, whose channels move as can_wave(), recorded and finished.
struct RecordedCan {
  RecordedCan() {
    Recorder recorder(config, folder,
                      [&](const std::string& ended) { session = ended.substr(folder.size() + 1); });
    EXPECT_EQ(recorder.begin({"CAN", "", ""}, test::kTrafficStart_us), "");
    for (const drivers::BusFrame& f : test::can_traffic(config, 100 * kSeconds)) {
      recorder.frame(f.bus, f.frame);
      recorder.tick(f.frame.stamp_us);
    }
    const std::int64_t end_us = test::kTrafficStart_us + kSeconds * kSecond;
    EXPECT_EQ(recorder.stop("command", end_us), "");
    recorder.tick(end_us + kSecond);
    FinishArguments finish;
    finish.config = config.path;
    finish.folder = folder + "/" + session;
    finish.report = false;
    finish.quiet = true;
    EXPECT_EQ(finish_session(finish), 0);
  }
  std::unique_ptr<SessionPlayback> open(const Config& of) {
    return SessionPlayback::open(of, folder, session, why);
  }

  static constexpr int kSeconds = 8;
  const test::TemporaryDirectory directory;
  const std::string folder = directory.path("sessions");
  const Config config = test::can_example("tower");
  std::string session, why;
};

TEST(SessionPlayback, PlaysFramesOfCan) {
  RecordedCan r;
  const auto playback = r.open(r.config);
  ASSERT_TRUE(playback) << r.why;
  int rows = 0, estimates = 0;
  for (const Played& e : played(*playback)) {
    if (e.name == "end") {
      EXPECT_TRUE(e.data["notes"].empty()) << e.data;
    }
    estimates += e.name == "estimate";
    if (e.name != "motion") continue;
    for (const auto& row : e.data["rows"]) {
      const double t_s =
          1e-6 * static_cast<double>(e.data["first_us"].get<std::int64_t>() +
                                     row[0].get<std::int64_t>() - test::kTrafficStart_us);
      for (std::size_t a = 0; a < r.config.pipeline.axes.size(); ++a)
        EXPECT_NEAR(row[1][a].get<double>(), test::can_wave(a, 0.01 * std::round(100 * t_s)),
                    kCanStep_mps2);
      EXPECT_NEAR(t_s, e.at_s, 1);
      ++rows;
    }
  }
  EXPECT_GT(rows, 100 * (RecordedCan::kSeconds - 1));
  EXPECT_GT(estimates, 0);
}

TEST(SessionPlayback, NamesWhereALogOfFramesIsDamagedOrCutOff) {
  RecordedCan r;
  const std::string log = r.folder + "/" + r.session + "/raw.can.log";
  std::filesystem::resize_file(log, std::filesystem::file_size(log) - 3);
  std::fstream(log, std::ios::in | std::ios::out).put('?');
  const std::vector<Played> events = played(*r.open(r.config));
  const auto& notes = events.back().data["notes"];
  ASSERT_EQ(notes.size(), 2u) << notes;
  EXPECT_EQ(notes[0].get<std::string>().find("raw.can.log:1: the line does not begin with"), 0u)
      << notes;
  EXPECT_NE(notes[1].get<std::string>().find("cut off: left out"), std::string::npos) << notes;
}

TEST(SessionPlayback, RefusesFramesThatItCannotRead) {
  RecordedCan r;
  Config without = r.config;
  without.can = {};
  EXPECT_FALSE(r.open(without));
  EXPECT_NE(r.why.find("the page's configuration has no [[can]]"), std::string::npos) << r.why;
  test::write_file(r.folder + "/" + r.session + "/raw.can.log", "");
  EXPECT_FALSE(r.open(r.config));
  EXPECT_EQ(r.why, "it holds no samples");
}

class PlaybackServed : public test::Served {
 protected:
  PlaybackServed() : test::Served(with_sessions()) {}
  static WebSettings with_sessions() {
    static const Recorded recorded;
    recorded.write();
    WebSettings s = settings();
    s.sessions = recorded.folder;
    return s;
  }
};

TEST_F(PlaybackServed, IsServedToPagesOfThisMachineOnly) {
  const auto get = [&](const std::string& path, const std::string& host = "localhost") {
    return test::ask(server_.port(), "GET " + path + " HTTP/1.1\r\nHost: " + host +
                                         "\r\nConnection: close\r\n\r\n");
  };
  const std::string all = get("/session/a/playback");
  EXPECT_EQ(all.find("HTTP/1.1 200"), 0u) << all.substr(0, 300);
  EXPECT_NE(all.find("Content-Security-Policy: default-src 'none'; script-src 'self'"),
            std::string::npos);
  EXPECT_NE(all.find("event: begin"), std::string::npos);
  EXPECT_NE(all.find("event: end"), std::string::npos);
  EXPECT_EQ(get("/session/b/playback").find("HTTP/1.1 409"), 0u);
  EXPECT_NE(get("/session/%2e%2e/playback").find("there is no such session"), std::string::npos);
  EXPECT_EQ(get("/session/a/playback", "evil.example").find("HTTP/1.1 421"), 0u);
}

}  // namespace session_playback_test
}  // namespace framewatch::daemon
