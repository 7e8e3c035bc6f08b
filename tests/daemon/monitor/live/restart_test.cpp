// SPDX-License-Identifier: MIT
// Kills and restarts a daemon during an earthquake. Its report must have the peaks of the time
// before, from the raw samples of its history, and first name the time without samples.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "daemon/monitor/estimation/estimation.h"
#include "daemon/monitor/estimation/state_file.h"
#include "daemon/monitor/event_report/event_report_files.h"
#include "daemon/monitor/history/history.h"
#include "daemon/monitor/live/live_estimation.h"
#include "daemon/monitor/live/raw_backlog.h"
#include "daemon/page/findings/shaking.h"
#include "daemon/tools/simulation/simulate_command.h"
#include "drivers/lcm/accel_intake.h"
#include "drivers/lcm/lcm_log.h"
#include "estimator/motion/acquisition.h"
#include "estimator/pipeline/pipeline.h"
#include "estimator/shaking/story_drift.h"
#include "estimator/shaking/story_response.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace restart_test {

// Limits.
constexpr double kSame = 1e-3;  // relative, of peaks before the kill: raw samples are rounded

constexpr double kStrong_s = 14, kShaken_s = 26, kSeconds = 48;
constexpr double kStateAge_s = 2.5, kAfterPeak_s = 1, kAway_s = 4;

using Json = nlohmann::json;

double seconds(std::int64_t us) {
  return 1e-6 * static_cast<double>(us);
}

