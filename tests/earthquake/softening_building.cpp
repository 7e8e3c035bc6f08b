// SPDX-License-Identifier: MIT
#include "tests/earthquake/softening_building.h"

#include <cmath>
#include <utility>

#include "estimator/simulate/make_law.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::earthquake {
namespace {

constexpr int kFine = 20;  // steps per instant
constexpr double kStep_s = 1 / (kFine * SofteningBuilding::kRate_hz);
constexpr double kGround_hz = 2.5, kGroundDamping = 0.6, kGround_mps2 = 1;
constexpr double kRise_s = 2, kFall_s = 20;      // of the running rms drift
constexpr double kSlipAt = 3, kSlipShare = 0.5;  // usual drifts; of the softening
constexpr double kMeasured_s = 30, kBeforeThat_s = 10;

}  // namespace

SofteningBuilding::SofteningBuilding(const estimator::Structure& structure,
                                     const Eigen::VectorXd& theta,
                                     const std::vector<estimator::SensorAxis>& axes,
                                     Softening softening, double amount, double noise_ratio,
                                     std::uint64_t seed)
    : structure_(structure),
      elements_(elements(structure, estimator::ParameterTable(structure))),
      influence_(ground_influence(structure)),
      softening_(softening),
      amount_(amount),
      frames_(elements_.size()),
      ground_random_(seed, 1),
      noise_random_(seed, 2) {
  const auto count = static_cast<Eigen::Index>(elements_.size());
  stiffness_ = theta.head(count);
  damping_ = theta.tail(count);
  remaining_ = Eigen::VectorXd::Ones(count);
  mass_.resize(structure.degrees_of_freedom());
  for (int story = 1; story <= structure.stories; ++story)
    for (int f = 0; f < structure.frames(); ++f)
      mass_[structure.dof(story, f)] = structure.frame_mass(story, f);
  std::vector<estimator::DecimatorChannel> channels;
  const std::vector<double> taps = estimator::anti_alias_taps(kFine);
  for (const estimator::SensorAxis& axis : axes) {
    channels.push_back({static_cast<int>(channels.size()), taps});
    sensed_.push_back(axis.story > 0 ? structure.dof(axis.story, axis.frame)
                                     : (axis.direction == estimator::Direction::x ? -1 : -2));
  }
  fine_ = out_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(axes.size()));
  sigma_.assign(axes.size(), 0);
  decimator_ = std::make_unique<estimator::Decimator>(channels, static_cast<int>(channels.size()));
  rest();
  learn_usual(noise_ratio);
}

void SofteningBuilding::rest() {
  moved_ = velocity_ = accel_ = force_ = Eigen::VectorXd::Zero(mass_.size());
  for (Ground& g : ground_) g = {};
  for (Frame& f : frames_) f.level = 0, f.states.assign(f.states.size(), 0);
  time_s_ = 0;
}

/// Measures the usual drifts and the channels' rms under shaking of level 1; returns to rest.
void SofteningBuilding::learn_usual(double noise_ratio) {
  const auto instants = std::lround(kMeasured_s * kRate_hz);
  std::vector<double> squares(sigma_.size(), 0);
  std::vector<double> drifts(frames_.size(), 0);
  for (long i = -std::lround(kBeforeThat_s * kRate_hz); i < instants; ++i) {
    next(1);
    if (i < 0) continue;
    for (std::size_t a = 0; a < squares.size(); ++a) {
      const double value = out_[static_cast<Eigen::Index>(a)];
      squares[a] += value * value / static_cast<double>(instants);
    }
    for (std::size_t e = 0; e < frames_.size(); ++e)
      drifts[e] += frames_[e].level / static_cast<double>(instants);
  }
  for (std::size_t a = 0; a < squares.size(); ++a) sigma_[a] = noise_ratio * std::sqrt(squares[a]);
  for (std::size_t e = 0; e < frames_.size(); ++e) {
    frames_[e].usual = std::sqrt(drifts[e]);
    if (softening_ != Softening::slipping || elements_[e].frame < 0) continue;
    estimator::EffectPlace place;
    place.story = elements_[e].story, place.frame = elements_[e].frame;
    estimator::Effect effect = make_effect(estimator::EffectKind::amplitude_dependence, place);
    effect.set("softening", amount_);
    effect.set("at_m", kSlipAt * frames_[e].usual);
    effect.set("slip", kSlipShare);
    frames_[e].law = make_amplitude_law(effect, stiffness_[static_cast<Eigen::Index>(e)]);
    frames_[e].states.assign(static_cast<std::size_t>(frames_[e].law->states()), 0);
    frames_[e].rates = frames_[e].states;
  }
  linear_ = false;
  rest();
}

