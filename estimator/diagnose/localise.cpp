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

/// Squares and products of unknowns, end terms and residual of one stretch.
struct Square {
  MatrixXd columns;  ///< unknowns, end terms, residual
  MatrixXd square;
};

Square square_of(const Linearised& at, std::size_t record) {
  Square out;
  const Whitened& system = at.systems[record];
  out.columns.resize(system.residual.size(), at.columns[record].cols() + system.ends.cols() + 1);
  out.columns << at.columns[record], system.ends, system.residual;
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
  double misfit = 0, expected = 0, tolerated = 0;
  std::vector<double> record_ratio;
};

Reduced reduce(const Fitter& fitter, const Linearised& at, const Model& model,
               const std::vector<Square>& squares, const std::vector<Suspect>& suspects) {
  const auto count = static_cast<Index>(at.unknowns.size());
  Reduced out{MatrixXd::Zero(count, count), VectorXd::Zero(count), 0, 0, 0, {}};
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
    const double expected = fitter.expected(r) * (1 - static_cast<double>(size) / n);
    out.misfit += left;
    out.expected += expected;
    out.record_ratio.push_back(left / expected);
  }
  for (const Unknown& u : at.unknowns) {
    if (u.sigma <= 0) continue;
    const double away = (value_of(model, u) - u.centre) / u.sigma;
    out.tolerated += 0.5 * away * away;
  }
  return out;
}

/// tolerances: whether masses, gains and clocks move too.
VectorXd step_of(const Reduced& reduced, const Linearised& at, double level, bool tolerances) {
  MatrixXd normal = reduced.normal;
  normal.diagonal() += level / at.level * at.prior;
  normal.diagonal().array() += 1e-12 + 1e-9 * normal.diagonal().array();
  VectorXd right = level / at.level * at.pull - reduced.gradient;
  for (std::size_t u = 0; u < at.unknowns.size() && !tolerances; ++u) {
    using Kind = Unknown::Kind;
    const Unknown& unknown = at.unknowns[u];
    const bool tolerated =
        unknown.kind == Kind::mass || unknown.kind == Kind::gain || unknown.kind == Kind::clock;
    if (!tolerated || unknown.sigma <= 0) continue;
    const auto c = static_cast<Index>(u);
    normal.row(c).setZero();
    normal.col(c).setZero();
    normal(c, c) = 1;
    right[c] = 0;
  }
  return normal.ldlt().solve(right);
}

}  // namespace

std::vector<Localisation> localise_once(const Fitter& fitter, const Linearised& at,
                                        const Model& model,
                                        const std::vector<std::vector<Suspect>>& lists) {
  std::vector<Square> squares;
  for (std::size_t r = 0; r < at.systems.size(); ++r) squares.push_back(square_of(at, r));
  std::vector<Localisation> out;
  for (const std::vector<Suspect>& suspects : lists) {
    Localisation one;
    one.suspects = suspects;
    const Reduced reduced = reduce(fitter, at, model, squares, suspects);
    const VectorXd step = step_of(reduced, at, 1.0, false);
    if (step.allFinite()) {
      const double left =
          reduced.misfit + step.dot(reduced.normal * step) + 2 * step.dot(reduced.gradient);
      one.misfit = left + reduced.tolerated;
      one.ratio = left / reduced.expected;
      one.record_ratio = reduced.record_ratio;
      one.model = model;
      for (std::size_t u = 0; u < at.unknowns.size(); ++u) {
        const Unknown& unknown = at.unknowns[u];
        double to = value_of(model, unknown) + step[static_cast<Index>(u)];
        if (unknown.kind == Unknown::Kind::theta && unknown.index < fitter.plant().element_count())
          to = std::max(to, 0.05);
        set_value(one.model, unknown, to);
      }
    }
    out.push_back(std::move(one));
  }
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
    const Linearised at = fitter.linearise(model, driving, Forcing::measured);
    if (at.systems.size() != fitter.stretches().size() || !at.systems.back().good) return out;
    std::vector<Square> squares;
    for (std::size_t r = 0; r < at.systems.size(); ++r) squares.push_back(square_of(at, r));
    const Reduced reduced = reduce(fitter, at, model, squares, suspects);
    if (reduced.misfit + reduced.tolerated < out.misfit) {
      out.misfit = reduced.misfit + reduced.tolerated;
      out.ratio = reduced.misfit / reduced.expected;
      out.record_ratio = reduced.record_ratio;
      out.model = model;
      out.motion.clear();
      for (const Whitened& system : at.systems) out.motion.push_back(system.calibrated);
    }
    if (step == steps || std::abs(before - reduced.misfit) < 1e-3 * reduced.misfit) break;
    before = reduced.misfit;
    const VectorXd change =
        step_of(reduced, at, std::max(1.0, reduced.misfit / reduced.expected), true);
    if (!change.allFinite()) break;
    double share = 1;
    for (Index p = 0; p < plant.element_count(); ++p)
      share = std::min(share, 0.5 / std::max(std::abs(change[p]), 1e-300));
    for (std::size_t u = 0; u < at.unknowns.size(); ++u) {
      const Unknown& unknown = at.unknowns[u];
      double to = value_of(model, unknown) + share * change[static_cast<Index>(u)];
      if (unknown.kind == Unknown::Kind::theta && unknown.index < plant.element_count())
        to = std::max(to, 0.02);
      set_value(model, unknown, to);
    }
    for (std::size_t r = 0; r < at.systems.size(); ++r) driving[r] = at.systems[r].calibrated;
  }
  return out;
}

}  // namespace framewatch
