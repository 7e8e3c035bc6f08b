// SPDX-License-Identifier: MIT
#include "estimator/diagnose/fit/fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "estimator/diagnose/fit/fit_columns.h"
#include "estimator/diagnose/fit/normal_equations.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kTries = 7, kTriesOfLarge = 4;  ///< of a step, with increasing damping

double total_misfit(const std::vector<Whitened>& systems) {
  double out = 0;
  for (const Whitened& s : systems) out += s.misfit;
  return out;
}

bool all_good(const std::vector<Whitened>& systems) {
  return std::all_of(systems.begin(), systems.end(), [](const Whitened& s) { return s.good; });
}

RunCache* of_record(std::vector<RunCache>* caches, std::size_t record) {
  return caches ? &(*caches)[record % caches->size()] : nullptr;
}

void store_misfit(const std::vector<Whitened>& systems, double prior, FitResult& out) {
  out.motion.clear();
  out.misfit.clear();
  for (const Whitened& s : systems) {
    out.motion.push_back(s.motion);
    out.misfit.push_back(s.misfit);
  }
  out.cost = out.total_misfit() + prior;
}

}  // namespace

double FitResult::total_misfit() const {
  return std::accumulate(misfit.begin(), misfit.end(), 0.0);
}

FitOptions thorough(const Model& model, int max_steps) {
  FitOptions out;
  out.forcing = forcing_of(model);
  out.max_steps = max_steps;
  out.through_run = true;
  return out;
}

Fitter::Fitter(const Plant& plant, const std::vector<RecordSegment>& segments,
               const Tolerances& tolerances, Parallel within, const SearchSettings& settings)
    : plant_(plant),
      segments_(segments),
      tolerances_(tolerances),
      settings_(settings),
      within_(std::move(within)) {
  for (const RecordSegment& s : segments) ratio_.push_back(steps_per_sample(plant, s));
}

double Fitter::expected(std::size_t record, const Model& model) const {
  double n = static_cast<double>(plant_.read_equations());
  for (const ModelEffect& e : model.effects)
    n -= e.form == LawForm::clipped || e.form == LawForm::broadband;
  // The end terms of motions that no axis reads have two values each.
  return n * static_cast<double>(segments_[record].bins()) - 2 * n -
         static_cast<double>(plant_.unread.cols());
}

double Fitter::expected(const Model& model) const {
  double out = 0;
  for (std::size_t r = 0; r < segments_.size(); ++r) out += expected(r, model);
  return out;
}

double Fitter::prior_cost(const Model& model) const {
  double sum = 0;
  for (const Unknown& u : unknowns_of(plant_, model, tolerances_))
    if (u.sigma > 0) {
      const double away = (value_of(model, u) - u.center) / u.sigma;
      sum += 0.5 * away * away;
    }
  return sum;
}

int Fitter::ratio(std::size_t record, const Model& model) const {
  return steps_of(model, ratio(record));
}

std::vector<Whitened> Fitter::systems(const Model& model, const std::vector<MatrixXcd>& motion,
                                      Forcing forcing, const std::vector<Whitened>* weights,
                                      std::vector<RunCache>* caches) const {
  std::vector<Whitened> out(segments_.size());
  of_all([&](std::size_t r) {
    std::optional<std::vector<LawTrack>> tracks = tracks_of(
        plant_, model, segments_[r], r, forcing, r < motion.size() ? motion[r] : MatrixXcd(),
        ratio(r, model), of_record(caches, r));
    if (tracks)
      out[r] = whiten(plant_, model, segments_[r], r, std::move(*tracks), ratio(r, model),
                      weights ? (*weights)[r].weights : nullptr);
  });
  return all_good(out) ? std::move(out) : std::vector<Whitened>();
}

Linearised Fitter::linearise(const Model& model, std::vector<Whitened> systems,
                             const FitOptions& options, std::vector<RunCache>* caches) const {
  Linearised out;
  out.plant = &plant_;
  out.unknowns = unknowns_of(plant_, model, tolerances_);
  if (options.holds_tolerated) std::erase_if(out.unknowns, is_tolerated);
  out.systems = std::move(systems);
  const auto count = static_cast<Index>(out.unknowns.size());
  out.prior = VectorXd::Zero(count);
  out.pull = VectorXd::Zero(count);
  for (Index u = 0; u < count; ++u) {
    const Unknown& unknown = out.unknowns[static_cast<std::size_t>(u)];
    if (unknown.sigma <= 0) continue;
    // The misfit is half of a sum of squares with variance one.
    out.prior[u] = 0.5 / (unknown.sigma * unknown.sigma);
    out.pull[u] = out.prior[u] * (unknown.center - value_of(model, unknown));
  }
  out.columns.resize(segments_.size());
  of_all([&](std::size_t r) {
    out.columns[r] = columns_of(plant_, model, segments_[r], r, out.systems[r], out.unknowns,
                                ratio(r, model), options.through_run, of_record(caches, r));
  });
  out.level = std::max(1.0, total_misfit(out.systems) / expected(model));
  out.prior *= out.level;
  out.pull *= out.level;
  return out;
}

