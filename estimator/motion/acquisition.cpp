// SPDX-License-Identifier: MIT
#include "estimator/motion/acquisition.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/numeric/nan.h"

namespace framewatch::estimator {

LostSampleFiller::LostSampleFiller(std::vector<std::uint8_t> repair) : repair_(std::move(repair)) {
  for (SampleSet& s : ring_) s.accel.resize(repair_.size());
  out_.accel.resize(repair_.size());
  repaired_.assign(repair_.size(), 0);
}

const SampleSet* LostSampleFiller::push(const SampleSet& set) {
  ring_[static_cast<std::size_t>(next_)].copy(set);
  next_ = (next_ + 1) % 5;
  filled_ = std::min(filled_ + 1, 5);
  ++waiting_;
  if (filled_ == 5) repair();
  return waiting_ > kLookAhead ? give() : nullptr;
}

const SampleSet* LostSampleFiller::drain() {
  return waiting_ > 0 ? give() : nullptr;
}

const SampleSet* LostSampleFiller::give() {
  out_.copy(held(waiting_ - 1));
  --waiting_;
  return &out_;
}

void LostSampleFiller::repair() {
  if (held(0).index - held(4).index != 4) return;
  for (std::size_t a = 0; a < repaired_.size(); ++a) {
    double& x = held(2).accel[a];
    if (repair_[a] == 0 || !std::isnan(x)) continue;
    const double near = held(1).accel[a] + held(3).accel[a];
    const double far = held(0).accel[a] + held(4).accel[a];
    const double filled = (4 * near - far) / 6;
    if (!std::isfinite(filled)) continue;
    x = filled;
    ++repaired_[a];
  }
}

namespace {

constexpr double kGravity = 9.80665;

}  // namespace

Calibration::Calibration(const std::vector<SensorAxis>& axes) : straight_(axes.size()) {
  for (const SensorAxis& axis : axes) {
    Axis out;
    out.gain = axis.polarity / std::cos(axis.tilt);
    out.offset = axis.offset + axis.polarity * kGravity * std::sin(axis.tilt);
    out.cross = axis.cross;
    if (axis.cross >= 0) {
      // With angles a and b counter-clockwise, an x axis measures mx = cos(a) ax + sin(a) ay, and a
      // y axis measures my = cos(b) ay - sin(b) ax.
      const SensorAxis& other = axes[static_cast<std::size_t>(axis.cross)];
      const double sign = axis.direction == Direction::x ? 1 : -1;
      const double determinant = std::cos(axis.mount_angle - other.mount_angle);
      out.own = std::cos(other.mount_angle) / determinant;
      out.other = -sign * std::sin(axis.mount_angle) / determinant;
    }
    axes_.push_back(out);
  }
}

void Calibration::apply(std::vector<double>& accel) {
  for (std::size_t a = 0; a < axes_.size(); ++a)
    straight_[a] = axes_[a].gain * (accel[a] - axes_[a].offset);
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    const Axis& axis = axes_[a];
    accel[a] = axis.cross < 0 ? straight_[a]
                              : axis.own * straight_[a] +
                                    axis.other * straight_[static_cast<std::size_t>(axis.cross)];
  }
}

namespace {

constexpr int kVertical = 2;  ///< stands beside the two directions

std::vector<AxisGuard::Axis> guarded_axes(const std::vector<SensorAxis>& axes) {
  std::vector<AxisGuard::Axis> out;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const SensorAxis& axis = axes[a];
    const auto same = std::find_if(axes.begin(), axes.end(), [&](const SensorAxis& other) {
      return !axis.group.empty() && other.group == axis.group;
    });
    const auto group = same == axes.end() ? static_cast<std::ptrdiff_t>(a) : same - axes.begin();
    out.push_back({axis.range, axis.vertical ? kVertical : static_cast<int>(axis.direction),
                   static_cast<int>(group), !axis.is_force});
  }
  return out;
}

/// The blow of a hammer is not a smooth curve, so a lost sample of a force is not interpolated.
std::vector<std::uint8_t> axes_to_repair(const std::vector<SensorAxis>& axes, bool repair) {
  std::vector<std::uint8_t> out;
  for (const SensorAxis& axis : axes) out.push_back(repair && !axis.is_force);
  return out;
}

}  // namespace

double whole_delay_s(double delay_s, double rate_hz) {
  return std::round(delay_s * rate_hz) / rate_hz;
}

Acquisition::Acquisition(const std::vector<SensorAxis>& axes, const EstimatorOptions& options,
                         bool lone_spikes)
    : axes_(axes),
      merger_(static_cast<int>(axes.size()), options.rate_hz, options.lateness_s),
      guard_(guarded_axes(axes), options.rate_hz, lone_spikes),
      calibration_(axes),
      filler_(axes_to_repair(axes, options.fill_single_losses)) {
  for (SensorAxis& axis : axes_) {
    bound_.push_back(sample_bound(axis));
    const double whole = whole_delay_s(axis.delay, options.rate_hz);
    whole_delay_.emplace_back(std::llround(whole * 1e6));
    axis.delay -= whole;
  }
  calibrated_.accel.resize(axes.size());
}

void Acquisition::take(const AccelSample& raw) {
  const auto a = static_cast<std::size_t>(raw.axis);
  AccelSample sample = raw;
  sample.accel *= axes_[a].scale;
  if (!bound_[a].holds(sample.accel)) {
    if (!std::isnan(raw.accel)) ++merger_.counters_of(raw.axis).absurd;
    sample.accel = kNaN;  // the merger counts it as rejected
  }
  sample.time -= whole_delay_[a];
  if (!merger_.push(sample)) waiting_ = sample;
}

void Acquisition::end() {
  merger_.finish();
  ending_ = Ending::guard;
}

const SampleSet* Acquisition::next() {
  for (;;) {
    const SampleSet* guarded = nullptr;
    if (const SampleSet* merged = merger_.next()) {
      guarded = guard_.push(*merged);
    } else if (waiting_) {
      (void)merger_.push(*waiting_);
      waiting_.reset();
    } else if (ending_ == Ending::guard) {
      guarded = guard_.drain();
      if (guarded == nullptr) ending_ = Ending::filler;
    } else if (ending_ == Ending::filler) {
      const SampleSet* last = filler_.drain();
      if (last == nullptr) ending_ = Ending::no;
      return last;
    } else {
      return nullptr;
    }
    if (guarded == nullptr) continue;
    if (const SampleSet* set = repaired(*guarded)) return set;
  }
}

const SampleSet* Acquisition::repaired(const SampleSet& guarded) {
  calibrated_ = guarded;
  calibration_.apply(calibrated_.accel);
  return filler_.push(calibrated_);
}

std::vector<AxisCounters> Acquisition::counters() const {
  std::vector<AxisCounters> out = merger_.counters();
  for (std::size_t a = 0; a < out.size(); ++a) {
    out[a].repaired = filler_.repaired()[a];
    out[a].stuck = guard_.stuck()[a];
    out[a].missing += guard_.missing()[a];
    out[a].clipped = guard_.clipped()[a];
    out[a].rejected += guard_.absurd()[a];
    out[a].absurd += guard_.absurd()[a];
  }
  return out;
}

}  // namespace framewatch::estimator
