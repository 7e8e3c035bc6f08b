// SPDX-License-Identifier: MIT
#include "estimator/refine/group_likelihood.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "estimator/identify/elements/deformations.h"
#include "estimator/identify/elements/story_design.h"
#include "estimator/identify/groups/group_equations.h"
#include "estimator/numeric/complex.h"
#include "estimator/numeric/eigenvalues.h"
#include "estimator/numeric/solve.h"
#include "estimator/structure/group_design.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr double kNoPart = 1e-10;  // of a part's largest eigenvalue
constexpr double kLowShare = 0.4, kHighShare = 2, kNyquistShare = 0.4;
constexpr int kInverseSteps = 60;

std::vector<Index> touched_rows(const MatrixXd& symmetric) {
  std::vector<Index> rows;
  for (Index i = 0; i < symmetric.rows(); ++i)
    if (symmetric(i, i) > 0) rows.push_back(i);
  return rows;
}

MatrixXd factor_of(const MatrixXd& symmetric, const std::vector<Index>& rows) {
  const auto size = static_cast<Index>(rows.size());
  if (size == 0) return MatrixXd(0, 0);
  const RealEigen eigen = symmetric_eigen(symmetric(rows, rows));
  const double largest = eigen.values[size - 1];
  Index first = 0;
  while (first < size - 1 && eigen.values[first] < kNoPart * largest) ++first;
  return eigen.vectors.rightCols(size - first) *
         eigen.values.tail(size - first).cwiseMax(0).cwiseSqrt().asDiagonal();
}

void find_inner_modes(MeasuredGroups& out) {
  const ReducedBuilding& b = out.building;
  MatrixXd stiffness = b.constant_stiffness;
  for (std::size_t p = 0; p < b.parts.size(); ++p)
    if (b.damping[p] == 0) stiffness += b.parts[p];
  std::vector<VectorXd> momenta;
  std::vector<double> hz;
  for (std::size_t set = 0; set + 1 < b.sets.size(); ++set) {
    const Index first = b.sets[set], size = b.sets[set + 1] - first;
    if (size == 0) continue;
    // Solve the inverse problem, because hinges have no mass.
    const MatrixXd mass = b.mass.block(first, first, size, size);
    const RealEigen modes = generalized_eigen(mass, stiffness.block(first, first, size, size));
    for (Index j = 0; modes.good && j < size; ++j) {
      if (!(modes.values[j] > kNoPart * modes.values[size - 1])) continue;
      momenta.push_back(VectorXd::Zero(b.size()));
      momenta.back().segment(first, size) =
          mass * modes.vectors.col(j) / std::sqrt(modes.values[j]);
      hz.push_back(1 / (2 * std::numbers::pi * std::sqrt(modes.values[j])));
    }
  }
  out.momenta.resize(b.size(), static_cast<Index>(momenta.size()));
  for (std::size_t j = 0; j < momenta.size(); ++j)
    out.momenta.col(static_cast<Index>(j)) = momenta[j];
  out.inner_hz = Eigen::Map<const VectorXd>(hz.data(), static_cast<Index>(hz.size()));
}

double lowest_frequency(const ReducedBuilding& b, const VectorXd& x) {
  MatrixXd stiffness = b.constant_stiffness;
  for (std::size_t p = 0; p < b.parts.size(); ++p)
    if (b.damping[p] == 0) stiffness += x[static_cast<Index>(p)] * b.parts[p];
  const Index free = b.size() - b.inputs;
  const Ldlt factor{MatrixXd(stiffness.bottomRightCorner(free, free))};
  const MatrixXd mass = b.mass.bottomRightCorner(free, free);
  VectorXd shape = VectorXd::Ones(free);
  double w2 = 0;
  for (int i = 0; i < kInverseSteps; ++i) {
    const VectorXd next = factor.solve(VectorXd(mass * shape));
    w2 = shape.dot(mass * next) / next.dot(mass * next);
    shape = next / next.norm();
  }
  return std::sqrt(std::max(w2, 0.0)) / (2 * std::numbers::pi);
}

constexpr Index kStates = 2;  // displacement and velocity