/// The demo's table in a simulated earthquake, as a log of messages.
class Restart : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    directory_ = new test::TemporaryDirectory;
    const std::string configs = std::string(FRAMEWATCH_SOURCE_DIR) + "/configs/";
    std::string scenario = test::read_file(configs + "scenario_table_two_story.toml");
    const auto set = [&](const std::string& what, const std::string& by) {
      const std::size_t at = scenario.find(what);
      ASSERT_NE(at, std::string::npos) << what;
      scenario.replace(at, what.size(), by);
    };
    set("\"table_two_story.toml\"", "\"" + configs + "table_two_story.toml\"");
    set("length_s = 3600.0", "length_s = " + std::to_string(kShaken_s));
    set("strong_s = 100000.0", "strong_s = " + std::to_string(kStrong_s));
    test::write_file(path("scenario.toml"), scenario);
    SimulateArguments s;
    s.scenario = path("scenario.toml");
    s.out = path("rec.lcmlog");
    s.seconds = kSeconds;
    s.quiet = true;
    ASSERT_EQ(simulate(s), 0);
    drivers::LcmLogReader reader;
    ASSERT_TRUE(reader.open(path("rec.lcmlog")));
    drivers::LogEvent event;
    while (reader.next(event) == drivers::LogRead::event) messages_.push_back(event);
    ASSERT_FALSE(messages_.empty());
    find_peaks();
  }
  static void TearDownTestSuite() {
    delete directory_;
    messages_.clear();
  }
  static const std::vector<drivers::LogEvent>& messages() { return messages_; }
  static std::string path(const std::string& name) { return directory_->path(name); }
  static double at_s(const drivers::LogEvent& e) {
    return seconds(e.timestamp_us - messages_.front().timestamp_us);
  }

  /// Returns the configuration of one case, whose reports and history are in folders of its name.
  static Config config_of(const std::string& name, bool history) {
    test::write_file(path(name + ".toml"),
                     test::read_file(test::table_config()) + "\n[event_report]\ndirectory = \"" +
                         name + "\"\nquiet_s = 10\n" +
                         (history ? "[history]\ndirectory = \"" + name + "-history\"\n" : ""));
    std::vector<ConfigProblem> problems;
    const auto config = load_config(path(name + ".toml"), problems);
    EXPECT_TRUE(config) << (problems.empty() ? "" : problems.front().message);
    return *config;
  }
  static void feed(LiveEstimation& live, drivers::LcmProvider& lcm, double from_s, double to_s,
                   const std::function<void(double)>& passed = {}) {
    for (const drivers::LogEvent& e : messages_) {
      if (at_s(e) < from_s) continue;
      if (at_s(e) >= to_s) break;
      if (passed) passed(at_s(e));
      lcm.publish(e.channel, e.data.data(), static_cast<unsigned>(e.data.size()));
      ASSERT_TRUE(live.poll(0));
    }
    while (live.catching_up()) ASSERT_TRUE(live.poll(0));
  }
  struct Reports {
    std::vector<Json> json;
    std::vector<std::string> html;
    std::vector<event_t> events;
  };
  static Reports reports_of(const std::string& name) {
    Reports out;
    for (const std::string& report : event_report_names(path(name))) {
      out.json.push_back(Json::parse(test::read_file(path(name + "/" + report + ".json"))));
      out.html.push_back(test::read_file(path(name + "/" + report + ".html")));
    }
    return out;
  }
  static Reports uninterrupted() {
    if (event_report_names(path("whole")).empty()) {
      const Config config = config_of("whole", false);
      drivers::LcmProvider lcm("memq://");
      LiveEstimation live(config, lcm);
      feed(live, lcm, 0, kSeconds);
    }
    return reports_of("whole");
  }
  struct How {
    bool state = true, history = true;
    double away_s = kAway_s;
  };
  /// Kills the daemon kAfterPeak_s after the last peak; its last state is kStateAge_s old then.
  static Reports restarted(const std::string& name, const How& how) {
    const Config config = config_of(name, how.history);
    const double killed_s = last_peak_s_ + kAfterPeak_s;
    {
      drivers::LcmProvider lcm("memq://");
      LiveEstimation live(config, lcm);
      std::optional<History> history;
      if (how.history) live.record_to(&history.emplace(config));
      bool saved = false;
      feed(live, lcm, 0, killed_s, [&](double now_s) {
        if (saved || now_s < killed_s - kStateAge_s) return;
        saved = true;
        ASSERT_EQ(write_state(path(name + ".state"), saved_state(config, live.estimation(), 0)),
                  "");
      });
    }
    Reports out;
    {
      drivers::LcmProvider lcm("memq://");
      LiveEstimation live(config, lcm);
      if (how.state) {
        bool touched = false;
        EXPECT_EQ(load_state(path(name + ".state"), config, live.estimation(), touched).problem,
                  "");
      }
      std::vector<std::string> notes;
      RawBacklog backlog =
          RawBacklog::read(config, live.estimation().newest_us(), how.state, notes);
      EXPECT_TRUE(notes.empty()) << notes.front();
      EXPECT_EQ(backlog.empty(), !how.history);
      std::optional<History> history;
      if (how.history) live.record_to(&history.emplace(config));
      live.catch_up(std::move(backlog));
      feed(live, lcm, killed_s + how.away_s, kSeconds);
      for (const event_t& e : live.take_events())
        if (e.kind == "strong_motion") out.events.push_back(e);
    }
    Reports written = reports_of(name);
    written.events = out.events;
    return written;
  }
  static double drift(const Json& report) {
    double most = 0;
    for (const Json& story : report["stories"])
      if (story["peak_drift_ratio"].is_number())
        most = std::max(most, story["peak_drift_ratio"].get<double>());
    return most;
  }
  static double force(const Json& report) { return report["base_shear_n"]["x"].get<double>(); }
  static void print(const char* what, const Json& report) {
    std::printf("%s: drift %.4f %%, force %.1f N\n", what, 100 * drift(report), force(report));
  }
  static void expect_same_peaks(const Json& report, const Json& whole) {
    EXPECT_NEAR(drift(report) / drift(whole), 1, kSame);
    EXPECT_NEAR(force(report) / force(whole), 1, kSame);
  }

 private:
  /// Finds the time after which both the largest drift and the largest force have occurred.
  static void find_peaks() {
    const Config config = config_of("peaks", false);
    double drift = 0, force = 0;
    std::optional<estimator::StoryResponse> response;
    std::int64_t first_us = 0;
    estimator::Acquisition acquisition(config.pipeline.axes, config.pipeline.options);
    const auto take = [&](estimator::Acquisition::SampleSets&& sets) {
      for (const estimator::SampleSet& set : sets) {
        if (first_us == 0) first_us = to_microseconds(set.time);
        response->push(set);
        double largest = 0;
        for (const double d : response->drift_m())
          if (std::isfinite(d)) largest = std::max(largest, std::abs(d));
        const double shear = std::abs(response->base_shear_n()[0]);
        if (largest <= drift && !(shear > force)) continue;
        drift = std::max(drift, largest);
        if (shear > force) force = shear;
        last_peak_s_ = seconds(to_microseconds(set.time) - first_us);
      }
    };
    estimator::PipelineConfig pipeline = config.pipeline;
    pipeline.axes = acquisition.axes();
    response.emplace(pipeline);
    drivers::AccelIntake intake(
        wanted_axes(config), [&](const estimator::AccelSample& s) { take(acquisition.push(s)); },
        intake_settings(config));
    for (const drivers::LogEvent& e : messages_)
      (void)intake.message(e.channel, e.data.data(), e.data.size());
    take(acquisition.finish());
    ASSERT_GT(last_peak_s_, kStateAge_s);
    ASSERT_LT(last_peak_s_, kShaken_s - 2 * kAway_s);
  }

  inline static test::TemporaryDirectory* directory_ = nullptr;
  inline static std::vector<drivers::LogEvent> messages_;
  inline static double last_peak_s_ = 0;
};

