// SPDX-License-Identifier: MIT
#include "estimator/diagnose/locate/localise.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "estimator/diagnose/fit/bin_products.h"
#include "estimator/diagnose/fit/normal_equations.h"
#include "estimator/diagnose/locate/candidate_places.h"
#include "estimator/diagnose/locate/conjugate_step.h"
#include "estimator/diagnose/locate/large_lists.h"
#include "estimator/numeric/complex.h"
namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kConverged = 1e-3;  ///< change of the misfit, relative
/// Lists processed in one pass over the bins: limited by the numbers in their squares, but at least
/// a few.
constexpr std::size_t kNumbersTogether = 8'000'000, kFewestTogether = 8, kMaxTogether = 64;
/// Lists of a large building that get a step by conjugate gradients; the others have only a rough
/// misfit.
constexpr std::size_t kWithStep = 64;

/// Returns the unknowns that a step may change. Includes masses, gains and clocks within tolerance
/// only if `tolerances`.
std::vector<Index> moving(const Linearised& at, bool tolerances) {
  using Kind = Unknown::Kind;
  std::vector<Index> out;
  for (std::size_t u = 0; u < at.unknowns.size(); ++u) {
    const Unknown& unknown = at.unknowns[u];
    const bool tolerated =
        unknown.kind == Kind::mass || unknown.kind == Kind::gain || unknown.kind == Kind::clock;
    if (tolerances || !tolerated || unknown.sigma <= 0) out.push_back(static_cast<Index>(u));
  }
  return out;
}

/// Returns for each list the Gram matrix of the unknowns, the residual and the end terms, with the
/// whitened directions of the list's places projected out.
std::vector<MatrixXd> without(const MatrixXd& square, const Linearised& at, std::size_t record,
                              const std::vector<Index>& kept,
                              std::span<const std::vector<CandidatePlace>> lists) {
  if (at.plant->is_large()) return without_sampled(square, at, record, kept, lists);
  const Whitened& system = at.systems[record];
  const Index n = system.weights->equations(), ends = system.weights->ends();
  std::vector<RowGram> along(lists.size(), RowGram(square.cols()));
  BinProducts products(at, record, kept);
  RowMatrix forces, shares;
  for (Index b = 0; b < system.bins(); ++b) {
    products.compute(b);
    for (std::size_t i = 0; i < lists.size(); ++i) {
      const PlaceProducts places = place_products(products, lists[i]);
      const Index count = places.columns.rows(), own = places.columns.cols();
      auto rows = along[i].rows(2 * count);
      rows.topLeftCorner(count, own) = places.columns.real();
      rows.bottomLeftCorner(count, own) = places.columns.imag();
      forces.resize(2 * n, 2 * count);
      forces.topLeftCorner(n, count) = places.equations.real().transpose();
      forces.topRightCorner(n, count) = places.equations.imag().transpose();
      forces.bottomLeftCorner(n, count) = places.equations.imag().transpose();
      forces.bottomRightCorner(n, count) = -places.equations.real().transpose();
      shares.setZero(ends, 2 * count);
      system.weights->add_shares(b, forces, shares);
      rows.rightCols(ends) = shares.transpose();
      along[i].add();
    }
  }
  std::vector<MatrixXd> out;
  for (const RowGram& g : along) out.push_back(square - g.sum());
  return out;
}

/// Returns square_of() of every segment.
std::vector<MatrixXd> squares_of(const Fitter& fitter, const Linearised& at,
                                 const std::vector<Index>& kept) {
  std::vector<MatrixXd> out(at.systems.size());
  run_all(fitter.within(), static_cast<int>(out.size()), [&](int r) {
    out[static_cast<std::size_t>(r)] = square_of(at, static_cast<std::size_t>(r), kept);
  });
  return out;
}

struct Reduced {
  NormalEquations equations;
  double expected = 0;
  std::vector<double> record_ratio;
};

Index size_of(const std::vector<CandidatePlace>& candidate_places) {
  Index out = 0;
  for (const CandidatePlace& s : candidate_places) out += s.size();
  return out;
}

/// Returns the expected misfit of all segments with arbitrary signals at these places.
double expected_of(const Fitter& fitter, const Model& model,
                   const std::vector<CandidatePlace>& places) {
  return fitter.expected(model) * (1 - static_cast<double>(size_of(places)) /
                                           static_cast<double>(fitter.plant().read_equations()));
}

