// SPDX-License-Identifier: MIT
// The loop of issue 7: a gap is noticed live, its samples are stored, diagnose names the missing
// effect, the running program adopts the model, and the gap disappears.
#include <algorithm>
#include <filesystem>

#include <framewatch/event_t.hpp>
#include <framewatch/gap_t.hpp>

#include <gtest/gtest.h>

#include "daemon/monitor/estimation/gap_files.h"
#include "daemon/monitor/live/run_command.h"
#include "daemon/tools/diagnosis/adopt_command.h"
#include "daemon/tools/diagnosis/diagnose_command.h"
#include "daemon/tools/replay/replay_command.h"
#include "daemon/tools/simulation/simulate_command.h"
#include "drivers/lcm/lcm_log.h"
#include "drivers/lcm/message_check.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace gap_test {

constexpr double kSeconds = 240, kAdopted_s = 150;
constexpr double kLargeGap = 0.15;  // before, of the learned linear model
constexpr double kShrinks = 5;      // times, with the missing effect in the model

const std::string kBuilding = R"([structure]
name = "plane frame"
stories = 2
frames_x = ["y1"]
frames_y = []
span_x_m = []
span_y_m = []
story_height_m = 3.0
node_mass_kg = 40.0

[gap]
model = "adopted.toml"
store = "segments"
learn_s = 20
store_before_s = 40
store_after_s = 40
)";

std::string channel(const std::string& name, int node, const std::string& place) {
  return "\n[[channel]]\nname = \"" + name + "\"\n" + place +
         "\nsource = { lcm = \"ACCEL\", node = " + std::to_string(node) +
         ", axis = \"x\" }\nnoise_mps2_per_rthz = 1e-3\n";
}

const std::string kScenario = R"(config = "building.toml"
duration_s = 300.0
seed = 11

[truth]
kx_npm = [[28e3], [26e3]]
damping_ratio = 0.02

[motion]
angle_deg = 0.0
peak_mps2 = 2.0
ground_frequency_hz = 3.0
ground_damping_ratio = 0.6
strong_s = 300.0
length_s = 400.0

[sensors]
noise_mps2_per_rthz = 1e-3

[[effect]]
kind = "cubic_stiffness"
story = 1
frame = "y1"
k3_npm3 = 2e7
)";

struct Heard {
  std::vector<framewatch::gap_t> gaps;
  std::vector<framewatch::event_t> events;
  void on_gap(const lcm::ReceiveBuffer*, const std::string&, const framewatch::gap_t* m) {
    gaps.push_back(*m);
  }
  void on_event(const lcm::ReceiveBuffer*, const std::string&, const framewatch::event_t* m) {
    events.push_back(*m);
  }
};

class GapLoop : public testing::Test {
 protected:
  void SetUp() override {
    test::write_file(path("building.toml"), kBuilding +
                                                channel("base", 0, "story = 0\ndirection = \"x\"") +
                                                channel("F1", 1, "story = 1\nframe = \"y1\"") +
                                                channel("F2", 2, "story = 2\nframe = \"y1\""));
    test::write_file(path("scenario.toml"), kScenario);
    SimulateArguments a;
    a.scenario = path("scenario.toml");
    a.out = path("rec.lcmlog");
    a.seconds = kSeconds;
    a.quiet = true;
    ASSERT_EQ(simulate(a), 0);
  }
  std::string path(const std::string& name) const { return directory_.path(name); }

  Config config() const {
    std::vector<ConfigProblem> problems;
    const auto out = load_config(path("building.toml"), problems);
    EXPECT_TRUE(out.has_value()) << (problems.empty() ? "" : problems.front().message);
    return out.value_or(Config{});
  }

  test::TemporaryDirectory directory_;
};