TEST_F(Restart, TheReportHasPeaksThatTheStateLacks) {
  const Reports whole = uninterrupted(), r = restarted("restarted", {});
  ASSERT_EQ(whole.json.size(), 1u);
  ASSERT_EQ(r.json.size(), 1u);
  EXPECT_TRUE(whole.json[0]["unheard"].empty());
  print("never stopped", whole.json[0]);
  print("killed, with state and history", r.json[0]);
  expect_same_peaks(r.json[0], whole.json[0]);
  EXPECT_EQ(r.json[0]["start_us"], whole.json[0]["start_us"]);
  EXPECT_NEAR(seconds(r.json[0]["end_us"].get<std::int64_t>() -
                      whole.json[0]["end_us"].get<std::int64_t>()),
              0, 0.02);
  ASSERT_EQ(r.json[0]["unheard"].size(), 1u);
  const Json& unheard = r.json[0]["unheard"][0];
  EXPECT_EQ(unheard["why"], "restart");
  EXPECT_NEAR(unheard["seconds"].get<double>(), kAway_s, 0.5);
  EXPECT_EQ(unheard["message"].get<std::string>().find("Nobody listened from "), 0u) << unheard;
  EXPECT_NE(r.json[0]["verdict"], "green");
  // It stands before everything else.
  const std::size_t said = r.html[0].find("Nobody listened from "),
                    story = r.html[0].find("strong motion of");
  ASSERT_NE(said, std::string::npos);
  EXPECT_LT(said, story);
  EXPECT_EQ(whole.html[0].find("Nobody listened"), std::string::npos);
  ASSERT_EQ(r.events.size(), 1u);
  EXPECT_NE(r.events[0].message.find("were not heard"), std::string::npos) << r.events[0].message;
}

TEST_F(Restart, StoredSamplesSufficeWithoutAState) {
  const Reports whole = uninterrupted(), r = restarted("stateless", {.state = false});
  ASSERT_EQ(whole.json.size(), 1u);
  ASSERT_EQ(r.json.size(), 1u);
  print("killed, with history alone", r.json[0]);
  expect_same_peaks(r.json[0], whole.json[0]);
  EXPECT_EQ(r.json[0]["unheard"].size(), 1u);
  EXPECT_EQ(r.json[0]["unheard"][0]["why"], "restart");
}

TEST_F(Restart, TheReportSaysThatSamplesAreLostWithoutAHistory) {
  const Reports r = restarted("forgetful", {.history = false});
  ASSERT_EQ(r.json.size(), 1u);
  print("killed, with a state alone", r.json[0]);
  const Json& unheard = r.json[0]["unheard"][0];
  EXPECT_EQ(unheard["why"], "restart_without_raw_samples");
  EXPECT_NEAR(unheard["seconds"].get<double>(), kAway_s + kStateAge_s, 0.5);
  EXPECT_NE(unheard["message"].get<std::string>().find("[history]"), std::string::npos) << unheard;
}

TEST_F(Restart, TheReportSaysThatTheDaemonStartedLateWithoutStoredSamples) {
  const Reports r = restarted("nothing", {.state = false, .history = false});
  ASSERT_EQ(r.json.size(), 1u);
  const Json& unheard = r.json[0]["unheard"][0];
  EXPECT_TRUE(unheard["from_us"].is_null());
  EXPECT_EQ(unheard["message"].get<std::string>().find("Nobody listened before "), 0u) << unheard;
}

TEST_F(Restart, ALongAbsenceDoesNotEndTheMotion) {
  // Longer than quiet_s: it is still the same motion, which ends only after a calm time with
  // samples.
  const Reports r = restarted("long", {.away_s = 12});
  ASSERT_EQ(r.json.size(), 1u);
  EXPECT_NEAR(r.json[0]["unheard"][0]["seconds"].get<double>(), 12, 0.5);
}

TEST_F(Restart, ThePageHasTheSamePeaks) {
  const Reports r = restarted("page", {});
  ASSERT_EQ(r.json.size(), 1u);
  // The page's process was not killed.
  const Config config = config_of("page2", false);
  std::optional<Shaking> shaking;
  estimator::Pipeline pipeline(config.pipeline);
  const auto take = [&](estimator::Pipeline::Results&& results) {
    for (const estimator::PipelineResult& result : results) {
      if (result.instant != nullptr) shaking->push(*result.instant);
      if (result.estimate != nullptr) shaking->follow(*result.estimate);
    }
  };
  estimator::PipelineConfig calibrated = config.pipeline;
  calibrated.axes = pipeline.axes();
  shaking.emplace(calibrated);
  drivers::AccelIntake intake(
      wanted_axes(config), [&](const estimator::AccelSample& s) { take(pipeline.push(s)); },
      intake_settings(config));
  for (const drivers::LogEvent& e : messages())
    (void)intake.message(e.channel, e.data.data(), e.data.size());
  take(pipeline.finish());
  ASSERT_NE(shaking->strongest(), nullptr);
  const estimator::PeakResponse& peak = shaking->strongest()->peak;
  EXPECT_NEAR(drift(r.json[0]) / estimator::largest_drift_ratio(peak, config.pipeline.structure), 1,
              kSame);
  EXPECT_NEAR(force(r.json[0]) / peak.base_shear_n[0], 1, kSame);
}

}  // namespace restart_test
}  // namespace framewatch::daemon
