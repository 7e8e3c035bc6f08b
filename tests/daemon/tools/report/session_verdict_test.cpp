// SPDX-License-Identifier: MIT
// A frame loses 15 % in the middle of a session. The report must start with it and keep the
// building before and after apart.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "daemon/monitor/estimates/parameter_summary.h"
#include "daemon/tools/lab/study_buildings.h"
#include "daemon/tools/replay/replay_command.h"
#include "daemon/tools/report/report_command.h"
#include "daemon/tools/report/session_report.h"
#include "daemon/tools/simulation/simulate_command.h"
#include "estimator/structure/natural_frequencies.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace session_verdict_test {

constexpr double kSeconds = 60, kChange_s = 20, kLost = 0.15;
constexpr double kTimeError_s = 1, kModeError = 0.06;
const std::string kChanged = "kx_1_y2";

/// A shaken minute of the demo's building, evaluated. change: true if the frame loses stiffness.
struct Session {
  explicit Session(bool change) {
    const std::string configs = std::string(FRAMEWATCH_SOURCE_DIR) + "/configs/";
    std::string scenario = test::read_file(configs + "scenario_table_two_story.toml");
    const std::string config = "config = \"";
    scenario.insert(scenario.find(config) + config.size(), configs);
    if (change)
      scenario += "\n[[change]]\nat_s = " + std::to_string(kChange_s) + "\nparameter = \"" +
                  kChanged + "\"\nfactor = " + std::to_string(1 - kLost) + "\n";
    test::write_file(directory.path("scenario.toml"), scenario);
    SimulateArguments s;
    s.scenario = directory.path("scenario.toml");
    s.out = directory.path("raw.lcmlog");
    s.seconds = kSeconds;
    s.quiet = true;
    EXPECT_EQ(simulate(s), 0);
    EXPECT_EQ(
        replay({test::table_config(), {s.out}, directory.path("est.lcmlog"), false, true, false}),
        0);
    std::vector<drivers::Problem> problems;
    std::vector<ConfigProblem> config_problems;
    std::vector<std::string> raw_problems;
    report.estimates = read_session_estimates(directory.path("est.lcmlog"), problems).value();
    report.config = load_config(test::table_config(), config_problems);
    report.motion = read_session_motion(*report.config, {s.out}, raw_problems);
    evaluate(report);
  }
  std::size_t index(const std::string& name) const {
    const auto& names = report.estimates.table.name;
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  }
  test::TemporaryDirectory directory;
  SessionReport report;
};

const Session& changed() {
  static const Session one(true);
  return one;
}

TEST(SessionVerdict, NamesTheFrameItsLossAndTheTime) {
  const SessionReport& r = changed().report;
  ASSERT_EQ(r.changes.size(), 1u);
  const ElementChange& c = r.changes.front();
  EXPECT_EQ(r.estimates.table.name[c.parameter], kChanged);
  EXPECT_NEAR(c.ratio, -kLost, 3 * c.std_error);
  EXPECT_LT(c.std_error, 0.01);
  EXPECT_NEAR(session_seconds(r, c.since_us), kChange_s, kTimeError_s);
  EXPECT_EQ(verdict_sentence(r).rfind("Frame y2 of story 1 has lost 1", 0), 0u)
      << verdict_sentence(r);
}

TEST(SessionVerdict, ComesFirstAndEventsComeBeforeFigures) {
  const std::string html = session_report_html(changed().report);
  const std::size_t body = html.find("<body>"), verdict = html.find("Frame y2 of story 1 has lost");
  ASSERT_NE(verdict, std::string::npos);
  EXPECT_LT(verdict - body, 40u);
  EXPECT_LT(html.find("<h2>Events"), html.find("<h2>Identified"));
  EXPECT_EQ(html.find("furthest from its reference"), std::string::npos);
}

