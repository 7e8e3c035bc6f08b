#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "estimator/diagnose/propose_parts.h"
#include "estimator/structure/complex.h"

namespace framewatch {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

}  // namespace

Knob linear_knob(double value, double step) {
  Knob out;
  out.value = value;
  out.step = std::max(std::abs(step), 1e-30);
  return out;
}

Knob logarithmic_knob(double value, double low, double high) {
  Knob out;
  out.logarithmic = true;
  out.value = std::log(value);
  out.step = 0.02;
  out.low = std::log(low);
  out.high = std::log(high);
  return out;
}

Knob bounded_knob(double value, double step, double low, double high, bool free) {
  Knob out = linear_knob(value, step);
  out.low = low;
  out.high = high;
  out.free = free;
  return out;
}

std::vector<VectorXcd> linear_columns(const Needed& needed, const VectorXd& w) {
  return {needed.d, needed.d.array() * w.array() * kJ};
}

ScalarFit scalar_fit(const std::vector<Needed>& needed,
                     const std::vector<std::vector<VectorXcd>>& columns) {
  const auto count = static_cast<Index>(columns.front().size());
  MatrixXd normal = MatrixXd::Zero(count, count);
  VectorXd right = VectorXd::Zero(count);
  double total = 0;
  for (std::size_t r = 0; r < needed.size(); ++r) {
    const VectorXd& w = needed[r].weight;
    for (Index i = 0; i < count; ++i) {
      const VectorXcd& a = columns[r][static_cast<std::size_t>(i)];
      right[i] += (w.array() * (a.conjugate().array() * needed[r].force.array()).real()).sum();
      for (Index j = 0; j <= i; ++j) {
        const VectorXcd& b = columns[r][static_cast<std::size_t>(j)];
        normal(i, j) += (w.array() * (a.conjugate().array() * b.array()).real()).sum();
        normal(j, i) = normal(i, j);
      }
    }
    total += (w.array() * needed[r].force.array().abs2()).sum();
  }
  const VectorXd scale = normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  MatrixXd scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  scaled.diagonal().array() += 1e-10;
  ScalarFit out;
  out.coefficients = scale.asDiagonal() * scaled.ldlt().solve(scale.asDiagonal() * right);
  out.misfit = total - out.coefficients.dot(right);
  return out;
}

}  // namespace framewatch
