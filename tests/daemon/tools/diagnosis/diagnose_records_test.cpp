// SPDX-License-Identifier: MIT
// Tests the records of a diagnosis: their channels, and reasons to refuse them.
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "daemon/tools/diagnosis/diagnose_records.h"
#include "tests/estimator/diagnose/small_building.h"
#include "tests/support/config_fixture.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace diagnose_records_test {

constexpr int kSamples = 2000, kRate_hz = 100;

const std::string kSpring = R"([structure]
name = "spring"
stories = 1
frames_x = ["f"]
frames_y = []
story_height_m = [1.0]
node_mass_kg = 1.0
[structure.design]
kx_npm = [[1000.0]]
damping_ratio = 0.02
[estimator]
rate_hz = 100
[[channel]]
name = "ground"
story = 0
direction = "x"
[[channel]]
name = "y"
story = 1
frame = "f"
)";

/// Returns the instants that lead into the simulation of a record with motion from begin_s on.
Eigen::Index lead_of_record(double begin_s, bool prescribed) {
  std::string text = "time_s,y,u\n";
  for (int i = 0; i < kSamples; ++i) {
    const double t = static_cast<double>(i) / kRate_hz;
    const double d = t < begin_s ? 0 : 0.01 * std::sin(2 * M_PI * 5 * t);
    text += fmt::format("{:.4f},{:.9f},{:.9f}\n", t, d, 1000 * d);
  }
  const test::TemporaryDirectory folder;
  test::write_file(folder.path("a.csv"), text);
  estimator::ComponentTest component;
  component.force = "u";
  component.displacement = true;
  component.prescribed = prescribed;
  std::vector<std::string> problems;
  const auto records =
      read_diagnose_records(test::good(kSpring), {folder.path("a.csv")}, component, problems);
  EXPECT_TRUE(problems.empty()) << problems.front();
  return records.empty() ? -1 : records.front().samples.lead;
}

/// The force of a law depends on motion simulated from rest. Without a lead it was wrong at the
/// beginning of a record cut from the middle of a test (Silverbox: a gap of 0.84 instead of 0.67
/// %).
TEST(DiagnoseRecords, NeedALeadIfAComponentStartsInMotion) {
  EXPECT_EQ(lead_of_record(0, false), kSamples / 2);
  EXPECT_EQ(lead_of_record(3, false), 0);
}

TEST(DiagnoseRecords, NeedNoLeadForAPrescribedMotion) {
  EXPECT_EQ(lead_of_record(0, true), 0);
}

/// Whole samples of a delay are removed from a record file, as an acquisition removes them from
/// stamps. A fit that started 0.5 s late did not converge.
TEST(DiagnoseRecords, AlignChannelsByTheirDelays) {
  constexpr double kRounding = 1e-8;
  std::string text = "time_s,ground,y\n";
  const auto motion = [](int i) { return std::sin(0.05 * i) * std::sin(0.0007 * i * i); };
  for (int i = 0; i < kSamples; ++i)
    text += fmt::format("{:.4f},{:.9f},{:.9f}\n", static_cast<double>(i) / kRate_hz, motion(i),
                        motion(i - 40));
  const test::TemporaryDirectory folder;
  test::write_file(folder.path("a.csv"), text);
  const Config config = test::good(kSpring + "delay_s = 0.402\n");
  std::vector<std::string> problems;
  auto records = read_diagnose_records(config, {folder.path("a.csv")}, {}, problems);
  ASSERT_TRUE(problems.empty()) << problems.front();
  const Eigen::MatrixXd& accel = records.front().samples.accel;
  EXPECT_EQ(accel.rows(), kSamples - 40);
  EXPECT_LT((accel.col(0) - accel.col(1)).cwiseAbs().maxCoeff(), kRounding);
  EXPECT_NEAR(accel(700, 0), motion(700), kRounding);
  EXPECT_NEAR(compared_channels(config, records).axes[1].delay, 0.002, 1e-12);
}

constexpr double kPeriod_s = 0.37;

/// Returns the problems of a record of kSpring. `value` returns the text of the channel y.
template <typename Value>
std::vector<std::string> problems_of_record(double rate_hz, Value value) {
  std::string text = "time_s,ground,y\n";
  for (int i = 0; i < kSamples; ++i)
    text += fmt::format("{:.4f},{:.9f},{}\n", i / rate_hz,
                        std::sin(2 * M_PI * i / (rate_hz * kPeriod_s)), value(i));
  const test::TemporaryDirectory folder;
  test::write_file(folder.path("a.csv"), text);
  std::vector<std::string> problems;
  read_diagnose_records(test::good(kSpring), {folder.path("a.csv")}, {}, problems);
  for (std::string& problem : problems) problem.erase(0, folder.path("").size());
  return problems;
}

std::string other_motion(int i) {
  return fmt::format("{:.9f}", std::cos(0.2 * i) + 0.3 * std::sin(0.013 * i));
}

using Problems = std::vector<std::string>;

