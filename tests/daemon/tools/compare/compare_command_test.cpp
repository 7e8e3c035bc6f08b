// SPDX-License-Identifier: MIT
#include "daemon/tools/compare/compare_command.h"

#include <unistd.h>

#include <cmath>
#include <complex>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "daemon/monitor/history/history_files.h"
#include "daemon/tools/replay/replay_command.h"
#include "daemon/tools/report/session_file.h"
#include "daemon/tools/simulation/simulate_command.h"
#include "drivers/files/text_output.h"

namespace framewatch::daemon {
namespace compare_command_test {

namespace fs = std::filesystem;

// Limits.
constexpr double kLoss = 0.15;        // of frame y2 in story 1 of the damaged run
constexpr double kLossError = 0.005;  // of its measured size
constexpr double kWithinErrors =
    3;  // standard errors that nearly all undamaged elements are within
constexpr double kShareWithin = 0.9;                           // of them
constexpr double kLeastCoverage = 0.90, kMostCoverage = 0.99;  // of two standard errors
constexpr double kSameFrequency = 0.001;  // relative, of the well known modes of undamaged runs
constexpr double kFrequencyLoss = 0.02;   // least relative, of mode 1 of the softened building
constexpr double kTransferError = 0.1;    // of the formula for the error of a transfer function

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Four runs of the paper's building in different earthquakes, the last two with losses; made once.
struct Runs {
  std::string directory, config;

  Runs() {
    char name[] = "/tmp/framewatch-compare-test-XXXXXX";
    directory = ::mkdtemp(name);
    config = directory + "/building.toml";
    std::string text = text_of(FRAMEWATCH_SOURCE_DIR "/configs/paper_table1.toml");
    const std::size_t at = text.find("frames_x");
    text.insert(at, "labels_x = [\"south wall\", \"north wall\"]\n");
    std::ofstream(config) << text;
    make("run1.csv", 1, 2000e3);
    make("run2.csv", 2, 2000e3);
    make("damaged.csv", 3, (1 - kLoss) * 2000e3);
    make("softened.csv", 4, 0.5 * 2000e3);
  }
  ~Runs() { fs::remove_all(directory); }

