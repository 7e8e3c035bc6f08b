// SPDX-License-Identifier: MIT
// Measures one shift of the window, ours and with dense algebra, side by side in one run on one
// core.
#include <malloc.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "estimator/identify/elements/deformations.h"
#include "estimator/identify/elements/floor_layout.h"
#include "estimator/motion/acquisition.h"
#include "estimator/motion/derivative_triple.h"
#include "estimator/motion/drift_controlled_integrator.h"
#include "estimator/structure/parameter_table.h"
#include "tests/bench/alternatives.h"
#include "tests/bench/cpu_clock.h"
#include "tests/bench/shaken_building.h"

namespace framewatch::bench {
namespace {

constexpr int kWindow = 500;
constexpr int kShifts = 200;            // of an alternative, at most
constexpr int kSteadyFrom = 1000;       // instants; warm-up and first tuning are over on most
constexpr double kMaxOfOne_s = 8;       // of an alternative; longer ones are cut short or skipped
constexpr double kDenseRate = 1.5e10;   // floating-point operations a second, to predict that
constexpr double kUnblockedRate = 2e9;  // the same for Eigen's LDLT and numpy's SVD
constexpr double kBudget_us = 10'000;   // of a shift at 100 Hz

struct Size {
  int bays, stories;
};
constexpr Size kSizes[] = {{1, 2}, {1, 5}, {1, 10}, {1, 20}, {1, 40}, {1, 60}, {1, 100}, {1, 300},
                           {3, 2}, {3, 5}, {3, 10}, {3, 20}, {3, 40}, {3, 60}, {3, 100}, {3, 300}};

struct Cost {
  double median_us = 0, p99_us = 0, largest_us = 0;
};

/// One way to the estimate. extrapolated: computed from a smaller run.
struct Result {
  double us = 0;
  bool extrapolated = false;
};

struct Row {
  Size size;
  int parameters = 0, equations = 0;
  Cost shift;
  double windows_us = 0, windows_p99_us = 0;  ///< with the default four windows
  double boxplot_us = 0, front_us = 0, start_s = 0, memory_mb = 0;
  /// naive, LLT, LDLT by Eigen as the program is built, then for AVX2 and AVX-512; numpy
  std::array<Result, 7> other{};
};

Cost cost_of(const std::vector<double>& times, double clock_us) {
  const auto net = [&](double share) { return std::max(quantile(times, share) - clock_us, 0.0); };
  return {net(0.5), net(0.99), net(1)};
}

double allocated_mb() {
  const auto info = ::mallinfo2();
  return 1e-6 * static_cast<double>(info.uordblks + info.hblkhd);
}

/// Times every instant from kSteadyFrom on, with all its axes pushed one after the other.
template <typename Clock, typename Push>
std::vector<double> time_instants(const Eigen::MatrixXd& accel, Clock clock_us, Push push) {
  std::vector<double> times;
  times.reserve(static_cast<std::size_t>(accel.rows()));
  for (int t = 0; t < accel.rows(); ++t) {
    const estimator::Time time = estimator::from_microseconds(10'000LL * t);
    const double begin = clock_us();
    for (int a = 0; a < accel.cols(); ++a) push(estimator::AccelSample{time, a, accel(t, a)});
    if (t >= kSteadyFrom) times.push_back(clock_us() - begin);
  }
  return times;
}

/// Reading the CPU clock is a system call, which costs too much in a shift of a few microseconds.
/// So the median of small buildings uses the other clock. The p99 always uses the CPU clock, which
/// does not count time of other processes.
template <typename Make>
Cost time_twice(const Eigen::MatrixXd& accel, double clock_us, bool small, Make make) {
  auto first = make();
  Cost cost = cost_of(
      time_instants(accel, cpu_us, [&](const estimator::AccelSample& s) { first->push(s); }),
      clock_us);
  if (!small) return cost;
  auto second = make();
  cost.median_us = quantile(
      time_instants(accel, wall_us, [&](const estimator::AccelSample& s) { second->push(s); }),
      0.5);
  return cost;
}

/// Times the whole pipeline, from samples to the published estimate: with the main window alone,
/// as the alternatives have it; with all windows; with the main window and boxplots.
enum class Ours { window, windows, boxplot };

void run_ours(const estimator::PipelineConfig& base, const Eigen::MatrixXd& accel, double clock_us,
              Ours what, Row& row) {
  estimator::PipelineConfig config = base;
  if (what != Ours::boxplot) config.options.boxplot_windows = 0;
  if (what != Ours::windows) config.options.other_windows_s.clear();
  int valid = 0;
  const auto make = [&] {
    const double before_mb = allocated_mb(), start = cpu_us();
    auto pipeline =
        std::make_unique<estimator::Pipeline>(config, [&](const estimator::WindowEstimate& e) {
          valid += e.status == estimator::WindowStatus::valid ? 1 : 0;
        });
    if (what == Ours::windows) row.start_s = 1e-6 * (cpu_us() - start);
    if (what == Ours::windows) row.memory_mb = std::max(row.memory_mb, allocated_mb() - before_mb);
    return pipeline;
  };
  const Cost cost = time_twice(accel, clock_us, row.size.stories <= 20, make);
  if (valid == 0) std::printf("(no valid estimate)\n");
  switch (what) {
    case Ours::window:
      row.shift = cost;
      break;
    case Ours::windows:
      row.windows_us = cost.median_us, row.windows_p99_us = cost.p99_us;
      break;
    case Ours::boxplot:
      row.boxplot_us = std::max(cost.median_us - row.shift.median_us, 0.0);
  }
}

/// Times the step from samples to element deformations, which every method needs.
class FrontEnd {
 public:
  explicit FrontEnd(const estimator::PipelineConfig& config)
      : table_(config.structure),
        layout_(config.structure, table_),
        deformations_(config.structure, layout_, config.axes),
        filter_(std::vector<estimator::DerivativeTriple>(config.axes.size(),
                                                         estimator::matched_triple(100)),
                estimator::HighPass(config.options.high_pass_hz, 100)),
        set_(deformations_.make_set()),
        acquisition_(config.axes, config.options) {}
  void push(const estimator::AccelSample& sample) {
    for (const estimator::SampleSet& samples : acquisition_.push(sample)) {
      filter_.push(samples.accel);
      deformations_.compute(filter_, set_);
    }
  }

 private:
  estimator::ParameterTable table_;
  estimator::FloorLayout layout_;
  estimator::Deformations deformations_;
  estimator::DriftControlledIntegrator filter_;
  estimator::DeformationSet set_;
  estimator::Acquisition acquisition_;
};

double median_of_runs(const DenseInput& input, Alternative& way, int counted, double most_s) {
  std::vector<double> cpu, wall;
  const double end = cpu_us() + 1e6 * most_s;
  for (int i = 1; i <= kShifts && (cpu.empty() || cpu_us() < end); ++i) {
    const double begin = cpu_us(), wall_begin = wall_us();
    way.solve(input.motion.data() + i * input.stride(), kWindow, counted);
    wall.push_back(wall_us() - wall_begin);
    cpu.push_back(cpu_us() - begin);
  }
  return std::min(quantile(cpu, 0.5), quantile(wall, 0.5));
}

using Make = std::unique_ptr<Alternative> (*)(Method, const Pattern&);
const std::vector<Make> kPortable = {make_alternative_v1};
const std::vector<Make> kNative = {make_alternative_v3, make_alternative_v4};
constexpr double kPortableSlower = 3;

/// Returns the fastest of some instruction sets. Cut to `counted` of the window's instants, with
/// the cost scaled by kWindow / counted.
Result run_dense(Method method, const std::vector<Make>& builds, const DenseInput& input,
                 double flops, double rate) {
  const double foreseen_s = flops / rate;
  int counted = kWindow;
  if (method == Method::naive && foreseen_s > kMaxOfOne_s)
    counted = std::max(1, static_cast<int>(kWindow * kMaxOfOne_s / foreseen_s));
  if (method != Method::naive && foreseen_s > kMaxOfOne_s) return {};
  Result best;
  for (const Make make : builds) {
    const auto way = make(method, input.pattern());
    if (way == nullptr) continue;
    // A recursive sum starts with enough instants to be regular.
    if (method != Method::naive)
      way->solve(input.motion.data(), kWindow,
                 std::min(kWindow, 4 * input.elements / input.equations + 10));
    double us = median_of_runs(input, *way, counted, 2);
    if (counted < kWindow) {
      const double factor_us = median_of_runs(input, *way, 0, 1);
      us = (us - factor_us) * kWindow / counted + factor_us;
    }
    if (best.us == 0 || us < best.us) best = {us, counted < kWindow};
  }
  return best;
}

Result run_numpy(int equations, int parameters, double flops) {
  if (flops / kUnblockedRate / 2 > kMaxOfOne_s) return {};
  const std::string command = "OPENBLAS_NUM_THREADS=1 /usr/bin/python3 " FRAMEWATCH_SOURCE_DIR
                              "/tests/bench/numpy_lstsq.py " +
                              std::to_string(kWindow * equations) + " " +
                              std::to_string(parameters) + " 2>/dev/null";
  Result out;
  if (FILE* pipe = ::popen(command.c_str(), "r")) {
    if (std::fscanf(pipe, "%lf", &out.us) != 1) out.us = 0;
    ::pclose(pipe);
  }
  return out;
}

void run_alternatives(const estimator::PipelineConfig& config, Row& row, const Row* smaller) {
  const double p = row.parameters, rows = kWindow * static_cast<double>(row.equations);
  const double gram = 2 * rows * p * p, factor = p * p * p / 3;
  const double update = 2.0 * row.equations * p * p;
  if (row.size.stories <= 100) {
    const DenseInput input(config, kWindow + kShifts + 1);
    for (std::size_t i = 0; i < 2; ++i) {
      const std::vector<Make>& builds = i == 0 ? kPortable : kNative;
      const double rate = i == 0 ? kDenseRate / kPortableSlower : kDenseRate;
      Result* to = &row.other[3 * i];
      to[0] = run_dense(Method::naive, builds, input, gram + factor, rate);
      to[1] = run_dense(Method::recursive_llt, builds, input, update + factor, rate);
      to[2] = run_dense(Method::recursive_ldlt, builds, input, update + factor, kUnblockedRate);
    }
    row.other[6] = run_numpy(row.equations, row.parameters, 2 * gram);
  }
  // Cases that need too long or too much memory are extrapolated from the next smaller building.
  if (smaller == nullptr) return;
  const double ratio = p / smaller->parameters;
  for (std::size_t i = 0; i < row.other.size(); ++i)
    if (row.other[i].us == 0 && smaller->other[i].us > 0)
      row.other[i] = {smaller->other[i].us * ratio * ratio * ratio, true};
}

double ratio(const Row& r, std::size_t other) {
  return (r.other[other].us + r.front_us) / r.shift.median_us;
}

void print_head() {
  std::printf("%-5s %4s %6s | %9s %9s %9s | %9s %9s | %8s %8s | %8s %7s | %s\n", "bays", "N",
              "params", "shift us", "p99", "largest", "4 windows", "p99", "boxplot", "front",
              "start s", "MB",
              "us and ratio to ours: naive rebuild, recursive + LLT, + LDLT (Eigen as the program "
              "is built), the same for AVX2/AVX-512, numpy lstsq");
}

void print(const Row& r) {
  std::printf("%dx%-3d %4d %6d | %9.1f %9.1f %9.1f | %9.1f %9.1f | %8.1f %8.1f | %8.2f %7.1f |",
              r.size.bays, r.size.bays, r.size.stories, r.parameters, r.shift.median_us,
              r.shift.p99_us, r.shift.largest_us, r.windows_us, r.windows_p99_us, r.boxplot_us,
              r.front_us, r.start_s, r.memory_mb);
  for (const Result& other : r.other) {
    if (other.us == 0)
      std::printf(" %11s %9s", "-", "");
    else
      std::printf(" %s%10.0f %8.1fx", other.extrapolated ? "~" : " ", other.us + r.front_us,
                  (other.us + r.front_us) / r.shift.median_us);
  }
  std::printf("\n");
  std::fflush(stdout);
}

/// Slope of log(median) over log(N) from 10 to 100 stories, least squares.
double growth(const std::vector<Row>& rows, int bays) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const Row& r : rows) {
    if (r.size.bays != bays || r.size.stories < 10 || r.size.stories > 100) continue;
    const double x = std::log(r.size.stories), y = std::log(r.shift.median_us);
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return n > 1 ? (n * sxy - sx * sy) / (n * sxx - sx * sx) : 0;
}

void print_targets(const std::vector<Row>& rows) {
  struct Target {
    Size size;
    double naive, llt;
  };
  constexpr Target kTargets[] = {
      {{1, 5}, 300, 2.5}, {{3, 2}, 160, 1.5}, {{3, 20}, 5000, 30}, {{3, 40}, 19000, 120}};
  std::printf(
      "\nasked for                  naive: wanted    got (AVX)   LLT: wanted   got (AVX)\n");
  for (const Target& t : kTargets)
    for (const Row& r : rows)
      if (r.size.bays == t.size.bays && r.size.stories == t.size.stories)
        std::printf("%dx%d bays, %3d stories %14.0fx %6.0fx (%.0fx) %7.1fx %6.1fx (%.1fx)\n",
                    t.size.bays, t.size.bays, t.size.stories, t.naive, ratio(r, 0), ratio(r, 3),
                    t.llt, ratio(r, 1), ratio(r, 4));
  for (const int bays : {1, 3})
    std::printf("growth exponent, %dx%d bays, 10 to 100 stories: %.2f (wanted: at most 1.1)\n",
                bays, bays, growth(rows, bays));
  for (const Row& r : rows)
    if (r.size.bays == 3 && r.size.stories >= 60)
      std::printf("3x3 bays, %3d stories: p99 with 4 windows is %4.1f %% of the 10-ms budget\n",
                  r.size.stories, 100 * r.windows_p99_us / kBudget_us);
}

Row run(const Size& size, int instants, double clock_us) {
  Row row;
  row.size = size;
  const estimator::PipelineConfig config = building(size.stories, size.bays);
  row.parameters = estimator::ParameterTable(config.structure).size();
  row.equations = config.structure.degrees_of_freedom();
  const Eigen::MatrixXd accel = shaken(config, instants);
  for (const Ours what : {Ours::window, Ours::windows, Ours::boxplot})
    run_ours(config, accel, clock_us, what, row);
  row.front_us = time_twice(accel, clock_us, size.stories <= 20, [&] {
                   return std::make_unique<FrontEnd>(config);
                 }).median_us;
  return row;
}

}  // namespace
}  // namespace framewatch::bench

/// shift_bench [MOST_STORIES [BAYS]] | shift_bench BAYS STORIES INSTANTS: ours only
int main(int argc, char** argv) {
  using namespace framewatch::bench;
  const double clock_us = cpu_clock_cost_us();
  print_head();
  if (argc == 4) {
    print(run({std::atoi(argv[1]), std::atoi(argv[2])}, std::atoi(argv[3]), clock_us));
    return 0;
  }
  const int most = argc > 1 ? std::atoi(argv[1]) : 300;
  const int only = argc > 2 ? std::atoi(argv[2]) : 0;
  std::vector<Row> rows;
  for (const Size& size : kSizes) {
    if (size.stories > most || (only > 0 && size.bays != only)) continue;
    const int instants = size.stories > 100 ? 2500 : 4000;
    Row row = run(size, instants, clock_us);
    const bool same = !rows.empty() && rows.back().size.bays == size.bays;
    run_alternatives(building(size.stories, size.bays), row, same ? &rows.back() : nullptr);
    rows.push_back(row);
    print(row);
  }
  print_targets(rows);
  return 0;
}
