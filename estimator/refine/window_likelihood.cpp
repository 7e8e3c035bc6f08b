#include "estimator/refine/window_likelihood.h"

#include "estimator/numeric/complex.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

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
