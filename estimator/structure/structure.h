// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace framewatch::estimator {

/// One broken rule of a description and the part that breaks it.
struct Problem {
  std::string field;    ///< configuration key of the part; empty if a part is missing
  int index = -1;       ///< of the sensor axis; -1 for the structure
  std::string message;  ///< the rule, for people
};

/// The direction that a frame is parallel to, and along which its floors and sensors move.
enum class Direction {
  x,  ///< along the x-parallel frames
  y   ///< along the y-parallel frames
};

/// Returns "x" or "y".
inline const char* letter(Direction direction) {
  return direction == Direction::x ? "x" : "y";
}

/// The motion of a floor in its plane.
enum class FloorModel {
  flexible,  ///< every floor panel shears
  rigid      ///< the floor moves as one body (diaphragm)
};

/// The monitored building's static description. SI units.
///
/// The frames of a floor are numbered 0..n-1 for the x-parallel ones (in order of y) and n..n+m-1
/// for the y-parallel ones (in order of x). Each has one horizontal degree of freedom per floor,
/// along its plane, positive toward +x or +y. Stories are numbered 1..N; floor i is on top of story
/// i, floor 0 is the ground. In a plane building, one direction has no frame.
struct Structure {
  std::string name;                         ///< of the building, for people
  int stories = 0;                          ///< N
  std::vector<std::string> frames_x;        ///< names of the x-parallel frames; size n
  std::vector<std::string> frames_y;        ///< names of the y-parallel frames; size m
  std::vector<std::string> labels_x;        ///< what people call frames_x; empty or size n
  std::vector<std::string> labels_y;        ///< what people call frames_y; empty or size m
  std::vector<double> span_x;               ///< m, between y-parallel frames; size m-1
  std::vector<double> span_y;               ///< m, between x-parallel frames; size n-1
  std::vector<double> story_height;         ///< m; size N
  FloorModel floor = FloorModel::flexible;  ///< of every floor
  /// kg, [story][y line][x line] flattened; a direction without frames counts as one line.
  std::vector<double> node_mass;

  /// Returns the number of x-parallel frames.
  int n() const { return static_cast<int>(frames_x.size()); }
  /// Returns the number of y-parallel frames.
  int m() const { return static_cast<int>(frames_y.size()); }
  /// Returns the number of frames.
  int frames() const { return n() + m(); }
  /// Returns the number of horizontal degrees of freedom.
  int degrees_of_freedom() const { return stories * frames(); }
  /// Returns the number of panels per floor, (n-1)(m-1), or 0 if floors are rigid or the building
  /// is plane.
  int panels() const;
  /// Returns the direction that a frame is parallel to.
  Direction direction(int frame) const { return frame < n() ? Direction::x : Direction::y; }
  /// Returns the name of a frame.
  const std::string& frame_name(int frame) const;
  /// Returns the index of the degree of freedom of `frame` at floor `story`, story-major.
  int dof(int story, int frame) const { return (story - 1) * frames() + frame; }
  /// Returns the mass that moves with `frame` at floor `story`, kg: the sum over the nodes on it
  /// (A13, A14).
  double frame_mass(int story, int frame) const;
  /// Returns the number of node masses that the description needs.
  int nodes() const;
};

/// Returns true if frames along `direction` bend as a whole because their columns lengthen and
/// shorten: from ten stories on, or if the building is more than three times as high as wide.
bool bends_as_a_whole(const Structure& structure, Direction direction);

/// Returns every way in which `structure` is not a building; empty if it is one.
std::vector<Problem> find_problems(const Structure& structure);
/// Returns the messages of find_problems().
std::vector<std::string> problems(const Structure& structure);

/// Returns the name of a crossing: x1y1, the y-parallel frame, then the x-parallel one. In a plane
/// building it is the name of the one frame.
std::string crossing_name(const Structure& structure, int crossing);
/// Returns the name of a panel: that of the crossing where its spans start, as in Gk_2_x1y1.
std::string panel_name(const Structure& structure, int panel);

}  // namespace framewatch::estimator
