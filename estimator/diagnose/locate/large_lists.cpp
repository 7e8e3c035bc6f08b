#include "estimator/diagnose/locate/large_lists.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/diagnose/fit/bin_products.h"
#include "estimator/diagnose/fit/sampled_bins.h"
#include "estimator/diagnose/locate/few_products.h"
#include "estimator/diagnose/locate/place_products.h"
#include "estimator/diagnose/spectra/row_gram.h"
#include "estimator/numeric/complex.h"
#include "estimator/numeric/positive_solver.h"

namespace framewatch::estimator {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

namespace {

constexpr std::size_t kListsTogether = 256;

/// The directions of a list's places; those of axes change from bin to bin.
class Directions {
 public:
  explicit Directions(const std::vector<CandidatePlace>& places) {
    for (const CandidatePlace& place : places) {
      if (place.kind == CandidatePlace::Kind::axis) {
        forces_.emplace_back();
        axes_.push_back(place.axis);
      }
      for (Index c = 0; c < place.directions.cols(); ++c) {
        forces_.push_back(BinProducts::of_force(place.directions.col(c)));
        axes_.push_back(-1);
      }
    }
  }

  /// As FewProducts::add(), from products that are there.
  void add(const BinProducts& products, VectorXd& sum) const {
    const auto count = static_cast<Index>(forces_.size());
    MatrixXcd square(count, count), columns(count, sum.size());
    for (Index i = 0; i < count; ++i) {
      columns.row(i) = products.with_columns(at(products, i));
      for (Index j = 0; j <= i; ++j) {
        square(i, j) = products.between(at(products, i), at(products, j));
        square(j, i) = std::conj(square(i, j));
      }
    }
    add_explained(std::move(square), columns, sum);
  }

 private:
  const BinProducts::Direction& at(const BinProducts& products, Index i) const {
    const int axis = axes_[static_cast<std::size_t>(i)];
    return axis < 0 ? forces_[static_cast<std::size_t>(i)] : products.of_axis(axis);
  }

  std::vector<BinProducts::Direction> forces_;
  std::vector<int> axes_;  ///< -1: a force
};

}  // namespace

std::vector<MatrixXd> without_sampled(const MatrixXd& square, const Linearised& at,
                                      std::size_t record, const std::vector<Index>& kept,
                                      std::span<const std::vector<CandidatePlace>> lists) {
  const std::vector<SampledBin> sampled = sampled_bins(at, record);
  std::vector<RowGram> along(lists.size(), RowGram(square.cols()));
  BinProducts products(at, record, kept);
  for (const SampledBin& one : sampled) {
    products.compute(one.bin);
    const double root = std::sqrt(one.weight);
    for (std::size_t i = 0; i < lists.size(); ++i) {
      const PlaceProducts places = place_products(products, lists[i]);
      const Index count = places.columns.rows();
      auto rows = along[i].rows(2 * count);
      rows.topRows(count) = root * places.columns.real();
      rows.bottomRows(count) = root * places.columns.imag();
      along[i].add();
    }
  }
  const std::vector<VectorXd> last = last_without(square, at, record, kept, lists);
  std::vector<MatrixXd> out;
  const Index end = square.cols() - 1;
  for (std::size_t i = 0; i < lists.size(); ++i) {
    MatrixXd& one = out.emplace_back(square - along[i].sum());
    one.col(end) = last[i];
    one.row(end) = last[i].transpose();
  }
  return out;
}

std::vector<VectorXd> last_without(const MatrixXd& square, const Linearised& at, std::size_t record,
                                   const std::vector<Index>& kept,
                                   std::span<const std::vector<CandidatePlace>> lists) {
  std::vector<VectorXd> taken(lists.size(), VectorXd::Zero(square.cols()));
  FewProducts few(at, record, kept);
  for (Index b = 0; b < at.systems[record].bins(); ++b) {
    few.set_bin(b);
    for (std::size_t i = 0; i < lists.size(); ++i) few.add(lists[i], taken[i]);
  }
  std::vector<VectorXd> out;
  for (const VectorXd& one : taken) out.push_back(square.col(square.cols() - 1) - one);
  return out;
}

PositiveSolver curvature_of(const Linearised& at, const std::vector<Index>& kept,
                            const std::vector<MatrixXd>& squares) {
  const auto count = static_cast<Index>(kept.size());
  MatrixXd normal = MatrixXd::Zero(count, count);
  for (const MatrixXd& one : squares) normal += one.topLeftCorner(count, count);
  for (Index i = 0; i < count; ++i)
    normal(i, i) += at.prior[kept[static_cast<std::size_t>(i)]] / at.level;
  normal.diagonal() *= 1 + 1e-9;
  return PositiveSolver(normal);
}

std::vector<double> rough_misfits(const Linearised& at, const std::vector<Index>& kept,
                                  const std::vector<MatrixXd>& squares,
                                  const PositiveSolver& curvature,
                                  const std::vector<std::vector<CandidatePlace>>& lists,
                                  const Parallel& parallel) {
  const auto count = static_cast<Index>(kept.size());
  VectorXd whole = VectorXd::Zero(count + 1);
  for (const MatrixXd& one : squares) whole += one.col(count);
  std::vector<double> out(lists.size());
  const std::size_t groups = (lists.size() + kListsTogether - 1) / kListsTogether;
  run_all(parallel, static_cast<int>(groups), [&](int group) {
    const std::size_t first = static_cast<std::size_t>(group) * kListsTogether;
    const std::size_t end = std::min(first + kListsTogether, lists.size());
    std::vector<VectorXd> last(end - first, VectorXd::Zero(count + 1));
    std::vector<Directions> directions;
    for (std::size_t i = first; i < end; ++i) directions.emplace_back(lists[i]);
    for (std::size_t r = 0; r < at.systems.size(); ++r) {
      BinProducts products(at, r, kept);
      for (Index b = 0; b < at.systems[r].bins(); ++b) {
        products.compute(b);
        for (std::size_t i = first; i < end; ++i)
          directions[i - first].add(products, last[i - first]);
      }
    }
    for (std::size_t i = first; i < end; ++i) {
      const VectorXd rest = whole - last[i - first];
      const VectorXd gradient = rest.head(count);
      out[i] = rest[count] - gradient.dot(curvature.solve(gradient));
    }
  });
  return out;
}

}  // namespace framewatch::estimator