/// Returns the momenta of the inner modes in the band; other modes follow their ends.
MatrixXd momenta_within(const MeasuredGroups& groups, double high_hz) {
  std::vector<Index> within;
  for (Index j = 0; j < groups.inner_hz.size(); ++j)
    if (groups.inner_hz[j] < high_hz) within.push_back(j);
  return groups.momenta(Eigen::all, within);
}

}  // namespace

MeasuredGroups measured_groups(const PipelineConfig& c) {
  MeasuredGroups out;
  const ParameterTable table = c.parameters();
  const GroupDesign design = story_design(c);
  out.designed = group_parameters(c.structure, table, design);
  out.building = reduced_building(c.structure, c.axes, table, design, identifying(c.axes));
  for (const MatrixXd& part : out.building.parts) {
    out.touched.push_back(touched_rows(part));
    out.factors.push_back(factor_of(part, out.touched.back()));
  }
  find_inner_modes(out);
  out.variance.resize(static_cast<Index>(c.axes.size()));
  out.delay.resize(out.variance.size());
  for (std::size_t a = 0; a < c.axes.size(); ++a) {
    const double density = c.axes[a].noise_density;
    out.noise_known = out.noise_known && density > 0;
    out.variance[static_cast<Index>(a)] =
        noise_variance(density > 0 ? density : kDefaultNoiseDensity, c.options.rate_hz);
    out.delay[static_cast<Index>(a)] = c.axes[a].delay;
  }
  return out;
}

Band groups_band(const MeasuredGroups& groups, const VectorXd& theta, double rate_hz) {
  const VectorXd x = theta.cwiseQuotient(groups.designed);
  const std::vector<double> rows = group_equations(groups.building, x, rate_hz).frequency_hz;
  const double highest = rows.empty() ? 0 : *std::max_element(rows.begin(), rows.end());
  return {kLowShare * lowest_frequency(groups.building, x),
          std::min(kNyquistShare * rate_hz, kHighShare * highest)};
}

GroupLikelihood::GroupLikelihood(const MeasuredGroups& groups, const Spectrum& spectrum,
                                 EndTerms terms)
    : SegmentLikelihood(groups.equations(), groups.parameters(), groups.variance, spectrum, terms,
                        kStates * momenta_within(groups, spectrum.band.high_hz).cols()),
      groups_(groups),
      momenta_(momenta_within(groups, spectrum.band.high_hz)),
      motion_(static_cast<std::size_t>(spectrum.bins())),
      free_(motion_.size()) {}

/// Solves every inner set separately: only measured coordinates couple them.
MatrixXcd GroupLikelihood::inner_motion(const MatrixXcd& dynamic, const MatrixXcd& forces) const {
  const ReducedBuilding& b = groups_.building;
  MatrixXcd motion = MatrixXcd::Zero(b.size(), forces.cols());
  for (std::size_t set = 0; set + 1 < b.sets.size(); ++set) {
    const Index first = b.sets[set], size = b.sets[set + 1] - first;
    if (size == 0) continue;
    motion.middleRows(first, size) = ComplexLu(dynamic.block(first, first, size, size))
                                         .solve(MatrixXcd(forces.middleRows(first, size)));
  }
  return motion;
}

bool GroupLikelihood::operate(const VectorXd& theta) {
  const ReducedBuilding& b = groups_.building;
  MatrixXd stiffness = b.constant_stiffness, damping = b.constant_damping;
  for (std::size_t p = 0; p < b.parts.size(); ++p) {
    const auto i = static_cast<Index>(p);
    (b.damping[p] != 0 ? damping : stiffness) += theta[i] / groups_.designed[i] * b.parts[p];
  }
  for (Index k = 0; k < spectrum().bins(); ++k) {
    const double w = spectrum().w[k];
    MatrixXcd dynamic(b.size(), b.size());
    dynamic.real() = stiffness - w * w * b.mass;
    dynamic.imag() = w * damping;
    MatrixXcd& motion = motion_[static_cast<std::size_t>(k)];
    motion = inner_motion(dynamic, -dynamic.leftCols(b.measured));
    motion.topRows(b.measured).setIdentity();
    free_[static_cast<std::size_t>(k)] = inner_motion(dynamic, -(w * w) * momenta_.cast<Complex>());
    if (!motion.allFinite()) return false;
    const MatrixXcd forces =
        dynamic.middleRows(b.inputs, b.rows()) * motion;  // the forces of inner rows are zero
    bin(k).operation = forces * b.from_axes / -(w * w);
    const MatrixXcd felt = motion.rightCols(b.rows()).transpose() * momenta_;
    MatrixXcd& inner_end = bin(k).inner_end;
    inner_end.resize(b.rows(), kStates * felt.cols());
    for (Index state = 0; state < kStates; ++state)
      inner_end.middleCols(state * felt.cols(), felt.cols()) =
          bin(k).end[static_cast<std::size_t>(state)] * felt;
  }
  return true;
}

