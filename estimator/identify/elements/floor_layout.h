#pragma once

#include <vector>

#include "estimator/structure/matrices.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// Order of the unknowns floor by floor, which makes the normal equations block tridiagonal.
/// The equations of floor i involve [k of its frames, c of its frames, G, G_c] (its own unknowns),
/// then [k, c] of the next story's frames, then the right-hand side: together the floor's front.
class FloorLayout {
 public:
  FloorLayout(const Structure& structure, const ParameterTable& table);

  int floors() const { return floors_; }
  int frames() const { return frames_; }
  int panels() const { return panels_; }
  /// Unknowns that belong to a floor: 2 frames + 2 panels.
  int own() const { return 2 * frames_ + 2 * panels_; }
  /// Unknowns of the next story in this floor's equations; 0 at the top.
  int next(int floor) const { return floor + 1 < floors_ ? 2 * frames_ : 0; }
  /// own + next + 1 (right-hand side).
  int front(int floor) const { return own() + next(floor) + 1; }
  int unknowns() const { return floors_ * own(); }
  /// theta index of unknown `position` (0..own-1) of a floor; floors count from 0.
  int parameter(int floor, int position) const;
  /// Entry at frame f of the floor of b_e, docs/equations.md (2) and (3); e: the element of front
  /// unknown `position`.
  double coefficient(int position, int f) const {
    return coefficient_[static_cast<std::size_t>(position * frames_ + f)];
  }

 private:
  int floors_, frames_, panels_;
  std::vector<int> parameter_;
  std::vector<double> coefficient_;  ///< (own + 2 frames) x frames
};

}  // namespace framewatch::estimator
