// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "daemon/base/workers.h"
#include "daemon/tools/lab/accuracy_study.h"
#include "daemon/tools/lab/excitation_study.h"
#include "daemon/tools/lab/few_sensors.h"
#include "daemon/tools/lab/table_test.h"

namespace framewatch::daemon {

/// One building of the paper: its figure without noise, and its rows of the accuracy table.
struct BuildingReproduction {
  std::string group;  ///< table1, table2b, table2c, table2d
  std::string title;
  estimator::ParameterTable table;
  Eigen::VectorXd truth;
  Eigen::VectorXd paper;    ///< 10 s without noise; P1 (21) on exact a, v and d
  Eigen::VectorXd matched;  ///< 10 s without noise; framewatch on accelerations, last 5 s
  ErrorsByKind exact;       ///< framewatch without noise on seeded motions
  std::vector<AccuracyRow> rows;
};

/// Results of the "noise" case other than Figure 6.
struct Robustness {
  std::vector<ExcitationSweep> sweeps;
  std::vector<Silence> silences;
  double change_by_bias = 0;
  std::optional<AccuracyRow> random_buildings;
};

/// All results of `framewatch reproduce`; cases that were not requested are empty.
struct Reproduction {
  int seeds = 0;
  std::string hachinohe, el_centro;  ///< names of the motions used for the paper's
  std::vector<BuildingReproduction> buildings;
  std::optional<NoiseSweep> noise, denoise;
  std::optional<Robustness> robustness;
  std::vector<FewSensorsRow> few_sensors, wrong_models;
  std::vector<TableTest> tables;
  bool motions_missing = false;         ///< a seeded motion replaces at least one
  bool measured_table_missing = false;  ///< requested, but not in the data folder
};

/// Names of --case, in the order of the report.
const std::vector<std::string>& reproduction_cases();

/// Runs the studies. only: one of reproduction_cases(), or empty for all. data: folder with the
/// paper's motions and the measured table. Seeded motions replace missing ones, and the results
/// name them.
Reproduction reproduce_paper(const std::string& only, int seeds, const std::string& data,
                             const Workers& workers);

/// A limit on the accuracy, and whether it was kept.
struct Promise {
  std::string what;
  std::string measured;
  bool kept;
};
/// Judges everything in `all`. Returns an empty vector with fewer than kSeedsToJudge seeds.
std::vector<Promise> promises(const Reproduction& all);
inline constexpr int kSeedsToJudge = 20;

}  // namespace framewatch::daemon
