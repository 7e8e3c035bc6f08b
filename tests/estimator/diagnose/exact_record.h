// SPDX-License-Identifier: MIT
#pragma once

#include "tests/estimator/diagnose/effect_of.h"
#include "tests/estimator/diagnose/small_building.h"

namespace framewatch::test {

/// Returns the readings of perfect sensors of the small building with these effects.
inline Eigen::MatrixXd exact_record(const Small& small,
                                    const std::vector<estimator::Effect>& effects,
                                    std::uint64_t seed) {
  estimator::ResponseStream stream(small.structure, small.table, small.truth, oblique_motion(seed),
                                   {kRate_hz}, {}, {}, effects);
  Eigen::MatrixXd out(static_cast<Eigen::Index>(kSeconds * kRate_hz), 6);
  for (Eigen::Index i = 0; i < out.rows(); ++i) out.row(i) = stream.next().transpose();
  return out;
}

/// Returns the readings without effects.
inline estimator::Model true_model(const Small& small, const estimator::Plant& plant) {
  estimator::Model out = initial_model(plant);
  out.theta = small.truth;
  return out;
}

inline estimator::Effect with_values(estimator::EffectKind kind,
                                     const estimator::EffectPlace& place,
                                     const std::vector<double>& values) {
  estimator::Effect out = make_effect(kind, place);
  for (std::size_t i = 0; i < values.size(); ++i) out.values[i] = values[i];
  return out;
}

/// An effect in the simulator's form and in the model's form.
struct EffectTwins {
  estimator::Effect simulated;
  estimator::ModelEffect modelled;
};

/// Returns a cubic spring at a frame, N/m^3; the model's force is that at 1 cm.
inline EffectTwins cubic_spring(int frame, double k3) {
  constexpr double kDeformation_m = 0.01;
  estimator::ModelEffect e = effect_of(estimator::LawForm::power, frame_place(frame),
                                       {k3 * std::pow(kDeformation_m, 3), 3});
  e.deformation = kDeformation_m;
  e.parameters[1].free = false;
  return {with_values(estimator::EffectKind::cubic_stiffness, frame_place(frame), {k3}), e};
}

inline EffectTwins extra_mass(int crossing, double mass) {
  const estimator::EffectPlace place = crossing_place(crossing);
  return {with_values(estimator::EffectKind::extra_mass, place, {mass}),
          effect_of(estimator::LawForm::mass, place, {mass})};
}

}  // namespace framewatch::test
