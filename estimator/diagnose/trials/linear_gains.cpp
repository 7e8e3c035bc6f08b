// SPDX-License-Identifier: MIT
#include "estimator/diagnose/trials/linear_gains.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

#include "estimator/diagnose/fit/normal_equations.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kTogether = 64;  ///< effects whose derivatives are in memory at once

/// Returns the gains of effects whose derivatives are computed together, each at size zero.
std::vector<LinearGain> gains_of(const TrialContext& c, std::span<const ModelEffect> effects) {
  std::vector<LinearGain> out(effects.size());
  Model model = c.now.model;
  const std::size_t own = model.effects.size();
  for (const ModelEffect& e : effects) {
    model.effects.push_back(e);
    model.effects.back().parameters.front().value = 0;
  }
  std::vector<Whitened> systems = c.fitter.systems(model, c.now.motion, forcing_of(model));
  if (systems.empty()) return out;
  const Linearised at = c.fitter.linearise(model, std::move(systems));
  NormalEquations equations = normal_equations(at, c.fitter.within());
  equations.normal.diagonal() += at.prior;
  const VectorXd right = at.pull - equations.gradient;

  std::vector<Index> before, added;
  std::vector<std::size_t> effect;
  for (std::size_t u = 0; u < at.unknowns.size(); ++u) {
    const Unknown& unknown = at.unknowns[u];
    const bool is_added =
        unknown.kind == Unknown::Kind::parameter && static_cast<std::size_t>(unknown.index) >= own;
    if (!is_added) before.push_back(static_cast<Index>(u));
    if (!is_added || unknown.parameter != 0) continue;
    added.push_back(static_cast<Index>(u));
    effect.push_back(static_cast<std::size_t>(unknown.index) - own);
  }
  MatrixXd normal = equations.normal(before, before);
  normal.diagonal() *= 1 + 1e-9;
  normal.diagonal().array() += 1e-12;
  const Ldlt factor(normal);
  const MatrixXd cross = equations.normal(before, added), solved = factor.solve(cross);
  const VectorXd step = factor.solve(VectorXd(right(before)));
  for (std::size_t i = 0; i < added.size(); ++i) {
    const auto column = static_cast<Index>(i);
    const double whole = equations.normal(added[i], added[i]);
    const double alone = whole - cross.col(column).dot(solved.col(column));
    const double pull = right[added[i]] - cross.col(column).dot(step);
    if (!(alone > 1e-9 * whole)) continue;  // the building's own unknowns have the same influence
    const double scale = at.unknowns[static_cast<std::size_t>(added[i])].scale;
    out[effect[i]] = {pull * pull / alone, scale * pull / alone};
  }
  return out;
}

}  // namespace

std::vector<LinearGain> linear_gains(const TrialContext& context,
                                     const std::vector<ModelEffect>& effects) {
  std::vector<LinearGain> out(effects.size());
  const std::size_t groups = (effects.size() + kTogether - 1) / kTogether;
  run_all(context.parallel, static_cast<int>(groups), [&](int group) {
    const std::size_t first = static_cast<std::size_t>(group) * kTogether;
    const std::size_t count = std::min(kTogether, effects.size() - first);
    const std::vector<LinearGain> some =
        gains_of(context, std::span(effects).subspan(first, count));
    std::copy(some.begin(), some.end(), out.begin() + static_cast<std::ptrdiff_t>(first));
  });
  return out;
}

}  // namespace framewatch::estimator
