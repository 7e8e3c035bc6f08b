#pragma once

#include <vector>

#include "estimator/structure/matrices.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// Order of the unknowns floor by floor, which makes the normal equations block tridiagonal.
/// The equations of floor i involve [k of its frames, c of its frames, G, G_c] (its own unknowns),
/// then [k, c] of the next story's frames, then the right-hand side: together the floor's front.
///
/// Of groups of stories all equations may hold all unknowns (bending couples the whole building):
/// they are those of one floor, with every unknown its own.
class FloorLayout {
 public:
  /// axes: asked of a building of groups alone, whose equations are at most as many.
  FloorLayout(const Structure& structure, const ParameterTable& table,
              const std::vector<SensorAxis>& axes = {});

  bool grouped() const { return grouped_; }
  int floors() const { return floors_; }
  int frames() const { return frames_; }
  int panels() const { return panels_; }
  /// Most equations of a floor.
  int most_rows() const { return rows_; }
  /// Unknowns that belong to a floor: 2 frames + 2 panels.
  int own() const { return own_; }
  /// Unknowns of a story that the floor below knows: its first ones.
  int shared() const { return grouped_ ? 0 : 2 * frames_; }
  /// Unknowns of the next story in this floor's equations; 0 at the top.
  int next(int floor) const { return floor + 1 < floors_ ? shared() : 0; }
  /// Flags of what is measured: of frames on floors and at the base, or of a group's axes.
  int places() const { return places_; }
  int most_front() const { return own_ + shared() + 1; }
  /// own + next + 1 (right-hand side).
  int front(int floor) const { return own() + next(floor) + 1; }
  int unknowns() const { return floors_ * own(); }
  /// theta index of unknown `position` (0..own-1) of a floor; floors count from 0.
  int parameter(int floor, int position) const;
  ParameterKind kind(int position) const { return kind_[static_cast<std::size_t>(position)]; }
  /// Entry at frame f of the floor of b_e, docs/equations.md (2) and (3); e: the element of front
  /// unknown `position`.
  double coefficient(int position, int f) const {
    return coefficient_[static_cast<std::size_t>(position * frames_ + f)];
  }

 private:
  bool grouped_;
  int floors_, frames_, panels_, rows_, places_, own_;
  std::vector<int> parameter_;
  std::vector<ParameterKind> kind_;  ///< of a floor's own unknowns
  std::vector<double> coefficient_;  ///< (own + 2 frames) x frames
};

}  // namespace framewatch::estimator
