// SPDX-License-Identifier: MIT
// A constructed pipeline never allocates memory, for any samples, Eigen included. This program's
// malloc in front of glibc's, or a hook of the address sanitizer, counts allocations.
#include <atomic>
#include <cstdlib>
#include <memory>

#include <gtest/gtest.h>

#include "estimator/pipeline/pipeline.h"
#include "tests/support/paper_buildings.h"
#include "tests/support/pipeline_run.h"

namespace {
std::atomic<long> allocations{0};
}

extern "C" {
#ifdef __SANITIZE_ADDRESS__
int __sanitizer_install_malloc_and_free_hooks(void (*malloc_hook)(const volatile void*,
                                                                  std::size_t),
                                              void (*free_hook)(const volatile void*));
[[maybe_unused]] const int installed = __sanitizer_install_malloc_and_free_hooks(
    [](const volatile void*, std::size_t) { ++allocations; }, [](const volatile void*) {});
#else
void* __libc_malloc(std::size_t size);
void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
#endif
}

namespace framewatch::estimator {
namespace {

/// Results of a run of samples; `delivered` selects samples.
struct Watched {
  long allocations = 0;
  int values = 0;
  PipelineCounters counters;
};
Watched watch(const PipelineConfig& config, const Eigen::MatrixXd& accel,
              const test::Delivered& delivered = {}) {
  Watched out;
  const auto take = [&](const WindowEstimate& e) {
    out.values += e.status == WindowStatus::valid ? 1 : 0;
  };
  Pipeline pipeline(config);
  const long before = allocations;
  for (int t = 0; t < accel.rows(); ++t)
    for (int axis = 0; axis < accel.cols(); ++axis)
      if (!delivered || delivered(t, axis))
        each_main_window(pipeline.push(test::sample_at(accel, 100, t, axis)), take);
  each_main_window(pipeline.finish(), take);
  out.allocations = allocations - before;
  out.counters = pipeline.counters();
  return out;
}

TEST(PipelineAllocation, CountsNewAndEigen) {
  const long before = allocations;
  const auto probe = std::make_unique<Eigen::VectorXd>(Eigen::VectorXd::Ones(7));
  ASSERT_EQ(probe->sum(), 7);
  EXPECT_EQ(allocations - before, 2);
}

/// Warms up, estimates, and checks once per window whether the filters still fit.
TEST(PipelineAllocation, SamplesAllocateNothing) {
  for (const bool small : {true, false}) {
    const Structure s = small ? test::table1() : test::table2();
    PipelineConfig config = test::pipeline_config(s);
    config.design = small ? test::table1_theta() : test::table2_theta('c');
    config.options.long_window_s = 8;
    const Watched run = watch(config, test::shaken(s, config.design, 100, 25, 0.01));
    EXPECT_EQ(run.allocations, 0);
    EXPECT_GT(run.values, 500);
    EXPECT_LE(run.counters.retunes, 1);  // to the noise that was measured
  }
}

TEST(PipelineAllocation, RetuningTheFiltersAllocatesNothing) {
  const Structure s = test::table1();
  PipelineConfig config = test::pipeline_config(s);  // the guessed design is far off
  const Watched run = watch(config, test::shaken(s, test::table1_theta(), 100, 25, 0.01));
  EXPECT_EQ(run.allocations, 0);
  EXPECT_GT(run.values, 500);
  EXPECT_GE(run.counters.retunes, 1);
}

TEST(PipelineAllocation, LossesGapsAndSilentAxesAllocateNothing) {
  const Structure s = test::table1();
  PipelineConfig config = test::pipeline_config(s);
  config.design = test::table1_theta();
  config.options.long_window_s = 8;
  for (SensorAxis& axis : config.axes) axis.noise_density = 1e-3;
  const Watched run =
      watch(config, test::shaken(s, config.design, 100, 40, 0.01), [](int t, int axis) {
        if (t == 1400) return axis != 3;              // a single loss
        if (t >= 1500 && t < 1503) return axis != 7;  // a short one
        if (t >= 1600 && t < 1900) return axis != 5;  // a silent axis
        return t < 2000 || t >= 2300;                 // no channel
      });
  EXPECT_EQ(run.allocations, 0);
  EXPECT_GT(run.values, 500);
  EXPECT_GE(run.counters.interruptions, 1);
}

}  // namespace
}  // namespace framewatch::estimator
