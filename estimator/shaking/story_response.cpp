// SPDX-License-Identifier: MIT
#include "estimator/shaking/story_response.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "estimator/identify/elements/story_design.h"
#include "estimator/identify/groups/reduced_building.h"
#include "estimator/numeric/nan.h"
#include "estimator/numeric/quantile.h"
#include "estimator/numeric/solve.h"
#include "estimator/structure/matrices.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kMisfitMemory_s = 60;  // longer than the quiet time that ends a strong motion

/// Turns displacements of floors into drifts of stories, in place.
void subtract_floors_below(const Structure& s, MatrixXd& rows) {
  for (int story = s.stories; story > 1; --story)
    rows.middleRows(s.dof(story, 0), s.frames()) -=
        rows.middleRows(s.dof(story - 1, 0), s.frames());
}

/// Returns -motion K^-1 motion' M. motion: of the frames by the coordinates of `stiffness`.
MatrixXd flexibility(const Structure& s, const MatrixXd& motion, const MatrixXd& stiffness) {
  const MatrixXd forces = -(motion.transpose() * frame_masses(s).asDiagonal());
  MatrixXd out = motion * Ldlt(stiffness).solve(forces);
  subtract_floors_below(s, out);
  return out;
}

MatrixXd flexibility_of_groups(const PipelineConfig& c, const ParameterTable& table,
                               const GroupDesign& design, const VectorXd& factor) {
  const ReducedBuilding b =
      reduced_building(c.structure, c.axes, table, design, identifying(c.axes), true);
  if (b.rows() == 0) return {};
  MatrixXd stiffness = b.constant_stiffness;
  for (std::size_t p = 0; p < b.parts.size(); ++p)
    if (b.damping[p] == 0 && b.parts[p].size() > 0) stiffness += factor[b.same_as[p]] * b.parts[p];
  const Index free = b.size() - b.inputs;
  return flexibility(c.structure,
                     b.frames.bottomRows(c.structure.degrees_of_freedom()).rightCols(free),
                     stiffness.bottomRightCorner(free, free));
}

VectorXd as_vector(const std::vector<double>& values) {
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size()));
}

constexpr double kMeanShare = 0.03;   // corner of the mean, over that of the displacement
constexpr double kSettlePeriods = 2;  // of the corner

}  // namespace

SlowDrift::SlowDrift(const PipelineConfig& config)
    : config_(config),
      table_(config.parameters()),
      design_(story_design(config)),
      designed_(table_.grouped() ? group_parameters(config.structure, table_, design_)
                                 : design_.theta),
      driven_(has_force(config.axes)),
      theta_(designed_.begin(), designed_.end()),
      std_error_(theta_.size(), kNaN),
      identified_(theta_.size(), 0),
      static_before_(VectorXd::Zero(config.structure.degrees_of_freedom())),
      drift_(VectorXd::Constant(config.structure.degrees_of_freedom(), kNaN)) {}

void SlowDrift::follow_misfit(const WindowEstimate& e) {
  double strength = 0;
  for (const double amplitude : e.amplitude)
    if (std::isfinite(amplitude)) strength += amplitude * amplitude;
  const double passed_s = seconds_of(e.end - newest_);
  newest_ = e.end;
  strongest_m2_ *= std::exp(-std::max(0.0, passed_s) / kMisfitMemory_s);
  if (!std::isfinite(e.residual_ratio) || strength < strongest_m2_) return;
  strongest_m2_ = strength;
  misfit_ = std::abs(e.residual_ratio);
}

void SlowDrift::follow(const WindowEstimate& e) {
  if (e.window != 0 || e.status != WindowStatus::valid || e.value.size() != theta_.size()) return;
  follow_misfit(e);
  for (std::size_t p = 0; p < theta_.size(); ++p) {
    if (e.reason[p] != Observability::observable || !(e.value[p] > 0)) continue;
    theta_[p] = e.value[p];
    std_error_[p] = p < e.std_error.size() ? e.std_error[p] / e.value[p] : kNaN;
    identified_[p] = 1;
  }
  bool far = formed_.size() == 0;
  for (Index p = 0; p < formed_.size(); ++p) {
    const bool damping = p >= table_.elements() && p < 2 * table_.elements();
    const double now = theta_[static_cast<std::size_t>(p)];
    far = far || (!damping && std::abs(now - formed_[p]) > kFar * std::abs(formed_[p]));
  }
  if (far) form();
}

double SlowDrift::damping_lag_s() const {
  std::vector<double> ratios;
  for (int p = 0; p < table_.elements(); ++p) {
    const auto k = static_cast<std::size_t>(p), c = static_cast<std::size_t>(p + table_.elements());
    if (table_[p].kind == ParameterKind::frame_stiffness && identified_[c] != 0)
      ratios.push_back(theta_[c] / theta_[k]);
  }
  return upper_median(ratios, 0);
}

