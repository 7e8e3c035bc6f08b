// SPDX-License-Identifier: MIT
#include "estimator/modes/natural_modes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "estimator/numeric/complex.h"
#include "estimator/numeric/eigenvalues.h"
#include "estimator/numeric/nan.h"
#include "estimator/numeric/solve.h"
#include "estimator/simulate/building_model.h"
#include "estimator/structure/matrices.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

/// Undamped modes that the damped ones are combined of; buildings with fewer lose nothing.
constexpr Index kMostUndamped = 80;
/// Relative difference of frequencies that are equal up to rounding.
constexpr double kRounding = 1e-7;
constexpr double kEqual = 2;  ///< standard errors of a difference

/// A spring or dashpot of a model in undamped modes, and the parameters that set it.
struct ModalElement {
  VectorXd b;
  int stiffness_parameter = -1, damping_parameter = -1;  ///< -1: no parameter
  double stiffness_share = 0, damping_share = 0;  ///< derivatives of k and c by their parameters
};

/// Returns for every element of the table of stories the parameter of `table` that sets its
/// stiffness; -1: none.
std::vector<int> parameters_of_elements(const Structure& s, const ParameterTable& table) {
  const ParameterTable stories(s);
  std::vector<int> out(static_cast<std::size_t>(stories.elements()), -1);
  if (!table.grouped()) {
    std::iota(out.begin(), out.end(), 0);
    return out;
  }
  for (int story = 1; story <= s.stories; ++story)
    for (int f = 0; f < s.frames(); ++f)
      out[static_cast<std::size_t>(stories.frame_stiffness(story, f))] =
          table.frame_stiffness(story, f);
  return out;
}

/// Returns the design with the bending stiffness of theta.
BendingStiffness bending_of(const ParameterTable& table, BendingStiffness bending,
                            const VectorXd& theta) {
  if (const auto x = table.find("krx")) bending.base_nmprad[0] = theta[*x];
  if (const auto y = table.find("kry")) bending.base_nmprad[1] = theta[*y];
  return bending;
}

/// A building in its undamped modes: q'' + C q' + diag(w^2) q = 0, y = shapes q.
class ModalBuilding {
 public:
  ModalBuilding(const Structure& s, const ParameterTable& table, const GroupDesign& design,
                const VectorXd& theta) {
    const VectorXd of_stories = table.grouped() ? story_parameters(s, table, design, theta) : theta;
    const ParameterTable stories(s);
    const LinearModel model = linear_model(s, stories, of_stories, {}, ground_influence(s),
                                           bending_of(table, design.bending_nmprad, theta));
    const MatrixXd& t = model.constraint;
    const RealEigen undamped = generalized_eigen(t.transpose() * model.stiffness() * t,
                                                 t.transpose() * model.mass.asDiagonal() * t);
    if (!undamped.good) return;
    const Index kept = std::min(undamped.values.size(), kMostUndamped);
    square_ = undamped.values.head(kept).cwiseMax(0);
    shapes_ = t * undamped.vectors.leftCols(kept);
    damping_ = shapes_.transpose() * model.damping() * shapes_;
    add_elements(s, table, theta, stories.elements(), model);
  }

  Index size() const { return square_.size(); }
  const VectorXd& square() const { return square_; }
  const MatrixXd& damping() const { return damping_; }
  const MatrixXd& shapes() const { return shapes_; }
  const std::vector<ModalElement>& elements() const { return elements_; }

 private:
  void add_elements(const Structure& s, const ParameterTable& table, const VectorXd& theta,
                    int of_stories, const LinearModel& model) {
    const std::vector<int> parameters = parameters_of_elements(s, table);
    const auto share = [&](double value, int p) { return p >= 0 ? value / theta[p] : 0; };
    const int first_y = of_stories + (table.find("krx") ? s.n() * s.stories : 0);
    for (std::size_t i = 0; i < model.linear.size(); ++i) {
      const LinearElement& e = model.linear[i];
      ModalElement out{shapes_.transpose() * e.b};
      const auto at = static_cast<int>(i);
      out.stiffness_parameter =
          at < of_stories ? parameters[i] : table.find(at < first_y ? "krx" : "kry").value_or(-1);
      if (at < of_stories && out.stiffness_parameter >= 0)
        out.damping_parameter = out.stiffness_parameter + table.elements();
      out.stiffness_share = share(e.stiffness, out.stiffness_parameter);
      out.damping_share = share(e.damping, out.damping_parameter);
      elements_.push_back(std::move(out));
    }
  }

