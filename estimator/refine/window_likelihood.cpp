#include "estimator/refine/window_likelihood.h"

#include <cmath>

#include "estimator/numeric/complex.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

/// A z = b by a Cholesky factorisation of A brought to a unit diagonal.
class ScaledCholesky {
 public:
  explicit ScaledCholesky(const MatrixXd& matrix)
      : scale_(matrix.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse()),
        factor_(scale_.asDiagonal() * matrix * scale_.asDiagonal()) {}
  bool good() const { return factor_.good() && scale_.allFinite(); }
  MatrixXd solve(const MatrixXd& right) const {
    return scale_.asDiagonal() * factor_.solve(scale_.asDiagonal() * right);
  }

 private:
  VectorXd scale_;
  Cholesky factor_;
};

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
    : building_(building),
      spectrum_(spectrum),
      terms_(static_cast<Index>(terms)),
      noise_(spectrum.intervals * building.variance),
      bins_(static_cast<std::size_t>(spectrum.bins())) {
  if (bins_.empty()) return;
  const double middle = std::sqrt(spectrum.w[0] * spectrum.w[spectrum.bins() - 1]);
  for (Index b = 0; b < spectrum.bins(); ++b) {
    const double ratio = spectrum.w[b] / middle;
    auto& end = bins_[static_cast<std::size_t>(b)].end;
    end = {1 / (ratio * ratio), 1.0 / (kJ * ratio), 1, kJ * ratio};
    end.resize(static_cast<std::size_t>(terms_));
  }
}

double WindowLikelihood::observations() const {
  return static_cast<double>(spectrum_.bins() * building_.equations());
}

bool WindowLikelihood::prepare(const VectorXd& theta) {
  const Index elements = building_.elements();
  if (bins_.empty() || theta.size() != 2 * elements || !theta.allFinite()) return false;
  const MatrixXcd identity = MatrixXcd::Identity(building_.equations(), building_.equations());
  for (Index b = 0; b < spectrum_.bins(); ++b) {
    Bin& bin = bins_[static_cast<std::size_t>(b)];
    const double w = spectrum_.w[b];
    bin.operation.resize(building_.equations(), building_.axes());
    const VectorXd stiff = theta.head(elements) / -(w * w);
    const VectorXd damped = theta.tail(elements) / -w;  // 1 / jw = -j / w
    bin.operation.real() = building_.mass + building_.act * stiff.asDiagonal() * building_.sense;
    bin.operation.imag() = building_.act * damped.asDiagonal() * building_.sense;
    const MatrixXcd omega = bin.operation * noise_.asDiagonal() * bin.operation.adjoint();
    const ComplexCholesky factor(omega);
    if (!factor.good()) return false;
    bin.weight = factor.solve(identity);
    bin.residual = bin.operation * spectrum_.accel.col(b);
  }
  return fit_ends();
}

bool WindowLikelihood::fit_ends() {
  const Index n = building_.equations();
  ends_ = MatrixXd::Zero(terms_ * n, terms_ * n);
  VectorXd right = VectorXd::Zero(terms_ * n);
  for (const Bin& bin : bins_) {
    const VectorXcd weighted = bin.weight * bin.residual;
    for (Index r = 0; r < terms_; ++r) {
      const Complex row = std::conj(bin.end[static_cast<std::size_t>(r)]);
      right.segment(r * n, n) += 2 * (row * weighted).real();
      for (Index c = 0; c < terms_; ++c)
        ends_.block(r * n, c * n, n, n) +=
            2 * (row * bin.end[static_cast<std::size_t>(c)] * bin.weight).real();
    }
  }
  const ScaledCholesky factor(ends_);
  if (!factor.good()) return false;
  const VectorXd fitted = factor.solve(right);
  for (Bin& bin : bins_)
    for (Index r = 0; r < terms_; ++r)
      bin.residual -= bin.end[static_cast<std::size_t>(r)] * fitted.segment(r * n, n);
  return true;
}

double WindowLikelihood::sum_misfit() const {
  double sum = 0;
  for (const Bin& bin : bins_) sum += bin.residual.dot(bin.weight * bin.residual).real();
  return sum;
}

bool WindowLikelihood::gather(LikelihoodPoint& point, bool exact_motion) const {
  const Index n = building_.equations();
  const Index elements = building_.elements();
  point.gradient = VectorXd::Zero(2 * elements);
  point.information = MatrixXd::Zero(2 * elements, 2 * elements);
  point.noise_part = point.information;
  MatrixXd cross = MatrixXd::Zero(2 * elements, terms_ * n);
  for (Index b = 0; b < spectrum_.bins(); ++b) {
    const Bin& bin = bins_[static_cast<std::size_t>(b)];
    const double w = spectrum_.w[b];
    const VectorXcd force = bin.weight * bin.residual;
    VectorXcd motion = spectrum_.accel.col(b);
    if (!exact_motion) motion -= noise_.asDiagonal() * (bin.operation.adjoint() * force);
    const VectorXcd deformation = building_.sense * motion;
    const VectorXcd pull = deformation.conjugate().cwiseProduct(building_.act.transpose() * force);
    point.gradient.head(elements) -= 2 / (w * w) * pull.real();
    point.gradient.tail(elements) -= 2 / w * pull.imag();  // conj(1 / jw) = j / w

    const MatrixXcd seen = bin.weight * building_.act;  // equations x elements
    const MatrixXcd share = building_.act.transpose() * seen;
    add_information((deformation.conjugate() * deformation.transpose()).cwiseProduct(share), w,
                    point.information);
    for (Index r = 0; r < terms_; ++r) {
      const Complex end = bin.end[static_cast<std::size_t>(r)];
      const MatrixXcd part = end * (seen * deformation.asDiagonal()).adjoint();
      cross.block(0, r * n, elements, n) -= 2 / (w * w) * part.real();
      cross.block(elements, r * n, elements, n) -= 2 / w * part.imag();
    }
    if (exact_motion) continue;
    const MatrixXcd heard = building_.sense * noise_.asDiagonal() * bin.operation.adjoint();
    const MatrixXcd left = building_.sense * noise_.asDiagonal() * building_.sense.transpose() -
                           heard * bin.weight * heard.adjoint();
    add_information(left.conjugate().cwiseProduct(share), w, point.noise_part);
  }
  const ScaledCholesky factor(ends_);
  if (!factor.good()) return false;
  point.information -= cross * factor.solve(cross.transpose());
  return point.information.allFinite() && point.gradient.allFinite();
}

std::optional<double> WindowLikelihood::misfit(const VectorXd& theta) {
  if (!prepare(theta)) return std::nullopt;
  const double sum = sum_misfit();
  return std::isfinite(sum) ? std::optional(sum) : std::nullopt;
}

std::optional<LikelihoodPoint> WindowLikelihood::at(const VectorXd& theta) {
  LikelihoodPoint point;
  if (!prepare(theta) || !gather(point, false)) return std::nullopt;
  point.misfit = sum_misfit();
  return point;
}

std::optional<MatrixXd> WindowLikelihood::information_of_exact_motion(const VectorXd& theta) {
  LikelihoodPoint point;
  if (!prepare(theta) || !gather(point, true)) return std::nullopt;
  return point.information;
}

}  // namespace framewatch::estimator
