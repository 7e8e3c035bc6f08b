// SPDX-License-Identifier: MIT
#include "estimator/structure/natural_frequencies.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include <Eigen/SparseCholesky>

#include "estimator/numeric/eigenvalues.h"
#include "estimator/numeric/solve.h"
#include "estimator/structure/matrices.h"

namespace framewatch::estimator {
namespace {

constexpr int kDense = 200;  // degrees of freedom up to which dense algebra is as fast
constexpr int kVectors = 8;
constexpr int kMaxIterations = 200;
constexpr double kConverged = 1e-14;

}  // namespace

double lowest_frequency_hz(const Structure& s, const ParameterTable& table,
                           const Eigen::VectorXd& theta) {
  if (s.degrees_of_freedom() <= kDense) return natural_frequencies_hz(s, table, theta).front();
  using Sparse = Eigen::SparseMatrix<double>;
  const int nd = s.degrees_of_freedom();
  std::vector<Eigen::Triplet<double>> entries;
  for (const Element& e : elements(s, table))
    for (const auto& [row, br] : e.b)
      for (const auto& [column, bc] : e.b)
        entries.emplace_back(row, column, theta[e.stiffness] * br * bc);
  Sparse stiffness(nd, nd), mass(nd, nd);
  stiffness.setFromTriplets(entries.begin(), entries.end());
  entries.clear();
  for (int story = 1; story <= s.stories; ++story)
    for (int f = 0; f < s.frames(); ++f)
      entries.emplace_back(s.dof(story, f), s.dof(story, f), s.frame_mass(story, f));
  mass.setFromTriplets(entries.begin(), entries.end());
  if (s.floor == FloorModel::rigid) {
    const Sparse r = floor_constraint(s).sparseView();
    stiffness = Sparse(r.transpose()) * stiffness * r;
    mass = Sparse(r.transpose()) * mass * r;
  }
  // Subspace iteration with several vectors, because the lowest frequencies may lie close together.
  const Eigen::SimplicialLDLT<Sparse> solver(stiffness);
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(stiffness.rows(), kVectors);
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    for (Eigen::Index c = 0; c < kVectors; ++c)
      x(i, c) = std::cos(static_cast<double>((2 * c + 1) * i) / static_cast<double>(x.rows())) +
                (i % kVectors == c ? 1 : 0);
  double lowest = 0;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    x = solver.solve(mass * x);
    const RealEigen small =
        generalized_eigen(x.transpose() * (stiffness * x), x.transpose() * (mass * x));
    x = x * small.vectors;
    const double before = lowest;
    lowest = small.values[0];
    if (std::abs(lowest - before) <= kConverged * lowest) break;
  }
  return std::sqrt(std::max(lowest, 0.0)) / (2 * M_PI);
}

std::vector<double> natural_frequencies_hz(const Structure& s, const ParameterTable& table,
                                           const Eigen::VectorXd& theta) {
  const Matrices matrices = assemble(s, table, theta);
  const Eigen::MatrixXd r = floor_constraint(s);
  const Eigen::MatrixXd m = r.transpose() * matrices.mass.asDiagonal() * r;
  const Eigen::MatrixXd k = r.transpose() * matrices.stiffness * r;
  std::vector<double> out;
  for (const double w2 : generalized_eigenvalues(k, m))
    out.push_back(std::sqrt(std::max(w2, 0.0)) / (2 * M_PI));
  return out;
}

Eigen::VectorXd with_proportional_damping(const Structure& structure, const ParameterTable& table,
                                          Eigen::VectorXd theta, double damping_ratio) {
  const double w1 = 2 * M_PI * lowest_frequency_hz(structure, table, theta);
  theta.tail(table.elements()) = 2 * damping_ratio / w1 * theta.head(table.elements());
  return theta;
}

namespace {

constexpr std::size_t kModes = 12;

}  // namespace

std::vector<double> panel_excitation(const Structure& s, const ParameterTable& table,
                                     const Eigen::VectorXd& theta) {
  const Matrices matrices = assemble(s, table, theta);
  const std::vector<Element> all = elements(s, table);
  const Eigen::MatrixXd force = matrices.mass.asDiagonal() * ground_influence(s);
  std::vector<double> share(static_cast<std::size_t>(s.stories * s.panels()), 0.0);
  const int first_panel = table.elements() - static_cast<int>(share.size());

  std::vector<double> frequencies = natural_frequencies_hz(s, table, theta);
  frequencies.resize(std::min(frequencies.size(), kModes));
  for (const double hz : frequencies) {
    const double w = 2 * M_PI * hz;
    Eigen::MatrixXcd dynamic = matrices.stiffness.cast<std::complex<double>>();
    dynamic += std::complex<double>(0, w) * matrices.damping;
    dynamic.diagonal() -= (w * w * matrices.mass).cast<std::complex<double>>();
    const Eigen::MatrixXcd motion =
        ComplexLu(dynamic).solve(Eigen::MatrixXcd(force.cast<std::complex<double>>()));
    Eigen::VectorXd deformation(table.elements());
    for (const Element& e : all) {
      Eigen::RowVectorXcd q = Eigen::RowVectorXcd::Zero(2);
      for (const auto& [dof, coefficient] : e.b) q += coefficient * motion.row(dof);
      deformation[e.stiffness] = q.cwiseAbs().sum();
    }
    const double largest_frame = deformation.head(first_panel).maxCoeff();
    for (std::size_t p = 0; p < share.size(); ++p)
      share[p] = std::max(share[p], deformation[first_panel + static_cast<int>(p)] / largest_frame);
  }
  return share;
}

}  // namespace framewatch::estimator
