#include "estimator/shaking/story_response.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace framewatch::estimator {
namespace {

constexpr double kMeanShare = 0.03;   // corner of the mean, over that of the displacement
constexpr double kSettlePeriods = 2;  // of the corner

/// The larger of two, where the first may be none.
void raise_peak(double& peak, double value) {
  if (std::isfinite(value) && !(std::abs(value) <= peak)) peak = std::abs(value);
}

}  // namespace

StoryResponse::StoryResponse(const PipelineConfig& config)
    : structure_(config.structure),
      axes_(config.axes),
      rate_hz_(config.options.rate_hz),
      section_(config.options.high_pass_hz, kDamping, config.options.rate_hz),
      velocity_gain_(section_.gain /
                     (4 * std::tan(std::numbers::pi * config.options.high_pass_hz / rate_hz_))),
      over_w2_(std::pow(2 * std::numbers::pi * config.options.high_pass_hz, -2)),
      mean_step_(2 * std::numbers::pi * kMeanShare * config.options.high_pass_hz /
                 config.options.rate_hz),
      settling_(kSettlePeriods * config.options.rate_hz / config.options.high_pass_hz),
      step_s_(1 / config.options.rate_hz),
      motion_of_dof_(static_cast<std::size_t>(structure_.degrees_of_freedom()), -1),
      accel_(axes_.size(), kNaN),
      slow_drift_(config),
      slow_floors_(Eigen::VectorXd::Constant(structure_.degrees_of_freedom(), kNaN)),
      drift_(motion_of_dof_.size(), kNaN),
      slow_(motion_of_dof_.size(), kNaN) {
  std::size_t motions = axes_.size();
  if (config.parameters().grouped()) {
    floors_.emplace(config, static_cast<std::int64_t>(settling_) + 1);
    motions += static_cast<std::size_t>(structure_.frames()) + motion_of_dof_.size();
  } else {
    for (std::size_t a = 0; a < axes_.size(); ++a)
      if (axes_[a].story > 0 && axes_[a].frame >= 0)
        motion_of_dof_[static_cast<std::size_t>(structure_.dof(axes_[a].story, axes_[a].frame))] =
            static_cast<int>(a);
  }
  motions_.resize(motions);
  coming_motions_.resize(motions - axes_.size());
  for (const SensorAxis& axis : axes_) late_s_.push_back(std::remainder(axis.delay, 1 / rate_hz_));
  late_s_.resize(motions, 0);
  for (std::vector<double>* of : {&motion_accel_, &moved_, &slow_accel_}) of->assign(motions, kNaN);
}

void StoryResponse::advance(Motion& m, double accel) const {
  if (!std::isfinite(accel)) {
    m.x1 = m.x2 = m.s1 = m.s2 = m.v1 = m.v2 = m.settled = 0;  // the sensor rests where it rested
    return;
  }
  ++m.seen;
  m.mean += std::max(mean_step_, 1 / m.seen) * (accel - m.mean);
  const double x = accel - m.mean;
  // Acceleration that is linear between instants; (1 + z^-1)^2 / 4 would lose 1 % at 4 Hz.
  const double s =
      section_.gain * (x + 4 * m.x1 + m.x2) / 6 - section_.a1 * m.s1 - section_.a2 * m.s2;
  const double v = velocity_gain_ * (x - m.x2) - section_.a1 * m.v1 - section_.a2 * m.v2;
  m.x2 = m.x1;
  m.x1 = x;
  m.s2 = m.s1;
  m.s1 = s;
  m.v2 = m.v1;
  m.v1 = v;
  ++m.settled;
}

void StoryResponse::follow(std::size_t motion, double accel) {
  Motion& m = motions_[motion];
  advance(m, accel);
  motion_accel_[motion] = moved_[motion] = slow_accel_[motion] = kNaN;
  if (!std::isfinite(accel)) return;
  motion_accel_[motion] = m.x1;
  if (m.settled < settling_) return;
  moved_[motion] = m.s1 * over_w2_ + late_s_[motion] * m.v1 * std::sqrt(over_w2_);
  slow_accel_[motion] = m.s1 + 2 * kDamping * m.v1;
}

void StoryResponse::push(const SampleSet& set) {
  interrupted_ = set.index != next_index_;
  next_index_ = set.index + 1;
  if (interrupted_)
    for (std::size_t i = 0; i < motions_.size(); ++i) follow(i, kNaN);
  if (interrupted_)
    for (Motion& motion : coming_motions_) advance(motion, kNaN);
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    follow(a, set.accel[a]);
    accel_[a] = motion_accel_[a];
  }
  if (floors_) follow_floors(set);
  find_story_motion();
}

