// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "estimator/simulate/ground_motion.h"
#include "tests/study/hidden.h"

namespace framewatch::study {

struct CaseOptions {
  std::string building = "2story_1x1";
  double noise_ratio = 0.02;   ///< of every channel's rms
  double flicker_share = 0.3;  ///< of the noise's power: FlickerNoise
  /// Damping ratio of the first mode from mass-proportional damping, over 1 %. Dashpots between
  /// floors cannot produce it.
  double mass_damping = 0.2;
  double seconds = 60;  ///< of each record
  double rate_hz = 100;
  double least_gap = 3;  ///< in noise floors
  std::uint64_t seed = 1;
};

/// A building, its hidden effects and its two ground motions.
struct StudyCase {
  CaseOptions options;
  std::string group;  ///< catalogue, nothing, other_form, outside, two_effects, three_effects
  std::string name;   ///< of the hidden part
  StudyBuilding building;
  Hidden hidden;
  std::vector<estimator::PlanMotion> motions;     ///< train, holdout
  std::vector<estimator::Effect> ground_dampers;  ///< the mass-proportional damping
  bool filtered = false;      ///< clean_record(): a late reading is taken from a filtered record
  double gap_over_floor = 0;  ///< gap that no linear model explains, of the train record
};

/// Returns nullopt and sets `why_not` if no size makes the effect show.
std::optional<StudyCase> make_case(const std::string& group, const std::string& name,
                                   const CaseOptions& options, std::string& why_not);

/// Returns the sampled channels of a record with noise, instants x axes, m/s^2.
Eigen::MatrixXd measured(const StudyCase& c, int record);

/// Writes config.toml, train.csv.gz, holdout.csv.gz and truth.json to `directory`. Returns false
/// and sets `error` if they cannot be written.
bool write_case(const StudyCase& c, const std::string& directory, std::string& error);

}  // namespace framewatch::study
