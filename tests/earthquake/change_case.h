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

/// The stiffness of one element falls, at once.
struct Loss {
  double at_s = 0;
  int element = -1;  ///< frame story in the order of ParameterTable(structure)
  double ratio = 0;  ///< of its stiffness
};

/// A building, what happens to it, and what the estimator is told. Drawn by seed.
struct ChangeCase {
  static constexpr double kLearned_s = 100;  ///< the baseline is learned by then
  static constexpr double kEnd_s = 200;

  ChangeKind kind = ChangeKind::loss;
  std::uint64_t seed = 1;
  StudyBuilding told;          ///< what the estimator is told: design and masses may be off
  estimator::Structure truly;  ///< with the true masses
  Eigen::VectorXd theta;       ///< true, in the order of ParameterTable(truly)
  std::vector<Loss> losses;    ///< ascending in time
  Softening softening = Softening::none;
  double amount = 0;         ///< of the softening
  bool model_error = false;  ///< masses off by 2 %, profiles of groups by 5 %, standard deviations
  bool between = false;      ///< the change falls between two strong motions, else into one
  bool loud = false;  ///< the earthquake is 2.5 times as strong as what the baseline was learned in

  bool grouped() const { return told.config.parameters().grouped(); }
  bool softens() const { return softening != Softening::none; }
  /// Level of the ground's motion at a time; 1 is about 1 m/s^2 rms.
  double level(double time_s) const;
  /// When the change can be seen first: its time, or when strong motion begins again after it.
  double visible_s(double change_s) const;
  /// Remaining stiffness of every element of ParameterTable(truly) at a time, relative.
  Eigen::VectorXd remaining(double time_s) const;
  /// What the identified parameters have lost at a time, relative: exact, also of groups.
  std::vector<double> truth(double time_s) const;
  /// One line for people.
  std::string text() const;
};

/// The case of a number. The same seed and number give the same case.
ChangeCase change_case(ChangeKind kind, std::uint64_t seed, int number);

}  // namespace framewatch::earthquake
