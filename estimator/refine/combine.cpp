// SPDX-License-Identifier: MIT
#include "estimator/refine/combine.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

/// An estimate by its information, in units of `scale`.
struct Piece {
  Eigen::VectorXd theta;
  Eigen::MatrixXd information;
};

/// Returns an estimate in units of `scale`, which keeps the matrices well conditioned; nullopt: it
/// does not count.
std::optional<Piece> piece_of(const Refinement& r, const Eigen::VectorXd& scale) {
  if (r.status != RefineStatus::converged || !r.covariance.allFinite() || !(scale.minCoeff() > 0))
    return std::nullopt;
  const Eigen::VectorXd unit = scale.cwiseInverse();
  const Eigen::MatrixXd covariance = unit.asDiagonal() * r.covariance * unit.asDiagonal();
  const Cholesky factor(covariance);
  if (!factor.good()) return std::nullopt;
  return Piece{r.theta.cwiseProduct(unit),
               factor.solve(Eigen::MatrixXd::Identity(scale.size(), scale.size()))};
}

}  // namespace

Refinement combine(const std::vector<Refinement>& estimates) {
  Refinement out = estimates.front();
  Eigen::VectorXd scale;
  std::vector<Piece> pieces;
  double misfit = 0;
  Eigen::VectorXd bound_information;
  for (const Refinement& r : estimates) {
    const std::optional<Piece> piece = piece_of(r, pieces.empty() ? r.theta : scale);
    if (!piece) continue;
    if (pieces.empty()) {
      out = r;
      scale = r.theta;
      bound_information = Eigen::VectorXd::Zero(scale.size());
    }
    pieces.push_back(*piece);
    misfit += r.misfit_ratio;
    bound_information += r.bound.cwiseAbs2().cwiseInverse();
  }
  if (pieces.size() < 2) return out;
  const Eigen::Index parameters = scale.size();
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(parameters, parameters);
  Eigen::VectorXd weighted = Eigen::VectorXd::Zero(parameters);
  for (const Piece& piece : pieces) {
    information += piece.information;
    weighted += piece.information * piece.theta;
  }
  const Cholesky factor(information);
  const Eigen::VectorXd mean = factor.solve(weighted);
  double apart = 0;
  for (const Piece& piece : pieces) {
    const Eigen::VectorXd off = piece.theta - mean;
    apart += off.dot(piece.information * off);
  }
  const auto count = static_cast<double>(pieces.size());
  const double freedoms = (count - 1) * static_cast<double>(parameters);
  const double wider = std::max(1.0, apart / freedoms);
  out.theta = mean.cwiseProduct(scale);
  out.covariance = wider * (scale.asDiagonal() *
                            factor.solve(Eigen::MatrixXd::Identity(parameters, parameters)) *
                            scale.asDiagonal());
  out.std_error = out.covariance.diagonal().cwiseSqrt();
  out.bound = bound_information.cwiseInverse().cwiseSqrt();
  out.misfit_ratio = misfit / count;
  return out;
}

}  // namespace framewatch::estimator
