// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "estimator/diagnose/propose/law_kind.h"
#include "estimator/simulate/element_law.h"
#include "estimator/structure/effect.h"
#include "tests/study/study_building.h"

namespace framewatch::study {

/// Largest deformation and rate of every element of theta in the linear building, m and m/s, and
/// rms absolute acceleration of every degree of freedom, m/s^2.
struct Peaks {
  Eigen::VectorXd deformation, rate, accel_rms;
  double first_mode_hz = 1;
  double last_mode_hz = 1;
  double seconds = 0;  ///< of the record
};

/// A law on a frame story that the catalog does not have.
struct OtherLaw {
  std::string name;
  std::vector<std::string> accepted;  ///< names of the catalog that describe it approximately
  estimator::LawKind sort;            ///< of its force
  estimator::EffectPlace place;
  std::function<std::unique_ptr<estimator::ElementLaw>(int record)> make;
};

/// The hidden part of a case, of a certain size.
struct Hidden {
  std::vector<estimator::Effect> effects;  ///< of record 0
  std::vector<OtherLaw> laws;
  Eigen::VectorXd theta;  ///< the building's, less the share taken over by the effects
};

/// A hidden effect with everything drawn except its size. `make` returns it for a size in (0,
/// largest], added to the contents of `hidden`.
struct Draw {
  std::string name;
  double largest = 1;
  bool sizeless = false;  ///< polarity, swapped
  bool of_channel = false;
  std::function<void(double size, Hidden& hidden)> make;
};

/// Draws an effect of the catalog at a random place.
Draw draw_effect(estimator::EffectKind kind, const StudyBuilding& building, const Peaks& peaks,
                 estimator::Random& random);

/// Returns the names of laws that resemble one of the catalog's, and of those that resemble none.
const std::vector<std::string>& other_forms();
const std::vector<std::string>& outsiders();
Draw draw_law(const std::string& name, const StudyBuilding& building, const Peaks& peaks,
              estimator::Random& random);

/// Returns the effects as they act in another record: start times and phases differ.
std::vector<estimator::Effect> in_record(std::vector<estimator::Effect> effects, int record,
                                         double seconds);

}  // namespace framewatch::study
