// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "daemon/base/workers.h"
#include "daemon/tools/lab/accuracy_trial.h"
#include "daemon/tools/lab/study_buildings.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/structure/effect.h"

namespace framewatch::daemon {

/// The true tall building, which the estimator does not know, and its beliefs about it.
struct TallTrial {
  std::vector<int> floors{5, 10, 15, 20};  ///< measured
  int stories = 20;
  /// Two frames each way under rigid floors, uneven, with three channels a floor, instead of one.
  bool in_space = false;
  double noise_ratio = 0.01;  ///< white noise of each channel over the rms of its motion
  double stiffness_off = 0.2, damping_off = 0.3;  ///< of groups from the design, at most
  double profile_off = 0, mass_off = 0;           ///< standard deviations: of stories, of floors
  double bending_nmprad = 0;                      ///< true one
  /// Additional damping ratio of the lowest mode by dashpots from the floors to the ground,
  /// proportional to mass. The estimator's model does not have them.
  double ground_damping_ratio = 0;
  double believed_bending_nmprad = 0;          ///< of the design; 0: it does not bend
  std::vector<estimator::Effect> hidden = {};  ///< additional effects, of plane buildings only
  double duration_s = 60;
  double from_s = 20;  ///< windows count from here on
  std::uint64_t seed = 1;
};

/// A trial's building and the measurements of its channels.
struct TallRecord {
  estimator::PipelineConfig config;
  Eigen::VectorXd truth;  ///< of config.parameters()
  Eigen::MatrixXd accel;  ///< instants x axes, m/s^2
};

/// Integrates the true building exactly at 1 ms. The ground is a Kanai-Tajimi motion of 2.5 Hz,
/// strong all the time, independent along x and y.
TallRecord tall_record(const TallTrial& trial);

/// Errors of the 5-s windows from `from_s` on, 5 s apart.
struct FewSensorsErrors {
  ErrorStatistics stiffness, damping;
  /// Published stiffnesses whose 95 % interval by the window's and the model's error together holds
  /// the truth.
  int held = 0;
  double held_ratio() const;
  void add(const FewSensorsErrors& other);
};
FewSensorsErrors few_sensors_errors(const TallRecord& record, double from_s = 20);

/// A row of the tables: several trials of one layout.
struct FewSensorsRow {
  std::string name;
  TallTrial trial;  ///< with seed 1; the others have the seeds after it
  FewSensorsErrors errors;
  /// Largest allowed median errors, relative; 0: no limit.
  double most_k = 0, most_c = 0;
  std::string must() const;
};
std::vector<FewSensorsRow> study_few_sensors(int seeds, const Workers& workers);
/// Runs buildings that the model does not describe, with sensors on few floors and on every floor.
std::vector<FewSensorsRow> study_wrong_models(int seeds, const Workers& workers);

}  // namespace framewatch::daemon
