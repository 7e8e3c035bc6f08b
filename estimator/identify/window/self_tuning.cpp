// SPDX-License-Identifier: MIT
#include "estimator/identify/window/self_tuning.h"

#include <algorithm>

namespace framewatch::estimator {
namespace {

constexpr int kMaxPasses = 6;     // tuning passes before the first estimate
constexpr double kDetuned = 0.1;  // relative change of a filter's corner that requires retuning
constexpr int kMinFloors = 4;     // floors checked or tuned per instant, at least
/// Limits of the instants that a newly tuned regression takes in per instant of input. A small
/// building takes many, so that it starts soon; a large one takes few, so that no instant is late.
constexpr int kMaxCatchUp = 8, kMinCatchUp = 2;
constexpr double kCatchUpWork = 6e5;  // entries of the floors' fronts per instant

}  // namespace

SelfTuning::SelfTuning(const FloorLayout& layout, const ParameterTable& table,
                       std::unique_ptr<TunedRegression> standby, int blocks, int fill,
                       bool noise_known)
    : layout_(layout),
      table_(table),
      standby_(std::move(standby)),
      blocks_(blocks),
      fill_(fill),
      parts_per_instant_(
          layout.grouped() ? 1 : std::max(kMinFloors, (layout.floors() + blocks - 1) / blocks)),
      noise_known_(noise_known),
      noise_(standby_->tuning().noise_density()),
      work_(table.size()),
      next_theta0_(Eigen::VectorXd::Zero(table.size())) {
  const double front = layout.most_front();
  catch_up_per_instant_ = static_cast<int>(std::clamp<double>(
      kCatchUpWork / (layout.floors() * front * front), kMinCatchUp, kMaxCatchUp));
}

void SelfTuning::start_tuned(std::unique_ptr<TunedRegression>& active, const Tuning& tuning) {
  standby_->tuning().set_theta0(tuning.theta0, tuning.noise_density);
  for (int part = 0; part < standby_->tuning().parts(); ++part) standby_->tuning().tune(part);
  standby_->start(0);
  active.swap(standby_);
  noise_known_ = true;
  tuned_ = tuning.found_right;
}

bool SelfTuning::due() {
  if (phase_ != Phase::idle) return false;
  if (tuned_ && ++since_check_ < blocks_) return false;
  since_check_ = 0;
  return true;
}

void SelfTuning::begin_check(const TunedRegression& active, const std::vector<double>& ratio,
                             const std::vector<double>& std_error,
                             const std::vector<std::uint8_t>& shown, const AxisNoise& noise) {
  const bool any = std::any_of(shown.begin(), shown.end(), [](auto s) { return s != 0; });
  // Groups whose design is far off show nothing until the noise is known, because the residual
  // counts as noise.
  if (!any && (noise_known_ || !layout_.grouped())) return;
  retuned_design(layout_, table_, active.tuning().theta0(), ratio, std_error, shown, work_,
                 next_theta0_);
  noise_measured_ = noise.densities(noise_);
  if (!any && !noise_measured_) return;
  noise_differs_ =
      noise_measured_ && (!noise_known_ || noise.differs(noise_, active.tuning().noise_density()));
  phase_ = Phase::checking;
  next_part_ = 0;
  detuning_ = 0;
}

void SelfTuning::begin_axes(const TunedRegression& active, const std::vector<std::uint8_t>& present,
                            const RowTuning::Known& known) {
  noise_measured_ = noise_known_;
  begin_tuning(present, known, known.theta, active.tuning().noise_density());
}

void SelfTuning::lend(const TunedRegression& active) {
  lending_ = true;
  const RowTuning& tuning = active.tuning();
  begin_tuning(tuning.axes(), tuning.ratios(), tuning.theta0(), tuning.noise_density());
}

void SelfTuning::begin_tuning(const std::vector<std::uint8_t>& axes, const RowTuning::Known& ratios,
                              const Eigen::VectorXd& theta0,
                              const std::vector<double>& noise_density) {
  standby_->rest();
  if (standby_->tuning().axes() != axes) standby_->tuning().set_axes(axes, ratios);
  standby_->tuning().set_theta0(theta0, noise_density);
  phase_ = Phase::tuning;
  next_part_ = 0;
}

bool SelfTuning::step(std::unique_ptr<TunedRegression>& active, const MotionRing& ring) {
  switch (phase_) {
    case Phase::idle:
    case Phase::lent:
      break;
    case Phase::checking:
      check_floors(*active);
      break;
    case Phase::tuning:
      tune_parts(ring);
      break;
    case Phase::catching_up:
      if (!catch_up(*active, ring)) break;
      active.swap(standby_);
      noise_known_ = noise_known_ || noise_measured_;  // newly measured; otherwise as before
      phase_ = Phase::idle;
      ++retunes_;
      return true;
  }
  return false;
}

void SelfTuning::check_floors(TunedRegression& active) {
  for (int i = 0; i < parts_per_instant_ && next_part_ < layout_.floors(); ++i)
    detuning_ = std::max(detuning_, active.tuning().detuning(next_part_++, next_theta0_));
  if (next_part_ < layout_.floors()) return;
  phase_ = Phase::idle;
  if ((detuning_ <= kDetuned && !noise_differs_) || passes_ >= kMaxPasses) {
    tuned_ = true;
    passes_ = 0;
    return;
  }
  if (!tuned_) ++passes_;
  begin_tuning(active.tuning().axes(), active.tuning().ratios(), next_theta0_,
               noise_measured_ ? noise_ : active.tuning().noise_density());
}

void SelfTuning::tune_parts(const MotionRing& ring) {
  for (int i = 0; i < parts_per_instant_ && next_part_ < standby_->tuning().parts(); ++i)
    standby_->tuning().tune(next_part_++);
  if (next_part_ < standby_->tuning().parts()) return;
  if (lending_) {
    phase_ = Phase::lent;
    return;
  }
  const std::int64_t back = standby_->warm_up() + fill_;
  standby_->start(std::max(ring.begin(), ring.end() - back));
  phase_ = Phase::catching_up;
}

bool SelfTuning::catch_up(const TunedRegression& active, const MotionRing& ring) {
  for (int i = 0; i < catch_up_per_instant_ && standby_->next() < ring.end(); ++i) {
    standby_->advance(ring);
    standby_->finish(ring);
  }
  return standby_->next() == ring.end() && (standby_->full() || !active.full());
}

}  // namespace framewatch::estimator
