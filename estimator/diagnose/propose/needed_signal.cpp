// SPDX-License-Identifier: MIT
#include "estimator/diagnose/propose/needed_signal.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/diagnose/fit/measured_deformation.h"
#include "estimator/diagnose/model/law_port.h"
#include "estimator/numeric/complex.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

/// Returns real and imaginary parts, multiplied by the roots of the weights.
VectorXd real_rows(const VectorXcd& signal, const VectorXd& root) {
  VectorXd out(2 * signal.size());
  out << signal.real().cwiseProduct(root), signal.imag().cwiseProduct(root);
  return out;
}

/// Returns orthonormal columns with the span of x. Leaves out dependent columns.
MatrixXd orthonormal(MatrixXd x) {
  constexpr double kDependent = 1e-6;
  Index kept = 0;
  for (Index c = 0; c < x.cols(); ++c) {
    VectorXd v = x.col(c);
    const double before = v.norm();
    for (int twice = 0; twice < 2; ++twice)
      v -= x.leftCols(kept) * (x.leftCols(kept).transpose() * v).eval();
    if (v.norm() > kDependent * before) x.col(kept++) = v.normalized();
  }
  return x.leftCols(kept);
}

/// Returns NeededSignal::ends. along: per bin, the whitened direction of the place.
MatrixXd ends_of(const Whitened& system, const RecordSegment& s,
                 const std::vector<VectorXcd>& along, const VectorXd& weight) {
  const Index n = system.operation.equations();
  const double middle = std::sqrt(s.w[0] * s.w[s.w.size() - 1]);
  std::vector<VectorXcd> columns(static_cast<std::size_t>(4 * n), VectorXcd(s.bins()));
  for (Index b = 0; b < s.bins(); ++b) {
    const double r = s.w[b] / middle;
    const Complex factors[] = {1 / (r * r), -kJ / r, 1, kJ * r};
    const Eigen::RowVectorXcd share =
        system.weights->whitener(b).adjoint_times(along[static_cast<std::size_t>(b)]).adjoint() /
        weight[b];
    for (Index term = 0; term < 4; ++term)
      for (Index i = 0; i < n; ++i)
        columns[static_cast<std::size_t>(term * n + i)][b] = factors[term] * share[i];
  }
  const VectorXd root = weight.cwiseSqrt();
  MatrixXd out(2 * s.bins(), 4 * n);
  for (Index c = 0; c < out.cols(); ++c)
    out.col(c) = real_rows(columns[static_cast<std::size_t>(c)], root);
  return orthonormal(std::move(out));
}

void set_deformation(const Fitter& fitter, const Localisation& place,
                     const Eigen::RowVectorXd& sense, std::size_t record, NeededSignal& out) {
  const RecordSegment& s = fitter.segments()[record];
  const MatrixXcd& motion = place.motion[record];
  const VectorXcd q = (sense * motion).transpose();
  out.d = -q.array() / s.w.array().square();
  MeasuredDeformation m =
      measured_deformation(fitter.plant(), s, sense, motion, fitter.ratio(record));
  out.d_t = std::move(m.d);
  out.v_t = std::move(m.v);
}

}  // namespace

VectorXcd NeededSignal::without_ends(const VectorXcd& signal) const {
  if (ends.size() == 0) return signal;
  const VectorXd root = weight.cwiseSqrt();
  VectorXd rows = real_rows(signal, root);
  rows -= ends * (ends.transpose() * rows).eval();
  VectorXcd out(signal.size());
  out.real() = rows.head(signal.size()).cwiseQuotient(root);
  out.imag() = rows.tail(signal.size()).cwiseQuotient(root);
  return out;
}

std::vector<NeededSignal> needed_signals(const Fitter& fitter, const Localisation& place) {
  const Plant& plant = fitter.plant();
  const CandidatePlace& candidate = place.candidate_places.front();
  const std::vector<CandidatePlace> others(place.candidate_places.begin() + 1,
                                           place.candidate_places.end());
  const bool axis = candidate.kind == CandidatePlace::Kind::axis;
  const Index n = plant.equations();
  std::vector<NeededSignal> out;
  for (std::size_t r = 0; r < fitter.segments().size(); ++r) {
    const RecordSegment& s = fitter.segments()[r];
    const Whitened system =
        whiten(plant, place.model, s, r, Forcing::measured, place.motion[r], fitter.ratio(r));
    NeededSignal one;
    one.force.resize(s.bins());
    one.weight.resize(s.bins());
    std::vector<VectorXcd> along(static_cast<std::size_t>(s.bins()));
    for (Index b = 0; b < s.bins(); ++b) {
      const auto at = static_cast<std::size_t>(b);
      VectorXcd u = system.weights->whitener(b).times(
          axis ? VectorXcd(system.operation[at].col(candidate.axis))
               : VectorXcd(candidate.directions.col(0).cast<Complex>()));
      if (!others.empty()) {  // exclude the part that the other places explain
        const MatrixXcd basis = candidate_basis(system, b, others);
        u -= (basis * (basis.adjoint() * u)).eval();
      }
      const VectorXcd rest = rows_of_bin(system.residual, b, n);
      one.weight[b] = std::max(u.squaredNorm(), 1e-300);
      one.force[b] = -u.dot(rest) / one.weight[b];
      along[at] = u;
    }
    one.ends = ends_of(system, s, along, one.weight);
    if (candidate.kind == CandidatePlace::Kind::element)
      set_deformation(fitter, place, plant.building.sense.row(candidate.element), r, one);
    out.push_back(std::move(one));
  }
  return out;
}

