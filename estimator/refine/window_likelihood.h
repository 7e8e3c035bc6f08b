#pragma once

#include <complex>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/refine/measured_building.h"
#include "estimator/refine/spectrum.h"

namespace framewatch::estimator {

/// Unknowns per equation for the ends of a segment, docs/equations.md (32). states: displacement
/// and velocity; sampled: also the terms that sampling adds.
enum class EndTerms { states = 2, sampled = 4 };

/// Misfit of a segment at one theta and its derivatives; docs/equations.md (33)-(36).
struct LikelihoodPoint {
  double misfit = 0;            ///< sum of e^H Omega^-1 e, end terms fitted
  Eigen::VectorXd gradient;     ///< of misfit, per unit of theta
  Eigen::MatrixXd information;  ///< Fisher information of theta, end terms projected out
  Eigen::MatrixXd noise_part;   ///< expected value of `information` under sensor noise alone
};

/// Errors-in-variables likelihood of a segment: every axis noisy, the true motion unknown.
class WindowLikelihood {
 public:
  /// Both must outlive this.
  WindowLikelihood(const MeasuredBuilding& building, const Spectrum& spectrum, EndTerms terms);

  /// Empty when the misfit is not finite at theta.
  std::optional<double> misfit(const Eigen::VectorXd& theta);
  std::optional<LikelihoodPoint> at(const Eigen::VectorXd& theta);
  /// Information of the segment if its spectrum is the exact motion.
  std::optional<Eigen::MatrixXd> information_of_exact_motion(const Eigen::VectorXd& theta);

  /// Complex equations over all bins.
  double observations() const;
  Eigen::Index end_unknowns() const { return terms_ * building_.equations(); }

 private:
  struct Bin {
    Eigen::MatrixXcd operation;             ///< D, equations x axes
    Eigen::MatrixXcd weight;                ///< Omega^-1
    Eigen::VectorXcd residual;              ///< e; minus the fitted end terms after fit_ends()
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

}  // namespace framewatch::estimator
