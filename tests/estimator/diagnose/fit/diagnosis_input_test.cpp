// SPDX-License-Identifier: MIT
#include "estimator/diagnose/fit/diagnosis_input.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/estimator/diagnose/small_building.h"

namespace framewatch::estimator {
namespace diagnosis_input_test {

using test::kRate_hz;
using test::Small;

constexpr double kDesignOff = 0.1;  // of a stiffness estimated from one record, relative

std::vector<RecordSamples> one_record(const Small& small) {
  return {{kRate_hz, small.record({}, 1), 0}};
}

TEST(DiagnosisInput, KeepsAGivenDesign) {
  const Small small;
  const auto input =
      diagnosis_input(small.structure, small.axes, small.design, {}, one_record(small));
  ASSERT_TRUE(input);
  EXPECT_EQ(input->plant.design, small.design);
  ASSERT_EQ(input->segments.size(), 1U);
  const std::vector<double> hz = natural_frequencies_hz(small.structure, small.table, small.design);
  EXPECT_GE(input->segments[0].w[0], 2 * M_PI * 0.4 * hz.front());
  EXPECT_LE(input->segments[0].w.tail(1)[0], 2 * M_PI * 1.6 * hz.back());
}

TEST(DiagnosisInput, EstimatesADesignFromTheRecords) {
  const Small small;
  const auto input = diagnosis_input(small.structure, small.axes, {}, {}, one_record(small));
  ASSERT_TRUE(input);
  for (int f = 0; f < 4; ++f) {
    const int at = small.table.frame_stiffness(1, f);
    EXPECT_NEAR(input->plant.design[at] / small.truth[at], 1, kDesignOff) << f;
  }
}

TEST(DiagnosisInput, NeedsEveryMotionOfTheEquations) {
  Small small;
  const std::vector<RecordSamples> records = one_record(small);
  small.axes.erase(small.axes.begin() + 4);  // base-x
  EXPECT_FALSE(diagnosis_input(small.structure, small.axes, small.design, {}, records));
}

TEST(DiagnosisInput, RefusesShortRecordsAndThoseWithoutExcitation) {
  const Small small;
  std::vector<RecordSamples> records = one_record(small);
  const auto fault = [&] {
    const auto input = diagnosis_input(small.structure, small.axes, small.design, {}, records);
    return fault_of(input->plant, input->segments.front(), {});
  };
  EXPECT_EQ(fault(), SegmentFault::none);
  const Eigen::MatrixXd whole = records[0].accel;
  records[0].accel = whole.topRows(static_cast<Eigen::Index>(2 * kRate_hz));
  EXPECT_EQ(fault(), SegmentFault::too_short);
  Random random(1);
  records[0].accel = whole.unaryExpr([&](double) { return test::kNoise_mps2 * random.normal(); });
  EXPECT_EQ(fault(), SegmentFault::no_excitation);
}

/// Returns the middle of a record, with its floors `late` instants late.
Eigen::MatrixXd with_late_floors(const Eigen::MatrixXd& record, Eigen::Index late) {
  constexpr Eigen::Index kFloors = 4, kMargin = 100;
  const Eigen::Index rows = record.rows() - 2 * kMargin;
  Eigen::MatrixXd out = record.middleRows(kMargin, rows);
  out.leftCols(kFloors) = record.leftCols(kFloors).middleRows(kMargin - late, rows);
  return out;
}

TEST(DiagnosisInput, AlignsFloorsWithTheClockOfTheBase) {
  Small small;
  const Eigen::MatrixXd whole = small.record({}, 1);
  const auto offsets = [&](Eigen::Index late) {
    const auto input = diagnosis_input(small.structure, small.axes, small.design, {},
                                       {{kRate_hz, with_late_floors(whole, late), 0}});
    return clocks_apart(input->plant, input->segments.front());
  };
  EXPECT_TRUE(offsets(0).empty());
  EXPECT_TRUE(offsets(1).empty()) << "a delay that is fitted";
  for (const Eigen::Index late : {25, -60}) {
    const std::vector<ClockOffset> found = offsets(late);
    ASSERT_EQ(found.size(), 4U);
    for (const ClockOffset& o : found) {
      EXPECT_EQ(o.base,
                small.axes[static_cast<std::size_t>(o.axis)].direction == Direction::x ? 4 : 5);
      EXPECT_NEAR(o.seconds, static_cast<double>(late) / kRate_hz, 2 / kRate_hz);
    }
  }
  for (std::size_t a = 0; a < 4; ++a) small.axes[a].delay = 25 / kRate_hz;
  EXPECT_TRUE(offsets(25).empty()) << "the configuration says so";
}

}  // namespace diagnosis_input_test
}  // namespace framewatch::estimator
