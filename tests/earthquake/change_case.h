// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "tests/earthquake/softening_building.h"
#include "tests/earthquake/study_buildings.h"

namespace framewatch::earthquake {

enum class ChangeKind {
  loss,    ///< one or two elements lose 5 to 40 %
  none,    ///< control: nothing changes
  uniform  ///< every element loses 5 %
};

/// A sudden loss of stiffness of one element.
struct Loss {
  double at_s = 0;
  int element = -1;  ///< frame story in the order of ParameterTable(structure)
  double ratio = 0;  ///< of its stiffness
};

/// A building, its changes, and the estimator's design. Drawn by seed.
struct ChangeCase {
  static constexpr double kLearned_s = 100;  ///< the baseline is learned by then
  static constexpr double kEnd_s = 200;

  ChangeKind kind = ChangeKind::loss;
  std::uint64_t seed = 1;
  StudyBuilding told;          ///< the estimator's configuration: design and masses may be wrong
  estimator::Structure truly;  ///< with the true masses
  Eigen::VectorXd theta;       ///< true, in the order of ParameterTable(truly)
  std::vector<Loss> losses;    ///< ascending in time
  Softening softening = Softening::none;
  double amount = 0;         ///< of the softening
  bool model_error = false;  ///< masses off by 2 %, profiles of groups by 5 %, standard deviations
  bool between = false;  ///< true: the change falls between two strong motions; false: within one
  bool loud = false;  ///< true: the earthquake is 2.5 times as strong as the motion of the baseline

  bool grouped() const { return told.config.parameters().grouped(); }
  bool softens() const { return softening != Softening::none; }
  /// Returns the level of the ground's motion at a time; 1 is about 1 m/s^2 rms.
  double level(double time_s) const;
  /// Returns the first time at which the change can be seen: its time, or the next start of strong
  /// motion.
  double visible_s(double change_s) const;
  /// Returns the remaining relative stiffness of every element of ParameterTable(truly) at a time.
  Eigen::VectorXd remaining(double time_s) const;
  /// Returns the relative losses of the identified parameters at a time, exact also for groups.
  std::vector<double> truth(double time_s) const;
  /// Returns one line that describes the case.
  std::string text() const;
};

/// Returns the case of a number. The same seed and number give the same case.
ChangeCase change_case(ChangeKind kind, std::uint64_t seed, int number);

}  // namespace framewatch::earthquake
