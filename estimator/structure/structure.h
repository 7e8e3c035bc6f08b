#pragma once

#include <string>
#include <vector>

namespace framewatch::estimator {

/// One broken rule of a description, and which part of the description broke it.
struct Problem {
  std::string field;  ///< configuration key of the part; empty when a part is missing altogether
  int index = -1;     ///< of the sensor axis; -1 for the structure
  std::string message;
};

/// Axis a frame is parallel to, and along which its floors and sensors move.
enum class Direction { x, y };

/// "x" or "y".
inline const char* letter(Direction direction) {
  return direction == Direction::x ? "x" : "y";
}

/// flexible: every floor panel shears in its plane; rigid: a floor moves as one body (diaphragm).
enum class FloorModel { flexible, rigid };

/// The monitored building's static description. SI units.
///
/// Frames at one floor are numbered 0..n-1 for the x-parallel ones (in order of y) and n..n+m-1 for
/// the y-parallel ones (in order of x); each has one horizontal degree of freedom per floor, along
/// its own plane, positive toward +x or +y. Stories are numbered 1..N, floor i on top of story i,
/// floor 0 the ground. Either direction may have no frame: a plane building.
struct Structure {
  std::string name;
  int stories = 0;
  std::vector<std::string> frames_x;
  std::vector<std::string> frames_y;
  std::vector<double> span_x;        ///< m, between y-parallel frames; size m-1
  std::vector<double> span_y;        ///< m, between x-parallel frames; size n-1
  std::vector<double> story_height;  ///< m; size N
  FloorModel floor = FloorModel::flexible;
  /// kg, [story][y line][x line] flattened; a direction without frames counts as one line.
  std::vector<double> node_mass;

  int n() const { return static_cast<int>(frames_x.size()); }
  int m() const { return static_cast<int>(frames_y.size()); }
  int frames() const { return n() + m(); }
  int degrees_of_freedom() const { return stories * frames(); }
  /// Floor panels per floor, (n-1)(m-1); none when rigid or plane.
  int panels() const;
  Direction direction(int frame) const { return frame < n() ? Direction::x : Direction::y; }
  const std::string& frame_name(int frame) const;
  /// Index of the degree of freedom of `frame` at floor `story`: story-major.
  int dof(int story, int frame) const { return (story - 1) * frames() + frame; }
  /// Mass that moves with `frame` at floor `story`, kg: sum over the nodes on it (A13, A14).
  double frame_mass(int story, int frame) const;
  /// Number of node masses the description must hold.
  int nodes() const;
};

/// Whether frames along `direction` are so tall, ten stories, or so slender, three times as high as
/// wide, that they bend as a whole: their columns lengthen and shorten.
bool bends_as_a_whole(const Structure& structure, Direction direction);

/// Every way in which `structure` is not a building; empty when it is one.
std::vector<Problem> find_problems(const Structure& structure);
/// Their messages.
std::vector<std::string> problems(const Structure& structure);

/// x1y1: the y-parallel, then the x-parallel frame; the one frame's name in a plane building.
std::string crossing_name(const Structure& structure, int crossing);
/// Of the crossing where its spans start, as in Gk_2_x1y1.
std::string panel_name(const Structure& structure, int panel);

}  // namespace framewatch::estimator