/// Returns the mean of the last ten.
double late_gap(const std::vector<framewatch::gap_t>& gaps) {
  double sum = 0;
  const std::size_t count = std::min<std::size_t>(gaps.size(), 10);
  for (std::size_t i = gaps.size() - count; i < gaps.size(); ++i) sum += gaps[i].overall_nrmse;
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

TEST_F(GapLoop, IsFoundAndExplainedLive) {
  const Config building = config();
  drivers::LcmProvider lcm("memq://");
  Heard heard;
  lcm.subscribe("FRAMEWATCH_GAP", &Heard::on_gap, &heard)->setQueueCapacity(10000);
  lcm.subscribe("FRAMEWATCH_EVENT", &Heard::on_event, &heard)->setQueueCapacity(10000);
  LiveEstimation live(building, lcm);
  GapKeeper keeper(building);
  drivers::LcmLogReader reader;
  ASSERT_TRUE(reader.open(path("rec.lcmlog")));
  drivers::LogEvent event;
  const auto play_to = [&](double to_s) {
    while (reader.next(event) == drivers::LogRead::event) {
      lcm.publish(event.channel, event.data.data(), static_cast<unsigned>(event.data.size()));
      EXPECT_TRUE(live.poll(0));
      if (static_cast<double>(event.timestamp_us) > 1e6 * to_s) break;
    }
    while (lcm.handleTimeout(100) > 0) {
    }
  };
  std::int64_t now_us = 0;
  keeper.poll(live.estimation(), now_us);
  play_to(kAdopted_s);
  ASSERT_EQ(heard.events.size(), 1u);
  const framewatch::event_t raised = heard.events.front();
  EXPECT_EQ(raised.kind, "gap");
  EXPECT_EQ(raised.state, 1);
  EXPECT_EQ(raised.segment, "gap-" + std::to_string(raised.id) + ".lcmlog");
  const double before = late_gap(heard.gaps);
  EXPECT_GT(before, kLargeGap);

  const std::string segment = path("segments/" + raised.segment);
  for (int wait = 0; wait < 100 && !std::filesystem::exists(segment); ++wait) ::usleep(50'000);
  ASSERT_TRUE(std::filesystem::exists(segment));
  DiagnoseArguments d;
  d.config = path("building.toml");
  d.event = std::to_string(raised.id);
  d.out = path("diagnosis");
  d.quiet = true;
  ASSERT_EQ(diagnose_command(d), 0);
  const std::string model = test::read_file(path("diagnosis/model.toml"));
  EXPECT_NE(model.find("kind = \"cubic_stiffness\"\nstory = 1\nframe = \"y1\""), std::string::npos)
      << model;
  const std::string page = test::read_file(path("diagnosis/report.html"));
  const std::size_t verdict = page.find("<p class=\"verdict\">The model lacks ");
  ASSERT_NE(verdict, std::string::npos);
  EXPECT_LT(verdict, page.find("<h1>"));
  for (const char* wanted : {"cubic stiffness at story 1, frame y1 (a stiffness that changes",
                             "confidence", "noise alone would make"})
    EXPECT_LT(page.find(wanted), page.find("<h1>")) << wanted;
  EXPECT_EQ(page.find("misfit"), std::string::npos);
  ASSERT_EQ(adopt({path("building.toml"), path("diagnosis/model.toml"), true}), 0);
  testing::internal::CaptureStderr();
  keeper.poll(live.estimation(), now_us += 1'000'000);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("adopted"), std::string::npos);

  play_to(kSeconds);
  EXPECT_LT(late_gap(heard.gaps), before / kShrinks);
  ASSERT_EQ(heard.events.size(), 2u);
  EXPECT_EQ(heard.events.back().state, 0);
  EXPECT_EQ(heard.events.back().id, raised.id);
}

TEST_F(GapLoop, AReplayInTwoPartsGivesTheBytesOfOne) {
  const auto run = [&](const std::string& out, ReplaySpan span, const std::string& load,
                       const std::string& save) {
    ReplayArguments a;
    a.config = path("building.toml");
    a.inputs = {path("rec.lcmlog")};
    a.out = path(out);
    a.quiet = true;
    a.span = span;
    a.one_pass = true;  // as parts are estimated
    if (!load.empty()) a.load_state = path(load);
    if (!save.empty()) a.save_state = path(save);
    return replay(a);
  };
  ASSERT_EQ(run("uncut.lcmlog", {0, 100}, "", ""), 0);
  ASSERT_EQ(run("first.lcmlog", {0, 73}, "", "state"), 0);
  ASSERT_EQ(run("second.lcmlog", {73, 100}, "state", ""), 0);
  EXPECT_TRUE(test::read_file(path("uncut.lcmlog")) ==
              test::read_file(path("first.lcmlog")) + test::read_file(path("second.lcmlog")));
}

TEST_F(GapLoop, RefusesAModelOfAnotherBuilding) {
  const std::string building = test::read_file(path("building.toml"));
  const auto refused = [&](const std::string& text) {
    test::write_file(path("model.toml"), text);
    testing::internal::CaptureStderr();
    EXPECT_EQ(adopt({path("building.toml"), path("model.toml"), true}), 2);
    EXPECT_FALSE(std::filesystem::exists(path("adopted.toml")));
    return testing::internal::GetCapturedStderr();
  };
  EXPECT_NE(refused(building).find("[structure.design] is missing"), std::string::npos);
  EXPECT_NE(refused("[structure]\nstories = 2\n").find("model.toml:1"), std::string::npos);
  std::string other = building + "\n[structure.design]\nkx_npm = [[28e3], [26e3]]\n";
  other.replace(other.find("name = \"F2\""), 11, "name = \"F3\"");
  EXPECT_NE(refused(other).find("has other channels"), std::string::npos);
  EXPECT_NE(refused("nonsense").find("model.toml:1"), std::string::npos);
}

TEST_F(GapLoop, DiagnoseOfAnEventNamesTheMissingEffect) {
  DiagnoseArguments d;
  d.config = path("building.toml");
  d.event = "17";
  d.out = path("diagnosis");
  testing::internal::CaptureStderr();
  EXPECT_EQ(diagnose_command(d), 2);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("gap-17.lcmlog: cannot be opened"),
            std::string::npos);
  d.train = {path("rec.lcmlog")};
  testing::internal::CaptureStderr();
  EXPECT_EQ(diagnose_command(d), 2);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("or --event alone"), std::string::npos);
  d.settings = {"explan=0.9", "explains=2", "steps=many", "steps"};
  testing::internal::CaptureStderr();
  EXPECT_EQ(diagnose_command(d), 2);
  const std::string said = testing::internal::GetCapturedStderr();
  for (const char* problem :
       {"explan=0.9: the search has no number of this name, did you mean explains",
        "explains=2: must be NAME=VALUE with a value from 0 to 1", "steps=many: must be NAME=VALUE",
        "steps: must be NAME=VALUE"})
    EXPECT_NE(said.find(problem), std::string::npos) << said;
  EXPECT_FALSE(std::filesystem::exists(path("diagnosis")));
}

}  // namespace gap_test
}  // namespace framewatch::daemon
