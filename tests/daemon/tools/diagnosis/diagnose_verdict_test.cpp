#include "daemon/tools/diagnosis/diagnose_verdict.h"

#include <limits>

#include <gtest/gtest.h>

namespace framewatch::daemon {
namespace diagnose_verdict_test {

TEST(ConfidenceWords, SayWhatAnEffectExplainsAloneWhereItDoes) {
  estimator::FoundEffect found;
  found.confidence = 0.5;
  found.chosen.fraction = 0.84;
  EXPECT_EQ(confidence_words(found),
            "possible, others are nearly as good (confidence 50 %), it explains 84 % of what the "
            "sensors' noise does not");
  found.chosen.fraction = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(confidence_words(found), "possible, others are nearly as good (confidence 50 %)");
}

}  // namespace diagnose_verdict_test
}  // namespace framewatch::daemon
