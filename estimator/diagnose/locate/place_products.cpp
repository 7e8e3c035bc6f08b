#include "estimator/diagnose/locate/place_products.h"

#include <cmath>
#include <complex>

#include "estimator/numeric/complex.h"

namespace framewatch::estimator {

using Eigen::Index;
using Eigen::MatrixXcd;

namespace {

/// Share of a direction's square below which it depends on the directions before it.
constexpr double kIndependent = 1e-12;

Complex product(const Eigen::RowVectorXcd& equations, const BinProducts::Direction& direction) {
  Complex out = 0;
  for (const BinProducts::Entry& e : direction)
    out += equations[e.equation] * Complex(e.real, e.imaginary);
  return out;
}

PlaceProducts products_of(const BinProducts& products, const std::vector<CandidatePlace>& places,
                          bool with_columns) {
  std::vector<BinProducts::Direction> directions;
  for (const CandidatePlace& place : places) {
    if (place.kind == CandidatePlace::Kind::axis)
      directions.push_back(products.of_axis(place.axis));
    for (Index c = 0; c < place.directions.cols(); ++c)
      directions.push_back(products.of_force(place.directions.col(c)));
  }
  PlaceProducts out;
  const auto count = static_cast<Index>(directions.size());
  for (Index i = 0; i < count; ++i) {
    const BinProducts::Direction& direction = directions[static_cast<std::size_t>(i)];
    const Eigen::RowVectorXcd equations = products.under_metric(direction);
    Eigen::RowVectorXcd columns;
    if (with_columns) columns = products.with_columns(direction);
    if (i == 0) {
      out.equations = MatrixXcd::Zero(count, equations.size());
      out.columns = MatrixXcd::Zero(count, columns.size());
    }
    out.equations.row(i) = equations;
    out.columns.row(i) = columns;
    const double before = product(equations, direction).real();
    double square = before;
    // equations.row(k) force: the product of the orthonormal direction k with this one.
    for (Index k = 0; k < i; ++k) {
      const Complex with = product(out.equations.row(k), direction);
      out.equations.row(i) -= std::conj(with) * out.equations.row(k);
      out.columns.row(i) -= std::conj(with) * out.columns.row(k);
      square -= std::norm(with);
    }
    const double scale = square > kIndependent * before ? 1 / std::sqrt(square) : 0.0;
    out.equations.row(i) *= scale;
    out.columns.row(i) *= scale;
  }
  return out;
}

}  // namespace

PlaceProducts place_products(const BinProducts& products,
                             const std::vector<CandidatePlace>& places) {
  return products_of(products, places, true);
}

MatrixXcd place_equations(const BinProducts& products, const std::vector<CandidatePlace>& places) {
  return products_of(products, places, false).equations;
}

}  // namespace framewatch::estimator