/// Returns the normal equations with the places of each list projected out. squares: of each
/// segment.
std::vector<Reduced> reduce(const Fitter& fitter, const Linearised& at, const Model& model,
                            const std::vector<Index>& kept, const std::vector<MatrixXd>& squares,
                            std::span<const std::vector<CandidatePlace>> lists) {
  const auto count = static_cast<Index>(kept.size());
  const double n = static_cast<double>(fitter.plant().read_equations());
  std::vector<Reduced> out(lists.size(),
                           {{MatrixXd::Zero(count, count), VectorXd::Zero(count), 0}, 0, {}});
  for (std::size_t r = 0; r < at.systems.size(); ++r) {
    const std::vector<MatrixXd> rest = without(squares[r], at, r, kept, lists);
    for (std::size_t i = 0; i < lists.size(); ++i) {
      const NormalEquations one = without_ends(rest[i], ends_of(at, r));
      const double expected =
          fitter.expected(r, model) * (1 - static_cast<double>(size_of(lists[i])) / n);
      out[i].equations += one;
      out[i].expected += expected;
      out[i].record_ratio.push_back(one.misfit / expected);
    }
  }
  return out;
}

/// Returns the change of the unknowns `kept`.
VectorXd step_of(const Reduced& reduced, const Linearised& at, const Model& model, double level,
                 const std::vector<Index>& kept) {
  std::vector<Unknown> unknowns;
  for (const Index u : kept) unknowns.push_back(at.unknowns[static_cast<std::size_t>(u)]);
  MatrixXd normal = reduced.equations.normal;
  VectorXd right = -reduced.equations.gradient;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const auto c = static_cast<Index>(i);
    normal(c, c) += level / at.level * at.prior[kept[i]];
    right[c] += level / at.level * at.pull[kept[i]];
  }
  normal.diagonal().array() += 1e-12 + 1e-9 * normal.diagonal().array();
  return bounded_step(normal, right, model, unknowns);
}

bool explains_everything(const Fitter& fitter,
                         const std::vector<CandidatePlace>& candidate_places) {
  return size_of(candidate_places) >= fitter.plant().read_equations();
}

/// Returns the localization for places with as many directions as there are equations. They explain
/// any misfit.
Localisation everything(const Fitter& fitter, const Model& model,
                        const std::vector<CandidatePlace>& candidate_places,
                        const std::vector<Whitened>& systems) {
  Localisation out;
  out.candidate_places = candidate_places;
  out.misfit = 0;
  out.ratio = 1;
  out.model = model;
  for (std::size_t r = 0; r < systems.size(); ++r) {
    out.misfit += fitter.expected(r, model);
    out.record_ratio.push_back(1);
    out.motion.push_back(systems[r].calibrated);
  }
  return out;
}

/// Returns the residual without what arbitrary signals at the places explain.
VectorXd rest_without(const Whitened& system, const std::vector<CandidatePlace>& places) {
  VectorXd out = system.rest;
  const Index n = system.operation.equations();
  for (Index b = 0; b < system.bins(); ++b) {
    const MatrixXcd basis = candidate_basis(system, b, places);
    Eigen::VectorXcd rows = rows_of_bin(out, b, n);
    rows -= basis * (basis.adjoint() * rows).eval();
    out.segment(2 * n * b, n) = rows.real();
    out.segment(2 * n * b + n, n) = rows.imag();
  }
  return out;
}

}  // namespace

