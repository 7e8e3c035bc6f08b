// SPDX-License-Identifier: MIT
#include "tests/bench/shaken_building.h"

#include <cmath>

#include <Eigen/SparseCholesky>

#include "estimator/identify/elements/guessed_design.h"
#include "estimator/simulate/ground_motion.h"
#include "estimator/simulate/random.h"
#include "estimator/structure/matrices.h"

namespace framewatch::bench {
namespace {

constexpr double kRate_hz = 100;
constexpr int kSubsteps = 4;
constexpr double kNoise_mps2 = 0.005;  // standard deviation of a sample
constexpr double kOff = 0.1;           // of the building from its design

using Sparse = Eigen::SparseMatrix<double>;

Sparse assembled(const estimator::Structure& s, const estimator::ParameterTable& table,
                 const Eigen::VectorXd& theta, int half) {
  std::vector<Eigen::Triplet<double>> entries;
  for (const estimator::Element& e : elements(s, table))
    for (const auto& [i, bi] : e.b)
      for (const auto& [j, bj] : e.b)
        entries.emplace_back(i, j, theta[e.stiffness + half * table.elements()] * bi * bj);
  Sparse out(s.degrees_of_freedom(), s.degrees_of_freedom());
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

}  // namespace

estimator::PipelineConfig building(int stories, int bays) {
  estimator::PipelineConfig config;
  estimator::Structure& s = config.structure;
  s.name = "bench";
  s.stories = stories;
  for (int i = 1; i <= bays + 1; ++i) {
    s.frames_x.push_back("y" + std::to_string(i));
    s.frames_y.push_back("x" + std::to_string(i));
  }
  s.span_x.assign(static_cast<std::size_t>(bays), 6.0);
  s.span_y.assign(static_cast<std::size_t>(bays), 6.0);
  s.story_height.assign(static_cast<std::size_t>(stories), 3.5);
  s.node_mass.assign(static_cast<std::size_t>(s.nodes()), 5e4);
  const double density = kNoise_mps2 / std::sqrt(kRate_hz / 2);
  const auto add = [&](int story, int frame, estimator::Direction direction) {
    estimator::SensorAxis axis;
    axis.name = "axis" + std::to_string(config.axes.size());
    axis.story = story;
    axis.frame = frame;
    axis.direction = direction;
    axis.noise_density = density;
    config.axes.push_back(axis);
  };
  for (int story = 1; story <= stories; ++story)
    for (int f = 0; f < s.frames(); ++f) add(story, f, s.direction(f));
  add(0, -1, estimator::Direction::x);
  add(0, -1, estimator::Direction::y);
  config.options.rate_hz = kRate_hz;
  config.design = guessed_design(s, estimator::ParameterTable(s));
  return config;
}

Eigen::MatrixXd shaken(const estimator::PipelineConfig& config, int instants) {
  const estimator::Structure& s = config.structure;
  const estimator::ParameterTable table(s);
  Eigen::VectorXd theta = config.design;
  estimator::Random random(7);
  for (double& v : theta) v *= 1 + kOff * (2 * random.uniform() - 1);
  const int nd = s.degrees_of_freedom();
  const Sparse k = assembled(s, table, theta, 0), c = assembled(s, table, theta, 1);
  Sparse m(nd, nd);
  m.setIdentity();
  Eigen::MatrixXd influence = Eigen::MatrixXd::Zero(nd, 2);
  for (int story = 1; story <= s.stories; ++story)
    for (int f = 0; f < s.frames(); ++f) {
      m.coeffRef(s.dof(story, f), s.dof(story, f)) = s.frame_mass(story, f);
      influence(s.dof(story, f), s.direction(f) == estimator::Direction::x ? 0 : 1) = 1;
    }
  const double h = 1 / kRate_hz / kSubsteps;
  const Eigen::SimplicialLDLT<Sparse> solver(Sparse(m + h / 2 * c + h * h / 4 * k));

  estimator::KanaiTajimi ground;
  ground.duration_s = instants / kRate_hz + 1;
  ground.strong_s = ground.duration_s;
  ground.build_up_s = 1;
  const estimator::GroundMotion motion = kanai_tajimi(ground);
  const Eigen::Vector2d direction(std::cos(0.7), std::sin(0.7));
  Eigen::VectorXd d = Eigen::VectorXd::Zero(nd), v = d, a = d;
  Eigen::MatrixXd out(instants, nd + 2);
  for (int t = 0; t < instants; ++t) {
    double ground_accel = 0;
    for (int i = 0; i < kSubsteps; ++i) {
      ground_accel = motion.at((t + (i + 1.0) / kSubsteps) / kRate_hz);
      const Eigen::VectorXd v1 = v + h / 2 * a, d1 = d + h * v + h * h / 4 * a;
      a = solver.solve(-(m * (influence * direction) * ground_accel) - c * v1 - k * d1);
      v = v1 + h / 2 * a;
      d = d1 + h * h / 4 * a;
    }
    out.row(t).head(nd) = (a + influence * direction * ground_accel).transpose();
    out.row(t).tail(2) = (direction * ground_accel).transpose();
    for (double& x : out.row(t)) x += kNoise_mps2 * random.normal();
  }
  return out;
}

DenseInput::DenseInput(const estimator::PipelineConfig& config, int instants)
    : equations(config.structure.degrees_of_freedom()), elements(0) {
  const estimator::ParameterTable table(config.structure);
  elements = table.elements();
  for (const estimator::Element& e : estimator::elements(config.structure, table))
    for (const auto& [dof, b] : e.b) {
      equation.push_back(dof);
      element.push_back(e.stiffness);
      coefficient.push_back(b);
    }
  estimator::Random random(3);
  motion.resize(static_cast<std::size_t>(instants) * static_cast<std::size_t>(stride()));
  for (double& value : motion) value = random.normal();
}

Pattern DenseInput::pattern() const {
  return {equations,       elements,       static_cast<int>(equation.size()),
          equation.data(), element.data(), coefficient.data()};
}

}  // namespace framewatch::bench
