// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <stdexcept>
#include <vector>

#include "estimator/diagnose/fit/unknowns.h"
#include "estimator/diagnose/locate/candidate_places.h"
#include "estimator/diagnose/locate/localise.h"
#include "estimator/diagnose/verdict/diagnosis.h"
#include "tests/estimator/diagnose/small_building.h"

namespace framewatch::test {

inline estimator::EffectPlace in_frame(int frame) {
  estimator::EffectPlace out;
  out.story = 1;
  out.frame = frame;
  return out;
}

inline estimator::EffectPlace at_node(int frame) {
  estimator::EffectPlace out = in_frame(frame);
  out.kind = estimator::PlaceKind::node;
  return out;
}

inline estimator::EffectPlace at_channel(int channel) {
  estimator::EffectPlace out;
  out.kind = estimator::PlaceKind::channel;
  out.channel = channel;
  return out;
}

inline estimator::EffectPlace at_crossing(int crossing) {
  estimator::EffectPlace out;
  out.kind = estimator::PlaceKind::crossing;
  out.story = 1;
  out.crossing = crossing;
  return out;
}

/// values: in the catalog's order.
inline estimator::Effect effect_of(estimator::EffectKind kind, const estimator::EffectPlace& place,
                                   std::initializer_list<double> values) {
  estimator::Effect out = make_effect(kind, place);
  std::copy(values.begin(), values.end(), out.values.begin());
  return out;
}

/// Returns the readings of the small building, one record per seed.
inline std::vector<Eigen::MatrixXd> records_with(const std::vector<estimator::Effect>& effects,
                                                 std::initializer_list<std::uint64_t> seeds = {1}) {
  const Small small;
  std::vector<Eigen::MatrixXd> out;
  for (const std::uint64_t seed : seeds) out.push_back(small.record(effects, seed));
  return out;
}

/// first: of the held-out segments.
inline estimator::DiagnosisOptions held_out_from(std::size_t first) {
  estimator::DiagnosisOptions out;
  out.holdout_from = first;
  return out;
}

/// Records of the small building, ready for the steps of a diagnosis.
struct Recorded {
  Small small;
  estimator::Plant plant;
  std::vector<estimator::RecordSegment> segments;
  estimator::Fitter fitter;

  explicit Recorded(const std::vector<Eigen::MatrixXd>& records,
                    const estimator::Tolerances& tolerances = {})
      : plant(small.plant()),
        segments(small.segments(records)),
        fitter(plant, segments, tolerances) {}
  Recorded(const Recorded&) = delete;
  Recorded& operator=(const Recorded&) = delete;

  estimator::FitResult linear() const { return fitter.fit(initial_model(plant), {}, {}); }

  /// Returns the localization with an arbitrary signal at this place.
  estimator::Localisation freed(const estimator::EffectPlace& place) const {
    constexpr int kSteps = 6;
    const estimator::Model model = linear().model;
    for (const estimator::CandidatePlace& candidate : candidate_places_of(plant, model))
      if (candidate.place == place) return localise(fitter, model, {}, {candidate}, kSteps);
    throw std::invalid_argument("no such place in the small building");
  }
};

}  // namespace framewatch::test
