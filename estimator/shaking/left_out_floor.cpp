// SPDX-License-Identifier: MIT
#include "estimator/shaking/left_out_floor.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimator/identify/groups/floor_motion.h"
#include "estimator/identify/groups/reduced_building.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Applies one of the two Butterworth sections of a fourth-order filter, bilinear, forth and back.
void section(VectorXd& v, double corner_hz, double rate_hz, double quality, bool high) {
  const double k = std::tan(std::numbers::pi * corner_hz / rate_hz);
  const double norm = 1 / (1 + k / quality + k * k);
  const double b0 = (high ? 1 : k * k) * norm, b1 = (high ? -2 : 2) * b0;
  const double a1 = 2 * (k * k - 1) * norm, a2 = (1 - k / quality + k * k) * norm;
  const auto pass = [&](double& value, double& s1, double& s2) {
    const double out = b0 * value + s1;
    s1 = b1 * value - a1 * out + s2;
    s2 = b0 * value - a2 * out;
    value = out;
  };
  double s1 = 0, s2 = 0;
  for (Index i = 0; i < v.size(); ++i) pass(v[i], s1, s2);
  s1 = s2 = 0;
  for (Index i = v.size(); i-- > 0;) pass(v[i], s1, s2);
}

VectorXd filtered(VectorXd v, double corner_hz, double rate_hz, bool high) {
  if (high) v.array() -= v.mean();
  for (const double quality : {0.541196100146197, 1.306562964876377})
    section(v, corner_hz, rate_hz, quality, high);
  return v;
}

/// Returns the accelerometers of a floor along a direction. used: without those for a check.
std::vector<Index> axes_of(const PipelineConfig& c, int floor, Direction direction,
                           bool used = false) {
  std::vector<Index> out;
  for (std::size_t a = 0; a < c.axes.size(); ++a)
    if (c.axes[a].story == floor && c.axes[a].horizontal() && !(used && c.axes[a].check) &&
        direction_of(c.structure, c.axes[a]) == direction)
      out.push_back(static_cast<Index>(a));
  return out;
}

/// Returns the mean over the axes, each toward the direction's positive sense.
VectorXd mean_of(const PipelineConfig& c, const MatrixXd& accel, const std::vector<Index>& axes,
                 Direction direction) {
  VectorXd out = VectorXd::Zero(accel.rows());
  for (const Index a : axes) {
    const auto& plan = c.axes[static_cast<std::size_t>(a)].plan;
    const bool turned = plan && (direction == Direction::x ? std::cos(plan->angle_rad)
                                                           : std::sin(plan->angle_rad)) < 0;
    out += (turned ? -1.0 : 1.0) / static_cast<double>(axes.size()) * accel.col(a);
  }
  return out;
}

/// Returns what each axis of the floor would measure, predicted from the other floors.
MatrixXd predicted(const PipelineConfig& c, const VectorXd& theta, const MatrixXd& accel,
                   int floor) {
  std::vector<std::uint8_t> present = identifying(c.axes);
  for (std::size_t a = 0; a < present.size(); ++a)
    if (c.axes[a].story == floor && c.axes[a].horizontal()) present[a] = 0;
  FloorMotion motion(c);
  motion.tune(theta, present);
  MatrixXd weights = MatrixXd::Zero(accel.cols(), c.structure.frames());
  for (std::size_t a = 0; a < c.axes.size(); ++a) {
    if (c.axes[a].story != floor) continue;
    const std::vector<double> of_frames = frame_weights(c.structure, c.axes[a]);
    weights.row(static_cast<Index>(a)) = Eigen::Map<const Eigen::RowVectorXd>(
        of_frames.data(), static_cast<Index>(of_frames.size()));
  }
  MatrixXd out(accel.rows(), accel.cols());
  SampleSet set;
  for (Index i = 0; i < accel.rows(); ++i) {
    set.index = i;
    set.accel.assign(static_cast<std::size_t>(accel.cols()), 0);
    for (Index a = 0; a < accel.cols(); ++a) set.accel[static_cast<std::size_t>(a)] = accel(i, a);
    const VectorXd& frames = motion.push(set);
    out.row(i) =
        (weights * frames.segment(Index(floor) * c.structure.frames(), c.structure.frames()))
            .transpose();
  }
  return out;
}

class Judge {
 public:
  Judge(const PipelineConfig& c, Index first, Index end)
      : rate_(c.options.rate_hz), high_pass_(c.options.high_pass_hz), first_(first), end_(end) {}