  void make(const std::string& name, int seed, double k) const {
    std::ofstream(directory + "/scenario.toml") << fmt::format(
        "config = \"building.toml\"\nduration_s = 40.0\nseed = {}\n[truth]\n"
        "kx_npm = [[3500e3, {}], [3000e3, 2500e3], [2500e3, 2000e3], [2300e3, 2500e3], "
        "[2500e3, 2000e3]]\n[motion]\nangle_deg = 45.0\npeak_mps2 = 3.0\nstrong_s = 25.0\n"
        "decay_s = 5.0\nlength_s = 40.0\n[sensors]\nnoise_ratio = 0.01\n",
        seed, k);
    SimulateArguments simulated;
    simulated.scenario = directory + "/scenario.toml";
    simulated.out = path(name);
    simulated.quiet = true;
    EXPECT_EQ(simulate(simulated), 0);
  }
  std::string path(const std::string& name) const { return directory + "/" + name; }
  CompareArguments arguments(const std::string& a, const std::string& b) const {
    CompareArguments out;
    out.sources = {a.find('/') == 0 ? a : path(a), b.find('/') == 0 ? b : path(b)};
    out.options.config = config;
    out.quiet = true;
    return out;
  }
  Comparison compared(const std::string& a, const std::string& b) const {
    const CompareArguments all = arguments(a, b);
    std::vector<std::string> problems;
    std::vector<ComparedRun> runs;
    for (const std::string& source : all.sources)
      if (auto run = read_run(source, all.options, problems)) runs.push_back(*std::move(run));
    for (const std::string& problem : problems) ADD_FAILURE() << problem;
    return compare_runs(std::move(runs), {});
  }
};

const Runs& runs() {
  static const Runs one;
  return one;
}

TEST(Compare, TwoRunsOfOneBuildingDoNotDiffer) {
  EXPECT_EQ(compare(runs().arguments("run1.csv", "run2.csv")), 0);
  const Comparison c = runs().compared("run1.csv", "run2.csv");
  int within = 0, all = 0;
  for (const Difference& d : c.differences[0]) {
    if (!std::isfinite(d.ratio)) continue;
    ++all;
    within += d.errors() < kWithinErrors ? 1 : 0;
  }
  EXPECT_EQ(all, 50);
  EXPECT_GE(within, kShareWithin * all);
  EXPECT_EQ(verdict_sentences(c)[0].rfind("run2.csv does not differ from run1.csv: 25 of 25", 0),
            0u)
      << verdict_sentences(c)[0];
}

TEST(Compare, DifferencesOfRunsOfOneBuildingAreWithinTheirErrors) {
  constexpr int kRuns = 20;
  std::vector<std::vector<estimator::WindowMean>> means;
  for (int seed = 1; seed <= kRuns; ++seed) {
    runs().make("covered.csv", 100 + seed, 2000e3);
    ReplayArguments replayed;
    replayed.config = runs().config;
    replayed.inputs = {runs().path("covered.csv")};
    replayed.quiet = true;
    replayed.out = runs().path("covered.lcmlog");
    ASSERT_EQ(replay(replayed), 0);
    std::vector<drivers::Problem> problems;
    const auto estimates = read_session_estimates(replayed.out, problems);
    ASSERT_TRUE(estimates);
    means.emplace_back();
    for (std::size_t p = 0; p < estimates->parameters(); ++p) {
      const auto windows = separate_windows(*estimates, p);
      means.back().push_back(estimator::mean_of(windows, 0, windows.size()));
    }
  }
  double covered = 0, all = 0;
  for (std::size_t a = 0; a < means.size(); ++a)
    for (std::size_t b = a + 1; b < means.size(); ++b)
      for (std::size_t p = 0; p < means[a].size(); ++p) {
        const double error = estimator::ratio_error(means[a][p], means[b][p]);
        if (!(error > 0)) continue;
        ++all;
        covered += std::abs(means[b][p].value / means[a][p].value - 1) < 2 * error ? 1 : 0;
      }
  EXPECT_GT(all, 9000);
  RecordProperty("coverage", std::to_string(covered / all));
  EXPECT_GT(covered / all, kLeastCoverage);
  EXPECT_LT(covered / all, kMostCoverage);
}

TEST(Compare, FindsALossWithItsSizeAndPlace) {
  EXPECT_EQ(compare(runs().arguments("run1.csv", "damaged.csv")), 1);
  const Comparison c = runs().compared("run1.csv", "damaged.csv");
  for (std::size_t p = 0; p < c.differences[0].size(); ++p) {
    const Difference& d = c.differences[0][p];
    EXPECT_EQ(d.different, c.runs[0].table().name[p] == "kx_1_y2") << c.runs[0].table().name[p];
    if (d.different) {
      EXPECT_NEAR(d.ratio, -kLoss, kLossError);
    }
  }
  EXPECT_NE(verdict_sentences(c)[0].find("north wall (y2) of story 1 has 15."), std::string::npos)
      << verdict_sentences(c)[0];
}

TEST(Compare, ModesOfTwoRunsAgree) {
  const Comparison c = runs().compared("run1.csv", "run2.csv");
  EXPECT_EQ(c.known_modes().size(), 20u);
  // In the fourth mode floors shear, which 40 s show to 0.06 % only.
  for (std::size_t i = 0; i < 3; ++i) {
    const ModeDifference& d = c.modes[0][i];
    EXPECT_EQ(d.later, static_cast<int>(i));
    EXPECT_TRUE(d.frequency.judged) << i;
    EXPECT_LT(std::abs(d.frequency.ratio), kSameFrequency) << i;
    EXPECT_LT(d.frequency.errors(), kWithinErrors) << i;
    EXPECT_LT(d.damping.errors(), kWithinErrors) << i;
    EXPECT_GT(d.mac, 0.999) << i;
  }
  EXPECT_NE(verdict_sentences(c)[1].find("natural frequencies of run2.csv could be judged and are "
                                         "those of run1.csv"),
            std::string::npos)
      << verdict_sentences(c)[1];
  const std::string text = comparison_text(c);
  for (const char* wanted : {"1 (", "frequency, Hz", "damping ratio, %", "MAC",
                             "peak story drift, mm", "transfer function"})
    EXPECT_NE(text.find(wanted), std::string::npos) << wanted;
}

TEST(Compare, ALowerFrequencyHasASentenceAndDecidesTheExitStatus) {
  Comparison c = runs().compared("run1.csv", "softened.csv");
  const Difference& first = c.modes[0][0].frequency;
  EXPECT_TRUE(first.different);
  EXPECT_LT(first.ratio, -kFrequencyLoss);
  EXPECT_NE(verdict_sentences(c)[1].find(") lower, "), std::string::npos)
      << verdict_sentences(c)[1];
  for (Difference& d : c.differences[0]) d.different = false;
  EXPECT_TRUE(c.different()) << "by its frequencies alone";
  EXPECT_EQ(verdict_sentences(c)[0].rfind("softened.csv differs in frequency from run1.csv", 0), 0u)
      << verdict_sentences(c)[0];
  for (ModeDifference& d : c.modes[0]) d.frequency.different = false;
  EXPECT_FALSE(c.different());
}

TEST(Compare, RunsWithoutSamplesHaveTheModesOfTheirStiffness) {
  std::vector<std::string> problems;
  const auto record = read_run(runs().path("run1.csv"), {runs().config, {}}, problems);
  const auto design = read_run(runs().config, {}, problems);
  ASSERT_TRUE(record && design);
  // The design gives the frames and leaves the floor panels open.
  const estimator::NaturalMode& first = design->modes.modes.front().natural;
  EXPECT_GT(first.frequency_error_hz, 0);
  EXPECT_LT(first.frequency_error_hz, kSameFrequency * first.frequency_hz);
  EXPECT_TRUE(std::isfinite(record->modes.modes.front().measured_hz));
  SessionReport only_log = record->report;
  only_log.modes.clear();
  const RunModes of_log = run_modes(only_log, record->values);
  ASSERT_EQ(of_log.modes.size(), record->modes.modes.size());
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(of_log.modes[i].natural.frequency_hz / record->modes.modes[i].natural.frequency_hz,
                1, kSameFrequency);
    EXPECT_GT(of_log.modes[i].natural.frequency_error_hz, 0);
  }
  only_log.config.reset();
  EXPECT_EQ(run_modes(only_log, record->values).none, "it has no configuration; give --config");
}

TEST(Compare, ThresholdDecidesTheExitStatus) {
  CompareArguments a = runs().arguments("run1.csv", "damaged.csv");
  a.limits.ratio = 0.2;
  EXPECT_EQ(compare(a), 0);
  a.limits.ratio = 0.1;
  EXPECT_EQ(compare(a), 1);
}

TEST(Compare, WritesAPageAndJson) {
  CompareArguments a = runs().arguments("run1.csv", "damaged.csv");
  a.out = runs().path("page.html");
  EXPECT_EQ(compare(a), 1);
  const std::string page = text_of(a.out);
  EXPECT_LT(page.find("damaged.csv differs from run1.csv"), page.find("<h1>"));
  for (const char* wanted :
       {"story 1, north wall", "Peak story drifts", "Transfer functions", "Damping", "MN/m",
        "Provenance", "<nav", "<h2>Modes</h2>", "damping ratio, %", "MAC with damaged.csv"})
    EXPECT_NE(page.find(wanted), std::string::npos) << wanted;
  for (const char* unwanted : {">nan", "\"nan", " nan", "inf<", "<script"})
    EXPECT_EQ(page.find(unwanted), std::string::npos) << unwanted;
  const std::string json = comparison_json(runs().compared("run1.csv", "damaged.csv"));
  for (const char* wanted : {"\"framewatch.compare/1\"", "\"different\": true", "\"drift_ratio\"",
                             "\"std_errors\"", "\"place\": \"story 1, north wall\"",
                             "\"frequency_ratio\": 0.015", "\"mac\"", "\"measured_hz\""})
    EXPECT_NE(json.find(wanted), std::string::npos) << wanted;
  a.out = runs().path("page.png");
  EXPECT_EQ(compare(a), 2);
  EXPECT_FALSE(fs::exists(a.out));
}

TEST(Compare, RefusesUnlikeBuildingsWithTheReason) {
  const std::string other = FRAMEWATCH_SOURCE_DIR "/configs/table_two_story.toml";
  EXPECT_EQ(compare(runs().arguments(runs().config, other)), 2);
  std::vector<std::string> problems;
  const auto a = read_run(runs().config, {}, problems), b = read_run(other, {}, problems);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(why_unlike(*a, *b), "the first has 5 stories, the second 2");
  EXPECT_EQ(why_unlike(*a, *a), "");
  ComparedRun wider = *a;
  wider.report.config->pipeline.structure.span_x[0] += 1;
  EXPECT_EQ(why_unlike(*a, wider).rfind("span_x_m 1 is ", 0), 0u) << why_unlike(*a, wider);
  // Logs of estimates know no more than the names of parameters.
  ComparedRun log = *b;
  log.report.config.reset();
  EXPECT_NE(why_unlike(*a, log).find("the first has story 3, frame"), std::string::npos)
      << why_unlike(*a, log);
}

TEST(Compare, RefusesALogWithTheConfigurationOfAnotherBuilding) {
  ReplayArguments estimated;
  estimated.config = runs().config;
  estimated.inputs = {runs().path("run1.csv")};
  estimated.quiet = true;
  estimated.out = runs().path("of_another.lcmlog");
  ASSERT_EQ(replay(estimated), 0);
  RunOptions options;
  options.config = FRAMEWATCH_SOURCE_DIR "/configs/table_two_story.toml";
  std::vector<std::string> problems;
  EXPECT_FALSE(read_run(estimated.out, options, problems));
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].find("has 50 parameters of \"paper, Table 1\"; "), std::string::npos)
      << problems[0];
}