void StoryResponse::follow_floors(const SampleSet& set) {
  floor_accel_ = floors_->push(set);
  const auto floors = motions_.begin() + static_cast<std::ptrdiff_t>(axes_.size());
  if (floors_->swapped()) std::swap_ranges(floors, motions_.end(), coming_motions_.begin());
  if (floors_->began()) {
    std::copy(floors, motions_.end(), coming_motions_.begin());  // sensors rest where they rested
    for (Motion& motion : coming_motions_) advance(motion, kNaN);
  }
  if (const Eigen::VectorXd* coming = floors_->coming())
    for (Eigen::Index i = 0; i < coming->size(); ++i)
      advance(coming_motions_[static_cast<std::size_t>(i)], (*coming)[i]);
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
  slow_drift_.follow(estimate);
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
    return {motion_accel_[motion], moved_[motion], slow_accel_[motion]};
  }
  if (level == 0) return base(structure_.direction(frame));
  const int motion = motion_of_dof_[static_cast<std::size_t>(structure_.dof(level, frame))];
  if (motion < 0) return {kNaN, kNaN};
  const auto i = static_cast<std::size_t>(motion);
  return {motion_accel_[i], moved_[i], slow_accel_[i]};
}

void StoryResponse::find_story_motion() {
  base_shear_ = {0, 0};
  for (int f = 0; f < structure_.frames(); ++f) {
    const std::size_t along = structure_.direction(f) == Direction::x ? 0 : 1;
    double below = at(0, f).moved_m;
    for (int story = 1; story <= structure_.stories; ++story) {
      const At floor = at(story, f);
      drift_[static_cast<std::size_t>(structure_.dof(story, f))] = floor.moved_m - below;
      slow_floors_[structure_.dof(story, f)] = floor.slow_mps2;
      below = floor.moved_m;
      base_shear_[along] -= structure_.frame_mass(story, f) * floor.accel_mps2;
    }
  }
  if (structure_.n() == 0) base_shear_[0] = kNaN;
  if (structure_.m() == 0) base_shear_[1] = kNaN;
  const Eigen::VectorXd& slow = slow_drift_.push(slow_floors_);
  for (std::size_t dof = 0; dof < drift_.size(); ++dof) {
    slow_[dof] = slow[static_cast<Eigen::Index>(dof)];
    if (std::isfinite(slow_[dof])) drift_[dof] += slow_[dof];
  }
}

/// The largest of a drift one instant ago, between the instants by the parabola through three.
void PeakResponse::take_drift(std::size_t dof, double drift, double slow) {
  double* before = &before_m_[3 * dof];
  double peak = before[1];
  const double curvature = before[0] - 2 * before[1] + drift;
  const bool turns = std::isfinite(curvature) && (before[1] - before[0]) * (drift - before[1]) < 0;
  if (turns) peak -= (drift - before[0]) * (drift - before[0]) / (8 * curvature);
  if (std::isfinite(peak) && !(std::abs(peak) <= drift_m[dof])) {
    drift_m[dof] = std::abs(peak);
    slow_m[dof] = std::copysign(1.0, peak) * before[2];
  }
  before[0] = before[1];
  before[1] = drift;
  before[2] = slow;
}

void PeakResponse::note_unseen(std::size_t dof, const std::vector<double>& accel) {
  for (std::size_t a = 0; a < accel.size(); ++a)
    raise_peak(unseen_mps2[dof * accel.size() + a], accel[a]);
}

void PeakResponse::take(const StoryResponse& response) {
  const double decay = std::exp(-1 / (kLately_s * response.rate_hz()));
  for (std::size_t dof = 0; dof < drift_m.size(); ++dof) {
    if (response.interrupted()) note_unseen(dof, lately_mps2);
    if (!std::isfinite(response.drift_m()[dof])) note_unseen(dof, response.accel_mps2());
    take_drift(dof, response.drift_m()[dof], response.slow_m()[dof]);
  }
  for (std::size_t a = 0; a < accel_mps2.size(); ++a) {
    raise_peak(accel_mps2[a], response.accel_mps2()[a]);
    lately_mps2[a] *= decay;
    raise_peak(lately_mps2[a], response.accel_mps2()[a]);
  }
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
