// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/law_tracks.h"
#include "estimator/diagnose/model/linear_operation.h"
#include "estimator/diagnose/model/model.h"
#include "estimator/diagnose/spectra/record_segment.h"
#include "estimator/diagnose/spectra/weights.h"

namespace framewatch::estimator {

/// The operations D of every bin of a segment, equations x axes, docs/equations.md (31). Those of a
/// large building are computed on demand because of their memory.
class Operations {
 public:
  Operations() = default;
  /// D = mass - stiffness / w^2 - j damping / w + additions, all equations x axes; w: rad/s.
  Operations(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& stiffness,
             const Eigen::MatrixXd& damping, std::vector<LinearOperation> additions,
             Eigen::VectorXd w);

  bool empty() const { return w_.size() == 0; }
  Eigen::Index equations() const { return mass_.rows(); }
  Eigen::MatrixXcd operator[](std::size_t bin) const {
    return kept_.empty() ? made(static_cast<Eigen::Index>(bin)) : kept_[bin];
  }

  /// Returns D motion for every bin: equations x bins. motion: axes x bins.
  Eigen::MatrixXcd times(const Eigen::MatrixXcd& motion) const;
  /// Returns D^H forces for every bin: axes x bins. forces: equations x bins.
  Eigen::MatrixXcd adjoint_times(const Eigen::MatrixXcd& forces) const;
  /// Returns an axis' column for every bin: equations x bins.
  Eigen::MatrixXcd of_axis(Eigen::Index axis) const;

 private:
  Eigen::MatrixXcd made(Eigen::Index bin) const;
  Eigen::MatrixXcd product(const Eigen::MatrixXcd& columns, bool adjoint) const;

  Eigen::MatrixXd mass_, stiffness_, damping_;
  std::vector<LinearOperation> additions_;
  Eigen::VectorXd w_;
  std::vector<Eigen::MatrixXcd> kept_;
};

/// Ratio of misfit to its expectation under noise, below which the weights follow the model within
/// a step of the fit.
inline constexpr double kNearNoise = 1.5;

/// The equations of one segment under one model, D A + forces, whitened by the noise of the sensors
/// in them: docs/equations.md (33).
struct Whitened {
  bool good = false;
  Operations operation;  ///< D of every bin
  std::shared_ptr<const Weights> weights;
  /// Axes x bins: spectra corrected for the axes' errors. The rows below are the motions that no
  /// axis reads (Plant::unread), computed from them.
  Eigen::MatrixXcd calibrated;
  Eigen::MatrixXcd motion;              ///< the likeliest motion: has less noise if the model fits
  std::vector<LawTrack> tracks;         ///< of the element laws
  std::vector<Equivalent> linear;       ///< of the element laws
  std::vector<Eigen::VectorXcd> force;  ///< of the element laws: spectrum, N
  /// Equations x bins: forces of laws beyond `linear`, minus external forces.
  Eigen::MatrixXcd forces;
  Eigen::VectorXd residual;  ///< whitened rows, including end terms
  Eigen::VectorXd rest;      ///< residual with the end terms projected out
  double misfit = 0;         ///< sum of squares of `rest`
  /// Derivatives of half the misfit. by_forces: by forces on the equations, equations x bins:
  /// whitener^H rest. by_readings: by the axes' readings, axes x bins: D^H by_forces.
  Eigen::MatrixXcd by_forces, by_readings;

  Eigen::Index bins() const { return calibrated.cols(); }
};

/// Whitens the equations of one segment. tracks: of the model's element laws. ratio: steps per
/// sample. weights: null: compute the model's weights. Returns a system that is not good if it
/// cannot be computed.
Whitened whiten(const Plant& plant, const Model& model, const RecordSegment& segment,
                std::size_t record, std::vector<LawTrack> tracks, int ratio,
                std::shared_ptr<const Weights> weights = nullptr);
/// Whitens the equations with the tracks of tracks_of(). The result is not good if the free run
/// diverges.
Whitened whiten(const Plant& plant, const Model& model, const RecordSegment& segment,
                std::size_t record, Forcing forcing, const Eigen::MatrixXcd& motion, int ratio);
/// Returns a system of the same model, whitened again with the model's weights.
Whitened with_own_weights(const Plant& plant, const Model& model, const RecordSegment& segment,
                          Whitened system);

/// Returns the misfit near every bin over its expectation: the mean of the bin and of `around` on
/// each side. rest: whitened residual.
Eigen::VectorXd local_misfit(const Plant& plant, const Eigen::VectorXd& rest, Eigen::Index bins,
                             Eigen::Index around);

/// Sets the likeliest motion if only `rest` of the residual is noise: an arbitrary force explains
/// the other part.
void set_motion(const Plant& plant, const Model& model, const RecordSegment& segment,
                const Eigen::VectorXd& rest, Whitened& system);

/// Returns the whitened rows of forces, equations x bins.
Eigen::VectorXd whiten_rows(const Whitened& system, const Eigen::MatrixXcd& forces);
/// Returns the whitened rows of direction (equations) times signal (bins).
Eigen::VectorXd whiten_rows(const Whitened& system, const Eigen::VectorXd& direction,
                            const Eigen::VectorXcd& signal);
/// Returns the whitened rows of an error in the reading of one axis: its column of D times the
/// signal.
Eigen::VectorXd whiten_axis(const Whitened& system, Eigen::Index axis,
                            const Eigen::VectorXcd& signal);

}  // namespace framewatch::estimator
