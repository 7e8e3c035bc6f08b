#include "estimator/diagnose/propose/scalar_fit.h"

#include "estimator/numeric/solve.h"

namespace framewatch::estimator {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

ScalarSums scalar_sums(const NeededSignal& needed, const std::vector<VectorXcd>& given) {
  std::vector<VectorXcd> columns;
  for (const VectorXcd& column : given) columns.push_back(needed.without_ends(column));
  const VectorXcd force = needed.without_ends(needed.force);
  const auto count = static_cast<Index>(columns.size());
  const VectorXd& w = needed.weight;
  ScalarSums out{MatrixXd::Zero(count, count), VectorXd::Zero(count), 0};
  for (Index i = 0; i < count; ++i) {
    const VectorXcd& a = columns[static_cast<std::size_t>(i)];
    out.right[i] = (w.array() * (a.conjugate().array() * force.array()).real()).sum();
    for (Index j = 0; j <= i; ++j) {
      const VectorXcd& b = columns[static_cast<std::size_t>(j)];
      out.normal(i, j) = (w.array() * (a.conjugate().array() * b.array()).real()).sum();
      out.normal(j, i) = out.normal(i, j);
    }
  }
  out.total = (w.array() * force.array().abs2()).sum();
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
  out.coefficients = scale.asDiagonal() * Ldlt(scaled).solve(VectorXd(scale.asDiagonal() * right));
  out.misfit = total - out.coefficients.dot(right);
  return out;
}

ScalarFit scalar_fit(const std::vector<NeededSignal>& needed,
                     const std::vector<std::vector<VectorXcd>>& columns) {
  ScalarSums sums = scalar_sums(needed.front(), columns.front());
  for (std::size_t r = 1; r < needed.size(); ++r) sums += scalar_sums(needed[r], columns[r]);
  return sums.fit();
}

VectorXcd beyond_linear(const RecordSegment& s, const NeededSignal& needed) {
  if (needed.d.size() == 0) return needed.without_ends(needed.force);
  const std::vector<VectorXcd> columns = linear_columns(needed, s.w);
  const VectorXd fit = scalar_fit({needed}, {columns}).coefficients;
  VectorXcd rest = needed.force;
  for (std::size_t c = 0; c < columns.size(); ++c)
    rest -= fit[static_cast<Eigen::Index>(c)] * columns[c];
  return needed.without_ends(rest);
}

}  // namespace framewatch::estimator
