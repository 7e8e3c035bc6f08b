#include "daemon/tools/diagnosis/diagnose_records.h"

#include <gtest/gtest.h>

#include "tests/estimator/diagnose/small_building.h"

namespace framewatch::daemon {
namespace {

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

TEST(SegmentProblems, NameTheChannelsWhoseClockIsApart) {
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

}  // namespace
}  // namespace framewatch::daemon