FitResult Fitter::fit(const Model& start, const std::vector<MatrixXcd>& motion,
                      const FitOptions& options) const {
  FitResult out;
  out.model = start;
  const auto store = [&](const std::vector<Whitened>& systems) {
    store_misfit(systems, prior_cost(out.model), out);
  };
  std::vector<RunCache> caches(plant_.is_large() ? 1 : segments_.size());
  std::vector<Whitened> now = systems(out.model, motion, options.forcing, nullptr, &caches);
  if (now.empty()) return out;
  store(now);
  FitResult best = out;
  double damping = 1e-6;
  const int tries = plant_.is_large() ? kTriesOfLarge : kTries;
  int worse = 0;
  double weighted = total_misfit(now);  // misfit when the weights were computed
  bool own_weights = true;
  for (; out.steps < options.max_steps; ++out.steps) {
    if (!own_weights && total_misfit(now) < kNearNoise * expected(out.model)) {
      now = reweighted(out.model, std::move(now));
      if (now.empty()) break;
      weighted = total_misfit(now);
      own_weights = true;
      store(now);
      best = out;
    }
    const Linearised at = linearise(out.model, std::move(now), options, &caches);
    NormalEquations equations = normal_equations(at, within_);
    // The weights stay those of `at` within a step, because a wrong model must not lower its misfit
    // by softer weights. Near the noise, the change of the weights is part of the gradient.
    const double before = at.level * prior_cost(out.model) + total_misfit(at.systems);
    equations.normal.diagonal() += at.prior;
    bool better = false;
    for (int i = 0; i < tries && !better; ++i) {
      MatrixXd damped = equations.normal;
      damped.diagonal().array() += 1e-12 + damping * equations.normal.diagonal().array();
      const VectorXd step =
          bounded_step(damped, at.pull - equations.gradient, out.model, at.unknowns);
      if (!step.allFinite()) {
        damping = std::max(1e-4, damping * 20);
        continue;
      }
      const Model candidate = moved(out.model, at.unknowns, step);
      std::vector<Whitened> then =
          systems(candidate, out.motion, options.forcing, &at.systems, &caches);
      const bool falls =
          !then.empty() && total_misfit(then) + at.level * prior_cost(candidate) < before;
      const bool near = at.level < kNearNoise;
      if (falls && plant_.is_large() && !near && total_misfit(then) > kNewWeights * weighted) {
        now = std::move(then);
        own_weights = false;
      } else if (falls || (!then.empty() && near)) {
        now = reweighted(candidate, std::move(then));
        own_weights = true;
        if (!now.empty()) weighted = total_misfit(now);
      }
      better = falls || (!now.empty() && total_misfit(now) + prior_cost(candidate) < out.cost);
      if (better) out.model = candidate;
      damping = better ? std::max(1e-9, damping / 10) : std::max(1e-3, damping * 10);
    }
    if (!better || now.empty()) break;
    store(now);
    const double gained = best.cost - out.cost;
    if (gained > 0) best = out;
    worse = gained > std::max(options.tolerance, 1e-4 * out.cost) ? 0 : worse + 1;
    if (worse >= 2 || (worse == 1 && std::abs(gained) < options.tolerance)) break;
  }
  if (!own_weights) {
    std::vector<Whitened> last =
        systems(best.model, best.motion, options.forcing, nullptr, &caches);
    if (!last.empty()) {
      out.model = best.model;
      store(last);
      best = out;
    }
  }
  best.steps = out.steps;
  best.good = true;
  return best;
}

Model Fitter::moved(const Model& model, const std::vector<Unknown>& unknowns,
                    const VectorXd& step) const {
  double share = 1;
  for (std::size_t u = 0; u < unknowns.size(); ++u)
    share = std::min(
        share, unknowns[u].longest_step / std::max(std::abs(step[static_cast<Index>(u)]), 1e-300));
  Model out = model;
  for (std::size_t u = 0; u < unknowns.size(); ++u) {
    const double from = value_of(model, unknowns[u]);
    set_value(out, unknowns[u], from + share * step[static_cast<Index>(u)]);
  }
  return out;
}

std::vector<Whitened> Fitter::reweighted(const Model& model, std::vector<Whitened> systems) const {
  of_all([&](std::size_t r) {
    systems[r] = with_own_weights(plant_, model, segments_[r], std::move(systems[r]));
  });
  return all_good(systems) ? std::move(systems) : std::vector<Whitened>();
}

void Fitter::of_all(const std::function<void(std::size_t)>& work) const {
  run_all(plant_.is_large() ? Parallel() : within_, static_cast<int>(segments_.size()),
          [&](int r) { work(static_cast<std::size_t>(r)); });
}

}  // namespace framewatch::estimator