TEST(Compare, ReadsEverySource) {
  ReplayArguments replayed;
  replayed.config = runs().config;
  replayed.inputs = {runs().path("run1.csv")};
  replayed.quiet = true;
  replayed.out = runs().path("est.lcmlog");
  ASSERT_EQ(replay(replayed), 0);
  const std::string history = runs().path("history");
  fs::create_directories(history);
  replayed.out = summary_file(history);
  if (!replayed.out.ends_with(".sqlite")) replayed.out = runs().path("summary.sqlite");
  ASSERT_EQ(replay(replayed), 0);
  fs::rename(replayed.out, summary_file(history));
  const std::string session = runs().path("session");
  fs::create_directories(session);
  fs::copy_file(runs().path("est.lcmlog"), session + "/estimates.lcmlog");
  SessionFile file;
  file.state = "finished";
  file.config_path = runs().config;
  file.files = {"estimates.lcmlog"};
  ASSERT_EQ(drivers::write_text_file(session + "/session.json", session_json(file)), "");
  for (const std::string& source :
       {std::string("est.lcmlog"), std::string("session"), history + "@..", runs().config}) {
    const Comparison c = runs().compared("run1.csv", source);
    ASSERT_EQ(c.runs.size(), 2u) << source;
    EXPECT_TRUE(c.judged()) << source;
    EXPECT_FALSE(c.different()) << source << ": " << verdict_sentences(c)[0];
  }
  EXPECT_EQ(compare(runs().arguments("est.lcmlog", "run1.csv")), 0);
  CompareArguments without = runs().arguments("run1.csv", "run2.csv");
  without.options.config.clear();
  EXPECT_EQ(compare(without), 2) << "a record needs a configuration";
  EXPECT_EQ(compare(runs().arguments("run1.csv", "absent.csv")), 2);
}

