// SPDX-License-Identifier: MIT
// A short soak: ten minutes contain the events of 30 days.
#include "tests/soak/soak_run.h"

#include <cstdio>

#include <gtest/gtest.h>

#include "estimator/pipeline/pipeline.h"
#include "tests/support/temporary.h"

namespace framewatch::soak {
namespace {

constexpr double kMinutes = 10;
constexpr double kSumError = 1e-9;
constexpr std::int64_t kMaxGrowth_bytes = 3 << 20;  // SQLite's cache fills for longer
constexpr std::int64_t kWindowsPerStep = 10;        // lost when the clock steps
constexpr std::int64_t kRepeatedPerStep = 3;        // published twice

TEST(Soak, LosesNoSampleAndRaisesNoAlarm) {
  const test::TemporaryDirectory directory;
  SoakOptions o;
  o.days = kMinutes / 1440;
  o.directory = directory.path("history");
  o.quiet_window_s = 60;
  o.quiet_learn_hours = 0.05;
  o.alarms_per_year = 1;
  o.summary_s = 1;
  o.rotate_s = 60;
  const SoakResult r = run_soak(o);
  EXPECT_GE(r.windows, r.expected_windows - kWindowsPerStep * SoakNight::kClockSteps);
  EXPECT_LE(r.breaks, SoakNight::kClockSteps);
  EXPECT_GE(r.sums_compared, 4);
  EXPECT_LT(r.sum_error, kSumError);
  EXPECT_EQ(r.history_trouble, "");
  EXPECT_EQ(r.raw_dropped, 0);
  EXPECT_EQ(r.summary_dropped, 0);
  EXPECT_NEAR(static_cast<double>(r.summarised_windows), static_cast<double>(r.windows),
              kRepeatedPerStep * SoakNight::kClockSteps);
  EXPECT_EQ(r.hourly_windows, r.summarised_windows);
  EXPECT_GT(r.long_values, 5);
  EXPECT_EQ(r.alarms, 0);
  ASSERT_GE(r.resident.size(), 8u);
  EXPECT_LE(r.growth(), kMaxGrowth_bytes);
  std::printf("resident:");
  for (const std::int64_t bytes : r.resident)
    std::printf(" %.2f", static_cast<double>(bytes) / (1 << 20));
  std::printf(" MiB\n");
}

/// In a short window of weak motion, the measured noise may be less than the correction for it.
/// Then its errors are unknown. In this night, the first such window comes after 47 minutes.
TEST(Soak, PublishesNoValueIfTheNoiseCorrectionExceedsTheNoise) {
  constexpr double kSeconds = 2825, kRate_hz = 100;
  SoakOptions o;
  o.directory = "history";
  estimator::PipelineConfig config = configuration(o).pipeline;
  const auto whole = static_cast<std::int64_t>(o.days * 86400 * kRate_hz);
  SoakNight night(config, whole, o.seed);
  int windows = 0;
  const auto look = [&](const estimator::WindowEstimate& e) {
    if (e.status == estimator::WindowStatus::warming_up) return;
    for (std::size_t p = 0; p < e.value.size(); ++p) {
      if (e.snr[p] > 0) continue;
      EXPECT_NE(e.reason[p], estimator::Observability::observable);
      windows += p == 0 ? 1 : 0;
    }
  };
  estimator::Pipeline pipeline(config);
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(kSeconds * kRate_hz); ++i) {
    const Instant instant = night.next();
    for (std::size_t a = 0; a < instant.accel->size(); ++a)
      estimator::each_window(pipeline.push({estimator::from_microseconds(instant.time_us),
                                            static_cast<int>(a), (*instant.accel)[a]}),
                             look);
  }
  EXPECT_GT(windows, 0);
}

}  // namespace
}  // namespace framewatch::soak
