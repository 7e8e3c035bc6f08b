// SPDX-License-Identifier: MIT
#include "estimator/modes/mode_shapes.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "estimator/numeric/complex.h"
#include "estimator/numeric/nan.h"
#include "estimator/numeric/solve.h"
#include "estimator/structure/story_groups.h"

namespace framewatch::estimator {
namespace {

constexpr double kLeastMac = 0.5, kLargestRatio = 1.5;
constexpr double kAlikeRidge = 1e-12;  ///< of shapes that are alike at all channels

/// Returns the shapes of the modes with the frequency of mode `at`, as columns.
Eigen::MatrixXcd shapes_of(const std::vector<ComparedMode>& modes, int at) {
  const ComparedMode& mode = modes[static_cast<std::size_t>(at)];
  Eigen::MatrixXcd out(mode.shape.size(), mode.last_equal - mode.first_equal + 1);
  for (Eigen::Index i = 0; i < out.cols(); ++i) {
    out.col(i) = modes[static_cast<std::size_t>(mode.first_equal + static_cast<int>(i))].shape;
    out.col(i) /= std::max(out.col(i).norm(), 1e-300);
  }
  return out;
}

/// Returns the share of `shape` that lies in the space of the columns of `basis`.
double share_in(const Eigen::VectorXcd& shape, const Eigen::MatrixXcd& basis) {
  if (shape.size() != basis.rows()) return kNaN;
  Eigen::MatrixXcd gram = basis.adjoint() * basis;
  gram.diagonal().array() += kAlikeRidge;
  const Eigen::VectorXcd along = basis.adjoint() * shape;
  return along.dot(ComplexLu(gram).solve(along)).real() / shape.squaredNorm();
}

}  // namespace

std::vector<std::size_t> compared_axes(const std::vector<SensorAxis>& axes) {
  std::vector<std::size_t> out;
  for (std::size_t a = 0; a < axes.size(); ++a)
    if (axes[a].horizontal() && axes[a].story > 0) out.push_back(a);
  return out;
}

Eigen::MatrixXd channel_weights(const Structure& s, const std::vector<SensorAxis>& axes) {
  const std::vector<std::size_t> compared = compared_axes(axes);
  Eigen::MatrixXd out =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(compared.size()), s.degrees_of_freedom());
  for (std::size_t row = 0; row < compared.size(); ++row) {
    const SensorAxis& axis = axes[compared[row]];
    const std::vector<double> weights = frame_weights(s, axis);
    for (int f = 0; f < s.frames(); ++f)
      out(static_cast<Eigen::Index>(row), s.dof(axis.story, f)) =
          weights[static_cast<std::size_t>(f)];
  }
  return out;
}

double mac(const Eigen::VectorXcd& a, const Eigen::VectorXcd& b) {
  if (a.size() != b.size()) return kNaN;
  return std::norm(a.dot(b)) / (a.squaredNorm() * b.squaredNorm());
}

double mac(const std::vector<ComparedMode>& as, int a, const std::vector<ComparedMode>& bs, int b) {
  const ComparedMode& one = as[static_cast<std::size_t>(a)];
  const ComparedMode& other = bs[static_cast<std::size_t>(b)];
  if (other.first_equal != other.last_equal) return share_in(one.shape, shapes_of(bs, b));
  if (one.first_equal != one.last_equal) return share_in(other.shape, shapes_of(as, a));
  return mac(one.shape, other.shape);
}

std::vector<int> paired_modes(const std::vector<ComparedMode>& as,
                              const std::vector<ComparedMode>& bs) {
  // Pairs by ascending distance: what is missing to a MAC of 1, and the ratio of frequencies.
  std::vector<std::tuple<double, int, int>> pairs;
  for (int a = 0; a < static_cast<int>(as.size()); ++a)
    for (int b = 0; b < static_cast<int>(bs.size()); ++b) {
      const double alike = mac(as, a, bs, b);
      const double apart = std::abs(std::log(as[static_cast<std::size_t>(a)].frequency_hz /
                                             bs[static_cast<std::size_t>(b)].frequency_hz));
      if (alike >= kLeastMac && apart <= std::log(kLargestRatio))
        pairs.emplace_back(1 - alike + apart, a, b);
    }
  std::sort(pairs.begin(), pairs.end());
  std::vector<int> out(as.size(), -1);
  std::vector<bool> taken(bs.size(), false);
  for (const auto& [distance, a, b] : pairs) {
    if (out[static_cast<std::size_t>(a)] >= 0 || taken[static_cast<std::size_t>(b)]) continue;
    out[static_cast<std::size_t>(a)] = b;
    taken[static_cast<std::size_t>(b)] = true;
  }
  return out;
}

}  // namespace framewatch::estimator
