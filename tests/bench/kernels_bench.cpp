// SPDX-License-Identifier: MIT
// Measures each inner loop for every instruction set of this machine (google-benchmark).
#include <benchmark/benchmark.h>

#include <string>
#include <utility>
#include <vector>

#include "estimator/identify/estimate/boxplot.h"
#include "estimator/numeric/kernels.h"
#include "estimator/simulate/random.h"

namespace framewatch::bench {
namespace {

/// Fronts of a middle floor: 1x1 bay, then 3x3 bays.
struct Front {
  const char* name;
  int own, next, rows;
  int size() const { return own + next + 1; }
};
constexpr Front kFronts[] = {{"1x1", 10, 8, 4}, {"3x3", 34, 16, 8}};
constexpr int kColumns = 40;  // of the uncertainty pass

std::vector<double> random_values(int count) {
  estimator::Random random(1);
  std::vector<double> out(static_cast<std::size_t>(count));
  for (double& v : out) v = random.normal();
  return out;
}

void add_rows(benchmark::State& state, const estimator::kernels::Table& table, const Front& front) {
  const int stride = padded(front.size());
  const auto h = random_values(front.rows * stride);
  auto sum = random_values(stride * stride);
  for (auto _ : state) {
    table.add_rows(sum.data(), sum.data(), h.data(), front.rows, front.size(), stride);
    benchmark::ClobberMemory();
  }
  state.counters["flops"] = benchmark::Counter(1.0 * front.rows * front.size() * (front.size() + 1),
                                               benchmark::Counter::kIsIterationInvariantRate);
}

void partial_cholesky(benchmark::State& state, const estimator::kernels::Table& table,
                      const Front& front) {
  const int stride = padded(front.size());
  std::vector<double> start(static_cast<std::size_t>(stride * stride), 0.01);
  for (int i = 0; i < stride; ++i) start[static_cast<std::size_t>(i * stride + i)] = 10;
  auto a = start;
  const std::vector<double> least(static_cast<std::size_t>(front.own), 0.0);
  std::vector<unsigned char> usable(static_cast<std::size_t>(front.own));
  double flops = 0;
  for (int p = 0; p < front.own; ++p) flops += 1.0 * (front.size() - p) * (front.size() - p + 1);
  for (auto _ : state) {
    a = start;
    table.partial_cholesky(a.data(), a.data(), front.own, front.size(), stride, least.data(),
                           usable.data());
    benchmark::ClobberMemory();
  }
  state.counters["flops"] =
      benchmark::Counter(flops, benchmark::Counter::kIsIterationInvariantRate);
}

void backward_columns(benchmark::State& state, const estimator::kernels::Table& table,
                      const Front& front) {
  const int stride = padded(front.size());
  std::vector<double> factor(static_cast<std::size_t>(front.own * stride), 0.001);
  for (int i = 0; i < front.own; ++i) factor[static_cast<std::size_t>(i * stride + i)] = 1;
  auto x = random_values((front.own + front.next) * kColumns);
  for (auto _ : state) {
    table.backward_columns(factor.data(), stride, front.own, front.next, x.data(), kColumns);
    benchmark::ClobberMemory();
  }
}

void subtract_product(benchmark::State& state, const estimator::kernels::Table& table,
                      const Front& front) {
  const int stride = padded(front.size());
  const auto packed = random_values(stride * stride), x = random_values(stride);
  auto score = random_values(stride);
  for (auto _ : state) {
    table.subtract_product(packed.data(), x.data(), score.data(), front.size(), stride);
    benchmark::ClobberMemory();
  }
}

void boxplot(benchmark::State& state) {
  estimator::BoxplotWindow window(500);
  estimator::Random random(2);
  double value = 1;
  for (auto _ : state) {
    value += 1e-3 * random.normal();
    window.push(value);
    benchmark::DoNotOptimize(window.statistics());
  }
}

void register_all() {
  const std::pair<const char*, const estimator::kernels::Table*> tables[] = {
      {"portable", estimator::kernels::portable()},
      {"avx2", estimator::kernels::x86_64_v3()},
      {"avx512", estimator::kernels::x86_64_v4()}};
  for (const auto& [name, table] : tables) {
    if (table == nullptr) continue;
    for (const Front& front : kFronts) {
      const auto add = [&, table = table](const char* what, auto* body) {
        benchmark::RegisterBenchmark((std::string(what) + "/" + front.name + "/" + name).c_str(),
                                     [=](benchmark::State& s) { body(s, *table, front); });
      };
      add("add_rows", add_rows);
      add("partial_cholesky", partial_cholesky);
      add("backward_columns", backward_columns);
      add("subtract_product", subtract_product);
    }
  }
  benchmark::RegisterBenchmark("boxplot/500_windows", boxplot);
}

}  // namespace
}  // namespace framewatch::bench

int main(int argc, char** argv) {
  framewatch::bench::register_all();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