  VectorXd square_;
  MatrixXd damping_, shapes_;
  std::vector<ModalElement> elements_;
};

/// An eigenvalue with its vector in undamped modes.
struct Pole {
  Complex lambda;
  VectorXcd q;
};

/// Returns the eigenvalues above the real axis by ascending absolute value. overdamped: number of
/// pairs on it.
std::vector<Pole> poles_of(const ModalBuilding& building, int& overdamped) {
  const Index n = building.size();
  // Velocities over a mean circular frequency balance the matrix.
  const double scale = std::sqrt(std::max(building.square().mean(), 1e-12));
  MatrixXd a = MatrixXd::Zero(2 * n, 2 * n);
  a.topRightCorner(n, n).diagonal().setConstant(scale);
  a.bottomLeftCorner(n, n).diagonal() = -building.square() / scale;
  a.bottomRightCorner(n, n) = -building.damping();
  const ComplexEigen eigen = general_eigen(a);
  std::vector<Pole> out;
  if (!eigen.good) return out;
  for (Index i = 0; i < eigen.values.size(); ++i)
    if (eigen.values[i].imag() > 0) out.push_back({eigen.values[i], eigen.vectors.col(i).head(n)});
  std::stable_sort(out.begin(), out.end(), [](const Pole& one, const Pole& other) {
    return std::abs(one.lambda) < std::abs(other.lambda);
  });
  overdamped = static_cast<int>(n) - static_cast<int>(out.size());
  return out;
}

/// Derivatives of a pole by the parameters.
struct Sensitivity {
  VectorXcd lambda;  ///< parameters
  MatrixXcd force;   ///< undamped modes x parameters: -(lambda dC + dK) q
};

Sensitivity sensitivity_of(const ModalBuilding& building, const Pole& pole, Index parameters) {
  Sensitivity out{VectorXcd::Zero(parameters), MatrixXcd::Zero(building.size(), parameters)};
  for (const ModalElement& e : building.elements()) {
    const Complex deformation = (e.b.transpose() * pole.q)(0);
    if (e.stiffness_parameter >= 0)
      out.force.col(e.stiffness_parameter) -= e.stiffness_share * deformation * e.b;
    if (e.damping_parameter >= 0)
      out.force.col(e.damping_parameter) -= pole.lambda * e.damping_share * deformation * e.b;
  }
  const Complex scale = 2.0 * pole.lambda * (pole.q.transpose() * pole.q)(0) +
                        (pole.q.transpose() * building.damping() * pole.q)(0);
  out.lambda = (pole.q.transpose() * out.force).transpose() / scale;
  return out;
}

/// Returns the shape's entry with the largest absolute value.
Index reference_of(const VectorXcd& shape) {
  Index at = 0;
  shape.cwiseAbs().maxCoeff(&at);
  return at;
}

/// Returns the derivatives of the shape, degrees of freedom x parameters, with its reference fixed
/// at 1: the derivative of (lambda^2 + lambda C + K) q = 0 bordered by that condition.
MatrixXcd shape_derivatives(const ModalBuilding& building, const Pole& pole,
                            const Sensitivity& sensitivity) {
  const Index n = building.size();
  const MatrixXcd dynamic = pole.lambda * building.damping();
  const VectorXcd slope = 2.0 * pole.lambda * pole.q + building.damping() * pole.q;
  const VectorXcd shape = building.shapes() * pole.q;
  const Index reference = reference_of(shape);
  MatrixXcd bordered = MatrixXcd::Zero(n + 1, n + 1);
  bordered.topLeftCorner(n, n) = dynamic;
  bordered.topLeftCorner(n, n).diagonal().array() +=
      building.square().array().cast<Complex>() + pole.lambda * pole.lambda;
  bordered.topRightCorner(n, 1) = slope;
  bordered.bottomLeftCorner(1, n) = building.shapes().row(reference).cast<Complex>();
  MatrixXcd right = MatrixXcd::Zero(n + 1, sensitivity.force.cols());
  right.topRows(n) = sensitivity.force;
  const MatrixXcd solved = ComplexLu(bordered).solve(right);
  return building.shapes() * solved.topRows(n) / shape[reference];
}