TEST(SessionVerdict, KeepsValuesBeforeAndAfterApart) {
  const SessionReport& r = changed().report;
  ASSERT_EQ(r.compared.size(), 2u);
  EXPECT_FALSE(r.compared[0].after);
  EXPECT_TRUE(r.compared[1].after);
  const std::size_t p = changed().index(kChanged);
  const double before = summarise(r.estimates, p, r.compared[0].whole).mean,
               after = summarise(r.estimates, p, r.compared[1].whole).mean;
  EXPECT_NEAR(after / before, 1 - kLost, 0.02);
  ASSERT_EQ(r.loops.size(), 2u);
  for (const StageLoops& of : r.loops) {
    const ReportStage& stage = r.compared[of.stage];
    EXPECT_GE(of.loops.from_us, stage.from_us);
    EXPECT_LE(of.loops.to_us, stage.to_us);
    const double k = of.stage == 0 ? before : after;
    double cross = 0, own = 0;
    for (const FrameLoop& loop : of.loops.loops) {
      if (loop.parameter != static_cast<int>(p)) continue;
      for (std::size_t i = 0; i < loop.drift_m.size(); ++i) {
        cross += loop.drift_m[i] * loop.force_n[i];
        own += loop.drift_m[i] * loop.drift_m[i];
      }
    }
    EXPECT_NEAR(cross / own / k, 1, 0.03) << stage.name;
  }
}

TEST(SessionVerdict, ModesArePairedByShape) {
  const SessionReport& r = changed().report;
  ASSERT_EQ(r.transfer.size(), 2u);
  ASSERT_EQ(r.transfer_after.size(), 2u);
  const estimator::Structure& s = r.config->pipeline.structure;
  const estimator::ParameterTable table(s);
  const auto hz = [&](const Eigen::VectorXd& theta) {
    return estimator::natural_frequencies_hz(s, table, theta);
  };
  const std::vector<double> design = hz(r.config->pipeline.design);
  for (const bool after : {false, true}) {
    Eigen::VectorXd theta(table.size());
    for (int p = 0; p < table.size(); ++p)
      theta[p] =
          summarise(r.estimates, static_cast<std::size_t>(p), r.compared[after ? 1 : 0].whole).mean;
    const std::vector<double> identified = hz(theta);
    for (const TransferFunction& t : after ? r.transfer_after : r.transfer) {
      EXPECT_GT(t.mac, 0.8);
      // Order and shape of this building's modes match its drawings.
      std::size_t mode = 0;
      for (std::size_t m = 0; m < design.size(); ++m)
        if (std::abs(design[m] - t.model_mode_hz) < std::abs(design[mode] - t.model_mode_hz))
          mode = m;
      EXPECT_NEAR(t.stiffness_ratio() / std::pow(identified[mode] / design[mode], 2), 1, kModeError)
          << "mode " << mode << ": " << t.measured_mode_hz << " Hz, model " << t.model_mode_hz;
    }
  }
}

/// Reverses the changed session in time: the frame is stiffer after the change. weaker: factor on
/// the errors of later windows.
SessionReport grown(double weaker) {
  SessionReport r = changed().report;
  const std::size_t p = changed().index(kChanged);
  const std::int64_t at_us = r.changes.front().since_us;
  for (std::size_t w = 0; w < r.estimates.windows(); ++w) {
    if (r.estimates.end_us[w] <= at_us) continue;
    r.estimates.value[p][w] *= r.estimates.start_us[w] >= at_us ? 1 / (1 - kLost) / (1 - kLost) : 1;
    r.estimates.std_error[p][w] *= weaker;
  }
  r.changes = session_changes(r.estimates);
  r.recoveries = take_recoveries(r.estimates, nullptr, r.changes);
  return r;
}

TEST(SessionVerdict, CallsGrowthInDecayingMotionRecovery) {
  SessionReport r = grown(3);
  ASSERT_FALSE(r.recoveries.empty());
  EXPECT_TRUE(r.changes.empty());
  EXPECT_EQ(verdict_sentence(r).find("stiffer"), std::string::npos) << verdict_sentence(r);
  EXPECT_NE(verdict_section(r).find("frame y2 of story 1 grew stiffer again by 1"),
            std::string::npos);
  EXPECT_NE(verdict_section(r).find("not a change of the building"), std::string::npos);
  r.judged.clear();
  EXPECT_NE(verdict_sentence(r).find("only weaker motion"), std::string::npos);
}

