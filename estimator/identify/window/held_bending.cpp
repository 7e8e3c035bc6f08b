#include "estimator/identify/window/held_bending.h"

#include <algorithm>
#include <cmath>

namespace framewatch::estimator {
namespace {

constexpr double kMostError = 0.5;                   // relative, of a window that counts
constexpr double kLeastStep = 0.6, kMostStep = 1.6;  // per window

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
    if (table[p].kind == ParameterKind::bending_stiffness)
      held_.push_back({p, u, design[p], design_tolerance(table[p].kind)});
  }
}

bool HeldBending::advance(const LongWindow::Context& context) {
  const WindowEstimate* e = window_.advance(context);
  if (e == nullptr || !context.tuned) return false;
  bool changed = false;
  const WindowSolution& solution = window_.solution();
  for (Held& h : held_) {
    const auto u = static_cast<std::size_t>(h.unknown);
    const double error = std::max(solution.std_error()[u], kLeast);
    if (!solution.solver().usable(h.unknown) || !(error < kMostError)) continue;
    // The equations are linear in it near the tuning only.
    const double ratio = std::clamp(solution.solver().solution()[u], kLeastStep, kMostStep);
    const double value = ratio * context.regression->tuning().theta0()[h.parameter];
    // Weights of what was held, which may have moved since, and of the new window.
    const double before = 1 / (h.std_error * h.std_error + kDrift * kDrift);
    const double now = 1 / (error * error);
    h.value *= std::pow(value / h.value, now / (before + now));
    h.std_error = std::max(1 / std::sqrt(before + now), kLeast);
    changed = true;
  }
  if (changed) window_.begin_anew();
  return changed;
}

}  // namespace framewatch::estimator
