// SPDX-License-Identifier: MIT
#include <framewatch/parameter_table_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/monitor/estimates/estimate_table.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace framewatch::daemon {
namespace estimate_table_test {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct Example {
  parameter_table_t table{};
  window_estimate_t estimate{};
  std::vector<double> truth{20000, 30000, 5000, 40};

  Example() {
    table.name = {"kx_1_y1", "ky_1_x1", "Gk_1_x1y1", "cx_1_y1"};
    table.unit = {"N/m", "N/m", "N/(rad*m)", "N*s/m"};
    table.kind = {0, 0, 1, 2};
    estimate.value = {20100, 29970, 5100, kNone};
    estimate.std_error = {50, 60, 70, kNone};
    estimate.reason = {0, 0, 0, 3};
    estimate.q1 = {20050, 29900, 5050, kNone};
    estimate.median = {20090, 29980, 5080, kNone};
    estimate.q3 = {20150, 30010, 5120, kNone};
  }
};

TEST(EstimateTable, FindsTheWorstOfEachGroup) {
  const Example e;
  const EstimateErrors errors = errors_against(e.table, e.estimate, e.truth);
  EXPECT_EQ(errors.frames.worst, "kx_1_y1");
  EXPECT_NEAR(errors.frames.worst_ratio, 0.005, 1e-12);
  EXPECT_EQ(errors.panels.worst, "Gk_1_x1y1");
  EXPECT_NEAR(errors.panels.worst_ratio, 0.02, 1e-12);
  EXPECT_TRUE(errors.frames.without.empty());
}

TEST(EstimateTable, NamesAStiffnessWithoutValue) {
  Example e;
  e.estimate.reason[1] = 2;
  e.estimate.value[2] = kNone;
  const EstimateErrors errors = errors_against(e.table, e.estimate, e.truth);
  EXPECT_EQ(errors.frames.without, std::vector<std::string>{"ky_1_x1"});
  EXPECT_EQ(errors.panels.without, std::vector<std::string>{"Gk_1_x1y1"});
}

TEST(EstimateTable, ShowsEveryParameterWithItsStatus) {
  const Example e;
  const auto lines = estimate_table(e.table, e.estimate, e.truth);
  ASSERT_EQ(lines.size(), 5u);
  const auto contains = [&](std::size_t line, const char* text) {
    return lines[line].find(text) != std::string::npos;
  };
  EXPECT_TRUE(contains(0, "median"));
  EXPECT_TRUE(contains(1, "kN/m") && contains(1, "20.1 ") && contains(1, "+0.50"));
  EXPECT_TRUE(contains(1, "20.05") && contains(1, "20.09") && contains(1, "20.15"));
  EXPECT_TRUE(contains(1, " ok "));
  EXPECT_TRUE(contains(4, "floor too stiff") && contains(4, " - "));
}

TEST(EstimateTable, HandlesAMissingEstimate) {
  const Example e;
  const auto lines = estimate_table(e.table, window_estimate_t{}, e.truth);
  EXPECT_EQ(lines.size(), 5u);
  EXPECT_EQ(errors_against(e.table, window_estimate_t{}, e.truth).frames.without.size(), 2u);
}

}  // namespace estimate_table_test
}  // namespace framewatch::daemon
