#include "estimator/simulate/rotations.h"

#include <algorithm>
#include <vector>

#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

/// How much each rotation turns each frame story: stories' heights where it lies below.
struct Kinematics {
  std::vector<std::size_t> frames;  ///< elements of model.linear
  Eigen::MatrixXd height;           ///< frame stories x rotations, m
  Eigen::VectorXd spring;           ///< of the rotations, N*m/rad
};

Kinematics kinematics(const Structure& s, const ParameterTable& table, Direction direction,
                      double base_stiffness, double floor_stiffness) {
  Kinematics out;
  const int first = direction == Direction::x ? 0 : s.n();
  const int count = direction == Direction::x ? s.n() : s.m();
  const int base = base_stiffness > 0 ? 1 : 0;
  const int hinges = floor_stiffness > 0 ? s.stories : 0;
  out.height = Eigen::MatrixXd::Zero(count * s.stories, base + count * hinges);
  out.spring = Eigen::VectorXd::Constant(out.height.cols(), floor_stiffness);
  if (base) out.spring[0] = base_stiffness;
  for (int f = 0; f < count; ++f) {
    for (int story = 1; story <= s.stories; ++story) {
      const double h = s.story_height[static_cast<std::size_t>(story - 1)];
      const auto row = static_cast<Eigen::Index>(out.frames.size());
      if (base) out.height(row, 0) = h;
      for (int floor = 0; floor < std::min(story, hinges); ++floor)
        out.height(row, base + f * hinges + floor) = h;
      out.frames.push_back(static_cast<std::size_t>(table.frame_stiffness(story, first + f)));
    }
  }
  return out;
}

}  // namespace

void add_rotations(const Structure& s, const ParameterTable& table, Direction direction,
                   double base_stiffness, double floor_stiffness, LinearModel& model) {
  const Kinematics k = kinematics(s, table, direction, base_stiffness, floor_stiffness);
  const auto rows = static_cast<Eigen::Index>(k.frames.size());
  Eigen::MatrixXd drift(rows, model.mass.size());
  Eigen::VectorXd stiffness(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const LinearElement& frame = model.linear[k.frames[static_cast<std::size_t>(i)]];
    drift.row(i) = frame.b.transpose();
    stiffness[i] = frame.stiffness;
  }
  const Eigen::MatrixXd moment_arm = k.height.transpose() * stiffness.asDiagonal();
  Eigen::MatrixXd rotational = moment_arm * k.height;
  rotational.diagonal() += k.spring;
  const Eigen::MatrixXd rotation = Ldlt(rotational).solve(Eigen::MatrixXd(moment_arm * drift));
  const Eigen::MatrixXd deformation = drift - k.height * rotation;
  for (Eigen::Index i = 0; i < rows; ++i)
    model.linear[k.frames[static_cast<std::size_t>(i)]].b = deformation.row(i).transpose();
  for (Eigen::Index r = 0; r < rotation.rows(); ++r)
    model.linear.push_back({rotation.row(r).transpose(), k.spring[r], 0});
}

}  // namespace framewatch::estimator
