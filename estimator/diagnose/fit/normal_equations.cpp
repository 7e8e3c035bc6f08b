// SPDX-License-Identifier: MIT
#include "estimator/diagnose/fit/normal_equations.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "estimator/diagnose/fit/bin_products.h"
#include "estimator/numeric/kernels.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Chance of a bin per share of a column's square in it.
constexpr double kOfEffects = 8;

/// Returns the chances of the bins from the columns of effects: a resonance or a harmonic acts in
/// few bins.
VectorXd chances_of_effects(const Columns& columns, Index rows, Index bins) {
  VectorXd out = VectorXd::Zero(bins);
  for (Index e = 0; e < columns.effects.cols(); ++e) {
    const auto column = columns.effects.col(e);
    const double total = std::max(column.squaredNorm(), 1e-300);
    for (Index b = 0; b < bins; ++b)
      out[b] += kOfEffects * column.segment(rows * b, rows).squaredNorm() / total;
  }
  return out;
}

/// Returns a zero matrix for add_square(), which fills the upper triangle.
RowMatrix empty_square(Index count) {
  return RowMatrix::Zero(count, padded(static_cast<int>(count)));
}

/// Returns the products of the columns of all unknowns with the rest.
VectorXd gradient_of(const Linearised& at, std::size_t record) {
  const Plant& plant = *at.plant;
  const Whitened& system = at.systems[record];
  const Columns& columns = at.columns[record];
  const Index n = plant.equations(), elements = plant.element_count(), axes = plant.axis_count();
  Eigen::MatrixXcd along(system.bins(), elements + axes + n);
  along.leftCols(elements).real() = system.by_forces.real().transpose() * plant.building.act;
  along.leftCols(elements).imag() = system.by_forces.imag().transpose() * plant.building.act;
  along.middleCols(elements, axes) = system.by_readings.topRows(axes).transpose();
  along.rightCols(n) = system.by_forces.transpose();
  VectorXd out(columns.count());
  for (Index u = 0; u < out.size(); ++u) {
    const auto i = static_cast<std::size_t>(u);
    const Index d = columns.direction[i];
    out[u] = d >= 0 ? columns.size.col(u).dot(along.col(d)).real()
                    : columns.effects.col(columns.row[i]).dot(system.rest);
  }
  return out;
}

MatrixXd sampled_square_of(const Linearised& at, std::size_t record,
                           const std::vector<Index>& kept) {
  const auto count = static_cast<Index>(kept.size());
  BinProducts products(at, record, kept);
  RowMatrix square = empty_square(count + 1);
  for (const SampledBin& sampled : sampled_bins(at, record)) {
    products.compute(sampled.bin);
    products.add_square(square, sampled.weight);
  }
  MatrixXd out = square.leftCols(count + 1).selfadjointView<Eigen::Upper>();
  const VectorXd gradient = gradient_of(at, record)(kept);
  out.col(count).head(count) = gradient;
  out.row(count).head(count) = gradient.transpose();
  out(count, count) = at.systems[record].misfit;
  return out;
}

}  // namespace

std::vector<SampledBin> sampled_bins(const Linearised& at, std::size_t record) {
  constexpr Index kOneOf = 4, kFewest = 128;
  constexpr double kEvenly = 0.5;  // share of the chances that does not depend on the motion
  const Whitened& system = at.systems[record];
  const Index bins = system.bins();
  const double wanted = static_cast<double>(std::max(bins / kOneOf, std::min(bins, kFewest)));
  VectorXd motion = VectorXd::Zero(bins);
  for (std::size_t u = 0; u < at.unknowns.size(); ++u)
    if (at.unknowns[u].kind == Unknown::Kind::theta)
      motion += at.columns[record].size.col(static_cast<Index>(u)).cwiseAbs2();
  for (Index b = 0; b < bins; ++b) motion[b] *= system.weights->whitener(b).squared_norm();
  const double total = std::max(motion.sum(), 1e-300);
  const VectorXd of_effects =
      chances_of_effects(at.columns[record], 2 * system.operation.equations(), bins);
  std::vector<SampledBin> out;
  double passed = 0.5;  // of the sum of chances; a bin is taken where it passes a whole number
  for (Index b = 0; b < bins; ++b) {
    const double chance =
        std::min(1.0, of_effects[b] + wanted * (kEvenly / static_cast<double>(bins) +
                                                (1 - kEvenly) * motion[b] / total));
    passed += chance;
    if (passed < 1) continue;
    passed -= 1;
    out.push_back({b, 1 / chance});
  }
  return out;
}

