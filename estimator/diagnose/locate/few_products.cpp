#include "estimator/diagnose/locate/few_products.h"

#include <complex>

#include "estimator/numeric/complex.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::RowVectorXcd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

FewProducts::FewProducts(const Linearised& at, std::size_t record, const std::vector<Index>& kept)
    : at_(at), system_(at.systems[record]), columns_(at.columns[record]), kept_(kept) {
  const Eigen::MatrixXd& act = at.plant->building.act;
  for (Index e = 0; e < act.cols(); ++e) elements_.push_back(BinProducts::of_force(act.col(e)));
}

void FewProducts::set_bin(Index bin) {
  bin_ = bin;
  operation_ = system_.operation[static_cast<std::size_t>(bin)].leftCols(at_.plant->axis_count());
}

void FewProducts::add(const std::vector<CandidatePlace>& places, VectorXd& sum) const {
  const MatrixXcd directions = directions_of(places);
  const MatrixXcd whitened = system_.weights->whitened_of(bin_, directions);
  const MatrixXcd under = system_.weights->turned_back_of(bin_, whitened);
  add_explained(directions.adjoint() * under, with_columns(whitened, under), sum);
}

MatrixXcd FewProducts::directions_of(const std::vector<CandidatePlace>& places) const {
  Index count = 0;
  for (const CandidatePlace& place : places) count += place.size();
  MatrixXcd out(operation_.rows(), count);
  Index at = 0;
  for (const CandidatePlace& place : places) {
    if (place.kind == CandidatePlace::Kind::axis)
      out.col(at) = operation_.col(place.axis);
    else
      out.middleCols(at, place.size()) = place.directions.cast<Complex>();
    at += place.size();
  }
  return out;
}

MatrixXcd FewProducts::with_columns(const MatrixXcd& whitened, const MatrixXcd& under) const {
  const Index n = under.rows(), elements = static_cast<Index>(elements_.size());
  const auto end = static_cast<Index>(kept_.size());
  VectorXcd along(elements + operation_.cols() + n), effect(n);
  MatrixXcd out(under.cols(), end + 1);
  for (Index i = 0; i < under.cols(); ++i) {
    for (Index e = 0; e < elements; ++e) {
      along[e] = 0;
      for (const BinProducts::Entry& entry : elements_[static_cast<std::size_t>(e)])
        along[e] += entry.real * under(entry.equation, i);
    }
    along.segment(elements, operation_.cols()).noalias() = operation_.adjoint() * under.col(i);
    along.tail(n) = under.col(i);
    for (Index c = 0; c < end; ++c) {
      const auto u = static_cast<std::size_t>(kept_[static_cast<std::size_t>(c)]);
      if (const Index d = columns_.direction[u]; d >= 0) {
        out(i, c) = std::conj(along[d]) * columns_.size(bin_, static_cast<Index>(u));
        continue;
      }
      const auto rows = columns_.effects.col(columns_.row[u]);
      effect.real() = rows.segment(2 * n * bin_, n);
      effect.imag() = rows.segment(2 * n * bin_ + n, n);
      out(i, c) = whitened.col(i).dot(effect);
    }
  }
  effect.real() = system_.rest.segment(2 * n * bin_, n);
  effect.imag() = system_.rest.segment(2 * n * bin_ + n, n);
  out.col(end).noalias() = whitened.adjoint() * effect;
  return out;
}

void add_explained(MatrixXcd square, const MatrixXcd& columns, VectorXd& sum) {
  constexpr double kRegular = 1e-9;
  square.diagonal() *= 1 + kRegular;
  const VectorXcd last = columns.col(columns.cols() - 1);
  const VectorXcd size = square.cols() == 1 ? VectorXcd(last / square(0, 0).real())
                                            : VectorXcd(solve_ldlt(square, last));
  if (!size.allFinite()) return;
  for (Index i = 0; i < size.size(); ++i)
    sum += columns.row(i).real().transpose() * size[i].real() +
           columns.row(i).imag().transpose() * size[i].imag();
}

}  // namespace framewatch::estimator
