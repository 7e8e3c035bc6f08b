#include <cmath>

#include <gtest/gtest.h>

#include "estimator/diagnose/law/law_parameter.h"
#include "estimator/diagnose/propose/element_proposals.h"
#include "estimator/diagnose/propose/needed_signal.h"
#include "tests/estimator/diagnose/hidden_effect.h"

namespace framewatch::estimator {
namespace timed_change_test {

using test::Recorded;

constexpr int kFrame = 2;
constexpr double kOnsetOff = 0.02;   // of the record
constexpr double kLengthOff = 0.35;  // of the duration: the coarse search has three

/// Two records of a frame whose force gets one more share of stiffness: in the first from from_s
/// on, over length_s; in the second all the time.
struct Changing {
  Recorded recorded{test::records_with({}, {1, 2})};
  std::vector<NeededSignal> needed;
  ModelEffect start;

  Changing(double from_s, double length_s, bool also_in_second) {
    constexpr double kChange_npm = -1e6;
    const Localisation place = recorded.freed(test::in_frame(kFrame));
    needed = needed_signals(recorded.fitter, place);
    start.form = LawForm::changing;
    start.place = test::in_frame(kFrame);
    start.parameters = {linear_parameter(kChange_npm, 1e4)};
    for (std::size_t r = 0; r < needed.size(); ++r) {
      const RecordSegment& s = recorded.segments[r];
      const int ratio = recorded.fitter.ratio(r);
      const double from = r == 0 ? from_s : also_in_second ? -1 : 1e6;
      const LawValues law{LawForm::changing, {kChange_npm, from, r == 0 ? length_s : 0.05}, 1, 1};
      needed[r].force =
          band_of(law_force(law, needed[r].d_t, needed[r].v_t, 1 / (s.rate_hz * ratio)), s, ratio);
    }
  }

  std::vector<LawParameter> times(std::size_t record, bool sudden) const {
    return timed_change(recorded.fitter, needed, start, sudden).record_parameters[record];
  }
  double seconds() const { return recorded.segments.front().seconds(); }
};

TEST(TimedChange, ADropIsTimed) {
  for (const double from_s : {2.0, 9.3, 15.0}) {
    const Changing c(from_s, 0.05, true);
    const std::vector<LawParameter> times = c.times(0, true);
    EXPECT_NEAR(times[0].plain(), from_s, kOnsetOff * c.seconds());
    EXPECT_FALSE(times[1].free);
  }
}

TEST(TimedChange, ADriftIsTimedAndItsDurationFree) {
  constexpr double kFrom_s = 4, kDuration_s = 13;
  const Changing c(kFrom_s, kDuration_s, true);
  const std::vector<LawParameter> times = c.times(0, false);
  EXPECT_NEAR(times[0].plain(), kFrom_s, 2 * kOnsetOff * c.seconds());
  EXPECT_NEAR(times[1].plain() / kDuration_s, 1, kLengthOff);
  EXPECT_TRUE(times[1].free);
}

TEST(TimedChange, ARecordAfterTheChangeIsAllChanged) {
  // Alone it could as well be one of another stiffness; the first record tells.
  constexpr double kStillAtRest_s = 1;
  const Changing c(10, 0.05, true);
  EXPECT_LT(c.times(1, true)[0].plain(), kStillAtRest_s);
}

TEST(TimedChange, ARecordBeforeTheChangeHasItAtItsEnd) {
  constexpr double kMotionEnds_s = 15;
  const Changing c(10, 0.05, false);
  EXPECT_GT(c.times(1, true)[0].plain(), kMotionEnds_s);
}

}  // namespace timed_change_test
}  // namespace framewatch::estimator
