// SPDX-License-Identifier: MIT
#include "estimator/gap/axis_correction.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "estimator/numeric/nan.h"

namespace framewatch::estimator {
namespace {

constexpr double kNearly = 0.98;  ///< of the clipping level; larger samples are ignored

}  // namespace

AxisCorrection::AxisCorrection(const std::vector<SensorAxis>& axes,
                               const std::vector<Effect>& effects, double rate_hz)
    : axes_(axes.size()), aligned_(axes.size()) {
  std::vector<double> delay;
  for (const SensorAxis& axis : axes) delay.push_back(axis.delay * rate_hz);
  for (const Effect& e : effects) {
    if (!is_channel_effect(e.kind)) continue;
    if (e.kind == EffectKind::time_shift)
      delay[static_cast<std::size_t>(e.place.channel)] += e.value("shift_s") * rate_hz;
    else
      effects_.push_back(e);
  }
  int earliest = 0;
  for (const double instants : delay) {
    whole_.push_back(static_cast<int>(std::lround(instants)));
    rest_.push_back(instants - whole_.back());
    longest_ = std::max(longest_, whole_.back());
    earliest = std::min(earliest, whole_.back());
  }
  length_ = longest_ - earliest + 1;
  ring_.assign(static_cast<std::size_t>(length_) * axes_, kNaN);
}

const std::vector<double>& AxisCorrection::apply(const std::vector<double>& accel) {
  newest_ = newest_ == 0 ? length_ - 1 : newest_ - 1;
  std::copy(accel.begin(), accel.end(),
            ring_.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(newest_) * axes_));
  for (std::size_t a = 0; a < axes_; ++a) {
    const int age = longest_ - whole_[a];
    aligned_[a] = ring_[static_cast<std::size_t>((newest_ + age) % length_) * axes_ + a];
  }
  // Undo the effects in reverse: the last one applied comes first.
  for (auto e = effects_.rbegin(); e != effects_.rend(); ++e) {
    double& a = aligned_[static_cast<std::size_t>(e->place.channel)];
    switch (e->kind) {
      case EffectKind::gain_error:
        a /= 1 + e->value("gain");
        break;
      case EffectKind::polarity:
        a = -a;
        break;
      case EffectKind::misalignment: {
        const double angle = e->value("angle_deg") * M_PI / 180;
        const double other = aligned_[static_cast<std::size_t>(e->place.with_channel)];
        a = (a - std::sin(angle) * other) / std::cos(angle);
        break;
      }
      case EffectKind::clipping:
        if (std::abs(a) >= kNearly * e->value("level_mps2")) a = kNaN;
        break;
      case EffectKind::swapped:
        std::swap(a, aligned_[static_cast<std::size_t>(e->place.with_channel)]);
        break;
      default:
        break;
    }
  }
  return aligned_;
}

}  // namespace framewatch::estimator
