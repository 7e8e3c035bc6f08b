#include "estimator/diagnose/fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Cholesky>

#include "estimator/diagnose/run_columns.h"

namespace framewatch {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kLongestStep = 0.5;  ///< of a stiffness, relative to the design
constexpr int kTries = 7;

double prior_cost(const Model& model, const std::vector<Unknown>& unknowns) {
  double sum = 0;
  for (const Unknown& u : unknowns)
    if (u.sigma > 0) {
      const double away = (value_of(model, u) - u.centre) / u.sigma;
      sum += 0.5 * away * away;
    }
  return sum;
}

double total(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

double FitResult::total_misfit() const {
  return total(misfit);
}

Forcing forcing_of(const Model& model) {
  const bool laws = std::any_of(model.effects.begin(), model.effects.end(),
                                [](const ModelEffect& e) { return e.element_law(); });
  return laws ? Forcing::simulated : Forcing::measured;
}

Fitter::Fitter(const Plant& plant, const std::vector<Stretch>& stretches,
               const Tolerances& tolerances)
    : plant_(plant), stretches_(stretches), tolerances_(tolerances) {
  for (const Stretch& s : stretches) ratio_.push_back(steps_per_sample(plant, s.rate_hz));
}

double Fitter::expected(std::size_t record, const Model& model) const {
  double n = static_cast<double>(plant_.equations());
  for (const ModelEffect& e : model.effects)
    n -= e.form == LawForm::clipped || e.form == LawForm::broadband;
  return n * static_cast<double>(stretches_[record].bins()) - 2 * n;
}

double Fitter::expected(const Model& model) const {
  double out = 0;
  for (std::size_t r = 0; r < stretches_.size(); ++r) out += expected(r, model);
  return out;
}

std::vector<double> Fitter::misfit(const Model& model, std::vector<MatrixXcd>& motion,
                                   Forcing forcing, const Linearised* weights) const {
  std::vector<double> out;
  motion.resize(stretches_.size());
  for (std::size_t r = 0; r < stretches_.size(); ++r) {
    Whitened system = whiten(plant_, model, stretches_[r], r, forcing, motion[r], ratio_[r],
                             weights ? &weights->systems[r] : nullptr);
    if (!system.good) return {};
    out.push_back(system.misfit);
    motion[r] = std::move(system.motion);
  }
  out.push_back(prior_cost(model, unknowns_of(plant_, model, tolerances_)));
  return out;
}

VectorXd Fitter::column(const Model& model, std::size_t record, const Whitened& system,
                        const Unknown& unknown, bool through_run) const {
  const Stretch& s = stretches_[record];
  const int ratio = ratio_[record];
  if (through_run && !system.tracks.empty() && !plant_.prescribed &&
      moves_run(plant_, model, unknown)) {
    std::optional<VectorXd> out = run_column(plant_, model, s, record, system, unknown, ratio);
    const bool of_law = unknown.kind >= Unknown::Kind::knob &&
                        model.effects[static_cast<std::size_t>(unknown.index)].element_law();
    if (out && !of_law) *out += column_of(plant_, model, s, record, system, unknown, ratio);
    if (out) return *out;
  }
  return column_of(plant_, model, s, record, system, unknown, ratio);
}

Linearised Fitter::linearise(const Model& model, const std::vector<MatrixXcd>& motion,
                             Forcing forcing, bool through_run) const {
  Linearised out;
  out.unknowns = unknowns_of(plant_, model, tolerances_);
  const auto count = static_cast<Index>(out.unknowns.size());
  out.normal = MatrixXd::Zero(count, count);
  out.gradient = VectorXd::Zero(count);
  out.prior = VectorXd::Zero(count);
  out.pull = VectorXd::Zero(count);
  for (Index u = 0; u < count; ++u) {
    const Unknown& unknown = out.unknowns[static_cast<std::size_t>(u)];
    if (unknown.sigma <= 0) continue;
    // The misfit is half of a sum of squares with variance one.
    out.prior[u] = 0.5 / (unknown.sigma * unknown.sigma);
    out.pull[u] = out.prior[u] * (unknown.centre - value_of(model, unknown));
  }
  double misfit = 0, noise = 0;
  for (std::size_t r = 0; r < stretches_.size(); ++r) {
    const MatrixXcd driving = r < motion.size() ? motion[r] : MatrixXcd();
    out.systems.push_back(whiten(plant_, model, stretches_[r], r, forcing, driving, ratio_[r]));
    const Whitened& system = out.systems.back();
    if (!system.good) return out;
    MatrixXd columns(system.residual.size(), count);
    for (Index u = 0; u < count; ++u)
      columns.col(u) = column(model, r, system, out.unknowns[static_cast<std::size_t>(u)],
                              through_run && forcing == Forcing::simulated);
    MatrixXd square = MatrixXd::Zero(count, count);
    square.selfadjointView<Eigen::Lower>().rankUpdate(columns.transpose());
    const MatrixXd cross = columns.transpose() * system.ends;
    out.normal += MatrixXd(square.selfadjointView<Eigen::Lower>()) -
                  cross * system.ends_factor.solve(cross.transpose());
    out.gradient += columns.transpose() * system.rest;
    out.columns.push_back(std::move(columns));
    out.cross.push_back(cross);
    misfit += system.misfit;
    noise += expected(r, model);
  }
  out.level = std::max(1.0, misfit / noise);
  out.prior *= out.level;
  out.pull *= out.level;
  return out;
}

FitResult Fitter::fit(const Model& start, const std::vector<MatrixXcd>& motion,
                      const FitOptions& options) const {
  FitResult out;
  out.model = start;
  out.motion = motion;
  std::vector<double> own = misfit(out.model, out.motion, options.forcing);
  if (own.empty()) return out;
  out.cost = total(own);
  FitResult best = out;
  best.misfit = own;
  double damping = 1e-6;
  int worse = 0;
  for (; out.steps < options.max_steps; ++out.steps) {
    const Linearised at = linearise(out.model, out.motion, options.forcing, options.through_run);
    if (at.systems.size() != stretches_.size() || !at.systems.back().good) break;
    // Weights stay those of `at` within a step: a wrong model must not gain by making itself soft.
    double before = at.level * prior_cost(out.model, at.unknowns);
    for (const Whitened& system : at.systems) before += system.misfit;
    MatrixXd normal = at.normal;
    normal.diagonal() += at.prior;
    VectorXd gradient = at.pull - at.gradient;
    bool better = false;
    for (int i = 0; i < kTries && !better; ++i) {
      MatrixXd damped = normal;
      damped.diagonal().array() += 1e-12 + damping * normal.diagonal().array();
      for (std::size_t u = 0; u < at.unknowns.size() && options.linear_fixed; ++u) {
        if (at.unknowns[u].kind >= Unknown::Kind::knob) continue;
        const auto c = static_cast<Index>(u);
        damped.row(c).setZero();
        damped.col(c).setZero();
        damped(c, c) = 1;
        gradient[c] = 0;
      }
      const VectorXd step = damped.ldlt().solve(gradient);
      if (!step.allFinite()) {
        damping = std::max(1e-4, damping * 20);
        continue;
      }
      double share = 1;
      for (std::size_t u = 0; u < at.unknowns.size(); ++u)
        if (at.unknowns[u].kind == Unknown::Kind::theta &&
            at.unknowns[u].index < plant_.element_count())
          share = std::min(share,
                           kLongestStep / std::max(std::abs(step[static_cast<Index>(u)]), 1e-300));
      Model trial = out.model;
      for (std::size_t u = 0; u < at.unknowns.size(); ++u) {
        const Unknown& unknown = at.unknowns[u];
        double to = value_of(trial, unknown) + share * step[static_cast<Index>(u)];
        if (unknown.kind == Unknown::Kind::theta && unknown.index < plant_.element_count())
          to = std::max(to, 0.02);
        set_value(trial, unknown, to);
      }
      std::vector<MatrixXcd> trial_motion = out.motion;
      const std::vector<double> then = misfit(trial, trial_motion, options.forcing, &at);
      if (!then.empty() && total(then) + (at.level - 1) * then.back() < before) {
        better = true;
        out.model = std::move(trial);
        out.motion = std::move(trial_motion);
        damping = std::max(1e-9, damping / 10);
      } else {
        damping = std::max(1e-3, damping * 10);
      }
    }
    if (!better) break;
    own = misfit(out.model, out.motion, options.forcing);
    if (own.empty()) break;
    out.cost = total(own);
    const double gained = best.cost - out.cost;
    if (gained > 0) {
      best = out;
      best.misfit = own;
    }
    worse = gained > std::max(options.tolerance, 1e-4 * out.cost) ? 0 : worse + 1;
    if (worse >= 2 || (worse == 1 && std::abs(gained) < options.tolerance)) break;
  }
  best.steps = out.steps;
  best.misfit.pop_back();
  best.good = true;
  return best;
}

}  // namespace framewatch
