#include "estimator/simulate/channel_effects.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace framewatch::estimator {

ChannelEffects::ChannelEffects(std::vector<Effect> effects) : effects_(std::move(effects)) {
  std::erase_if(effects_, [](const Effect& e) { return !is_channel_effect(e.kind); });
}

void ChannelEffects::delay(std::vector<ResponseChannel>& channels) const {
  for (const Effect& e : effects_)
    if (e.kind == EffectKind::time_shift)
      channels[static_cast<std::size_t>(e.place.channel)].delay_s += e.value("shift_s");
}

void ChannelEffects::limit(std::vector<SensorModel>& models) const {
  for (const Effect& e : effects_) {
    if (e.kind != EffectKind::clipping) continue;
    double& level = models[static_cast<std::size_t>(e.place.channel)].clip_level;
    level = level > 0 ? std::min(level, e.value("level_mps2")) : e.value("level_mps2");
  }
}

const Eigen::VectorXd& ChannelEffects::apply(double time_s, const Eigen::VectorXd& motion) {
  out_ = motion;
  for (const Effect& e : effects_) {
    double& a = out_[e.place.channel];
    switch (e.kind) {
      case EffectKind::gain_error:
        a *= 1 + e.value("gain");
        break;
      case EffectKind::polarity:
        a = -a;
        break;
      case EffectKind::misalignment: {
        const double angle = e.value("angle_deg") * M_PI / 180;
        a = std::cos(angle) * a + std::sin(angle) * motion[e.place.with_channel];
        break;
      }
      case EffectKind::bias_drift:
        a += e.value("ramp_mps3") * std::max(time_s - e.value("from_s"), 0.0);
        break;
      case EffectKind::swapped:
        std::swap(a, out_[e.place.with_channel]);
        break;
      default:
        break;
    }
  }
  return out_;
}

}  // namespace framewatch::estimator
