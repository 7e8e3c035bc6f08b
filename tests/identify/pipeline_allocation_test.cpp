// Once the input is steady a sample costs no heap allocation, Eigen's included. Counted by this
// program's own malloc, in front of glibc's.
#include <atomic>
#include <cstdlib>
#include <map>
#include <memory>

#include <gtest/gtest.h>

#include "estimator/pipeline.h"
#include "tests/support/paper_buildings.h"
#include "tests/support/pipeline_run.h"

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define FRAMEWATCH_COUNTS_ALLOCATIONS

namespace {
std::atomic<long> allocations{0};
}

extern "C" {
void* __libc_malloc(std::size_t size);
void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
}
#endif

namespace framewatch {
namespace {

#ifdef FRAMEWATCH_COUNTS_ALLOCATIONS

constexpr int kSteadyFrom = 1500;
constexpr int kWindow = 500;

/// Instants of steady input that allocated, by how often each did.
std::map<long, int> allocating_instants(bool self_tune) {
  const Structure s = test::table1();
  PipelineConfig config = test::pipeline_config(s);
  config.design = test::table1_theta();
  config.options.self_tune = self_tune;
  const Eigen::MatrixXd accel = test::shaken(s, config.design, 100, 25, 0.01);
  int values = 0;
  Pipeline pipeline(
      config, [&](const WindowEstimate& e) { values += e.status == WindowStatus::valid ? 1 : 0; });
  std::map<long, int> instants;
  for (int t = 0; t < accel.rows(); ++t) {
    const long before = allocations;
    for (int axis = 0; axis < accel.cols(); ++axis)
      pipeline.push(test::sample_at(accel, 100, t, axis));
    const long made = allocations - before;
    if (t >= kSteadyFrom && made > 0) ++instants[made];
  }
  EXPECT_GT(values, 500);
  EXPECT_EQ(pipeline.counters().retunes, 0);
  return instants;
}

TEST(PipelineAllocation, CountsNewAndEigen) {
  const long before = allocations;
  const auto probe = std::make_unique<Eigen::VectorXd>(Eigen::VectorXd::Ones(7));
  ASSERT_EQ(probe->sum(), 7);
  EXPECT_EQ(allocations - before, 2);
}

TEST(PipelineAllocation, SteadyInputAllocatesNothing) {
  for (const auto& [count, instants] : allocating_instants(false))
    ADD_FAILURE() << instants << " instants made " << count << " allocations";
}

/// Whether the filters still fit is asked once a window; that alone may allocate.
TEST(PipelineAllocation, CheckOfTheTuningAllocatesOnceAWindowAtMost) {
  int checks = 0;
  for (const auto& [count, instants] : allocating_instants(true)) checks += instants;
  EXPECT_LE(checks, (2500 - kSteadyFrom) / kWindow + 1);
}

#else

TEST(PipelineAllocation, SteadyInputAllocatesNothing) {
  GTEST_SKIP() << "a sanitizer or another C library owns malloc";
}

#endif

}  // namespace
}  // namespace framewatch
