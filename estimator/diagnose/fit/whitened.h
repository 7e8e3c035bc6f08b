#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/law_tracks.h"
#include "estimator/diagnose/fit/operations.h"
#include "estimator/diagnose/model/model.h"
#include "estimator/diagnose/spectra/record_segment.h"
#include "estimator/diagnose/spectra/weights.h"

namespace framewatch::estimator {

/// Ratio of misfit to its expectation under noise, below which the weights follow the model within
/// a step of the fit.
inline constexpr double kNearNoise = 1.5;

/// The equations of one segment under one model, D A + forces, whitened by the noise that the
/// sensors put into them: docs/equations.md (33).
struct Whitened {
  bool good = false;
  Operations operation;  ///< D of every bin
  std::shared_ptr<const Weights> weights;
  /// Axes x bins: spectra without the axes' errors; below them motions that no axis reads
  /// (Plant::unread), as they follow from the axes'.
  Eigen::MatrixXcd calibrated;
  Eigen::MatrixXcd motion;              ///< the likeliest such motion: less noise where it fits
  std::vector<LawTrack> tracks;         ///< of the element laws
  std::vector<Equivalent> linear;       ///< of the element laws
  std::vector<Eigen::VectorXcd> force;  ///< of the element laws: spectrum, N
  /// Equations x bins: what laws do beyond `linear`, less forces from outside.
  Eigen::MatrixXcd forces;
  Eigen::VectorXd residual;  ///< whitened rows, end terms still in them
  Eigen::VectorXd rest;      ///< residual with the end terms projected out
  double misfit = 0;         ///< sum of squares of `rest`
  /// Derivative of half the misfit by forces on the equations, equations x bins: whitener^H rest;
  /// and by the axes' readings, axes x bins: D^H of that.
  Eigen::MatrixXcd by_forces, by_readings;

  Eigen::Index bins() const { return calibrated.cols(); }
};

/// tracks: of the model's element laws. weights: null: the model's own.
Whitened whiten(const Plant& plant, const Model& model, const RecordSegment& segment,
                std::size_t record, std::vector<LawTrack> tracks, int ratio,
                std::shared_ptr<const Weights> weights = nullptr);
/// The same with the tracks of tracks_of(); not good when the free run diverges.
Whitened whiten(const Plant& plant, const Model& model, const RecordSegment& segment,
                std::size_t record, Forcing forcing, const Eigen::MatrixXcd& motion, int ratio);
/// A system of the same model, whitened anew with the model's own weights.
Whitened with_own_weights(const Plant& plant, const Model& model, const RecordSegment& segment,
                          Whitened system);

/// equations x bins of forces -> whitened rows.
Eigen::VectorXd whiten_rows(const Whitened& system, const Eigen::MatrixXcd& forces);
/// direction (equations) times signal (bins) -> whitened rows.
Eigen::VectorXd whiten_rows(const Whitened& system, const Eigen::VectorXd& direction,
                            const Eigen::VectorXcd& signal);
/// An error in the reading of one axis (its column of D times the signal) -> whitened rows.
Eigen::VectorXd whiten_axis(const Whitened& system, Eigen::Index axis,
                            const Eigen::VectorXcd& signal);

}  // namespace framewatch::estimator