std::vector<Localisation> localise_once(const Fitter& fitter, const Linearised& at,
                                        const Model& model,
                                        const std::vector<std::vector<CandidatePlace>>& lists,
                                        const Parallel& parallel) {
  const std::vector<Index> kept = moving(at, false);
  const std::vector<MatrixXd> squares = squares_of(fitter, at, kept);
  const double prior = fitter.prior_cost(model);
  std::vector<Localisation> out(lists.size());
  // conjugate: only for a large building.
  const auto store = [&](std::size_t i, const Reduced& reduced, const ConjugateStep* conjugate) {
    Localisation& one = out[i];
    one.candidate_places = lists[i];
    if (explains_everything(fitter, one.candidate_places)) {
      one = everything(fitter, model, one.candidate_places, at.systems);
      return;
    }
    const VectorXd step = conjugate ? conjugate->step : step_of(reduced, at, model, 1.0, kept);
    if (!step.allFinite()) return;
    const double left = conjugate
                            ? conjugate->left
                            : reduced.equations.misfit + step.dot(reduced.equations.normal * step) +
                                  2 * step.dot(reduced.equations.gradient);
    one.misfit = left + prior;
    one.ratio = left / reduced.expected;
    one.record_ratio = reduced.record_ratio;
    VectorXd whole = VectorXd::Zero(static_cast<Index>(at.unknowns.size()));
    whole(kept) = step;
    one.model = fitter.moved(model, at.unknowns, whole);
  };
  std::vector<std::size_t> chosen(lists.size());
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  if (fitter.plant().is_large() && lists.size() > kWithStep) {
    const std::vector<double> left = rough_misfits(at, kept, squares, lists, parallel);
    for (std::size_t i = 0; i < lists.size(); ++i) {
      out[i].candidate_places = lists[i];
      out[i].misfit = left[i] + prior;
      out[i].ratio = left[i] / expected_of(fitter, model, lists[i]);
    }
    std::stable_sort(chosen.begin(), chosen.end(),
                     [&](std::size_t a, std::size_t b) { return out[a].ratio < out[b].ratio; });
    chosen.resize(kWithStep);
  }
  const auto numbers = static_cast<std::size_t>(squares.empty() ? 1 : squares.front().size());
  const bool large = fitter.plant().is_large();
  const std::size_t at_once =
      large ? kWithStep / 2 : std::clamp(kNumbersTogether / numbers, kFewestTogether, kMaxTogether);
  const std::size_t groups = (chosen.size() + at_once - 1) / at_once;
  run_all(parallel, static_cast<int>(groups), [&](int group) {
    const std::size_t first = static_cast<std::size_t>(group) * at_once;
    std::vector<std::vector<CandidatePlace>> together;
    for (std::size_t i = first; i < std::min(first + at_once, chosen.size()); ++i)
      together.push_back(lists[chosen[i]]);
    const std::vector<Reduced> reduced = reduce(fitter, at, model, kept, squares, together);
    std::vector<ConjugateStep> conjugate;
    if (large) {
      std::vector<NormalEquations> equations;
      for (const Reduced& one : reduced) equations.push_back(one.equations);
      conjugate = conjugate_steps(at, kept, together, equations);
    }
    for (std::size_t i = 0; i < reduced.size(); ++i)
      store(chosen[first + i], reduced[i], large ? &conjugate[i] : nullptr);
  });
  if (chosen.size() < lists.size()) {  // lists with only a rough misfit come after all others
    double last = 0;
    for (const std::size_t i : chosen)
      if (out[i].ratio < 1e299) last = std::max(last, out[i].ratio);
    for (std::size_t i = 0; i < out.size(); ++i)
      if (std::find(chosen.begin(), chosen.end(), i) == chosen.end())
        out[i].ratio = std::max(out[i].ratio, last);
  }
  return out;
}

Localisation localise(const Fitter& fitter, const Model& start,
                      const std::vector<MatrixXcd>& motion,
                      const std::vector<CandidatePlace>& candidate_places, int steps) {
  const Plant& plant = fitter.plant();
  Localisation out;
  out.candidate_places = candidate_places;
  Model model = start;
  std::vector<MatrixXcd> driving = motion;
  driving.resize(fitter.segments().size());
  double before = 1e300;
  for (int step = 0; step <= steps; ++step) {
    std::vector<Whitened> systems = fitter.systems(model, driving, Forcing::measured);
    if (systems.empty()) return out;
    if (explains_everything(fitter, candidate_places))
      return everything(fitter, model, candidate_places, systems);
    std::vector<CandidatePlace> current = candidate_places;
    update_directions(plant, model, current);
    // The signals are not noise: with them in the motion, the columns of a large building's many
    // elements would be biased.
    for (std::size_t r = 0; plant.is_large() && r < systems.size(); ++r)
      set_motion(plant, model, fitter.segments()[r], rest_without(systems[r], current), systems[r]);
    const Linearised at = fitter.linearise(model, std::move(systems));
    const std::vector<Index> kept = moving(at, true);
    const std::vector<MatrixXd> squares = squares_of(fitter, at, kept);
    const Reduced reduced =
        reduce(fitter, at, model, kept, squares, std::span(&current, 1)).front();
    const double left = reduced.equations.misfit, misfit = left + fitter.prior_cost(model);
    if (misfit < out.misfit) {
      out.candidate_places = current;
      out.misfit = misfit;
      out.ratio = left / reduced.expected;
      out.record_ratio = reduced.record_ratio;
      out.model = model;
      out.motion.clear();
      for (const Whitened& system : at.systems) out.motion.push_back(system.calibrated);
    }
    out.converged = std::abs(before - left) < kConverged * left;
    if (step == steps || out.converged) break;
    before = left;
    const VectorXd change =
        step_of(reduced, at, model, std::max(1.0, left / reduced.expected), kept);
    if (!change.allFinite()) break;
    model = fitter.moved(model, at.unknowns, change);
    for (std::size_t r = 0; r < at.systems.size(); ++r) driving[r] = at.systems[r].calibrated;
  }
  return out;
}

std::optional<Localisation> localise_element(const Fitter& fitter, const FitResult& now,
                                             const EffectPlace& element) {
  constexpr int kSteps = 8;
  std::vector<CandidatePlace> own = candidate_places_of(fitter.plant(), now.model);
  std::erase_if(own, [&](const CandidatePlace& p) {
    return p.kind != CandidatePlace::Kind::element || !(p.place == element);
  });
  if (own.empty()) return std::nullopt;
  return localise(fitter, now.model, now.motion, own, kSteps);
}

}  // namespace framewatch::estimator