MatrixXd square_of(const Linearised& at, std::size_t record, const std::vector<Index>& kept) {
  if (at.plant->is_large()) return sampled_square_of(at, record, kept);
  const Weights& weights = *at.systems[record].weights;
  const Index own = static_cast<Index>(kept.size()) + 1, ends = weights.ends();
  BinProducts products(at, record, kept);
  RowMatrix square = empty_square(own);
  RowMatrix along = RowMatrix::Zero(ends, products.at_equations().cols());
  for (Index b = 0; b < at.systems[record].bins(); ++b) {
    products.compute(b);
    products.add_square(square);
    weights.add_shares(b, products.at_equations(), along);
  }
  MatrixXd out(own + ends, own + ends);
  out.topLeftCorner(own, own) = square.leftCols(own).selfadjointView<Eigen::Upper>();
  out.bottomLeftCorner(ends, own) = along.leftCols(own);
  out.topRightCorner(own, ends) = along.leftCols(own).transpose();
  out.bottomRightCorner(ends, ends) = weights.ends_square();
  return out;
}

Index ends_of(const Linearised& at, std::size_t record) {
  return at.plant->is_large() ? 0 : at.systems[record].weights->ends();
}

NormalEquations without_ends(const MatrixXd& square, Index ends) {
  const Index count = square.cols() - ends - 1;
  if (ends == 0)
    return {square.topLeftCorner(count, count), square.col(count).head(count),
            square(count, count)};
  MatrixXd inner = square.bottomRightCorner(ends, ends);
  inner.diagonal().array() += 1e-9;
  const Ldlt factor(inner);
  const MatrixXd cross = square.topRightCorner(count, ends);
  const VectorXd last = square.row(count).tail(ends).transpose();
  const VectorXd solved = factor.solve(last);
  NormalEquations out;
  out.normal = square.topLeftCorner(count, count) - cross * factor.solve_transposed(cross);
  out.gradient = square.col(count).head(count) - cross * solved;
  out.misfit = square(count, count) - last.dot(solved);
  return out;
}

VectorXd bounded_step(const MatrixXd& normal, const VectorXd& right, const Model& model,
                      const std::vector<Unknown>& unknowns) {
  VectorXd step = solve_positive(normal, right);
  std::vector<char> held(unknowns.size(), 0);
  VectorXd to_bound = VectorXd::Zero(right.size());
  for (bool more = step.allFinite(); more;) {
    more = false;
    for (std::size_t i = 0; i < unknowns.size(); ++i) {
      const Unknown& u = unknowns[i];
      const auto at = static_cast<Index>(i);
      const double from = value_of(model, u), to = from + step[at];
      const double longest =
          u.stops_alone ? u.longest_step : std::numeric_limits<double>::infinity();
      const double low = std::max(u.low, from - longest), high = std::min(u.high, from + longest);
      if (held[i] || (to >= low && to <= high)) continue;
      held[i] = true;
      to_bound[at] = std::clamp(to, low, high) - from;
      more = true;
    }
    if (!more) break;
    MatrixXd rest = normal;
    VectorXd left = right - normal * to_bound;
    for (std::size_t i = 0; i < held.size(); ++i) {
      if (!held[i]) continue;
      const auto at = static_cast<Index>(i);
      rest.row(at).setZero();
      rest.col(at).setZero();
      rest(at, at) = 1;
      left[at] = to_bound[at];
    }
    step = solve_positive(rest, left);
    more = step.allFinite();
  }
  return step;
}

NormalEquations& NormalEquations::operator+=(const NormalEquations& other) {
  normal += other.normal;
  gradient += other.gradient;
  misfit += other.misfit;
  return *this;
}

NormalEquations normal_equations(const Linearised& at, const Parallel& within) {
  std::vector<Index> all(at.unknowns.size());
  std::iota(all.begin(), all.end(), Index{0});
  const auto count = static_cast<Index>(all.size());
  NormalEquations out{MatrixXd::Zero(count, count), VectorXd::Zero(count), 0};
  std::vector<NormalEquations> parts(at.systems.size());
  run_all(within, static_cast<int>(parts.size()), [&](int i) {
    const auto r = static_cast<std::size_t>(i);
    parts[r] = without_ends(square_of(at, r, all), ends_of(at, r));
  });
  for (const NormalEquations& part : parts) out += part;
  return out;
}

}  // namespace framewatch::estimator
