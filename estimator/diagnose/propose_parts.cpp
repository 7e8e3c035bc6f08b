#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "estimator/diagnose/propose_parts.h"
#include "estimator/structure/complex.h"

namespace framewatch {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

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

std::vector<VectorXcd> columns_with(const ModelEffect& effect, const Fitter& fitter,
                                    const std::vector<Needed>& needed, std::size_t record) {
  const Stretch& s = fitter.stretches()[record];
  const Needed& n = needed[record];
  const int ratio = fitter.ratio(record);
  std::vector<VectorXcd> out = linear_columns(n, s.w);
  const VectorXd force = law_force(effect.law(record), n.d_t, n.v_t, 1 / (s.rate_hz * ratio));
  out.push_back(band_of(force, s, ratio));
  return out;
}

ScalarSums scalar_sums(const Needed& needed, const std::vector<VectorXcd>& columns) {
  const auto count = static_cast<Index>(columns.size());
  const VectorXd& w = needed.weight;
  ScalarSums out{MatrixXd::Zero(count, count), VectorXd::Zero(count), 0};
  for (Index i = 0; i < count; ++i) {
    const VectorXcd& a = columns[static_cast<std::size_t>(i)];
    out.right[i] = (w.array() * (a.conjugate().array() * needed.force.array()).real()).sum();
    for (Index j = 0; j <= i; ++j) {
      const VectorXcd& b = columns[static_cast<std::size_t>(j)];
      out.normal(i, j) = (w.array() * (a.conjugate().array() * b.array()).real()).sum();
      out.normal(j, i) = out.normal(i, j);
    }
  }
  out.total = (w.array() * needed.force.array().abs2()).sum();
  return out;
}

ScalarSums& ScalarSums::operator+=(const ScalarSums& more) {
  normal += more.normal;
  right += more.right;
  total += more.total;
  return *this;
}

ScalarFit ScalarSums::fit() const {
  const VectorXd scale = normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  MatrixXd scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  scaled.diagonal().array() += 1e-10;
  ScalarFit out;
  out.coefficients = scale.asDiagonal() * scaled.ldlt().solve(scale.asDiagonal() * right);
  out.misfit = total - out.coefficients.dot(right);
  return out;
}

ScalarFit scalar_fit(const std::vector<Needed>& needed,
                     const std::vector<std::vector<VectorXcd>>& columns) {
  ScalarSums sums = scalar_sums(needed.front(), columns.front());
  for (std::size_t r = 1; r < needed.size(); ++r) sums += scalar_sums(needed[r], columns[r]);
  return sums.fit();
}

}  // namespace framewatch