/// Returns the shares of NaturalMode::motion.
std::array<double, 3> motion_of(const Structure& s, const VectorXcd& shape) {
  std::array<double, 3> out{};
  double whole = 0;
  for (int story = 1; story <= s.stories; ++story)
    for (const Direction direction : {Direction::x, Direction::y}) {
      double mass = 0;
      Complex momentum = 0;
      for (int f = 0; f < s.frames(); ++f) {
        if (s.direction(f) != direction) continue;
        const Complex motion = shape[s.dof(story, f)];
        mass += s.frame_mass(story, f);
        momentum += s.frame_mass(story, f) * motion;
        whole += s.frame_mass(story, f) * std::norm(motion);
      }
      if (mass > 0) out[direction == Direction::x ? 0 : 1] += std::norm(momentum) / mass;
    }
  out[0] /= whole;
  out[1] /= whole;
  out[2] = std::max(0.0, 1 - out[0] - out[1]);
  return out;
}

/// Replaces the vectors of modes with one frequency by real ones of the same subspace. Each moves
/// along x, along y or in rotation as purely as possible: they are eigenvectors of the energy of
/// translation along x minus that along y.
void purify(const Structure& s, const ModalBuilding& building, std::vector<Pole>& poles, int first,
            int last) {
  const Index count = last - first + 1;
  MatrixXcd shapes(s.degrees_of_freedom(), count);
  for (Index i = 0; i < count; ++i) {
    const VectorXcd shape =
        building.shapes() * poles[static_cast<std::size_t>(first + static_cast<int>(i))].q;
    shapes.col(i) = shape / shape[reference_of(shape)];
  }
  MatrixXd parts(shapes.rows(), 2 * count);
  parts << shapes.real(), shapes.imag();
  const MatrixXd basis = singular_values(parts).left.leftCols(count);
  const VectorXd mass = frame_masses(s);
  MatrixXd apart = MatrixXd::Zero(count, count);
  for (int story = 1; story <= s.stories; ++story)
    for (const Direction direction : {Direction::x, Direction::y}) {
      VectorXd momentum = VectorXd::Zero(count);
      double total = 0;
      for (int f = 0; f < s.frames(); ++f)
        if (s.direction(f) == direction) {
          momentum += s.frame_mass(story, f) * basis.row(s.dof(story, f)).transpose();
          total += s.frame_mass(story, f);
        }
      if (total > 0)
        apart += (direction == Direction::x ? 1 : -1) * momentum * momentum.transpose() / total;
    }
  const RealEigen turned = generalized_eigen(apart, basis.transpose() * mass.asDiagonal() * basis);
  if (!turned.good) return;
  const MatrixXd pure = basis * turned.vectors;
  // Each eigenvalue keeps the vector that is most like its own.
  MatrixXd alike = (pure.transpose() * mass.asDiagonal() * shapes).cwiseAbs2();
  const MatrixXd back = building.shapes().transpose() * mass.asDiagonal();
  for (Index i = 0; i < count; ++i) {
    Index vector = 0, pole = 0;
    alike.maxCoeff(&vector, &pole);
    poles[static_cast<std::size_t>(first + static_cast<int>(pole))].q =
        (back * pure.col(vector)).cast<Complex>();
    alike.row(vector).setConstant(-1);
    alike.col(pole).setConstant(-1);
  }
}

}  // namespace

