#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/free_run.h"
#include "estimator/diagnose/model.h"
#include "estimator/diagnose/stretch.h"
#include "estimator/diagnose/weights.h"

namespace framewatch {

/// Misfit over what noise explains below which the weights are those of the model itself.
inline constexpr double kNearNoise = 1.5;

/// Whose motion drives the laws of a model: what was measured (equation by equation), or what the
/// model itself does under the measured motion of the base.
enum class Forcing { measured, simulated };

/// The linear element nearest to the force of a law.
struct Equivalent {
  double stiffness = 0, damping = 0;  ///< N/m, N s/m
};

/// The equations of one stretch under one model, D A + forces, whitened by the noise that the
/// sensors put into them: docs/equations.md (33).
struct Whitened {
  bool good = false;
  std::vector<Eigen::MatrixXcd> operation;  ///< D of every bin, equations x axes
  std::shared_ptr<const Weights> weights;
  Eigen::MatrixXcd calibrated;          ///< axes x bins: spectra without the model's errors
  Eigen::MatrixXcd motion;              ///< the same with less noise where the model fits
  std::vector<LawTrack> tracks;         ///< of the element laws
  std::vector<Equivalent> linear;       ///< of the element laws
  std::vector<Eigen::VectorXcd> force;  ///< of the element laws: spectrum, N
  Eigen::VectorXd residual;             ///< before end terms
  Eigen::VectorXd rest;                 ///< residual without what end terms explain
  double misfit = 0;                    ///< sum of squares of `rest`

  Eigen::Index bins() const { return calibrated.cols(); }
};

/// Spectra of the axes without the errors that the model gives them.
Eigen::MatrixXcd calibrated(const Model& model, const Stretch& stretch);

/// Variance of every axis' noise in a bin, of the motion that the model says it is of.
Eigen::VectorXd bin_noise(const Model& model, const Stretch& stretch, Eigen::Index bin);

/// What the element laws do. motion: axes x bins that drives them when forcing is `measured`;
/// empty: what the sensors measured. Empty when the model runs away.
std::optional<std::vector<LawTrack>> tracks_of(const Plant& plant, const Model& model,
                                               const Stretch& stretch, std::size_t record,
                                               Forcing forcing, const Eigen::MatrixXcd& motion,
                                               int ratio);

/// tracks: of the model's element laws.
/// weights: null: the model's own.
Whitened whiten(const Plant& plant, const Model& model, const Stretch& stretch, std::size_t record,
                std::vector<LawTrack> tracks, int ratio,
                std::shared_ptr<const Weights> weights = nullptr);
/// The same of tracks_of(); not good when there are none.
Whitened whiten(const Plant& plant, const Model& model, const Stretch& stretch, std::size_t record,
                Forcing forcing, const Eigen::MatrixXcd& motion, int ratio);

Equivalent equivalent_of(const LawTrack& track);
/// Spectrum of a force without what a linear element of deformation d does.
Eigen::VectorXcd beyond(const Equivalent& linear, const Eigen::VectorXcd& force,
                        const Eigen::VectorXcd& d, const Eigen::VectorXd& w);
/// Spectrum of a harmonic force from outside.
Eigen::VectorXcd harmonic_bins(const ModelEffect& effect, const Stretch& stretch,
                               std::size_t record);

/// equations x bins of forces -> whitened rows.
Eigen::VectorXd whiten_rows(const Whitened& system, const Eigen::MatrixXcd& forces);
/// direction (equations) times signal (bins) -> whitened rows.
Eigen::VectorXd whiten_rows(const Whitened& system, const Eigen::VectorXd& direction,
                            const Eigen::VectorXcd& signal);
/// Column of one axis' signal error: D's column times the signal.
Eigen::VectorXd whiten_axis(const Whitened& system, Eigen::Index axis,
                            const Eigen::VectorXcd& signal);

}  // namespace framewatch
