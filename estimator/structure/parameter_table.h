// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "estimator/structure/story_groups.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// Rotational stiffness of every frame, along x and along y (effect frame_bending).
struct BendingStiffness {
  /// Stiffness at the base, along x and along y, N*m/rad; 0: frames do not bend.
  std::array<double, 2> base_nmprad{};
  /// Stiffness of each floor relative to the base's, base first; empty: all floors are alike.
  std::array<std::vector<double>, 2> shares{};

  /// Returns the stiffness at the base along `direction`, 0 for x and 1 for y, N*m/rad.
  double operator[](std::size_t direction) const { return base_nmprad[direction]; }
  /// Returns true if frames of a direction bend.
  bool any() const { return base_nmprad[0] > 0 || base_nmprad[1] > 0; }
  /// Returns the stiffness at `floor`, N*m/rad. Floors count from 0 (base) to the one below the
  /// roof.
  double of_floor(std::size_t direction, std::size_t floor) const {
    const std::vector<double>& share = shares[direction];
    return base_nmprad[direction] * (share.empty() ? 1 : share[floor]);
  }
};

/// The kind of element and of property that a parameter describes.
enum class ParameterKind {
  frame_stiffness,   ///< of a frame in a story or in a group of stories
  panel_stiffness,   ///< of a floor panel
  frame_damping,     ///< of a frame in a story or in a group of stories
  panel_damping,     ///< of a floor panel
  bending_stiffness  ///< of the frames of one direction
};

/// One entry of the parameter vector theta.
struct Parameter {
  /// kx_1_y2, ky_3_x1, Gk_2_x1y1, cx_1_y2, cy_3_x1, Gc_2_x1y1; for a group of stories kx_6to12, or
  /// kx_6to12_y1 for a single frame; krx, kry.
  std::string name;
  ParameterKind kind;  ///< what the parameter describes
  int story;           ///< 1..N; the lowest story of a group
  int frame;           ///< 0..n+m-1; -1 for a panel or several frames
  int panel;           ///< 0..panels-1, x span fastest; -1 for a frame
  /// N/m, N*s/m; for a panel, shear stiffness per unit length as in docs/equations.md (3):
  /// N/(rad*m), N*s/(rad*m). A group has the stiffness of its stories in series. krx, kry: N*m/rad,
  /// see BendingStiffness.
  std::string unit;
  int last_story = story;              ///< highest story of a group
  std::vector<int> frames = {};        ///< frames that share the parameter; empty for a panel
  Direction direction = Direction::x;  ///< of the frames
};

/// The parameter vector of the paper's equation (13): k_x, k_y, G_k, c_x, c_y, G_c, story-major
/// inside each kind, then in frame order (panels: y span, then x span fastest). For groups of
/// stories: k of each group, c of each group, then the bending stiffnesses.
class ParameterTable {
 public:
  /// Builds the table of a building in which every story is identified.
  explicit ParameterTable(const Structure& structure);
  /// Builds the table of the parameters that a layout identifies. Equals the table above if it
  /// identifies every story.
  ParameterTable(const Structure& structure, const StoryGroups& groups,
                 const BendingStiffness& bending);

  /// Returns the number of parameters.
  int size() const { return static_cast<int>(parameters_.size()); }
  /// Returns the parameter of an index from 0 to size() - 1.
  const Parameter& operator[](int index) const {
    return parameters_[static_cast<std::size_t>(index)];
  }
  /// Returns the number of stiffness entries. Damping entry i belongs to stiffness entry i -
  /// elements().
  int elements() const { return elements_; }
  /// Returns the index of a frame story's stiffness, or of its group's; -1 if no group holds it.
  int frame_stiffness(int story, int frame) const;
  /// Returns the index of a panel's stiffness. The structure must have panels, and every story must
  /// be identified.
  int panel_stiffness(int story, int panel) const;
  /// Returns true if the parameters belong to groups of stories.
  bool grouped() const { return !group_of_.empty(); }
  /// Returns the index of a frame story's damping. A group must hold the frame story.
  int frame_damping(int story, int frame) const {
    return frame_stiffness(story, frame) + elements();
  }
  /// Returns the index of a panel's damping; the preconditions are those of panel_stiffness().
  int panel_damping(int story, int panel) const {
    return panel_stiffness(story, panel) + elements();
  }
  /// Returns the index of a parameter by its name. Returns nullopt if no parameter has it.
  std::optional<int> find(const std::string& name) const;

 private:
  int stories_, n_, m_, panels_, elements_;
  std::vector<Parameter> parameters_;
  std::vector<int> group_of_;  ///< indexed by Structure::dof
};

/// Returns the usual relative error of a design. The estimators' priors have this width.
double design_tolerance(ParameterKind kind);

}  // namespace framewatch::estimator
