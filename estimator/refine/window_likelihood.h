#pragma once

#include <complex>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/refine/measured_building.h"
#include "estimator/refine/spectrum.h"

namespace framewatch {

/// Unknowns beside theta that a stretch needs per equation, docs/equations.md (32).
/// states: displacement and velocity at its ends; sampled: also what sampling adds to them.
enum class EndTerms { states = 2, sampled = 4 };

/// What the misfit of a stretch is and how it depends on theta; docs/equations.md (33)-(36).
struct LikelihoodPoint {
  double misfit = 0;            ///< sum of e^H Omega^-1 e, end terms fitted
  Eigen::VectorXd gradient;     ///< of misfit, per unit of theta
  Eigen::MatrixXd information;  ///< Fisher information of theta, end terms projected out
  Eigen::MatrixXd noise_part;   ///< share of `information` that is expected of sensor noise alone
};

/// Errors-in-variables likelihood of a stretch: every axis noisy, the true motion unknown.
class WindowLikelihood {
 public:
  /// Both must outlive this.
  WindowLikelihood(const MeasuredBuilding& building, const Spectrum& spectrum, EndTerms terms);

  /// Empty when theta makes no sense of the data (not finite).
  std::optional<double> misfit(const Eigen::VectorXd& theta);
  std::optional<LikelihoodPoint> at(const Eigen::VectorXd& theta);
  /// Information that exact motion gives: the spectrum is taken for the truth.
  std::optional<Eigen::MatrixXd> information_of_exact_motion(const Eigen::VectorXd& theta);

  /// Complex equations over all bins.
  double observations() const;
  Eigen::Index end_unknowns() const { return terms_ * building_.equations(); }

 private:
  struct Bin {
    Eigen::MatrixXcd operation;             ///< D, equations x axes
    Eigen::MatrixXcd weight;                ///< Omega^-1
    Eigen::VectorXcd residual;              ///< e, end terms taken off after fit_ends()
    std::vector<std::complex<double>> end;  ///< factors of the end unknowns
  };
  bool prepare(const Eigen::VectorXd& theta);
  bool fit_ends();
  double sum_misfit() const;
  bool gather(LikelihoodPoint& point, bool exact_motion) const;

  const MeasuredBuilding& building_;
  const Spectrum& spectrum_;
  Eigen::Index terms_;
  Eigen::VectorXd noise_;  ///< per axis in one bin
  std::vector<Bin> bins_;
  Eigen::MatrixXd ends_;  ///< information of the end unknowns
};

}  // namespace framewatch
