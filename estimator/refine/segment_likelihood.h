// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/refine/spectrum.h"

namespace framewatch::estimator {

/// Unknowns per equation at the ends of a segment, docs/equations.md (32). states: displacement and
/// velocity. sampled: also the terms that sampling adds.
enum class EndTerms { states = 2, sampled = 4 };

/// The misfit of a segment at one theta and its derivatives; docs/equations.md (33)-(36).
struct LikelihoodPoint {
  double misfit = 0;            ///< sum of e^H Omega^-1 e, end terms fitted
  Eigen::VectorXd gradient;     ///< of misfit, per unit of theta
  Eigen::MatrixXd information;  ///< Fisher information of theta, end terms projected out
  Eigen::MatrixXd noise_part;   ///< expected value of `information` under sensor noise alone
};

/// The errors-in-variables likelihood of a segment: every axis is noisy and the true motion
/// unknown. A derived class defines the equations e = D A of the motion.
class SegmentLikelihood {
 public:
  virtual ~SegmentLikelihood() = default;

  /// Return nullopt when the misfit is not finite at theta.
  std::optional<double> misfit(const Eigen::VectorXd& theta);
  std::optional<LikelihoodPoint> at(const Eigen::VectorXd& theta);
  /// Returns the information of the segment if its spectrum is the exact motion; nullopt as above.
  std::optional<Eigen::MatrixXd> information_of_exact_motion(const Eigen::VectorXd& theta);

  /// Returns the number of complex equations over all bins.
  double observations() const;
  Eigen::Index end_unknowns() const { return terms_ * equations_ + inner_ends_; }
  const Spectrum& spectrum() const { return spectrum_; }
  /// Returns the variance of one sample's white noise, per axis, (m/s^2)^2.
  const Eigen::VectorXd& variance() const { return variance_; }

 protected:
  struct Bin {
    Eigen::MatrixXcd operation;             ///< D, equations x axes
    Eigen::MatrixXcd weight;                ///< Omega^-1
    Eigen::VectorXcd residual;              ///< e; minus the fitted end terms after fit_ends()
    std::vector<std::complex<double>> end;  ///< factors of the end unknowns of every equation
    Eigen::MatrixXcd inner_end;             ///< equations x further end unknowns
  };
  /// spectrum: must outlive this. variance: per axis. inner_ends: number of further end unknowns.
  SegmentLikelihood(Eigen::Index equations, Eigen::Index parameters,
                    const Eigen::VectorXd& variance, const Spectrum& spectrum, EndTerms terms,
                    Eigen::Index inner_ends = 0);

  /// Sets every bin's operation and inner_end. Returns false when theta is invalid.
  virtual bool operate(const Eigen::VectorXd& theta) = 0;
  /// Adds bin b. force: weight times residual. motion: of the axes, without the noise found in it.
  /// cross: parameters x end unknowns. Skips noise_part if the motion is exact.
  virtual void gather(Eigen::Index b, const Eigen::VectorXcd& force, const Eigen::VectorXcd& motion,
                      bool exact_motion, LikelihoodPoint& point, Eigen::MatrixXd& cross) const = 0;

  const Bin& bin(Eigen::Index b) const { return bins_[static_cast<std::size_t>(b)]; }
  Bin& bin(Eigen::Index b) { return bins_[static_cast<std::size_t>(b)]; }
  /// Returns the noise variance per axis in one bin.
  const Eigen::VectorXd& noise() const { return noise_; }
  /// Returns the fitted further end unknowns.
  const Eigen::VectorXd& fitted_inner() const { return fitted_inner_; }
  Eigen::Index equations() const { return equations_; }
  Eigen::Index parameters() const { return parameters_; }

 private:
  bool prepare(const Eigen::VectorXd& theta);
  bool fit_ends();
  double sum_misfit() const;
  bool gather_all(LikelihoodPoint& point, bool exact_motion) const;

  Eigen::Index equations_, parameters_;
  const Spectrum& spectrum_;
  Eigen::Index terms_, inner_ends_;
  Eigen::VectorXd variance_, noise_, fitted_inner_;
  std::vector<Bin> bins_;
  Eigen::MatrixXd ends_;  ///< information of the end unknowns
};

}  // namespace framewatch::estimator