std::vector<GroupLikelihood::Part> GroupLikelihood::parts_of(Index b) const {
  const ReducedBuilding& building = groups_.building;
  const MatrixXcd& motion = motion_[static_cast<std::size_t>(b)];
  std::vector<Part> out;
  for (std::size_t p = 0; p < groups_.factors.size(); ++p) {
    const MatrixXcd springs =
        groups_.factors[p].transpose() * motion(groups_.touched[p], Eigen::all);
    out.push_back({springs.rightCols(building.rows()).transpose(), springs * building.from_axes});
  }
  return out;
}

void GroupLikelihood::gather(Index b, const VectorXcd& force, const VectorXcd& motion,
                             bool exact_motion, LikelihoodPoint& point, MatrixXd& cross) const {
  const Bin& bin = this->bin(b);
  const double w = spectrum().w[b];
  const std::vector<Part> parts = parts_of(b);
  const Index modes = momenta_.cols();
  VectorXcd ends = VectorXcd::Zero(modes);
  for (Index state = 0; state < kStates; ++state)
    ends += bin.end[static_cast<std::size_t>(state)] * fitted_inner().segment(state * modes, modes);
  const VectorXcd free = free_[static_cast<std::size_t>(b)] * ends;
  VectorXcd gain(parameters());
  MatrixXcd change(equations(), parameters());  // of e
  Index springs = 0;
  for (Index p = 0; p < parameters(); ++p) {
    const Part& part = parts[static_cast<std::size_t>(p)];
    const bool damping = groups_.building.damping[static_cast<std::size_t>(p)] != 0;
    gain[p] = (damping ? Complex(0, -1 / w) : Complex(-1 / (w * w), 0)) / groups_.designed[p];
    const auto at = static_cast<std::size_t>(p);
    const VectorXcd stretched =
        part.sense * motion + groups_.factors[at].transpose() * free(groups_.touched[at]);
    change.col(p) = gain[p] * (part.act * stretched);
    springs += part.sense.rows();
  }
  point.gradient += 2 * (change.adjoint() * force).real();
  const MatrixXcd weighed = bin.weight * change;
  point.information += 2 * (change.adjoint() * weighed).real();
  for (std::size_t r = 0; r < bin.end.size(); ++r)
    cross.middleCols(static_cast<Index>(r) * equations(), equations()) +=
        2 * (bin.end[r] * weighed.adjoint()).real();
  cross.rightCols(bin.inner_end.cols()) += 2 * (weighed.adjoint() * bin.inner_end).real();
  if (exact_motion) return;

  MatrixXcd act(equations(), springs), sense(springs, groups_.axes());
  std::vector<Index> first;
  Index at = 0;
  for (const Part& part : parts) {
    first.push_back(at);
    act.middleCols(at, part.act.cols()) = part.act;
    sense.middleRows(at, part.sense.rows()) = part.sense;
    at += part.sense.rows();
  }
  first.push_back(at);
  const MatrixXcd noisy = sense * noise().asDiagonal();
  const MatrixXcd heard = noisy * bin.operation.adjoint();
  const MatrixXcd left = noisy * sense.adjoint() - heard * bin.weight * heard.adjoint();
  const MatrixXcd share = (act.adjoint() * bin.weight * act).cwiseProduct(left.conjugate());
  for (std::size_t p = 0; p + 1 < first.size(); ++p)
    for (std::size_t q = 0; q + 1 < first.size(); ++q) {
      const auto i = static_cast<Index>(p), j = static_cast<Index>(q);
      const Complex sum =
          share.block(first[p], first[q], first[p + 1] - first[p], first[q + 1] - first[q]).sum();
      point.noise_part(i, j) += 2 * (std::conj(gain[i]) * gain[j] * sum).real();
    }
}

}  // namespace framewatch::estimator