void SlowDrift::form() {
  formed_.resize(0);
  flexibility_.resize(0, 0);
  if (driven_) return;
  for (int p = 0; p < table_.elements(); ++p)
    if (table_[p].kind == ParameterKind::frame_stiffness &&
        identified_[static_cast<std::size_t>(p)] == 0)
      return;
  const Structure& s = config_.structure;
  const VectorXd theta = as_vector(theta_);
  if (table_.grouped()) {
    flexibility_ = flexibility_of_groups(config_, table_, design_, theta.cwiseQuotient(designed_));
  } else {
    const MatrixXd motion = floor_constraint(s);
    flexibility_ =
        flexibility(s, motion, motion.transpose() * assemble(s, table_, theta).stiffness * motion);
  }
  if (!flexibility_.allFinite()) flexibility_.resize(0, 0);
  lag_ = 2 * damping_lag_s() * config_.options.rate_hz;
  formed_ = theta;
}

const VectorXd& SlowDrift::push(const VectorXd& slow_accel) {
  if (!known() || !slow_accel.allFinite()) {
    static_before_.setZero();
    drift_.setConstant(static_before_.size(), kNaN);
    return drift_;
  }
  const VectorXd now = flexibility_ * slow_accel;
  if (!drift_.allFinite()) {
    drift_ = now;
  } else {
    // Damping carries its share of the force: drift + lag d(drift)/dt = now, trapezoidal.
    drift_ = (now + static_before_ + (lag_ - 1) * drift_) / (lag_ + 1);
  }
  static_before_ = now;
  return drift_;
}

DriftKnowledge SlowDrift::knowledge() const {
  DriftKnowledge out;
  out.theta = theta_;
  out.std_error = std_error_;
  for (std::size_t p = 0; p < theta_.size(); ++p)
    if (identified_[p] == 0) out.theta[p] = kNaN;
  out.misfit = misfit_;
  return out;
}

EveryFloor::EveryFloor(const PipelineConfig& config, std::int64_t settling)
    : motion_(config),
      coming_(motion_),
      settling_(settling),
      elements_(static_cast<std::size_t>(config.parameters().elements())),
      used_(identifying(config.axes)),
      away_rows_(kAway_s * config.options.rate_hz),
      away_(config.axes.size(), 0) {}

/// Updates the channels that have values. Returns true when one disappeared or returned.
bool EveryFloor::follow_channels(const SampleSet& set) {
  bool changed = false;
  std::vector<std::uint8_t> present = motion_.present();
  for (std::size_t a = 0; a < away_.size(); ++a) {
    away_[a] = std::isfinite(set.accel[a]) ? 0 : std::min(away_[a] + 1, away_rows_);
    const std::uint8_t is =
        used_[a] == 0 ? 0 : away_[a] == 0 || (present[a] != 0 && away_[a] < away_rows_);
    changed = changed || is != present[a];
    present[a] = is;
  }
  if (!changed) return false;
  motion_.tune(Eigen::VectorXd(coming_in_ > 0 ? coming_.theta() : motion_.theta()), present);
  coming_in_ = 0;
  return true;
}

void EveryFloor::push_coming(const SampleSet& set) {
  began_ = coming_in_ == coming_unsettled_ + settling_;
  swapped_ = coming_in_ == 1;
  if (swapped_) std::swap(motion_, coming_);
  if (--coming_in_ == 0) return;
  coming_accel_ = coming_.push(set);
  if (coming_unsettled_ == 0) return;
  --coming_unsettled_;
  coming_accel_.setConstant(coming_accel_.size(), kNaN);
}

const Eigen::VectorXd& EveryFloor::push(const SampleSet& set) {
  began_ = swapped_ = false;
  if (follow_channels(set)) unsettled_ = motion_.settle_rows();
  if (coming_in_ > 0) push_coming(set);
  const Eigen::VectorXd& accel = motion_.push(set);
  if (unsettled_ == 0) return accel;
  --unsettled_;
  unknown_.setConstant(accel.size(), kNaN);
  return unknown_;
}

void EveryFloor::follow(const WindowEstimate& e) {
  if (e.window != 0 || e.status != WindowStatus::valid || coming_in_ > 0) return;
  Eigen::VectorXd theta = motion_.theta();
  bool far = false;
  for (std::size_t p = 0; p < e.value.size(); ++p) {
    if (e.reason[p] != Observability::observable || !(e.value[p] > 0)) continue;
    double& used = theta[static_cast<Eigen::Index>(p)];
    const bool damping = p >= elements_ && p < 2 * elements_;
    far = far || (!damping && std::abs(e.value[p] - used) > kFar * std::abs(used));
    used = e.value[p];
  }
  if (!far) return;
  coming_.tune(theta, std::vector<std::uint8_t>(motion_.present()));
  coming_unsettled_ = coming_.settle_rows();
  coming_in_ = coming_unsettled_ + settling_;
}

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
    m.x1 = m.x2 = m.s1 = m.s2 = m.v1 = m.v2 = m.settled = 0;  // the sensor restarts from rest
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
    std::copy(floors, motions_.end(),
              coming_motions_.begin());  // filters keep the resting sensors' means
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

/// Returns the mean of the base's sensors; NaN if one has no value or there is no sensor.
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

}  // namespace framewatch::estimator
