#include "estimator/shaking/story_response.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace framewatch::estimator {
namespace {

constexpr double kDamping = 0.7;
constexpr double kMeanShare = 0.1;    // corner of the mean, over that of the displacement
constexpr double kSettlePeriods = 2;  // of the corner

/// The larger of two, where the first may be none.
void raise_peak(double& peak, double value) {
  if (std::isfinite(value) && !(std::abs(value) <= peak)) peak = std::abs(value);
}

}  // namespace

StoryResponse::StoryResponse(const Structure& structure, const std::vector<SensorAxis>& axes,
                             const EstimatorOptions& estimation)
    : structure_(structure),
      axes_(axes),
      section_(estimation.high_pass_hz, kDamping, estimation.rate_hz),
      over_w2_(std::pow(2 * std::numbers::pi * estimation.high_pass_hz, -2)),
      mean_step_(2 * std::numbers::pi * kMeanShare * estimation.high_pass_hz / estimation.rate_hz),
      settling_(kSettlePeriods * estimation.rate_hz / estimation.high_pass_hz),
      axis_of_dof_(static_cast<std::size_t>(structure.degrees_of_freedom()), -1),
      motions_(axes.size()),
      accel_(axes.size(), kNaN),
      moved_(axes.size(), kNaN),
      drift_(axis_of_dof_.size(), kNaN) {
  for (std::size_t a = 0; a < axes.size(); ++a)
    if (axes[a].story > 0 && axes[a].frame >= 0)
      axis_of_dof_[static_cast<std::size_t>(structure.dof(axes[a].story, axes[a].frame))] =
          static_cast<int>(a);
}

void StoryResponse::follow(std::size_t axis, double accel) {
  Motion& m = motions_[axis];
  accel_[axis] = moved_[axis] = kNaN;
  if (!std::isfinite(accel)) {
    m.x1 = m.x2 = m.s1 = m.s2 = m.settled = 0;  // the sensor rests where it rested
    return;
  }
  ++m.seen;
  m.mean += std::max(mean_step_, 1 / m.seen) * (accel - m.mean);
  const double x = accel - m.mean;
  const double s =
      section_.gain * (x + 2 * m.x1 + m.x2) / 4 - section_.a1 * m.s1 - section_.a2 * m.s2;
  m.x2 = m.x1;
  m.x1 = x;
  m.s2 = m.s1;
  m.s1 = s;
  accel_[axis] = x;
  if (++m.settled >= settling_) moved_[axis] = s * over_w2_;
}

void StoryResponse::push(const SampleSet& set) {
  const bool interrupted = set.index != next_index_;
  next_index_ = set.index + 1;
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    if (interrupted) follow(a, kNaN);
    follow(a, set.accel[a]);
  }
  find_story_motion();
}

/// Mean of the base's sensors; NaN: one is not settled, or there is none.
double StoryResponse::base_displacement(Direction direction) const {
  double sum = 0, count = 0;
  for (std::size_t a = 0; a < axes_.size(); ++a)
    if (axes_[a].story == 0 && axes_[a].direction == direction) {
      sum += moved_[a];
      ++count;
    }
  return count > 0 ? sum / count : kNaN;
}

void StoryResponse::find_story_motion() {
  const std::array base = {base_displacement(Direction::x), base_displacement(Direction::y)};
  base_shear_ = {0, 0};
  for (int f = 0; f < structure_.frames(); ++f) {
    const std::size_t along = structure_.direction(f) == Direction::x ? 0 : 1;
    double below = base[along];
    for (int story = 1; story <= structure_.stories; ++story) {
      const auto dof = static_cast<std::size_t>(structure_.dof(story, f));
      const int axis = axis_of_dof_[dof];
      const double at = axis < 0 ? kNaN : moved_[static_cast<std::size_t>(axis)];
      const double accel = axis < 0 ? kNaN : accel_[static_cast<std::size_t>(axis)];
      drift_[dof] = at - below;
      below = at;
      base_shear_[along] -= structure_.frame_mass(story, f) * accel;
    }
  }
  if (structure_.n() == 0) base_shear_[0] = kNaN;
  if (structure_.m() == 0) base_shear_[1] = kNaN;
}

void PeakResponse::take(const StoryResponse& response) {
  for (std::size_t a = 0; a < accel_mps2.size(); ++a)
    raise_peak(accel_mps2[a], response.accel_mps2()[a]);
  for (std::size_t dof = 0; dof < drift_m.size(); ++dof)
    raise_peak(drift_m[dof], response.drift_m()[dof]);
  for (std::size_t d = 0; d < 2; ++d) raise_peak(base_shear_n[d], response.base_shear_n()[d]);
}

PeakDrift peak_drift(const PeakResponse& peak, const Structure& structure, int story) {
  PeakDrift out;
  for (int f = 0; f < structure.frames(); ++f) {
    const double ratio = peak.drift_m[static_cast<std::size_t>(structure.dof(story, f))] /
                         structure.story_height[static_cast<std::size_t>(story - 1)];
    if (std::isfinite(ratio) && !(ratio <= out.ratio)) out = {ratio, f};
  }
  return out;
}

double largest_drift_ratio(const PeakResponse& peak, const Structure& structure) {
  double most = 0;
  for (int story = 1; story <= structure.stories; ++story)
    if (const double ratio = peak_drift(peak, structure, story).ratio; ratio > most) most = ratio;
  return most;
}

double peak_accel_mps2(const PeakResponse& peak, const std::vector<SensorAxis>& axes, int level) {
  double most = kNaN;
  for (std::size_t a = 0; a < axes.size(); ++a)
    if (axes[a].story == level) raise_peak(most, peak.accel_mps2[a]);
  return most;
}

}  // namespace framewatch::estimator