TEST(SessionVerdict, SeesDecayInTheMotionIfAvailable) {
  SessionReport r = grown(1);
  std::vector<ElementChange> steady = r.changes, dying = r.changes;
  EXPECT_TRUE(take_recoveries(r.estimates, &*r.motion, steady).empty());
  const Eigen::Index from = r.motion->row_at(r.changes.front().since_us);
  r.motion->accel.bottomRows(r.motion->accel.rows() - from) *= 0.2;
  EXPECT_EQ(take_recoveries(r.estimates, &*r.motion, dying).size(), 1u);
  EXPECT_TRUE(dying.empty());
}

TEST(SessionVerdict, CallsGrowthUnderEqualMotionAChange) {
  const SessionReport r = grown(1);
  EXPECT_TRUE(r.recoveries.empty());
  EXPECT_NE(verdict_sentence(r).find("has become stiffer by 1"), std::string::npos)
      << verdict_sentence(r);
}

TEST(SessionVerdict, SaysThatABuildingStayedTheSame) {
  const Session same(false);
  EXPECT_TRUE(same.report.changes.empty());
  EXPECT_EQ(verdict_sentence(same.report).rfind("The building has not changed: ", 0), 0u)
      << verdict_sentence(same.report);
  EXPECT_EQ(same.report.compared.size(), 1u);
}

TEST(SessionVerdict, GivesNoVerdictOnATooShortSession) {
  SessionReport r = changed().report;
  r.changes.clear();
  r.judged.clear();
  EXPECT_NE(verdict_sentence(r).find("It is unknown whether the building has changed"),
            std::string::npos);
}

TEST(SessionVerdict, ReportsAChangeKnownOnlyFromAnEvent) {
  SessionReport r = changed().report;
  event_t event{};
  event.kind = "stiffness_change";
  event.place = "ky_2_x1";
  event.state = 1;
  event.value = -8;
  event.std_error = 1;
  event.since_us = r.estimates.start_us.front() - 1'000'000;
  r.estimates.events = {event};
  r.changes = session_changes(r.estimates);
  EXPECT_EQ(r.changes.size(), 2u);
  EXPECT_NE(verdict_sentence(r).find("frame x1 of story 2 has lost 8.0 %"), std::string::npos)
      << verdict_sentence(r);
  r.estimates.events.back().state = 0;
  EXPECT_EQ(session_changes(r.estimates).size(), 1u);
}

/// Twenty plane stories with four channels, whose model fit is described by `word`.
SessionReport tall(std::int32_t word, double bending_nmprad) {
  SessionReport r;
  r.config.emplace();
  r.config->pipeline.structure = tall_building(20);
  r.config->pipeline.design = tall_design(20);
  r.config->pipeline.axes = floor_axes({5, 10, 15, 20});
  r.config->pipeline.bending_nmprad.base_nmprad[0] = bending_nmprad;
  const auto parameters = static_cast<std::size_t>(r.config->pipeline.parameters().size());
  r.estimates.start_us = {0};
  r.estimates.end_us = {5'000'000};
  r.estimates.model_fit = {{5'000'000, std::vector<double>(parameters, 0.1),
                            std::vector<std::int32_t>(parameters, word)}};
  r.compared.push_back({StageKind::forced, "all of it", 0, 5'000'000, false, {0, 1}, {0, 1}});
  return r;
}

TEST(SessionVerdict, SaysWhetherTheFramesOfATallBuildingBend) {
  EXPECT_NE(bending_sentence(tall(3, 0)).find("set krx_nmprad"), std::string::npos);
  EXPECT_NE(bending_sentence(tall(2, 0)).find("set krx_nmprad"), std::string::npos);
  EXPECT_NE(bending_sentence(tall(1, 0)).find("fits without"), std::string::npos);
  EXPECT_EQ(bending_sentence(tall(0, 0)), "") << "nothing was seen";
  EXPECT_EQ(bending_sentence(tall(3, 1e12)), "") << "it is in the model";
}

}  // namespace session_verdict_test
}  // namespace framewatch::daemon