TEST(TransferError, IsThatOfManyRecords) {
  // Independent segments of white noise through a gain, with noise at the output.
  constexpr int kRecords = 4000, kSegments = 12;
  constexpr double kGain = 3, kNoise = 1.5;
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  const auto draw = [&] { return std::complex<double>(normal(random), normal(random)); };
  double sum = 0, squares = 0, told = 0;
  for (int r = 0; r < kRecords; ++r) {
    std::complex<double> cross = 0;
    double input = 0, output = 0;
    for (int s = 0; s < kSegments; ++s) {
      const std::complex<double> x = draw(), y = kGain * x + kNoise * draw();
      cross += y * std::conj(x);
      input += std::norm(x);
      output += std::norm(y);
    }
    const double h = std::abs(cross) / input;
    sum += h;
    squares += h * h;
    // The formula takes segments that overlap by half, which count 1.056 times less.
    told += std::pow(h * transfer_error(std::norm(cross) / (input * output), kSegments), 2);
  }
  const double variance = squares / kRecords - std::pow(sum / kRecords, 2);
  EXPECT_NEAR(std::sqrt(told / kRecords) / std::sqrt(variance), 1, kTransferError);
  EXPECT_TRUE(std::isnan(transfer_error(0.9, 1)));
  EXPECT_TRUE(std::isnan(transfer_error(std::nan(""), 5)));
}

}  // namespace compare_command_test
}  // namespace framewatch::daemon
