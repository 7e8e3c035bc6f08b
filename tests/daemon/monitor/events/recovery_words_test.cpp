#include "daemon/monitor/events/recovery_words.h"

#include <gtest/gtest.h>

namespace framewatch::daemon {
namespace recovery_words_test {

using estimator::RecoveryLaw, estimator::RecoveryReason, estimator::RecoveryVerdict;

RecoveryLaw law_after(double time_s, double loss) {
  RecoveryLaw law;
  law.first_s = 5;
  law.first_loss = 0.09;
  law.first_error = 0.01;
  law.time_s = time_s;
  law.loss = loss;
  law.std_error = 0.01;
  law.later_s = 86400;
  law.later_loss = 0.04;
  law.later_error = 0.01;
  law.stays = 0.06;
  return law;
}

TEST(RecoveryWords, SayLossTimeAndWhatIsExpected) {
  RecoveryLaw law = law_after(3600, 0.06);
  law.verdict = RecoveryVerdict::recovering;
  EXPECT_EQ(recovery_words(law),
            "lost 9 % at the earthquake, 6 % after 1 hour, recovering: 4 % (+-1 %) expected after "
            "1 day");
  law.verdict = RecoveryVerdict::lasting;
  EXPECT_EQ(recovery_words(law),
            "lost 9 % at the earthquake, 6 % after 1 hour, lasting: full recovery is excluded, at "
            "least 6 % stays");
  law.verdict = RecoveryVerdict::recovered;
  law.time_s = 600;
  law.loss = -0.001;
  EXPECT_EQ(recovery_words(law),
            "lost 9 % at the earthquake, 0 % (+-1 %) after 10 minutes, recovered");
}

TEST(RecoveryWords, SayWhyNothingIsKnown) {
  RecoveryLaw law = law_after(40, 0.08);
  law.reason = RecoveryReason::short_time;
  EXPECT_EQ(recovery_words(law),
            "lost 9 % at the earthquake, 8 % after 40 s, not known yet whether that lasts: too "
            "little time has passed");
  EXPECT_EQ(recovery_words(RecoveryLaw()),
            "not known yet whether that lasts: too few windows have come");
}

}  // namespace recovery_words_test
}  // namespace framewatch::daemon
