// SPDX-License-Identifier: MIT
#include "estimator/motion/drift_controlled_integrator.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "estimator/numeric/kernels.h"

namespace framewatch::estimator {
namespace {

constexpr int kMostOutputs = 5;  // of a DerivativeTriple

}  // namespace

HighPass::HighPass(double corner_hz, double rate_hz) {
  const double w = std::tan(M_PI * corner_hz / rate_hz);
  const double norm = 1 / (1 + std::sqrt(2.0) * w + w * w);
  gain = norm;
  a1 = 2 * (w * w - 1) * norm;
  a2 = (1 - std::sqrt(2.0) * w + w * w) * norm;
}

DriftControlledIntegrator::DriftControlledIntegrator(const std::vector<DerivativeTriple>& triples,
                                                     const HighPass& high_pass)
    : high_pass_(high_pass),
      axes_(triples.size()),
      length_(static_cast<std::size_t>(triples.front().length())),
      outputs_(padded(triples.front().held_second.empty() ? 3 : kMostOutputs)) {
  for (const DerivativeTriple& triple : triples)
    for (std::size_t k = 0; k < length_; ++k) {
      taps_.resize(taps_.size() + static_cast<std::size_t>(outputs_), 0.0);
      double* const tap = taps_.data() + taps_.size() - outputs_;
      tap[0] = triple.value[k], tap[1] = triple.first[k], tap[2] = triple.second[k];
      if (triple.held_second.empty()) continue;
      tap[3] = triple.held_first[k], tap[4] = triple.held_second[k];
    }
  for (std::vector<double>* state :
       {&x1_, &x2_, &y1_, &y2_, &value_, &first_, &second_, &held_first_, &held_second_})
    state->resize(axes_);
  ring_.resize(axes_ * 2 * length_);
  filled_.resize(axes_);
  reset();
}

void DriftControlledIntegrator::reset() {
  std::fill(filled_.begin(), filled_.end(), 0);
  std::fill(ring_.begin(), ring_.end(), 0.0);
  newest_ = 0;
}

void DriftControlledIntegrator::push(const std::vector<double>& accel) {
  newest_ = newest_ == 0 ? length_ - 1 : newest_ - 1;
  for (std::size_t axis = 0; axis < axes_; ++axis) push_axis(axis, accel[axis]);
}

void DriftControlledIntegrator::push_axis(std::size_t axis, double accel) {
  double* ring = &ring_[axis * 2 * length_];
  if (!std::isfinite(accel)) {
    filled_[axis] = 0;
    ring[newest_] = ring[newest_ + length_] = 0;
    value_[axis] = first_[axis] = second_[axis] = held_first_[axis] = held_second_[axis] = 0;
    return;
  }
  if (filled_[axis] == 0) {
    x1_[axis] = x2_[axis] = accel;
    y1_[axis] = y2_[axis] = 0;
    std::fill(ring, ring + 2 * length_, 0.0);
  }
  const double change = (accel - x1_[axis]) - (x1_[axis] - x2_[axis]);
  const double y = high_pass_.gain * change - high_pass_.a1 * y1_[axis] - high_pass_.a2 * y2_[axis];
  x2_[axis] = x1_[axis];
  x1_[axis] = accel;
  y2_[axis] = y1_[axis];
  y1_[axis] = y;
  ring[newest_] = ring[newest_ + length_] = y;
  filled_[axis] = std::min(filled_[axis] + 1, static_cast<int>(length_));

  const bool ready = filled_[axis] >= static_cast<int>(length_);
  std::array<double, padded(kMostOutputs)> out{};
  if (ready)
    kernels::in_use->apply_taps(&taps_[axis * length_ * static_cast<std::size_t>(outputs_)],
                                ring + newest_, static_cast<int>(length_), outputs_, out.data());
  value_[axis] = out[0], first_[axis] = out[1], second_[axis] = out[2];
  held_first_[axis] = out[3], held_second_[axis] = out[4];
}

}  // namespace framewatch::estimator
