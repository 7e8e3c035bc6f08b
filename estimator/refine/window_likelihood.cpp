// SPDX-License-Identifier: MIT
#include "estimator/refine/window_likelihood.h"

#include <algorithm>
#include <vector>

#include "estimator/identify/elements/deformations.h"
#include "estimator/identify/elements/floor_layout.h"
#include "estimator/numeric/complex.h"
#include "estimator/numeric/solve.h"
#include "estimator/structure/matrices.h"
#include "estimator/structure/story_groups.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

/// Returns the weights of the axes in the motion of every frame at one floor, frames x axes;
/// nullopt when all frames are needed and one is not measured.
std::optional<MatrixXd> places(const Deformations& deformations, int floor, int frames, Index axes,
                               bool all_needed, std::vector<Index>& measured) {
  MatrixXd share = MatrixXd::Zero(frames, axes);
  for (int f = 0; f < frames; ++f) {
    const auto& parts = deformations.at(floor, f);
    if (parts.empty() && all_needed) return std::nullopt;
    if (!parts.empty()) measured.push_back(f);
    for (const Deformations::Weighted& part : parts) share(f, part.axis) += part.weight;
  }
  return share;
}

/// Adds 2 Re(conj(g_p) g_q H) to the information of [k, c], g = -1/w^2 of k and 1/jw of c.
void add_information(const MatrixXcd& h, double w, MatrixXd& information) {
  const Index n = h.rows();
  const double w2 = w * w;
  information.topLeftCorner(n, n) += 2 / (w2 * w2) * h.real();
  information.bottomRightCorner(n, n) += 2 / w2 * h.real();
  const MatrixXd cross = -2 / (w2 * w) * h.imag();
  information.topRightCorner(n, n) += cross;
  information.bottomLeftCorner(n, n) += cross.transpose();
}

}  // namespace

std::optional<MeasuredBuilding> measured_building(const Structure& s, const ParameterTable& table,
                                                  const std::vector<SensorAxis>& axes,
                                                  double rate_hz) {
  const FloorLayout layout(s, table);
  const Deformations deformations(s, layout, axes);
  const auto count = static_cast<Index>(axes.size());
  const int frames = s.frames();
  const bool rigid = s.floor == FloorModel::rigid;

  MeasuredBuilding out;
  out.variance.resize(count);
  out.delay.resize(count);
  for (Index a = 0; a < count; ++a) {
    const SensorAxis& axis = axes[static_cast<std::size_t>(a)];
    out.variance[a] =
        noise_variance(deformations.noise_density()[static_cast<std::size_t>(a)], rate_hz);
    out.delay[a] = axis.delay;
    out.noise_known = out.noise_known && axis.noise_density > 0;
  }

  std::vector<Index> measured;
  const bool rests = has_force(axes) && std::none_of(axes.begin(), axes.end(),
                                                     [](const auto& a) { return a.story == 0; });
  const auto base = places(deformations, 0, frames, count, !rests, measured);
  if (!base) return std::nullopt;
  MatrixXd motion(s.degrees_of_freedom(), count);
  measured.clear();
  for (int floor = 1; floor <= s.stories; ++floor) {
    std::vector<Index> here;
    const auto share = places(deformations, floor, frames, count, !rigid, here);
    if (!share) return std::nullopt;
    motion.middleRows(s.dof(floor, 0), frames) = *share;
    for (const Index f : here) measured.push_back(s.dof(floor, 0) + f);
  }

  const MatrixXd constraint = floor_constraint(s);
  MatrixXd coordinates = motion;  // independent coordinates x axes
  if (rigid) {
    const auto rows = static_cast<Index>(measured.size());
    MatrixXd weighted(rows, constraint.cols()), readings(rows, count);
    for (Index i = 0; i < rows; ++i) {
      const Index dof = measured[static_cast<std::size_t>(i)];
      readings.row(i) = motion.row(dof);
      const double noise = motion.row(dof).cwiseAbs2() * out.variance;
      weighted.row(i) = constraint.row(dof) / noise;
    }
    const MatrixXd model = constraint(measured, Eigen::all);
    const MatrixXd normal = weighted.transpose() * model;
    const Ldlt solver(normal);
    const Eigen::VectorXd pivots = solver.pivots();
    if (rows < constraint.cols() || pivots.minCoeff() <= 1e-10 * pivots.maxCoeff())
      return std::nullopt;
    coordinates = solver.solve(MatrixXd(weighted.transpose() * readings));
  }

  const Matrices matrices = assemble(s, table, Eigen::VectorXd::Zero(table.size()));
  out.mass = constraint.transpose() * matrices.mass.asDiagonal() * constraint * coordinates;
  for (Index a = 0; a < count; ++a) {
    const SensorAxis& axis = axes[static_cast<std::size_t>(a)];
    if (!axis.is_force) continue;
    const std::vector<double> weights = frame_weights(s, axis);
    out.mass.col(a) -= constraint.middleRows(s.dof(axis.story, 0), frames).transpose() *
                       Eigen::Map<const Eigen::VectorXd>(weights.data(), frames);
  }
  MatrixXd vectors = MatrixXd::Zero(s.degrees_of_freedom(), table.elements());
  MatrixXd ground = MatrixXd::Zero(table.elements(), count);
  for (const Element& e : elements(s, table)) {
    for (const auto& [dof, coefficient] : e.b) vectors(dof, e.stiffness) += coefficient;
    if (e.frame >= 0 && e.story == 1) ground.row(e.stiffness) = base->row(e.frame);
  }
  out.act = constraint.transpose() * vectors;
  out.sense = out.act.transpose() * coordinates - ground;
  return out;
}

