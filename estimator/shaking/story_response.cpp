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

StoryResponse::StoryResponse(const PipelineConfig& config)
    : structure_(config.structure),
      axes_(config.axes),
      section_(config.options.high_pass_hz, kDamping, config.options.rate_hz),
      over_w2_(std::pow(2 * std::numbers::pi * config.options.high_pass_hz, -2)),
      mean_step_(2 * std::numbers::pi * kMeanShare * config.options.high_pass_hz /
                 config.options.rate_hz),
      settling_(kSettlePeriods * config.options.rate_hz / config.options.high_pass_hz),
      step_s_(1 / config.options.rate_hz),
      motion_of_dof_(static_cast<std::size_t>(structure_.degrees_of_freedom()), -1),
      accel_(axes_.size(), kNaN),
      drift_(motion_of_dof_.size(), kNaN) {
  std::size_t motions = axes_.size();
  if (config.parameters().grouped()) {
    floors_.emplace(config);
    motions += static_cast<std::size_t>(structure_.frames()) + motion_of_dof_.size();
  } else {
    for (std::size_t a = 0; a < axes_.size(); ++a)
      if (axes_[a].story > 0 && axes_[a].frame >= 0)
        motion_of_dof_[static_cast<std::size_t>(structure_.dof(axes_[a].story, axes_[a].frame))] =
            static_cast<int>(a);
  }
  motions_.resize(motions);
  motion_accel_.assign(motions, kNaN);
  moved_.assign(motions, kNaN);
}

void StoryResponse::follow(std::size_t motion, double accel) {
  Motion& m = motions_[motion];
  motion_accel_[motion] = moved_[motion] = kNaN;
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
  motion_accel_[motion] = x;
  if (++m.settled >= settling_) moved_[motion] = s * over_w2_;
}

void StoryResponse::push(const SampleSet& set) {
  const bool interrupted = set.index != next_index_;
  next_index_ = set.index + 1;
  if (interrupted)
    for (std::size_t i = 0; i < motions_.size(); ++i) follow(i, kNaN);
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    follow(a, set.accel[a]);
    accel_[a] = motion_accel_[a];
  }
  if (floors_) follow_floors(set);
  find_story_motion();
}

void StoryResponse::follow_floors(const SampleSet& set) {
  floor_accel_ = floors_->push(set);
  for (Eigen::Index i = 0; i < floor_accel_.size(); ++i)
    follow(axes_.size() + static_cast<std::size_t>(i), floor_accel_[i]);
}

double StoryResponse::floor_accel_mps2(int floor, int frame) const {
  if (!floors_) return at(floor, frame).accel_mps2;
  const Eigen::Index i = floor * structure_.frames() + frame;
  return i < floor_accel_.size() ? floor_accel_[i] : kNaN;
}

void StoryResponse::follow(const WindowEstimate& estimate) {
  if (floors_) floors_->follow(estimate);
}

/// Mean of the base's sensors; NaN: one has no value, or there is none.
StoryResponse::At StoryResponse::base(Direction direction) const {
  At sum{0, 0};
  double count = 0;
  for (std::size_t a = 0; a < axes_.size(); ++a)
    if (axes_[a].story == 0 && axes_[a].horizontal() && axes_[a].direction == direction) {
      sum.accel_mps2 += motion_accel_[a];
      sum.moved_m += moved_[a];
      ++count;
    }
  return count > 0 ? At{sum.accel_mps2 / count, sum.moved_m / count} : At{kNaN, kNaN};
}

StoryResponse::At StoryResponse::at(int level, int frame) const {
  if (floors_) {
    const std::size_t motion =
        axes_.size() + static_cast<std::size_t>(level * structure_.frames() + frame);
    return {motion_accel_[motion], moved_[motion]};
  }
  if (level == 0) return base(structure_.direction(frame));
  const int motion = motion_of_dof_[static_cast<std::size_t>(structure_.dof(level, frame))];
  if (motion < 0) return {kNaN, kNaN};
  return {motion_accel_[static_cast<std::size_t>(motion)],
          moved_[static_cast<std::size_t>(motion)]};
}

void StoryResponse::find_story_motion() {
  base_shear_ = {0, 0};
  for (int f = 0; f < structure_.frames(); ++f) {
    const std::size_t along = structure_.direction(f) == Direction::x ? 0 : 1;
    double below = at(0, f).moved_m;
    for (int story = 1; story <= structure_.stories; ++story) {
      const At floor = at(story, f);
      drift_[static_cast<std::size_t>(structure_.dof(story, f))] = floor.moved_m - below;
      below = floor.moved_m;
      base_shear_[along] -= structure_.frame_mass(story, f) * floor.accel_mps2;
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

bool drift_is_measured(const PipelineConfig& c, int story) {
  const auto has = [&](int floor, Direction along) {
    return floor == 0 || std::any_of(c.axes.begin(), c.axes.end(), [&](const SensorAxis& a) {
             const Direction own = a.frame >= 0 ? c.structure.direction(a.frame) : a.direction;
             return a.horizontal() && !a.check && a.story == floor && own == along;
           });
  };
  for (const Direction along : {Direction::x, Direction::y}) {
    if ((along == Direction::x ? c.structure.n() : c.structure.m()) == 0) continue;
    if (!has(story, along) || !has(story - 1, along)) return false;
  }
  return true;
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
    if (axes[a].story == level && axes[a].horizontal()) raise_peak(most, peak.accel_mps2[a]);
  return most;
}

}  // namespace framewatch::estimator
