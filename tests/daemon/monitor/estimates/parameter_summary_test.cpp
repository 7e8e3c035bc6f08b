// SPDX-License-Identifier: MIT
#include "daemon/monitor/estimates/parameter_summary.h"

#include <gtest/gtest.h>

#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {
namespace parameter_summary_test {

/// Returns a first record that finds the bending in its fourth window; until then the stiffness
/// depends on an older value.
SessionEstimates first_record() {
  SessionEstimates out;
  out.table.name = {"kx_1to2", "krx"};
  out.table.kind = {static_cast<int>(estimator::ParameterKind::frame_stiffness),
                    static_cast<int>(estimator::ParameterKind::bending_stiffness)};
  out.value = {{50, 51, 52, 100, 101, 102}, {3, 3, 3, 6, 6.3, 6.2}};
  out.std_error = {{1, 1, 1, 2, 2, 2}, {1, 1, 1, 1, 1, 1}};
  for (std::int64_t w = 0; w < 6; ++w) {
    out.start_us.push_back(1'000'000 * w);
    out.end_us.push_back(1'000'000 * (w + 1));
  }
  return out;
}

TEST(ParameterSummary, LeavesOutWindowsBeforeTheBendingWasKnown) {
  const ParameterSummary one = summarise(first_record(), 0, {0, 6});
  EXPECT_EQ(one.mean, 101);
  EXPECT_EQ(one.boxplot.median, 101);
  EXPECT_EQ(one.std_error, 2);
  EXPECT_EQ(one.observable_ratio, 0.5);
}

TEST(ParameterSummary, TakesAllWindowsIfNothingBends) {
  SessionEstimates session = first_record();
  session.table.name[1] = "ky_1to2";
  session.table.kind[1] = session.table.kind[0];
  EXPECT_EQ(summarise(session, 0, {0, 6}).mean, 76);
  EXPECT_EQ(summarise(session, 0, {3, 6}).mean, 101);
}

}  // namespace parameter_summary_test
}  // namespace framewatch::daemon
