#include "estimator/identify/window/held_bending.h"

#include <algorithm>
#include <cmath>

namespace framewatch::estimator {
namespace {

constexpr double kMaxError = 0.5;  // relative, of a window that counts
constexpr double kSurprise = 2;    // times the error of a step
constexpr double kTiny = 1e-300;
constexpr double kMinStep = 0.6, kMaxStep = 1.6;  // per window

EstimatorOptions of_bending(EstimatorOptions options) {
  options.long_window_s = std::max(HeldBending::kWindow_s, 2 * options.window_s);
  return options;
}

}  // namespace

HeldBending::HeldBending(const Structure& structure, const FloorLayout& layout,
                         const ParameterTable& table, const EstimatorOptions& options,
                         int block_rows, bool noise_configured, const Eigen::VectorXd& design)
    : window_(structure, layout, table, of_bending(options), block_rows, 0, noise_configured,
              LongWindow::Blocks::by_energy) {
  for (int u = 0; u < layout.unknowns(); ++u) {
    const int p = layout.parameter(u / layout.own(), u % layout.own());
    if (table[p].kind == ParameterKind::frame_stiffness) stiffnesses_.push_back(u);
    if (table[p].kind == ParameterKind::bending_stiffness)
      held_.push_back({p, u, design[p], design_tolerance(table[p].kind)});
  }
}

double HeldBending::detuning(const WindowSolution& solution) const {
  double out = 0;
  for (const int u : stiffnesses_) {
    const double ratio = solution.solver().solution()[static_cast<std::size_t>(u)];
    if (solution.shown(u))
      out = std::max(out, std::abs(std::log(std::clamp(ratio, kMinStep, kMaxStep))));
  }
  return out;
}

bool HeldBending::advance(const LongWindow::Context& context) {
  if (window_.advance(context) == nullptr || !context.tuned) return false;
  const WindowSolution& solution = window_.solution();
  const StorySolver& solver = solution.solver();
  const double off = detuning(solution);
  const double misfit = std::sqrt(std::max(solver.residual_energy(), 0.0) /
                                  std::max(solver.response_energy(), kTiny));
  bool changed = false;
  for (Held& h : held_) {
    const auto u = static_cast<std::size_t>(h.unknown);
    // A model that misfits by some share is wrong by about that share.
    const double error = std::max(std::hypot(solution.std_error()[u], misfit), kMin);
    const double with_tuning = std::hypot(error, off);
    if (!solver.usable(h.unknown) || !(with_tuning < kMaxError)) continue;
    // The equations are linear in it near the tuning only.
    const double ratio = std::clamp(solver.solution()[u], kMinStep, kMaxStep);
    const double value = ratio * context.regression->tuning().theta0()[h.parameter];
    const double step = std::log(value / h.value);
    double variance = h.std_error * h.std_error + kDrift * kDrift;
    // What is held was found far from the right tuning, or the building has changed.
    if (step * step > kSurprise * kSurprise * (variance + error * error)) variance = step * step;
    const double before = 1 / variance, now = 1 / (with_tuning * with_tuning);
    h.value *= std::exp(step * now / (before + now));
    h.std_error = std::max(1 / std::sqrt(before + now), kMin);
    changed = true;
  }
  if (changed) window_.begin_anew();
  return changed;
}

}  // namespace framewatch::estimator
