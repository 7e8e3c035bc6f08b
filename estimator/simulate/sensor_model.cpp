// SPDX-License-Identifier: MIT
#include "estimator/simulate/sensor_model.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>

#include "estimator/structure/story_groups.h"

namespace framewatch::estimator {
namespace {

double quantised(double accel, const SensorModel& m) {
  if (m.full_scale <= 0) return accel;
  if (m.bits == 0) return std::clamp(accel, -m.full_scale, m.full_scale);
  const double half_codes = std::exp2(m.bits - 1);
  const double step = m.full_scale / half_codes;
  return step * std::clamp(std::round(accel / step), -half_codes, half_codes - 1);
}

}  // namespace

std::vector<std::string> problems(const SensorModel& m) {
  std::vector<std::string> found;
  const auto require = [&](bool holds, const char* rule) {
    if (!holds) found.push_back(rule);
  };
  require(std::isfinite(m.noise_density) && m.noise_density >= 0, "noise must be >= 0");
  require(std::isfinite(m.bias) && std::isfinite(m.thermal_ramp), "bias and ramp must be finite");
  require(std::isfinite(m.bias_per_degc) && std::isfinite(m.gain_per_degc),
          "errors per degC must be finite");
  require(std::isfinite(m.full_scale) && m.full_scale >= 0, "full scale must be >= 0");
  require(m.bits == 0 || (m.bits >= 2 && m.bits <= 32), "bits must be 0 or 2 to 32");
  require(m.bits == 0 || m.full_scale > 0, "bits need a full scale");
  require(m.loss_ratio >= 0 && m.loss_ratio < 1, "loss ratio must be in [0, 1)");
  require(m.dead_to_s >= m.dead_from_s, "dead time must end after it begins");
  return found;
}

double noise_density_of(double ratio, double rms, double rate_hz) {
  return ratio * rms / std::sqrt(rate_hz / 2);
}

std::vector<ResponseChannel> response_channels(const Structure& structure,
                                               const std::vector<SensorAxis>& axes) {
  std::vector<ResponseChannel> out;
  for (const SensorAxis& axis : axes) {
    out.push_back({0, axis.delay, 0});
    const auto add = [&](int column, double weight) {
      if (std::abs(weight) < 1e-12) return;
      if (out.back().weight == 0) {
        out.back().column = column;
        out.back().weight = weight;
      } else {
        out.back().also.emplace_back(column, weight);
      }
    };
    if (axis.vertical) continue;  // the ground does not rock
    if (axis.is_force) {          // the sum of the forces at the axis
      const std::vector<double> weights = frame_weights(structure, axis);
      for (int f = 0; f < structure.frames(); ++f)
        if (weights[static_cast<std::size_t>(f)] > 0.5)
          add(structure.degrees_of_freedom() + 2 + structure.dof(axis.story, f), 1);
      continue;
    }
    if (axis.story > 0) {
      const std::vector<double> weights = frame_weights(structure, axis);
      for (int f = 0; f < structure.frames(); ++f)
        add(structure.dof(axis.story, f), weights[static_cast<std::size_t>(f)]);
      continue;
    }
    const Direction along = direction_of(structure, axis);
    const double angle = axis.plan ? axis.plan->angle_rad : along == Direction::x ? 0 : M_PI / 2;
    const int base = structure.degrees_of_freedom();  // the ground does not turn
    if (axis.plan || along == Direction::x) add(base, std::cos(angle));
    if (axis.plan || along == Direction::y) add(base + 1, std::sin(angle));
  }
  return out;
}

SensorArray::SensorArray(std::vector<SensorAxis> axes, std::vector<SensorModel> models,
                         double rate_hz, std::uint64_t seed)
    : axes_(std::move(axes)),
      models_(std::move(models)),
      noise_gain_(std::sqrt(rate_hz / 2)),
      raw_(axes_.size()) {
  assert(axes_.size() == models_.size());
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    noise_.emplace_back(seed, 2 * i);
    loss_.emplace_back(seed, 2 * i + 1);
  }
}

const std::vector<double>& SensorArray::measure(double time_s, const Eigen::VectorXd& motion,
                                                double warmer_degc) {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const SensorModel& m = models_[i];
    const double noise = m.noise_density * noise_gain_ * noise_[i].normal();
    const bool lost = loss_[i].uniform() < m.loss_ratio;
    const bool dead = time_s >= m.dead_from_s && time_s < m.dead_to_s;
    const double gain = 1 + m.gain_per_degc * warmer_degc;
    double analog = gain * motion[static_cast<Eigen::Index>(i)] + noise + m.bias +
                    m.bias_per_degc * warmer_degc + m.thermal_ramp * time_s;
    if (m.clip_level > 0) analog = std::clamp(analog, -m.clip_level, m.clip_level);
    const double seen = quantised(analog, m);
    raw_[i] = lost || dead ? std::numeric_limits<double>::quiet_NaN()
                           : (axes_[i].polarity * seen + axes_[i].offset) / axes_[i].scale;
  }
  return raw_;
}

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
