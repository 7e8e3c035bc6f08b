// How far the streaming estimator is from the Cramer-Rao bound. FRAMEWATCH_BOUND_SEEDS (default 3)
// motions a case; with 20 and --gtest_also_run_disabled_tests --gtest_filter=*Table this is the
// whole table.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/accuracy_trial.h"
#include "estimator/refine/cramer_rao.h"
#include "tests/support/noisy_stretch.h"
#include "tests/support/paper_buildings.h"

namespace framewatch {
namespace {

constexpr double kMedianOfNormal = 0.674;  ///< median |error| over standard deviation
constexpr double kFirstEnd_s = 10;
constexpr const char* kKind[] = {"k", "G", "c", "G_c"};

struct Case {
  char building;
  double noise;
};

struct Medians {
  double bound[4], streaming[4];
  double ratio(int kind) const { return streaming[kind] / (kMedianOfNormal * bound[kind]); }
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The 5-s windows, one a second, that end at 10 s or later, and the bound of the same 5 seconds.
Medians measure(Case c, int seeds) {
  const Structure s = c.building == '1' ? test::table1() : test::table2();
  const Eigen::VectorXd truth =
      c.building == '1' ? test::table1_theta() : test::table2_theta(c.building);
  const ParameterTable table(s);
  std::vector<double> bound[4];
  daemon::ErrorsByKind errors;
  for (int i = 1; i <= seeds; ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    daemon::AccuracyTrial trial;
    trial.structure = s;
    trial.truth = truth;
    trial.design = daemon::perturbed_design(table, truth, 0.1, 0.3, seed);
    trial.motion = test::oblique_motion(seed);
    trial.noise_ratio = c.noise;
    trial.seed = seed;
    std::vector<WindowEstimate> windows = daemon::run_trial(trial);
    std::erase_if(windows, [](const WindowEstimate& w) {
      return static_cast<double>(to_microseconds(w.end)) < kFirstEnd_s * 1e6;
    });
    daemon::collect_errors(windows, table, truth, errors);
    for (const WindowEstimate& w : windows) {
      const double end_s = 1e-6 * static_cast<double>(to_microseconds(w.end));
      const auto stretch = test::exact_stretch(s, truth, trial.motion, c.noise, end_s - 5, end_s);
      const CramerRaoBound b = cramer_rao_bound(s, stretch.axes, truth, 100, stretch.accel_abs);
      for (int p = 0; p < table.size(); ++p)
        bound[static_cast<int>(table[p].kind)].push_back(b.std_error[p] / truth[p]);
    }
  }
  Medians out;
  for (int kind = 0; kind < 4; ++kind) {
    out.bound[kind] = median(bound[kind]);
    out.streaming[kind] = errors[static_cast<std::size_t>(kind)].quantile(0.5);
  }
  return out;
}

int seeds() {
  const char* text = std::getenv("FRAMEWATCH_BOUND_SEEDS");
  return text == nullptr ? 3 : std::max(1, std::atoi(text));
}

TEST(StreamingBound, TableOneStiffnessIsWithinTwiceTheBound) {
  constexpr double kMost = 2.0;   // three motions only; 1.6 is the aim over twenty
  constexpr double kLeast = 0.7;  // lower would mean that the bound is wrong
  const Medians m = measure({'1', 0.01}, seeds());
  EXPECT_LT(m.ratio(0), kMost);
  EXPECT_GT(m.ratio(0), kLeast);
}

TEST(StreamingBound, DISABLED_Table) {
  std::printf("%-10s %-4s %10s %10s %7s\n", "case", "", "bound", "streaming", "ratio");
  for (const Case c : {Case{'1', 0.01}, Case{'1', 0.05}, Case{'b', 0.01}, Case{'c', 0.01},
                       Case{'c', 0.05}, Case{'d', 0.01}}) {
    const Medians m = measure(c, seeds());
    for (int kind = 0; kind < 4; ++kind)
      std::printf("T%c %4.0f %% %6s %10.5f %10.5f %7.2f\n", c.building, 100 * c.noise, kKind[kind],
                  m.bound[kind], m.streaming[kind], m.ratio(kind));
    EXPECT_GT(m.streaming[0], 0);
  }
}

}  // namespace
}  // namespace framewatch
