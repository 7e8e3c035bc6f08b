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

/// Rotational stiffness of every frame along x and along y where it stands on its base, N*m/rad;
/// 0: frames do not bend. shares: that of its floors, base first, relative to the base's; empty: of
/// every floor alike (effect frame_bending).
struct BendingStiffness {
  std::array<double, 2> base_nmprad{};
  std::array<std::vector<double>, 2> shares{};

  double operator[](std::size_t direction) const { return base_nmprad[direction]; }
  bool any() const { return base_nmprad[0] > 0 || base_nmprad[1] > 0; }
  /// floor: 0 (base) to the one below the roof.
  double of_floor(std::size_t direction, std::size_t floor) const {
    const std::vector<double>& share = shares[direction];
    return base_nmprad[direction] * (share.empty() ? 1 : share[floor]);
  }
};

enum class ParameterKind {
  frame_stiffness,
  panel_stiffness,
  frame_damping,
  panel_damping,
  bending_stiffness
};

/// One entry of the parameter vector theta.
struct Parameter {
  /// kx_1_y2, ky_3_x1, Gk_2_x1y1, cx_1_y2, cy_3_x1, Gc_2_x1y1; of a group of stories kx_6to12,
  /// or kx_6to12_y1 of one frame; krx, kry.
  std::string name;
  ParameterKind kind;
  int story;  ///< 1..N; of a group the lowest
  int frame;  ///< 0..n+m-1; -1 for a panel and where it is of several frames
  int panel;  ///< 0..panels-1, x span fastest; -1 for a frame
  /// N/m, N*s/m; panel shear stiffness per unit length as in docs/equations.md (3): N/(rad*m),
  /// N*s/(rad*m). A group's is that of its stories in series. krx, kry: N*m/rad, see
  /// BendingStiffness.
  std::string unit;
  int last_story = story;        ///< above `story` in a group
  std::vector<int> frames = {};  ///< those it is of, none of a panel
  Direction direction = Direction::x;
};

/// The parameter vector of the paper's equation (13): k_x, k_y, G_k, c_x, c_y, G_c, story-major
/// inside each group, then frame order (panels: y span, then x span fastest). Of groups of stories:
/// k and c of each group, in their order, then the bending stiffnesses.
class ParameterTable {
 public:
  explicit ParameterTable(const Structure& structure);
  /// What a layout shows; the same as the first where it shows every story.
  ParameterTable(const Structure& structure, const StoryGroups& groups,
                 const BendingStiffness& bending);

  int size() const { return static_cast<int>(parameters_.size()); }
  const Parameter& operator[](int index) const {
    return parameters_[static_cast<std::size_t>(index)];
  }
  /// Number of stiffness entries; damping entry i is the partner of stiffness entry i - elements().
  int elements() const { return elements_; }
  /// That of the group that the frame's story belongs to, or -1 where no group has it.
  int frame_stiffness(int story, int frame) const;
  /// Precondition: the structure has panels, and every story is identified.
  int panel_stiffness(int story, int panel) const;
  /// Parameters are those of groups of stories.
  bool grouped() const { return !group_of_.empty(); }
  int frame_damping(int story, int frame) const {
    return frame_stiffness(story, frame) + elements();
  }
  int panel_damping(int story, int panel) const {
    return panel_stiffness(story, panel) + elements();
  }
  std::optional<int> find(const std::string& name) const;

 private:
  int stories_, n_, m_, panels_, elements_;
  std::vector<Parameter> parameters_;
  std::vector<int> group_of_;  ///< by Structure::dof
};

/// How far a design may usually be off, relative: also the width of the estimators' priors.
double design_tolerance(ParameterKind kind);

}  // namespace framewatch::estimator
