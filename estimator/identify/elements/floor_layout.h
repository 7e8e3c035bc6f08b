// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "estimator/structure/matrices.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// The order of the unknowns floor by floor, which makes the normal equations block tridiagonal.
/// The equations of floor i involve [k of its frames, c of its frames, G, G_c] (its own unknowns),
/// then [k, c] of the next story's frames, then the right-hand side. Together they are the floor's
/// front.
///
/// With groups of stories, every equation may hold every unknown, because bending couples the whole
/// building. The layout then has one floor that owns all unknowns.
class FloorLayout {
 public:
  /// axes: needed for a building in groups only, which has at most one equation per axis.
  FloorLayout(const Structure& structure, const ParameterTable& table,
              const std::vector<SensorAxis>& axes = {});

  bool grouped() const { return grouped_; }
  int floors() const { return floors_; }
  int frames() const { return frames_; }
  int panels() const { return panels_; }
  /// Returns the largest number of equations of a floor.
  int most_rows() const { return rows_; }
  /// Returns the number of unknowns of a floor: 2 frames + 2 panels.
  int own() const { return own_; }
  /// Returns how many unknowns of a story the equations of the floor below hold: its first ones.
  int shared() const { return grouped_ ? 0 : 2 * frames_; }
  /// Returns the number of unknowns of the next story in this floor's equations; 0 at the top.
  int next(int floor) const { return floor + 1 < floors_ ? shared() : 0; }
  /// Returns the number of flags of measured places: frames on floors and at the base, or axes in
  /// groups.
  int places() const { return places_; }
  int most_front() const { return own_ + shared() + 1; }
  /// Returns the length of a floor's front: own + next + 1 (right-hand side).
  int front(int floor) const { return own() + next(floor) + 1; }
  int unknowns() const { return floors_ * own(); }
  /// Returns the theta index of unknown `position` (0..own-1) of a floor. Floors count from 0.
  int parameter(int floor, int position) const;
  /// Returns the theta index of unknown 0..unknowns()-1.
  int parameter_of(int unknown) const { return parameter(unknown / own(), unknown % own()); }
  ParameterKind kind(int position) const { return kind_[static_cast<std::size_t>(position)]; }
  /// Returns the entry of b_e at frame f of the floor, docs/equations.md (2) and (3), for the
  /// element e of front unknown `position`.
  double coefficient(int position, int f) const {
    return coefficient_[static_cast<std::size_t>(position * frames_ + f)];
  }

 private:
  bool grouped_;
  int floors_, frames_, panels_, rows_, places_, own_;
  std::vector<int> parameter_;
  std::vector<ParameterKind> kind_;  ///< kinds of a floor's unknowns
  std::vector<double> coefficient_;  ///< (own + 2 frames) x frames
};

}  // namespace framewatch::estimator