WindowLikelihood::WindowLikelihood(const MeasuredBuilding& building, const Spectrum& spectrum,
                                   EndTerms terms)
    : SegmentLikelihood(building.equations(), 2 * building.elements(), building.variance, spectrum,
                        terms),
      building_(building) {}

bool WindowLikelihood::operate(const VectorXd& theta) {
  const Index elements = building_.elements();
  for (Index b = 0; b < spectrum().bins(); ++b) {
    const double w = spectrum().w[b];
    MatrixXcd& operation = bin(b).operation;
    operation.resize(building_.equations(), building_.axes());
    const VectorXd stiff = theta.head(elements) / -(w * w);
    const VectorXd damped = theta.tail(elements) / -w;  // 1 / jw = -j / w
    operation.real() = building_.mass + building_.act * stiff.asDiagonal() * building_.sense;
    operation.imag() = building_.act * damped.asDiagonal() * building_.sense;
  }
  return true;
}

void WindowLikelihood::gather(Index b, const VectorXcd& force, const VectorXcd& motion,
                              bool exact_motion, LikelihoodPoint& point, MatrixXd& cross) const {
  const Index n = building_.equations();
  const Index elements = building_.elements();
  const Bin& bin = this->bin(b);
  const double w = spectrum().w[b];
  const auto terms = static_cast<Index>(bin.end.size());
  const VectorXcd deformation = building_.sense * motion;
  const VectorXcd pull = deformation.conjugate().cwiseProduct(building_.act.transpose() * force);
  point.gradient.head(elements) -= 2 / (w * w) * pull.real();
  point.gradient.tail(elements) -= 2 / w * pull.imag();  // conj(1 / jw) = j / w

  const MatrixXcd seen = bin.weight * building_.act;  // equations x elements
  const MatrixXcd share = building_.act.transpose() * seen;
  add_information((deformation.conjugate() * deformation.transpose()).cwiseProduct(share), w,
                  point.information);
  for (Index r = 0; r < terms; ++r) {
    const Complex end = bin.end[static_cast<std::size_t>(r)];
    const MatrixXcd part = end * (seen * deformation.asDiagonal()).adjoint();
    cross.block(0, r * n, elements, n) -= 2 / (w * w) * part.real();
    cross.block(elements, r * n, elements, n) -= 2 / w * part.imag();
  }
  if (exact_motion) return;
  const MatrixXcd heard = building_.sense * noise().asDiagonal() * bin.operation.adjoint();
  const MatrixXcd left = building_.sense * noise().asDiagonal() * building_.sense.transpose() -
                         heard * bin.weight * heard.adjoint();
  add_information(left.conjugate().cwiseProduct(share), w, point.noise_part);
}

}  // namespace framewatch::estimator
