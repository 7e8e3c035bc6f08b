#include "estimator/diagnose/localise.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include <Eigen/Cholesky>

namespace framewatch {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kSettled = 1e-3;  ///< change of the misfit, relative

/// Squares and products of unknowns, end terms and residual of one stretch.
struct Square {
  MatrixXd columns;  ///< unknowns, end terms, residual
  MatrixXd square;
};

/// Which unknowns may move; masses, gains and clocks only when `tolerances`.
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

Square square_of(const Linearised& at, std::size_t record, const std::vector<Index>& kept) {
  Square out;
  const Whitened& system = at.systems[record];
  out.columns.resize(system.residual.size(),
                     static_cast<Index>(kept.size()) + system.ends.cols() + 1);
  for (std::size_t u = 0; u < kept.size(); ++u)
    out.columns.col(static_cast<Index>(u)) = at.columns[record].col(kept[u]);
  out.columns.middleCols(static_cast<Index>(kept.size()), system.ends.cols()) = system.ends;
  out.columns.rightCols(1) = system.residual;
  out.square = MatrixXd::Zero(out.columns.cols(), out.columns.cols());
  out.square.selfadjointView<Eigen::Lower>().rankUpdate(out.columns.transpose());
  out.square = MatrixXd(out.square.selfadjointView<Eigen::Lower>());
  return out;
}

/// The square without what lies along the suspects' directions.
MatrixXd without(const Square& whole, const Whitened& system,
                 const std::vector<Suspect>& suspects) {
  const Index n = system.operation.front().rows(), columns = whole.columns.cols();
  Index size = 0;
  for (const Suspect& s : suspects) size += s.size();
  MatrixXd along(2 * size * system.bins(), columns);
  for (Index b = 0; b < system.bins(); ++b) {
    const MatrixXcd basis = suspect_basis(system, b, suspects);
    const auto real = whole.columns.middleRows(2 * n * b, n);
    const auto imag = whole.columns.middleRows(2 * n * b + n, n);
    along.middleRows(2 * size * b, size).noalias() =
        basis.real().transpose() * real + basis.imag().transpose() * imag;
    along.middleRows(2 * size * b + size, size).noalias() =
        basis.real().transpose() * imag - basis.imag().transpose() * real;
  }
  MatrixXd out = MatrixXd::Zero(columns, columns);
  out.selfadjointView<Eigen::Lower>().rankUpdate(along.transpose(), -1.0);
  return whole.square + MatrixXd(out.selfadjointView<Eigen::Lower>());
}

struct Reduced {
  MatrixXd normal;
  VectorXd gradient;
  double misfit = 0, expected = 0;
  std::vector<double> record_ratio;
};

Reduced reduce(const Fitter& fitter, const Linearised& at, const Model& model,
               const std::vector<Square>& squares, const std::vector<Suspect>& suspects) {
  const Index count = squares.front().columns.cols() - at.systems.front().ends.cols() - 1;
  Reduced out{MatrixXd::Zero(count, count), VectorXd::Zero(count), 0, 0, {}};
  Index size = 0;
  for (const Suspect& s : suspects) size += s.size();
  const double n = static_cast<double>(fitter.plant().equations());
  for (std::size_t r = 0; r < at.systems.size(); ++r) {
    const Index ends = at.systems[r].ends.cols();
    const MatrixXd square = without(squares[r], at.systems[r], suspects);
    MatrixXd inner = square.block(count, count, ends, ends);
    inner.diagonal().array() += 1e-9;
    const Eigen::LDLT<MatrixXd> factor(inner);
    const MatrixXd cross = square.block(0, count, count, ends);
    const VectorXd last = square.block(count, count + ends, ends, 1);
    const VectorXd solved = factor.solve(last);
    out.normal += square.topLeftCorner(count, count) - cross * factor.solve(cross.transpose());
    out.gradient += square.block(0, count + ends, count, 1) - cross * solved;
    const double left = square(count + ends, count + ends) - last.dot(solved);
    const double expected = fitter.expected(r, model) * (1 - static_cast<double>(size) / n);
    out.misfit += left;
    out.expected += expected;
    out.record_ratio.push_back(left / expected);
  }
  return out;
}

/// Change of the unknowns `kept`.
VectorXd step_of(const Reduced& reduced, const Linearised& at, double level,
                 const std::vector<Index>& kept) {
  MatrixXd normal = reduced.normal;
  VectorXd right = -reduced.gradient;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const auto c = static_cast<Index>(i);
    normal(c, c) += level / at.level * at.prior[kept[i]];
    right[c] += level / at.level * at.pull[kept[i]];
  }
  normal.diagonal().array() += 1e-12 + 1e-9 * normal.diagonal().array();
  return normal.ldlt().solve(right);
}