const Eigen::VectorXd& SofteningBuilding::next(double level) {
  for (int i = 0; i < kFine; ++i) step(level);
  out_ = decimator_->output();
  for (std::size_t a = 0; a < sigma_.size(); ++a)
    out_[static_cast<Eigen::Index>(a)] += sigma_[a] * noise_random_.normal();
  return out_;
}

/// White noise through the ground's own resonance.
void SofteningBuilding::shake_ground(double level) {
  const double w = 2 * M_PI * kGround_hz;
  const double gain = kGround_mps2 * level * std::sqrt(2 * kGroundDamping / w / kStep_s);
  for (Ground& g : ground_) {
    const auto pull = [&] { return 2 * kGroundDamping * w * g.velocity + w * w * g.moved; };
    g.velocity += kStep_s * (gain * ground_random_.normal() - pull());
    g.moved += kStep_s * g.velocity;
    g.accel = -pull();
  }
}

/// Returns the force of an element's spring beyond its linear part, over its present stiffness, m.
double SofteningBuilding::beyond_linear(std::size_t e, double drift, double rate) {
  if (elements_[e].frame < 0) return 0;
  Frame& frame = frames_[e];
  const double square = drift * drift;
  frame.level += kStep_s / (square > frame.level ? kRise_s : kFall_s) * (square - frame.level);
  if (linear_ || softening_ == Softening::none) return 0;
  if (softening_ == Softening::slow) {
    const double rms = std::sqrt(frame.level);
    return -amount_ * rms / (rms + frame.usual) * drift;
  }
  frame.law->begin_step(time_s_, drift);
  frame.law->rates(drift, rate, frame.states, frame.rates);
  for (std::size_t z = 0; z < frame.states.size(); ++z) frame.states[z] += kStep_s * frame.rates[z];
  return frame.law->force(time_s_, drift, rate, frame.states) /
         stiffness_[static_cast<Eigen::Index>(e)];
}

void SofteningBuilding::step(double level) {
  shake_ground(level);
  time_s_ += kStep_s;
  force_.setZero();
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    double drift = 0, rate = 0;
    // velocity_ is half a step behind: with half a step of the last acceleration it is in time.
    for (const auto& [dof, b] : elements_[e].b) {
      drift += b * moved_[dof];
      rate += b * (velocity_[dof] + kStep_s / 2 * accel_[dof]);
    }
    const auto i = static_cast<Eigen::Index>(e);
    const double force = remaining_[i] * stiffness_[i] * (drift + beyond_linear(e, drift, rate)) +
                         damping_[i] * rate;
    for (const auto& [dof, b] : elements_[e].b) force_[dof] += b * force;
  }
  const Eigen::Vector2d ground(ground_[0].accel, ground_[1].accel);
  accel_ = -force_.cwiseQuotient(mass_) - influence_ * ground;
  velocity_ += kStep_s * accel_;
  moved_ += kStep_s * velocity_;
  for (std::size_t a = 0; a < sensed_.size(); ++a) {
    const int at = sensed_[a];
    fine_[static_cast<Eigen::Index>(a)] =
        at < 0 ? ground[-1 - at] : accel_[at] + influence_.row(at).dot(ground);
  }
  decimator_->push(fine_);
}

}  // namespace framewatch::earthquake
