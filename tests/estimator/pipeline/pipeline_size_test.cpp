// SPDX-License-Identifier: MIT
#include "estimator/pipeline/pipeline_size.h"

#include <malloc.h>

#include <cstddef>
#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "estimator/pipeline/pipeline.h"

#ifdef __SANITIZE_ADDRESS__
extern "C" std::size_t __sanitizer_get_current_allocated_bytes();
#endif

namespace framewatch::estimator {
namespace pipeline_size_test {

// Limits.
constexpr double kOff = 0.35;  // of what a pipeline takes

std::size_t allocated_bytes() {
#ifdef __SANITIZE_ADDRESS__
  return __sanitizer_get_current_allocated_bytes();
#else
  const struct mallinfo2 info = ::mallinfo2();
  return info.uordblks + info.hblkhd;
#endif
}

struct Case {
  const char* name;
  int stories, bays;
  double rate_hz, window_s, high_pass_hz, lateness_s, long_window_s;
  int boxplot_windows;
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << c.name;
}

PipelineConfig config_of(const Case& c) {
  PipelineConfig out;
  Structure& s = out.structure;
  s.stories = c.stories;
  for (int f = 0; f <= c.bays; ++f) {
    s.frames_x.push_back("y" + std::to_string(f));
    s.frames_y.push_back("x" + std::to_string(f));
  }
  const auto bays = static_cast<std::size_t>(c.bays);
  s.span_x.assign(bays, 5.0);
  s.span_y.assign(bays, 5.0);
  s.story_height.assign(static_cast<std::size_t>(c.stories), 3.0);
  s.node_mass.assign(static_cast<std::size_t>(c.stories) * (bays + 1) * (bays + 1), 1000.0);
  for (int story = 0; story <= c.stories; ++story)
    for (int f = 0; f < (story == 0 ? 2 : s.frames()); ++f) {
      SensorAxis axis;
      axis.name = "s" + std::to_string(story) + "_" + std::to_string(f);
      axis.story = story;
      axis.frame = story == 0 ? -1 : f;
      axis.direction = story == 0 ? (f == 0 ? Direction::x : Direction::y) : s.direction(f);
      out.axes.push_back(axis);
    }
  EstimatorOptions& o = out.options;
  o.rate_hz = c.rate_hz;
  o.window_s = c.window_s;
  o.high_pass_hz = c.high_pass_hz;
  o.lateness_s = c.lateness_s;
  o.long_window_s = c.long_window_s;
  o.boxplot_windows = c.boxplot_windows;
  return out;
}

class PipelineSizeOf : public testing::TestWithParam<Case> {};

TEST_P(PipelineSizeOf, EqualsTheMemoryOfAPipeline) {
  const PipelineConfig config = config_of(GetParam());
  for (const std::string& problem : problems(config)) ADD_FAILURE() << problem;
  const std::size_t before = allocated_bytes();
  const Pipeline pipeline(config);
  const double taken = static_cast<double>(allocated_bytes() - before);
  const PipelineSize size = pipeline_size(config);
  EXPECT_NEAR(size.bytes() / taken, 1, kOff)
      << taken << ": sums " << size.sums << ", solvers " << size.solvers << ", motion "
      << size.motion << ", noise " << size.noise << ", boxplots " << size.boxplots << ", open "
      << size.open;
}

INSTANTIATE_TEST_SUITE_P(Some, PipelineSizeOf,
                         testing::Values(Case{"tower", 40, 1, 100, 5, 0.3, 0.5, 0, 500},
                                         Case{"wide", 10, 3, 100, 5, 0.3, 0.5, 0, 500},
                                         Case{"fast", 4, 1, 2000, 5, 0.3, 0.5, 0, 500},
                                         Case{"slow_drift", 2, 1, 500, 5, 0.005, 0.5, 0, 500},
                                         Case{"long_window", 10, 2, 100, 20, 0.3, 0.5, 3600, 500},
                                         Case{"boxplots", 10, 1, 100, 5, 0.3, 0.5, 0, 20000},
                                         Case{"late", 10, 1, 2000, 1, 3, 20, 0, 500}),
                         [](const auto& at) { return std::string(at.param.name); });

}  // namespace pipeline_size_test
}  // namespace framewatch::estimator
