// SPDX-License-Identifier: MIT
#include "daemon/tools/report/report_command.h"
#include "daemon/monitor/estimates/parameter_summary.h"

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>
#include <sstream>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "daemon/base/utc_time.h"
#include "daemon/tools/replay/replay_command.h"
#include "daemon/tools/report/session_report.h"
#include "daemon/tools/simulation/simulate_command.h"
#include "estimator/identify/estimate/boxplot.h"
#include "estimator/structure/matrices.h"
#include "estimator/structure/natural_frequencies.h"

namespace framewatch::daemon {
namespace report_command_test {

// Limits.
constexpr double kStageError_s = 1.0;     // of the end of the shaking, known to half a second
constexpr double kDynamicError = 0.03;    // of the mean stiffness ratio, from one mode
constexpr double kLoopSlopeError = 0.02;  // of the slope through a loop

constexpr double kShaken_s = 25, kWhole_s = 40;
const std::string kConfig = FRAMEWATCH_SOURCE_DIR "/configs/table_two_story.toml";

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// A virtual test, shaken for 25 s and at rest for 15 s, made once for all cases.
struct Session {
  std::string directory, raw, estimates;

  Session() {
    char name[] = "/tmp/framewatch-report-XXXXXX";
    directory = ::mkdtemp(name);
    std::string scenario = text_of(FRAMEWATCH_SOURCE_DIR "/configs/scenario_table_two_story.toml");
    const auto set = [&](const std::string& what, const std::string& by) {
      const std::size_t at = scenario.find(what);
      ASSERT_NE(at, std::string::npos) << what;
      scenario.replace(at, what.size(), by);
    };
    set("\"table_two_story.toml\"", "\"" + kConfig + "\"");
    set("length_s = 3600.0", fmt::format("length_s = {}", kShaken_s));
    set("strong_s = 100000.0", fmt::format("strong_s = {}", kShaken_s - 2));
    std::ofstream(directory + "/scenario.toml") << scenario;
    raw = directory + "/raw.lcmlog";
    estimates = directory + "/est.lcmlog";
    SimulateArguments simulated;
    simulated.scenario = directory + "/scenario.toml";
    simulated.out = raw;
    simulated.seconds = kWhole_s;
    simulated.quiet = true;
    EXPECT_EQ(simulate(simulated), 0);
    EXPECT_EQ(replay({kConfig, {raw}, estimates, false, true, false}), 0);
  }
  ~Session() { std::filesystem::remove_all(directory); }