  void take(const VectorXd& measured, const VectorXd& by_model, const VectorXd& by_spline,
            LeftOutFloor& out) const {
    if (!measured.allFinite()) return;
    const auto both = [&](const VectorXd& other, double& all, double& low) {
      if (!other.allFinite()) return;
      const VectorXd motion = filtered(measured, high_pass_, rate_, true);
      const VectorXd error = filtered(measured - other, high_pass_, rate_, true);
      all = ratio(error, motion);
      low = ratio(filtered(error, kLeftOutLow_hz, rate_, false),
                  filtered(motion, kLeftOutLow_hz, rate_, false));
    };
    both(by_model, out.error, out.low_error);
    both(by_spline, out.spline, out.low_spline);
  }

 private:
  double ratio(const VectorXd& error, const VectorXd& motion) const {
    const double moves = motion.segment(first_, end_ - first_).norm();
    return moves > 0 ? error.segment(first_, end_ - first_).norm() / moves : kNaN;
  }

  double rate_, high_pass_;
  Index first_, end_;
};

}  // namespace

VectorXd spline_weights(const std::vector<double>& x, double at) {
  const auto n = static_cast<Index>(x.size());
  VectorXd out = VectorXd::Zero(n);
  if (n == 1) out[0] = 1;
  if (n < 2) return out;
  Index i = 0;
  while (i + 2 < n && x[static_cast<std::size_t>(i + 1)] <= at) ++i;
  const auto h = [&](Index k) {
    return x[static_cast<std::size_t>(k + 1)] - x[static_cast<std::size_t>(k)];
  };
  // Second derivatives m = system^-1 right values, zero at the ends.
  MatrixXd system = MatrixXd::Identity(n, n), right = MatrixXd::Zero(n, n);
  for (Index k = 1; k + 1 < n; ++k) {
    system(k, k - 1) = h(k - 1) / 6;
    system(k, k) = (h(k - 1) + h(k)) / 3;
    system(k, k + 1) = h(k) / 6;
    right(k, k - 1) = 1 / h(k - 1);
    right(k, k) = -1 / h(k - 1) - 1 / h(k);
    right(k, k + 1) = 1 / h(k);
  }
  const MatrixXd second = solve_lu(system, right);
  const double width = h(i), b = (at - x[static_cast<std::size_t>(i)]) / width, a = 1 - b;
  out[i] += a;
  out[i + 1] += b;
  out += (width * width / 6) *
         ((a * a * a - a) * second.row(i) + (b * b * b - b) * second.row(i + 1)).transpose();
  return out;
}

std::vector<LeftOutFloor> leave_floors_out(const PipelineConfig& c, const VectorXd& theta,
                                           const MatrixXd& accel, Index first, Index end) {
  std::vector<LeftOutFloor> out;
  const Judge judge(c, first, end);
  std::vector<double> height{0};
  for (const double story : c.structure.story_height) height.push_back(height.back() + story);
  std::vector<MatrixXd> model(static_cast<std::size_t>(c.structure.stories) + 1);
  for (const Direction direction : {Direction::x, Direction::y}) {
    std::vector<int> floors;  // including the base
    for (int floor = 0; floor <= c.structure.stories; ++floor)
      if (!axes_of(c, floor, direction).empty()) floors.push_back(floor);
    for (std::size_t i = 1; i + 1 < floors.size(); ++i) {
      const int floor = floors[i];
      const auto at = static_cast<std::size_t>(floor);
      if (model[at].size() == 0) model[at] = predicted(c, theta, accel, floor);
      std::vector<double> places;
      std::vector<VectorXd> values;
      for (const int other : floors) {
        const std::vector<Index> used = axes_of(c, other, direction, true);
        if (other == floor || used.empty()) continue;
        places.push_back(height[static_cast<std::size_t>(other)]);
        values.push_back(mean_of(c, accel, used, direction));
      }
      const VectorXd weights = spline_weights(places, height[at]);
      VectorXd spline = VectorXd::Zero(accel.rows());
      for (std::size_t k = 0; k < values.size(); ++k)
        spline += weights[static_cast<Index>(k)] * values[k];
      LeftOutFloor one{floor, direction};
      const std::vector<Index> axes = axes_of(c, floor, direction);
      judge.take(mean_of(c, accel, axes, direction), mean_of(c, model[at], axes, direction), spline,
                 one);
      out.push_back(one);
    }
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const LeftOutFloor& a, const LeftOutFloor& b) { return a.floor < b.floor; });
  return out;
}

}  // namespace framewatch::estimator
