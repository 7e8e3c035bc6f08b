// What one shift of the window costs, ours and by dense algebra, side by side in one run.
#include <sched.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "tests/bench/alternatives.h"
#include "tests/bench/cpu_clock.h"
#include "tests/bench/shaken_building.h"

namespace framewatch::bench {
namespace {

constexpr int kWindow = 500;
constexpr double kMostOfOne_s = 12;       // an alternative that would take longer is cut short
constexpr double kDenseMost_bytes = 4e9;  // of a Gram matrix and its factor

struct Cost {
  double median_us = 0, p99_us = 0, largest_us = 0;
};

struct Ours {
  Cost shift, boxplot;
  double memory_mb = 0;
  double start_s = 0;
  int valid = 0, windows = 0, retunes = 0;
};

Cost cost_of(const std::vector<double>& times, double clock_us) {
  const auto net = [&](double share) { return std::max(quantile(times, share) - clock_us, 0.0); };
  return {net(0.5), net(0.99), net(1)};
}

double resident_mb() {
  long pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return 1e-6 * static_cast<double>(resident * ::sysconf(_SC_PAGESIZE));
}

/// Whole pipeline, from samples to the estimate given out.
Ours run_ours(const PipelineConfig& base, const Eigen::MatrixXd& accel, int from, double clock_us,
              bool boxplot) {
  PipelineConfig config = base;
  if (!boxplot) config.options.boxplot_windows = 0;
  Ours out;
  const double before_mb = resident_mb();
  const double start = cpu_us();
  Pipeline pipeline(config, [&](const WindowEstimate& e) {
    ++out.windows;
    out.valid += e.status == WindowStatus::valid ? 1 : 0;
  });
  out.start_s = 1e-6 * (cpu_us() - start);
  std::vector<double> times;
  times.reserve(static_cast<std::size_t>(accel.rows()));
  for (int t = 0; t < accel.rows(); ++t) {
    const Time time = from_microseconds(10'000LL * t);
    const double begin = cpu_us();
    for (int a = 0; a < accel.cols(); ++a) pipeline.push({time, a, accel(t, a)});
    const double taken = cpu_us() - begin;
    if (t >= from) times.push_back(taken);
  }
  out.memory_mb = resident_mb() - before_mb;
  out.shift = cost_of(times, clock_us);
  out.retunes = static_cast<int>(pipeline.counters().retunes);
  return out;
}

}  // namespace
}  // namespace framewatch::bench

int main(int argc, char** argv) {
  using namespace framewatch;
  using namespace framewatch::bench;
  const double clock_us = cpu_clock_cost_us();
  struct Size { int bays, stories; };
  std::vector<Size> sizes = {{1,2},{1,5},{1,10},{1,20},{1,40},{1,60},{1,100},{3,2},{3,5},{3,10},{3,20},{3,40},{3,60},{3,100},{3,300}};
  if (argc > 3) {
    const PipelineConfig config = building(std::atoi(argv[2]), std::atoi(argv[1]));
    const Eigen::MatrixXd accel = shaken(config, std::atoi(argv[3]));
    const Ours o = run_ours(config, accel, 1500, clock_us, argc > 4);
    std::printf("start %.2f s  shift %9.2f p99 %9.2f max %9.2f us  mem %.1f MB valid %d/%d retunes %d\n", o.start_s, o.shift.median_us, o.shift.p99_us, o.shift.largest_us, o.memory_mb, o.valid, o.windows, o.retunes);
    return 0;
  }
  const int most = argc > 1 ? std::atoi(argv[1]) : 60;
  for (const Size& size : sizes) {
    if (size.stories > most) continue;
    const PipelineConfig config = building(size.stories, size.bays);
    const Eigen::MatrixXd accel = shaken(config, 4000);
    const Ours o = run_ours(config, accel, 2000, clock_us, true);
    std::printf("%dx%d N=%3d start %.2f s  shift %9.1f p99 %9.1f max %9.1f us  mem %.1f MB valid %d/%d retunes %d\n", size.bays, size.bays, size.stories, o.start_s, o.shift.median_us, o.shift.p99_us, o.shift.largest_us, o.memory_mb, o.valid, o.windows, o.retunes);
    DenseInput input(config, std::min(kWindow + 20, size.stories * size.bays > 60 ? 1 : 520));
    if (size.stories > 20) continue;
    for (auto* make : {make_alternative_v3, make_alternative_v4})
      for (Method method : {Method::naive, Method::recursive_llt, Method::recursive_ldlt}) {
        auto alt = make(method, input.pattern());
        alt->solve(input.motion.data(), kWindow, kWindow);
        std::vector<double> times;
        for (int i = 1; i < (size.stories > 10 && method == Method::naive ? 3 : 20); ++i) {
          const double begin = cpu_us();
          alt->solve(input.motion.data() + i * input.stride(), kWindow, kWindow);
          times.push_back(cpu_us() - begin);
        }
        const Cost c = cost_of(times, clock_us);
        std::printf("   method %d  %9.1f us  ratio %.1f\n", static_cast<int>(method), c.median_us, c.median_us / o.shift.median_us);
      }
    std::fflush(stdout);
  }
}