bool takes_everything(const Fitter& fitter, const std::vector<Suspect>& suspects) {
  Index size = 0;
  for (const Suspect& s : suspects) size += s.size();
  return size >= fitter.plant().equations();
}

/// Of places that could explain everything whatever it is: as if they did.
Localisation everything(const Fitter& fitter, const Model& model,
                        const std::vector<Suspect>& suspects,
                        const std::vector<Whitened>& systems) {
  Localisation out;
  out.suspects = suspects;
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

}  // namespace

std::vector<Localisation> localise_once(const Fitter& fitter, const Linearised& at,
                                        const Model& model,
                                        const std::vector<std::vector<Suspect>>& lists,
                                        const Parallel& parallel) {
  const std::vector<Index> kept = moving(at, false);
  std::vector<Square> squares;
  for (std::size_t r = 0; r < at.systems.size(); ++r) squares.push_back(square_of(at, r, kept));
  const double prior = fitter.prior_cost(model);
  std::vector<Localisation> out(lists.size());
  run_all(parallel, static_cast<int>(lists.size()), [&](int i) {
    Localisation& one = out[static_cast<std::size_t>(i)];
    one.suspects = lists[static_cast<std::size_t>(i)];
    if (takes_everything(fitter, one.suspects)) {
      one = everything(fitter, model, one.suspects, at.systems);
      return;
    }
    const Reduced reduced = reduce(fitter, at, model, squares, one.suspects);
    const VectorXd step = step_of(reduced, at, 1.0, kept);
    if (!step.allFinite()) return;
    const double left =
        reduced.misfit + step.dot(reduced.normal * step) + 2 * step.dot(reduced.gradient);
    one.misfit = left + prior;
    one.ratio = left / reduced.expected;
    one.record_ratio = reduced.record_ratio;
    VectorXd whole = VectorXd::Zero(static_cast<Index>(at.unknowns.size()));
    whole(kept) = step;
    one.model = fitter.moved(model, at.unknowns, whole);
  });
  return out;
}

Localisation localise(const Fitter& fitter, const Model& start,
                      const std::vector<MatrixXcd>& motion, const std::vector<Suspect>& suspects,
                      int steps) {
  const Plant& plant = fitter.plant();
  Localisation out;
  out.suspects = suspects;
  Model model = start;
  std::vector<MatrixXcd> driving = motion;
  driving.resize(fitter.stretches().size());
  double before = 1e300;
  for (int step = 0; step <= steps; ++step) {
    std::vector<Whitened> systems = fitter.systems(model, driving, Forcing::measured);
    if (systems.empty()) return out;
    const Linearised at = fitter.linearise(model, std::move(systems));
    if (takes_everything(fitter, suspects)) return everything(fitter, model, suspects, at.systems);
    const std::vector<Index> kept = moving(at, true);
    std::vector<Square> squares;
    for (std::size_t r = 0; r < at.systems.size(); ++r) squares.push_back(square_of(at, r, kept));
    std::vector<Suspect> current = suspects;
    follow(plant, model, current);
    const Reduced reduced = reduce(fitter, at, model, squares, current);
    const double misfit = reduced.misfit + fitter.prior_cost(model);
    if (misfit < out.misfit) {
      out.suspects = current;
      out.misfit = misfit;
      out.ratio = reduced.misfit / reduced.expected;
      out.record_ratio = reduced.record_ratio;
      out.model = model;
      out.motion.clear();
      for (const Whitened& system : at.systems) out.motion.push_back(system.calibrated);
    }
    out.settled = std::abs(before - reduced.misfit) < kSettled * reduced.misfit;
    if (step == steps || out.settled) break;
    before = reduced.misfit;
    const VectorXd change =
        step_of(reduced, at, std::max(1.0, reduced.misfit / reduced.expected), kept);
    if (!change.allFinite()) break;
    model = fitter.moved(model, at.unknowns, change);
    for (std::size_t r = 0; r < at.systems.size(); ++r) driving[r] = at.systems[r].calibrated;
  }
  return out;
}

}  // namespace framewatch
