// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "estimator/diagnose/trials/trial.h"

namespace framewatch::estimator {

/// Confidence in a name that is as likely wrong as right.
inline constexpr double kDoubtful = 0.5;

/// One effect of a diagnosis.
struct FoundEffect {
  Trial chosen;
  std::vector<Trial> alternatives;  ///< best first
  std::vector<EffectKind> like;     ///< names that the data cannot distinguish from it
  double confidence = 0;            ///< in the name, 0 to 1
  /// More than noise is left: the effect differs from the law of its name, or another effect acts
  /// too.
  bool approximate = false;
  bool nearest =
      false;  ///< explains too little; named with low confidence because no other law comes nearer
  /// Held-out gap of the models with the effects before this one, and with it.
  double before = 0, after = 0;
  int index = -1;                 ///< among the model's effects; -1: gain or clock of an axis
  std::vector<double> ramp_mps3;  ///< bias_drift: slope in every segment
  std::vector<double> ramp_from_s;
  std::vector<double> drift_rms_mps2;  ///< of that drift about its mean; empty: of the ramp
  std::vector<double> std_error;       ///< of the catalog's parameters; 0: unknown
};

/// Returns the fitted rivals that alone would keep the confidence below `confidence`, best first.
/// Empty if the effect was chosen together with others, because its own trial then has no part in
/// it.
std::vector<const Trial*> near_rivals(const SearchSettings& settings, const FoundEffect& effect,
                                      double confidence);

/// Returns the best trial as an effect. trials: best first. Sets the alternatives, the names that
/// the data cannot distinguish from its name, and the confidence from the margin to the best rival.
FoundEffect effect_of(const SearchSettings& settings, const std::vector<Trial>& trials);

}  // namespace framewatch::estimator