NaturalModes natural_modes(const Structure& s, const ParameterTable& table,
                           const GroupDesign& design, const VectorXd& theta,
                           const MatrixXd& covariance, int most, bool shape_errors) {
  NaturalModes out;
  if (s.degrees_of_freedom() > kMostModalFreedoms) return out;
  const ModalBuilding building(s, table, design, theta);
  std::vector<Pole> poles = poles_of(building, out.overdamped);
  poles.resize(std::min(poles.size(), static_cast<std::size_t>(most)));
  const bool has_errors = covariance.size() > 0;

  // Errors of all frequencies, and which are equal.
  const auto count = static_cast<Index>(poles.size());
  std::vector<Sensitivity> sensitivities;
  MatrixXd frequency(count, theta.size());
  for (Index i = 0; i < count; ++i) {
    const Pole& pole = poles[static_cast<std::size_t>(i)];
    sensitivities.push_back(sensitivity_of(building, pole, theta.size()));
    frequency.row(i) = (std::conj(pole.lambda) * sensitivities.back().lambda).real().transpose() /
                       (std::abs(pole.lambda) * 2 * std::numbers::pi);
  }
  int first = 0;
  for (Index i = 0; i < count; ++i) {
    const auto hz = [&](Index at) {
      return std::abs(poles[static_cast<std::size_t>(at)].lambda) / (2 * std::numbers::pi);
    };
    NaturalMode mode;
    mode.frequency_hz = hz(i);
    double limit = kRounding * mode.frequency_hz;
    if (has_errors && i > 0) {
      const VectorXd apart = (frequency.row(i) - frequency.row(i - 1)).transpose();
      limit = std::max(limit, kEqual * std::sqrt(std::max(0.0, apart.dot(covariance * apart))));
    }
    if (i > 0 && hz(i) - hz(i - 1) > limit) first = static_cast<int>(i);
    mode.first_equal = first;
    out.modes.push_back(std::move(mode));
  }
  for (Index i = count - 1; i >= 0; --i) {
    NaturalMode& mode = out.modes[static_cast<std::size_t>(i)];
    const bool goes_on =
        i + 1 < count && out.modes[static_cast<std::size_t>(i + 1)].first_equal == mode.first_equal;
    mode.last_equal =
        goes_on ? out.modes[static_cast<std::size_t>(i + 1)].last_equal : static_cast<int>(i);
    if (mode.first_equal == i && mode.last_equal > mode.first_equal)
      purify(s, building, poles, mode.first_equal, mode.last_equal);
  }

  for (Index i = 0; i < count; ++i) {
    const Pole& pole = poles[static_cast<std::size_t>(i)];
    const Sensitivity& by = sensitivities[static_cast<std::size_t>(i)];
    NaturalMode& mode = out.modes[static_cast<std::size_t>(i)];
    const double radius = std::abs(pole.lambda);
    mode.damping_ratio = -pole.lambda.real() / radius;
    const VectorXcd shape = building.shapes() * pole.q;
    mode.shape = shape / shape[reference_of(shape)];
    mode.motion = motion_of(s, mode.shape);
    mode.shape_error = VectorXd::Constant(mode.shape.size(), kNaN);
    mode.frequency_error_hz = mode.damping_error = kNaN;
    if (!has_errors) continue;
    const VectorXd of_radius = 2 * std::numbers::pi * frequency.row(i).transpose();
    const VectorXd of_damping =
        -by.lambda.real() / radius - mode.damping_ratio / radius * of_radius;
    const auto error = [&](const VectorXd& slope) {
      return std::sqrt(std::max(0.0, slope.dot(covariance * slope)));
    };
    mode.frequency_error_hz = error(frequency.row(i).transpose());
    mode.damping_error = error(of_damping);
    if (!shape_errors || mode.first_equal != mode.last_equal) continue;
    const MatrixXd slopes = shape_derivatives(building, pole, by).real();
    const MatrixXd spread = slopes * covariance;
    for (Index d = 0; d < slopes.rows(); ++d)
      mode.shape_error[d] = std::sqrt(std::max(0.0, spread.row(d).dot(slopes.row(d))));
  }
  return out;
}

}  // namespace framewatch::estimator
