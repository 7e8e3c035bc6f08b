#pragma once

#include <vector>

#include "estimator/diagnose/fit/unknowns.h"
#include "estimator/diagnose/fit/whitened.h"

namespace framewatch::estimator {

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

}  // namespace framewatch::estimator
