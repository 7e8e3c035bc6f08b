#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "estimator/structure/structure.h"

namespace framewatch::estimator {

enum class ParameterKind { frame_stiffness, panel_stiffness, frame_damping, panel_damping };

/// One entry of the parameter vector theta.
struct Parameter {
  std::string name;  ///< kx_1_y2, ky_3_x1, Gk_2_x1y1, cx_1_y2, cy_3_x1, Gc_2_x1y1
  ParameterKind kind;
  int story;  ///< 1..N
  int frame;  ///< 0..n+m-1; -1 for a panel
  int panel;  ///< 0..panels-1, x span fastest; -1 for a frame
  /// N/m, N*s/m; panel shear stiffness per unit length as in docs/equations.md (3): N/(rad*m),
  /// N*s/(rad*m).
  std::string unit;
};

/// The parameter vector of the paper's equation (13): k_x, k_y, G_k, c_x, c_y, G_c, story-major
/// inside each group, then frame order (panels: y span, then x span fastest).
class ParameterTable {
 public:
  explicit ParameterTable(const Structure& structure);

  int size() const { return static_cast<int>(parameters_.size()); }
  const Parameter& operator[](int index) const {
    return parameters_[static_cast<std::size_t>(index)];
  }
  /// Number of stiffness entries; damping entry i is the partner of stiffness entry i - elements().
  int elements() const { return size() / 2; }
  int frame_stiffness(int story, int frame) const;
  int panel_stiffness(int story, int panel) const;
  int frame_damping(int story, int frame) const {
    return frame_stiffness(story, frame) + elements();
  }
  int panel_damping(int story, int panel) const {
    return panel_stiffness(story, panel) + elements();
  }
  std::optional<int> find(const std::string& name) const;

 private:
  int stories_, n_, m_, panels_;
  std::vector<Parameter> parameters_;
};

/// How far a design may usually be off, relative: also the width of the estimators' priors.
double design_tolerance(ParameterKind kind);

}  // namespace framewatch::estimator