void set_motion_of_floor(const Fitter& fitter, const Localisation& place,
                         std::vector<NeededSignal>& needed) {
  ModelEffect contact;
  contact.place = place.candidate_places.front().place;
  contact.place.kind = PlaceKind::node_pair;
  const LawPort port = law_ports(fitter.plant(), place.model, contact).front();
  for (std::size_t r = 0; r < needed.size(); ++r) {
    set_deformation(fitter, place, port.sense, r, needed[r]);
    needed[r].has_mass = true;
  }
}

Band fit_band(const Fitter& fitter) {
  const VectorXd& w = fitter.segments()[0].w;
  return {w[0] / (2 * M_PI), w.tail(1)[0] / (2 * M_PI)};
}

std::vector<VectorXcd> linear_columns(const NeededSignal& needed, const VectorXd& w) {
  std::vector<VectorXcd> out{needed.d, needed.d.array() * w.array() * kJ};
  if (needed.has_mass) out.emplace_back(needed.d.array() * w.array().square());
  return out;
}

std::vector<VectorXcd> columns_with(const ModelEffect& effect, const Fitter& fitter,
                                    const std::vector<NeededSignal>& needed, std::size_t record) {
  const RecordSegment& s = fitter.segments()[record];
  const NeededSignal& n = needed[record];
  const int ratio = fitter.ratio(record);
  std::vector<VectorXcd> out = linear_columns(n, s.w);
  const VectorXd force = law_force(effect.law(record), n.d_t, n.v_t, 1 / (s.rate_hz * ratio));
  out.push_back(band_of(force, s, ratio));
  return out;
}

ScalarSums scalar_sums(const NeededSignal& needed, const std::vector<VectorXcd>& given) {
  std::vector<VectorXcd> columns;
  for (const VectorXcd& column : given) columns.push_back(needed.without_ends(column));
  const VectorXcd force = needed.without_ends(needed.force);
  const auto count = static_cast<Index>(columns.size());
  const VectorXd& w = needed.weight;
  ScalarSums out{MatrixXd::Zero(count, count), VectorXd::Zero(count), 0};
  for (Index i = 0; i < count; ++i) {
    const VectorXcd& a = columns[static_cast<std::size_t>(i)];
    out.right[i] = (w.array() * (a.conjugate().array() * force.array()).real()).sum();
    for (Index j = 0; j <= i; ++j) {
      const VectorXcd& b = columns[static_cast<std::size_t>(j)];
      out.normal(i, j) = (w.array() * (a.conjugate().array() * b.array()).real()).sum();
      out.normal(j, i) = out.normal(i, j);
    }
  }
  out.total = (w.array() * force.array().abs2()).sum();
  return out;
}

ScalarSums& ScalarSums::operator+=(const ScalarSums& more) {
  normal += more.normal;
  right += more.right;
  total += more.total;
  return *this;
}

ScalarFit ScalarSums::fit() const {
  const VectorXd scale = normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  MatrixXd scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  scaled.diagonal().array() += 1e-10;
  ScalarFit out;
  out.coefficients = scale.asDiagonal() * Ldlt(scaled).solve(VectorXd(scale.asDiagonal() * right));
  out.misfit = total - out.coefficients.dot(right);
  return out;
}

ScalarFit scalar_fit(const std::vector<NeededSignal>& needed,
                     const std::vector<std::vector<VectorXcd>>& columns) {
  ScalarSums sums = scalar_sums(needed.front(), columns.front());
  for (std::size_t r = 1; r < needed.size(); ++r) sums += scalar_sums(needed[r], columns[r]);
  return sums.fit();
}

VectorXcd beyond_linear(const RecordSegment& s, const NeededSignal& needed) {
  if (needed.d.size() == 0) return needed.without_ends(needed.force);
  const std::vector<VectorXcd> columns = linear_columns(needed, s.w);
  const VectorXd fit = scalar_fit({needed}, {columns}).coefficients;
  VectorXcd rest = needed.force;
  for (std::size_t c = 0; c < columns.size(); ++c)
    rest -= fit[static_cast<Eigen::Index>(c)] * columns[c];
  return needed.without_ends(rest);
}

Proposal proposal_of(const Localisation& place, ModelEffect effect, EffectKind kind,
                     double misfit) {
  Proposal out{place.model, kind, effect.place, misfit};
  out.model.effects.push_back(std::move(effect));
  return out;
}

}  // namespace framewatch::estimator
