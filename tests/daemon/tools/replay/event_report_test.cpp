// SPDX-License-Identifier: MIT
// Runs a shaken building through the whole program: the report, the event that names it, and the
// same bytes every time.
#include <gtest/gtest.h>

#include <framewatch/event_t.hpp>

#include <nlohmann/json.hpp>

#include "daemon/monitor/live/live_estimation.h"
#include "daemon/tools/replay/replay_command.h"
#include "daemon/tools/simulation/simulate_command.h"
#include "drivers/lcm/lcm_log.h"
#include "drivers/lcm/message_check.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace event_report_test {

constexpr double kShaken_s = 40, kSeconds = 80, kDrop_s = 20;

/// The demo's table, shaken for 40 s and then at rest; one frame loses 25 %.
class EventReportReplay : public testing::Test {
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
    set("strong_s = 100000.0", "strong_s = " + std::to_string(kShaken_s - 2));
    scenario += "\n[[change]]\nat_s = " + std::to_string(kDrop_s) +
                "\nparameter = \"kx_1_y2\"\nfactor = 0.75\n";
    test::write_file(path("scenario.toml"), scenario);
    test::write_file(path("building.toml"),
                     test::read_file(test::table_config()) +
                         "\n[event_report]\ndirectory = \"live\"\nquiet_s = 15\n");
    SimulateArguments s;
    s.scenario = path("scenario.toml");
    s.out = path("rec.lcmlog");
    s.seconds = kSeconds;
    s.quiet = true;
    ASSERT_EQ(simulate(s), 0);
  }
  static void TearDownTestSuite() { delete directory_; }
  static std::string path(const std::string& name) { return directory_->path(name); }

  static ReplayArguments arguments(const std::string& reports, const std::string& out) {
    ReplayArguments a;
    a.config = path("building.toml");
    a.inputs = {path("rec.lcmlog")};
    a.out = path(out);
    a.quiet = true;
    a.event_reports = path(reports);
    return a;
  }
  static event_t only_event(const std::string& log) {
    std::vector<event_t> out;
    drivers::LcmLogReader reader;
    EXPECT_TRUE(reader.open(path(log)));
    drivers::LogEvent event;
    while (reader.next(event) == drivers::LogRead::event)
      if (event.channel == "FRAMEWATCH_EVENT")
        if (const auto m = drivers::decoded<event_t>(event.data)) out.push_back(*m);
    EXPECT_EQ(out.size(), 1u);
    return out.empty() ? event_t{} : out.front();
  }

 private:
  inline static test::TemporaryDirectory* directory_ = nullptr;
};

TEST_F(EventReportReplay, NamesFrameAndFileAndWritesTheSameBytes) {
  ASSERT_EQ(replay(arguments("a", "a.lcmlog")), 0);
  ASSERT_EQ(replay(arguments("b", "b.lcmlog")), 0);
  const event_t m = only_event("a.lcmlog");
  EXPECT_EQ(m.kind, "strong_motion");
  EXPECT_EQ(m.state, 1);
  EXPECT_LT(1e-6 * static_cast<double>(m.time_us), kShaken_s + 60);
  for (const std::string ending : {".html", ".json"}) {
    const std::string name = m.segment.substr(0, m.segment.rfind('.')) + ending;
    const std::string a = test::read_file(path("a/" + name));
    EXPECT_FALSE(a.empty()) << name;
    EXPECT_TRUE(a == test::read_file(path("b/" + name))) << name;
  }
  EXPECT_TRUE(test::read_file(path("a.lcmlog")) == test::read_file(path("b.lcmlog")));
  const auto json = nlohmann::json::parse(
      test::read_file(path("a/" + m.segment.substr(0, m.segment.rfind('.')) + ".json")));
  EXPECT_EQ(json["verdict"], "red");
  EXPECT_GT(json["stories"][0]["peak_drift_ratio"].get<double>(), 0.001);
  bool found = false;
  for (const auto& k : json["stiffness"]) {
    if (k["change_ratio"].is_null()) continue;
    const double change = k["change_ratio"].get<double>();
    if (k["parameter"] == "kx_1_y2") {
      found = true;
      EXPECT_NEAR(change, -0.25, 0.03);
    } else if (k["parameter"].get<std::string>()[0] == 'k') {
      EXPECT_NEAR(change, 0, 0.03) << k["parameter"];
    }
  }
  EXPECT_TRUE(found);
}

TEST_F(EventReportReplay, InTwoPartsGivesTheSameReport) {
  ReplayArguments whole = arguments("a", "a.lcmlog");
  whole.one_pass = true;
  ASSERT_EQ(replay(whole), 0);
  ReplayArguments first = arguments("cut", "1.lcmlog"), second = arguments("cut", "2.lcmlog");
  first.span = {0, 30};
  first.save_state = path("state");
  second.span.from_s = 30;
  second.load_state = path("state");
  ASSERT_EQ(replay(first), 0);
  ASSERT_EQ(replay(second), 0);
  const std::string name = only_event("a.lcmlog").segment;
  EXPECT_TRUE(test::read_file(path("a/" + name)) == test::read_file(path("cut/" + name)));
}

TEST_F(EventReportReplay, LiveEstimationWritesTheSameReport) {
  ReplayArguments as_it_comes = arguments("a", "a.lcmlog");
  as_it_comes.one_pass = true;
  ASSERT_EQ(replay(as_it_comes), 0);
  const std::string name = only_event("a.lcmlog").segment;
  std::vector<ConfigProblem> problems;
  const auto config = load_config(path("building.toml"), problems);
  ASSERT_TRUE(config);
  std::vector<event_t> events;
  {
    drivers::LcmProvider lcm("memq://");
    LiveEstimation live(*config, lcm);
    drivers::LcmLogReader reader;
    ASSERT_TRUE(reader.open(path("rec.lcmlog")));
    drivers::LogEvent event;
    while (reader.next(event) == drivers::LogRead::event) {
      lcm.publish(event.channel, event.data.data(), static_cast<unsigned>(event.data.size()));
      ASSERT_TRUE(live.poll(0));
    }
    live.finish();
    events = live.take_events();
  }
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events.front().segment, name);
  EXPECT_TRUE(test::read_file(path("live/" + name)) == test::read_file(path("a/" + name)));
}

TEST_F(EventReportReplay, NeedsTheEventReportSection) {
  ReplayArguments a = arguments("none", "none.lcmlog");
  a.config = test::table_config();
  testing::internal::CaptureStderr();
  EXPECT_EQ(replay(a), 2);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("needs [event_report]"), std::string::npos);
}

}  // namespace event_report_test
}  // namespace framewatch::daemon
