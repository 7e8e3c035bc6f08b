#include "estimator/refine/measured_groups.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "estimator/identify/elements/deformations.h"
#include "estimator/identify/elements/guessed_design.h"
#include "estimator/identify/groups/group_equations.h"
#include "estimator/numeric/eigenvalues.h"
#include "estimator/numeric/solve.h"
#include "estimator/structure/group_design.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
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
    // Hinges have no mass: of the inverse problem.
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

}  // namespace

MeasuredGroups measured_groups(const PipelineConfig& c) {
  MeasuredGroups out;
  const ParameterTable table = c.parameters();
  const GroupDesign design{
      c.design.size() > 0 ? c.design : guessed_design(c.structure, ParameterTable(c.structure)),
      c.bending_nmprad};
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

}  // namespace framewatch::estimator