TEST(DiagnoseRecords, AreRefusedAtAnotherRate) {
  EXPECT_EQ(problems_of_record(kRate_hz, other_motion), Problems());
  EXPECT_EQ(problems_of_record(kRate_hz / 2, other_motion),
            Problems({"a.csv: sampled at 50 Hz, but c.toml says rate_hz = 100"}));
  EXPECT_EQ(problems_of_record(2 * kRate_hz, other_motion),
            Problems({"a.csv: sampled at 200 Hz, but c.toml says rate_hz = 100"}));
}

TEST(DiagnoseRecords, AreRefusedIfEveryOtherSampleIsMissing) {
  EXPECT_EQ(problems_of_record(kRate_hz, [](int i) { return i % 2 ? "" : other_motion(i); }),
            Problems({"a.csv: channel 'y': 1000 of 2000 samples are missing, 5 % may be"}));
  EXPECT_EQ(problems_of_record(kRate_hz, [](int i) { return i % 25 ? other_motion(i) : ""; }),
            Problems())
      << "4 %";
}

TEST(DiagnoseRecords, AreRefusedIfAFloorRepeatsTheBase) {
  const auto base = [](int i) { return std::sin(2 * M_PI * i / (kRate_hz * kPeriod_s)); };
  const Problems copy{
      "a.csv: channel 'y' repeats channel 'ground' of another floor: give each its own samples"};
  EXPECT_EQ(problems_of_record(kRate_hz, [&](int i) { return fmt::format("{:.9f}", base(i)); }),
            copy);
  EXPECT_EQ(
      problems_of_record(kRate_hz, [&](int i) { return fmt::format("{:.9f}", 0.4 - 3 * base(i)); }),
      copy)
      << "with another scale and offset";
  EXPECT_EQ(
      problems_of_record(
          kRate_hz,
          [&](int i) { return fmt::format("{:.9f}", base(i) + 1e-3 * std::sin(11.0 * i * i)); }),
      Problems())
      << "a stiff building with noise";
}

TEST(ComparedChannels, LeaveOutCheckChannels) {
  const std::string check = "name = \"F1-Y1\"\ncheck = true\n";
  Config config = test::good(test::replaced(test::kGoodConfig, "name = \"F1-Y1\"\n", check));
  for (const int channel : {2, 4}) {
    estimator::EffectPlace place;
    place.kind = estimator::PlaceKind::channel;
    place.channel = channel;
    config.effects.push_back(make_effect(estimator::EffectKind::polarity, place));
  }
  std::vector<DiagnoseRecord> records(1);
  records[0].samples.accel.resize(2, 7);
  records[0].samples.accel << 0, 1, 2, 3, 4, 5, 6, 0, 1, 2, 3, 4, 5, 6;  // 6: a component's force
  const ComparedChannels compared = compared_channels(config, records);
  ASSERT_EQ(compared.axes.size(), 5U);
  EXPECT_EQ(compared.axes[2].name, "F1-Y2");
  ASSERT_EQ(compared.known.size(), 1U);
  EXPECT_EQ(compared.known[0].place.channel, 3);
  EXPECT_EQ(records[0].samples.accel.row(1),
            (Eigen::RowVectorXd(6) << 0, 1, 3, 4, 5, 6).finished());
}

std::vector<std::string> problems_of(const Eigen::MatrixXd& record) {
  const test::Small small;
  const auto input = estimator::diagnosis_input(small.structure, small.axes, small.design, {},
                                                {{test::kRate_hz, record, 0}});
  std::vector<std::string> out;
  add_segment_problems("monday.csv", *input, 0, {}, out);
  return out;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(SegmentProblems, SayWhatToMeasure) {
  const Eigen::MatrixXd whole = test::Small().record({}, 1);
  EXPECT_TRUE(problems_of(whole).empty());
  const std::vector<std::string> brief =
      problems_of(whole.topRows(static_cast<Eigen::Index>(2 * test::kRate_hz)));
  ASSERT_EQ(brief.size(), 1U);
  EXPECT_TRUE(has(brief[0], "monday.csv: too short") && has(brief[0], "; measure ")) << brief[0];
  estimator::Random random(1);
  const std::vector<std::string> calm =
      problems_of(whole.unaryExpr([&](double) { return test::kNoise_mps2 * random.normal(); }));
  ASSERT_EQ(calm.size(), 1U);
  EXPECT_TRUE(has(calm[0], "no excitation") && has(calm[0], "measure stronger")) << calm[0];
}

TEST(SegmentProblems, NameChannelsWithAnotherClock) {
  constexpr Eigen::Index kLate = 30;
  const Eigen::MatrixXd whole = test::Small().record({}, 1);
  Eigen::MatrixXd late = whole.bottomRows(whole.rows() - kLate);
  late.leftCols(4) = whole.leftCols(4).topRows(late.rows());
  const std::vector<std::string> problems = problems_of(late);
  ASSERT_EQ(problems.size(), 2U);
  EXPECT_TRUE(has(problems[0], "monday.csv: clocks apart: y1, y2 read 0.6")) << problems[0];
  EXPECT_TRUE(has(problems[0], "s later than base-x")) << problems[0];
  EXPECT_TRUE(has(problems[1], "x1, x2 read 0.6") && has(problems[1], "delay_s")) << problems[1];
}

}  // namespace diagnose_records_test
}  // namespace framewatch::daemon
