#include "estimator/shaking/every_floor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/numeric/nan.h"

namespace framewatch::estimator {

EveryFloor::EveryFloor(const PipelineConfig& config, std::int64_t settling)
    : motion_(config),
      coming_(motion_),
      settling_(settling),
      elements_(static_cast<std::size_t>(config.parameters().elements())),
      used_(identifying(config.axes)),
      away_rows_(kAway_s * config.options.rate_hz),
      away_(config.axes.size(), 0) {}

/// Whether a channel went, or came back.
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

}  // namespace framewatch::estimator
