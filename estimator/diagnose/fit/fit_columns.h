// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/unknowns.h"
#include "estimator/diagnose/fit/whitened.h"

namespace framewatch::estimator {

/// Returns true if the derivative of the free run's motion by this unknown is computed: for
/// parameters of effects, and for stiffness and mass of frames in the direction of a law's frame.
/// In a large building only for stiffnesses at the law and next to it.
bool moves_run(const Plant& plant, const Model& model, const Unknown& unknown);

/// Returns the derivative of the whitened equations by one unknown through the forces of the laws,
/// or nullopt if the changed model cannot be run. The laws' motion is that of the free run. system:
/// of the model, whitened with Forcing::simulated. cache: not shared between threads; null: no
/// cache.
std::optional<Eigen::VectorXd> run_column(const Plant& plant, const Model& model,
                                          const RecordSegment& segment, std::size_t record,
                                          const Whitened& system, const Unknown& unknown, int ratio,
                                          RunCache* cache = nullptr);

/// Derivatives of a segment's equations by the unknowns. For the linear building and the axes they
/// are a direction times a spectrum, and many unknowns share a direction. For effects they are
/// whitened rows.
struct Columns {
  /// For every unknown: index among the elements, then the axes, then the coordinates; -1: an
  /// effect.
  std::vector<Eigen::Index> direction;
  /// Bins x unknowns: the spectrum along the direction; for tied stories, that of the first story.
  Eigen::MatrixXcd size;
  std::vector<Eigen::Index> row;  ///< of every unknown in `effects`; -1: it has a direction
  Eigen::MatrixXd effects;        ///< whitened rows x unknowns of effects

  Eigen::Index count() const { return static_cast<Eigen::Index>(direction.size()); }
};

/// Computes the derivatives of one segment. ratio: steps per sample of the laws; through_run:
/// include the derivatives of the free run's motion.
Columns columns_of(const Plant& plant, const Model& model, const RecordSegment& segment,
                   std::size_t record, const Whitened& system, const std::vector<Unknown>& unknowns,
                   int ratio, bool through_run, RunCache* cache = nullptr);

/// Returns one column as whitened rows.
Eigen::VectorXd whole_column(const Plant& plant, const Whitened& system, const Columns& columns,
                             Eigen::Index unknown);

/// The whitened equations of all segments, linearised around one model.
struct Linearised {
  const Plant* plant = nullptr;
  std::vector<Unknown> unknowns;
  std::vector<Whitened> systems;  ///< of each segment
  std::vector<Columns> columns;   ///< of each segment: d(rows)/d(unknowns)
  /// Ratio of misfit to its expectation under noise, at least 1. The prior is weighted by it, so
  /// that a model that does not fit cannot compensate with masses, gains and clocks.
  double level = 1;
  Eigen::VectorXd prior, pull;  ///< level / (2 sigma^2); that times (center - value)
};

}  // namespace framewatch::estimator
