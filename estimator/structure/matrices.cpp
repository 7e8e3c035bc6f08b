#include "estimator/structure/matrices.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>

namespace framewatch {
namespace {

constexpr int kDense = 200;  // degrees of freedom up to which dense algebra is as quick
constexpr int kVectors = 8;
constexpr int kMostIterations = 200;
constexpr double kConverged = 1e-14;

/// Plan coordinates of the frame lines, from the first of each direction.
std::vector<double> lines(const std::vector<double>& spans) {
  std::vector<double> at{0.0};
  for (const double span : spans) at.push_back(at.back() + span);
  return at;
}

}  // namespace

std::vector<Element> elements(const Structure& s, const ParameterTable& table) {
  std::vector<Element> all(static_cast<std::size_t>(table.elements()));
  for (int story = 1; story <= s.stories; ++story) {
    for (int f = 0; f < s.frames(); ++f) {
      Element e{story, f, -1, table.frame_stiffness(story, f), {{s.dof(story, f), 1.0}}};
      if (story > 1) e.b.emplace_back(s.dof(story - 1, f), -1.0);
      all[static_cast<std::size_t>(e.stiffness)] = e;
    }
    for (int p = 0; p < s.panels(); ++p) {
      const int j = p % (s.m() - 1);
      const int l = p / (s.m() - 1);
      const double lx = s.span_x[static_cast<std::size_t>(j)];
      const double ly = s.span_y[static_cast<std::size_t>(l)];
      const double bu = std::sqrt(lx / ly);
      const double bv = std::sqrt(ly / lx);
      Element e{story, -1, p, table.panel_stiffness(story, p), {}};
      e.b = {{s.dof(story, l), -bu},
             {s.dof(story, l + 1), bu},
             {s.dof(story, s.n() + j), -bv},
             {s.dof(story, s.n() + j + 1), bv}};
      all[static_cast<std::size_t>(e.stiffness)] = e;
    }
  }
  return all;
}

Matrices assemble(const Structure& s, const ParameterTable& table, const Eigen::VectorXd& theta) {
  const int nd = s.degrees_of_freedom();
  Matrices out{Eigen::VectorXd(nd), Eigen::MatrixXd::Zero(nd, nd), Eigen::MatrixXd::Zero(nd, nd)};
  for (int story = 1; story <= s.stories; ++story)
    for (int f = 0; f < s.frames(); ++f) out.mass[s.dof(story, f)] = s.frame_mass(story, f);
  for (const Element& e : elements(s, table)) {
    const double k = theta[e.stiffness];
    const double c = theta[e.stiffness + table.elements()];
    for (const auto& [row, br] : e.b) {
      for (const auto& [column, bc] : e.b) {
        out.stiffness(row, column) += k * br * bc;
        out.damping(row, column) += c * br * bc;
      }
    }
  }
  return out;
}

Eigen::MatrixXd floor_constraint(const Structure& s) {
  const int nd = s.degrees_of_freedom();
  if (s.floor == FloorModel::flexible) return Eigen::MatrixXd::Identity(nd, nd);
  const std::vector<double> y = lines(s.span_y);
  const std::vector<double> x = lines(s.span_x);
  const int f = s.frames();
  Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(f, 3);
  for (int l = 0; l < s.n(); ++l)
    motions.row(l) << 1, 0, -(y[static_cast<std::size_t>(l)] - y.back() / 2);
  for (int j = 0; j < s.m(); ++j)
    motions.row(s.n() + j) << 0, 1, x[static_cast<std::size_t>(j)] - x.back() / 2;
  std::vector<Eigen::VectorXd> columns;
  for (int story = 1; story <= s.stories; ++story) {
    Eigen::VectorXd mass(f);
    for (int i = 0; i < f; ++i) mass[i] = s.frame_mass(story, i);
    std::vector<Eigen::VectorXd> basis;
    for (int c = 0; c < 3; ++c) {
      Eigen::VectorXd v = motions.col(c);
      const double before = v.dot(mass.cwiseProduct(v));
      for (const Eigen::VectorXd& b : basis) v -= b * b.dot(mass.cwiseProduct(v));
      const double norm2 = v.dot(mass.cwiseProduct(v));
      if (norm2 <= 1e-12 * before || before == 0) continue;
      basis.push_back(v / std::sqrt(norm2));
      Eigen::VectorXd column = Eigen::VectorXd::Zero(nd);
      column.segment(s.dof(story, 0), f) = basis.back();
      columns.push_back(column);
    }
  }
  Eigen::MatrixXd out(nd, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t c = 0; c < columns.size(); ++c)
    out.col(static_cast<Eigen::Index>(c)) = columns[c];
  return out;
}

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
  // Subspace iteration: several vectors, for the lowest frequencies may lie close together.
  const Eigen::SimplicialLDLT<Sparse> solver(stiffness);
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(stiffness.rows(), kVectors);
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    for (Eigen::Index c = 0; c < kVectors; ++c)
      x(i, c) = std::cos(static_cast<double>((2 * c + 1) * i) / static_cast<double>(x.rows())) +
                (i % kVectors == c ? 1 : 0);
  double lowest = 0;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    x = solver.solve(mass * x);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> small(
        x.transpose() * (stiffness * x), x.transpose() * (mass * x));
    x = x * small.eigenvectors();
    const double before = lowest;
    lowest = small.eigenvalues()[0];
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
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(k, m,
                                                                         Eigen::EigenvaluesOnly);
  std::vector<double> out;
  for (const double w2 : solver.eigenvalues())
    out.push_back(std::sqrt(std::max(w2, 0.0)) / (2 * M_PI));
  return out;
}

}  // namespace framewatch
