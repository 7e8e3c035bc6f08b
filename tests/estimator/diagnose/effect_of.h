// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <vector>

#include "estimator/diagnose/law/law_parameter.h"
#include "estimator/diagnose/model/model.h"

namespace framewatch::test {

inline constexpr double kParameterStep = 1e-3;  ///< of a value, or its logarithm

inline estimator::EffectPlace frame_place(int frame, int story = 1) {
  estimator::EffectPlace out;
  out.story = story;
  out.frame = frame;
  return out;
}

inline estimator::EffectPlace node_place(int frame, int story = 1) {
  estimator::EffectPlace out = frame_place(frame, story);
  out.kind = estimator::PlaceKind::node;
  return out;
}

/// Returns the place between a node and a lower one on the same frame; story 0: the ground.
inline estimator::EffectPlace pair_place(int frame, int story = 1, int to_story = 0) {
  estimator::EffectPlace out = frame_place(frame, story);
  out.kind = estimator::PlaceKind::node_pair;
  out.to_story = to_story;
  return out;
}

inline estimator::EffectPlace panel_place(int panel, int story = 1) {
  estimator::EffectPlace out;
  out.kind = estimator::PlaceKind::panel;
  out.story = story;
  out.panel = panel;
  return out;
}

inline estimator::EffectPlace floor_place(int story = 1) {
  estimator::EffectPlace out;
  out.kind = estimator::PlaceKind::floor;
  out.story = story;
  return out;
}

inline estimator::EffectPlace crossing_place(int crossing, int story = 1) {
  estimator::EffectPlace out;
  out.kind = estimator::PlaceKind::crossing;
  out.story = story;
  out.crossing = crossing;
  return out;
}

inline estimator::EffectPlace building_place(estimator::Direction direction) {
  estimator::EffectPlace out;
  out.kind = estimator::PlaceKind::building;
  out.direction = direction;
  return out;
}

inline estimator::EffectPlace channel_place(int channel, int with_channel = -1) {
  estimator::EffectPlace out;
  out.kind = with_channel < 0 ? estimator::PlaceKind::channel : estimator::PlaceKind::channel_pair;
  out.channel = channel;
  out.with_channel = with_channel;
  return out;
}

/// Returns a free value of an effect, without a prior.
inline estimator::LawParameter parameter_of(double value) {
  estimator::LawParameter out;
  out.value = value;
  out.step = kParameterStep * (value != 0 ? std::abs(value) : 1.0);
  return out;
}

inline estimator::ModelEffect effect_of(estimator::LawForm form,
                                        const estimator::EffectPlace& place,
                                        const std::vector<double>& values,
                                        const std::vector<double>& record_values = {}) {
  estimator::ModelEffect out;
  out.form = form;
  out.place = place;
  for (const double value : values) out.parameters.push_back(parameter_of(value));
  if (record_values.empty()) return out;
  out.record_parameters.emplace_back();
  for (const double value : record_values)
    out.record_parameters.front().push_back(parameter_of(value));
  out.onset_s.push_back(0);
  return out;
}

inline estimator::Model with_effects(estimator::Model model,
                                     const std::vector<estimator::ModelEffect>& effects) {
  model.effects.insert(model.effects.end(), effects.begin(), effects.end());
  return model;
}

}  // namespace framewatch::test