  ReportArguments arguments(const std::string& out) const {
    ReportArguments a;
    a.estimates = estimates;
    a.config = kConfig;
    a.raw = {raw};
    a.out = directory + "/" + out;
    a.quiet = true;
    return a;
  }
  SessionReport evaluated() const {
    SessionReport r;
    std::vector<drivers::Problem> problems;
    std::vector<ConfigProblem> config_problems;
    std::vector<std::string> raw_problems;
    r.estimates = read_session_estimates(estimates, problems).value();
    r.config = load_config(kConfig, config_problems);
    r.motion = read_session_motion(*r.config, {raw}, raw_problems);
    evaluate(r);
    return r;
  }
};

const Session& session() {
  static const Session one;
  return one;
}

TEST(SessionReport, FindsForcedAndFreeVibration) {
  const SessionReport r = session().evaluated();
  ASSERT_EQ(r.compared.size(), 2u);
  EXPECT_EQ(r.compared[0].kind, StageKind::forced);
  EXPECT_EQ(r.compared[1].kind, StageKind::free);
  ASSERT_GE(r.stages.size(), 2u);
  EXPECT_NEAR(session_seconds(r, r.stages[0].to_us), kShaken_s, kStageError_s);
  EXPECT_EQ(r.compared[0].boxes.size(), 500u);
  EXPECT_EQ(r.compared[0].boxes.to, r.compared[0].whole.to);
  EXPECT_EQ(r.compared[1].boxes.from, r.compared[1].whole.from);
  EXPECT_GE(r.estimates.start_us[r.compared[1].whole.from], r.stages[0].to_us);
}

TEST(SessionReport, ReferenceDynamicFollowsTheFundamentalFrequencies) {
  const SessionReport r = session().evaluated();
  ASSERT_EQ(r.transfer.size(), 2u);
  // The true frames are on average stiffer than the drawings along x and softer along y. The
  // expected ratio is that of the models' lowest natural frequencies.
  const estimator::Structure& s = r.config->pipeline.structure;
  const estimator::ParameterTable table(s);
  Eigen::VectorXd identified(table.size());
  for (int p = 0; p < table.size(); ++p)
    identified[p] = summarise(r.estimates, static_cast<std::size_t>(p), r.compared[0].whole).mean;
  const double expected = std::pow(lowest_frequency_hz(s, table, identified) /
                                       lowest_frequency_hz(s, table, r.config->pipeline.design),
                                   2);
  for (const TransferFunction& t : r.transfer)
    EXPECT_NEAR(t.stiffness_ratio() / expected, 1, kDynamicError)
        << t.measured_mode_hz << " Hz, model " << t.model_mode_hz << " Hz";
  EXPECT_TRUE(std::isfinite(r.reference_dynamic[0]));
  EXPECT_TRUE(std::isnan(r.reference_dynamic[static_cast<std::size_t>(table.elements())]));
}

TEST(SessionReport, LoopsHaveTheIdentifiedSlope) {
  const SessionReport r = session().evaluated();
  ASSERT_EQ(r.loops.size(), 1u);
  ASSERT_TRUE(r.loops[0].loops.reason.empty()) << r.loops[0].loops.reason;
  ASSERT_EQ(r.loops[0].loops.loops.size(), 8u);
  for (const FrameLoop& loop : r.loops[0].loops.loops) {
    double cross = 0, own = 0;
    for (std::size_t i = 0; i < loop.drift_m.size(); ++i) {
      cross += loop.drift_m[i] * loop.force_n[i];
      own += loop.drift_m[i] * loop.drift_m[i];
    }
    const double k =
        summarise(r.estimates, static_cast<std::size_t>(loop.parameter), r.compared[0].whole).mean;
    EXPECT_NEAR(cross / own / k, 1, kLoopSlopeError) << loop.name;
  }
}

TEST(SessionReport, ShowsTheBoxplotOfTheWindow) {
  std::mt19937 random(7);
  for (const int count : {1, 2, 3, 10, 499, 500}) {
    estimator::BoxplotWindow window(count);
    std::vector<double> values;
    for (int i = 0; i < count; ++i) {
      const auto value = static_cast<double>(random() % 1000) * (i % 50 == 0 ? 10 : 1);
      values.push_back(value);
      window.push(value);
    }
    const estimator::BoxplotStatistics a = boxplot_of(values), b = window.statistics();
    EXPECT_DOUBLE_EQ(a.q1, b.q1);
    EXPECT_DOUBLE_EQ(a.median, b.median);
    EXPECT_DOUBLE_EQ(a.q3, b.q3);
    EXPECT_DOUBLE_EQ(a.whisker_low, b.whisker_low);
    EXPECT_DOUBLE_EQ(a.whisker_high, b.whisker_high);
    EXPECT_EQ(a.outliers, b.outliers);
    EXPECT_EQ(a.count, b.count);
  }
  EXPECT_EQ(boxplot_of({NAN, INFINITY}).count, 0);
}

TEST(ReportCommand, GivesTheSameBytesAndLoadsNothing) {
  ASSERT_EQ(report(session().arguments("a.html")), 0);
  ASSERT_EQ(report(session().arguments("b.html")), 0);
  const std::string a = text_of(session().directory + "/a.html");
  EXPECT_EQ(a, text_of(session().directory + "/b.html"));
  EXPECT_EQ(a.find("<script"), std::string::npos);
  EXPECT_EQ(a.find("http"), std::string::npos);
  for (const char* wanted :
       {"forced vibration", "free vibration", "reference-static", "reference-dynamic", "coherence",
        "restoring force", "Provenance", "<h2>Modes</h2>", "mode 1 (",
        "only frame stiffness has a reference-dynamic value"})
    EXPECT_NE(a.find(wanted), std::string::npos) << wanted;
  for (const char* unwanted : {">nan", "\"nan", " nan", ",nan"})
    EXPECT_EQ(a.find(unwanted), std::string::npos) << unwanted;
}

TEST(SessionReport, EscapesForeignText) {
  const std::string bad = "</title></td><script>alert(1)</script>\"><img onerror=x>";
  SessionReport r = session().evaluated();
  r.title = r.test = r.operator_name = r.notes = bad;
  r.estimates.table.structure = r.estimates.table.version = r.estimates.table.config_sha256 = bad;
  for (std::string& name : r.estimates.table.name) name = bad;
  for (std::string& unit : r.estimates.table.unit) unit = bad;
  if (r.estimates.status)
    for (std::string& name : r.estimates.status->name) name = bad;
  r.estimates.notes = {bad};
  event_t event{};
  event.kind = event.place = event.message = event.unit = event.segment = bad;
  r.estimates.events = {event};
  r.session.emplace();
  r.session->asked_by = r.session->state = r.session->ended_by = bad;
  r.session->run.resize(1);
  r.session->run[0].name = r.session->run[0].problem = bad;
  r.session->check = r.session->run;
  r.files = {{"estimates", bad, "00"}};
  for (const bool triggered : {false, true}) {
    if (triggered) r.session->triggered_by = bad;
    const std::string html = session_report_html(r);
    EXPECT_EQ(html.find("<script"), std::string::npos);
    EXPECT_EQ(html.find("<img"), std::string::npos);
    EXPECT_NE(html.find("&lt;script&gt;"), std::string::npos);
  }
}

TEST(ReportCommand, NeedsOnlyEstimates) {
  ReportArguments a = session().arguments("alone.html");
  a.config.clear();
  a.raw.clear();
  a.operator_name = "<b>";
  ASSERT_EQ(report(a), 0);
  const std::string html = text_of(a.out);
  EXPECT_NE(html.find("all of it"), std::string::npos);
  EXPECT_NE(html.find("&lt;b&gt;"), std::string::npos);
  EXPECT_EQ(html.find("reference-dynamic /"), std::string::npos);
}

TEST(ReportCommand, RefusesAPageWithTheEndingOfAPicture) {
  EXPECT_EQ(report(session().arguments("x.png")), 2);
  EXPECT_FALSE(std::filesystem::exists(session().directory + "/x.png"));
}

TEST(SessionReport, NamesEveryPictureAndPlace) {
  SessionReport r = session().evaluated();
  r.labels = {{"y2", "north wall"}};
  std::set<std::string> names;
  for (const Picture& picture : session_pictures(r)) {
    EXPECT_TRUE(names.insert(picture.name).second) << picture.name;
    EXPECT_GT(picture.plot.csv().size(), 100u) << picture.name;
    // A code such as kx_1_y2 means nothing to a reader.
    EXPECT_EQ(picture.plot.svg().find("kx_"), std::string::npos) << picture.name;
    EXPECT_EQ(picture.plot.csv().find("kx_"), std::string::npos) << picture.name;
    EXPECT_NE(picture.plot.csv().rfind("\n,", 0), 0u) << "a series of the CSV has a name";
  }
  for (const char* wanted :
       {"means-frame-stiffness", "windows-panel-damping", "transfer-x", "coherence-y",
        "loop-kx_1_y2", "history-kx_1_y2", "acceleration-base", "acceleration-top", "residual"})
    EXPECT_TRUE(names.contains(wanted)) << wanted;
  EXPECT_NE(session_report_html(r).find("story 1, north wall"), std::string::npos);
}

TEST(ReportUnits, FitTheBuildingOrTheModel) {
  parameter_table_t table{};
  table.kind = {0, 2};
  table.design = {999e3, 1e9};
  EXPECT_EQ(ReportUnits(table).of(0), std::pair(1e-3, std::string("kN/m")));
  EXPECT_EQ(ReportUnits(table).of(2), std::pair(1.0, std::string("N*s/m")));
  EXPECT_EQ(ReportUnits(table).of_force(), std::pair(1.0, std::string("N")));
  table.design = {1e6, 0};
  EXPECT_EQ(ReportUnits(table).of(0), std::pair(1e-6, std::string("MN/m")));
  EXPECT_EQ(ReportUnits(table).of(1), std::pair(1e-6, std::string("MN/(rad*m)")));
  EXPECT_EQ(ReportUnits(table).of(4), std::pair(1e-6, std::string("MN*m/rad")));
  EXPECT_EQ(ReportUnits(table).of(2), std::pair(1e-3, std::string("kN*s/m")));
  EXPECT_EQ(ReportUnits(table).of_force(), std::pair(1e-3, std::string("kN")));
}

TEST(ReportCommand, ReportsATruncatedLog) {
  ReportArguments a = session().arguments("cut.html");
  const std::string whole = text_of(session().estimates);
  a.estimates = session().directory + "/cut.lcmlog";
  std::ofstream(a.estimates) << whole.substr(0, whole.size() * 2 / 3 + 7);
  ASSERT_EQ(report(a), 0);
  EXPECT_NE(text_of(a.out).find("left out"), std::string::npos);
}

TEST(ReportCommand, RefusesFilesThatAreNotASession) {
  ReportArguments raw_as_estimates = session().arguments("bad.html");
  raw_as_estimates.estimates = session().raw;
  EXPECT_EQ(report(raw_as_estimates), 2);
  ReportArguments no_config = session().arguments("bad.html");
  no_config.config.clear();
  EXPECT_EQ(report(no_config), 2);
  ReportArguments onto_itself = session().arguments("bad.html");
  onto_itself.out = onto_itself.estimates;
  EXPECT_EQ(report(onto_itself), 2);
  ReportArguments other_building = session().arguments("bad.html");
  other_building.config = FRAMEWATCH_SOURCE_DIR "/configs/mini_shake_table_xsens.toml";
  other_building.raw.clear();
  EXPECT_EQ(report(other_building), 2);
  EXPECT_FALSE(std::filesystem::exists(session().directory + "/bad.html"));
}

TEST(SessionReport, PrintsSensorTimeAsADate) {
  EXPECT_EQ(sensor_time_text(1'500'000), "1.500 s");
  EXPECT_EQ(sensor_time_text(1'582'934'400'000'000), "2020-02-29 00:00:00 UTC");
  EXPECT_EQ(sensor_time_text(1'798'761'599'000'000), "2026-12-31 23:59:59 UTC");
}

}  // namespace report_command_test
}  // namespace framewatch::daemon
