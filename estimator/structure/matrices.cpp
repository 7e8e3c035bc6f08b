// SPDX-License-Identifier: MIT
#include "estimator/structure/matrices.h"

#include <algorithm>
#include <cmath>

namespace framewatch::estimator {
namespace {

/// Returns the plan coordinates of the frame lines of one direction, m, from the first one.
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

Eigen::VectorXd frame_masses(const Structure& s) {
  Eigen::VectorXd out(s.degrees_of_freedom());
  for (int story = 1; story <= s.stories; ++story)
    for (int f = 0; f < s.frames(); ++f) out[s.dof(story, f)] = s.frame_mass(story, f);
  return out;
}

Matrices assemble(const Structure& s, const ParameterTable& table, const Eigen::VectorXd& theta) {
  const int nd = s.degrees_of_freedom();
  Matrices out{frame_masses(s), Eigen::MatrixXd::Zero(nd, nd), Eigen::MatrixXd::Zero(nd, nd)};
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

Eigen::MatrixXd ground_influence(const Structure& s) {
  Eigen::MatrixXd r = Eigen::MatrixXd::Zero(s.degrees_of_freedom(), 2);
  for (int story = 1; story <= s.stories; ++story)
    for (int f = 0; f < s.frames(); ++f)
      r(s.dof(story, f), s.direction(f) == Direction::x ? 0 : 1) = 1;
  return r;
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
  const Eigen::VectorXd masses = frame_masses(s);
  std::vector<Eigen::VectorXd> columns;
  for (int story = 1; story <= s.stories; ++story) {
    const Eigen::VectorXd mass = masses.segment(s.dof(story, 0), f);
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

}  // namespace framewatch::estimator
