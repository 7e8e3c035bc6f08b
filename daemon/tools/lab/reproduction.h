#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "daemon/base/workers.h"
#include "daemon/tools/lab/accuracy_study.h"
#include "daemon/tools/lab/excitation_study.h"
#include "daemon/tools/lab/few_sensors.h"
#include "daemon/tools/lab/noise_sweep.h"
#include "daemon/tools/lab/table_test.h"

namespace framewatch::daemon {

/// One building of the paper: its figure without noise, and its rows of the accuracy table.
struct BuildingReproduction {
  std::string group;  ///< table1, table2b, table2c, table2d
  std::string title;
  estimator::ParameterTable table;
  Eigen::VectorXd truth;
  Eigen::VectorXd paper;    ///< 10 s without noise; P1 (21) on exact a, v and d
  Eigen::VectorXd matched;  ///< likewise; ours on accelerations, last 5 s
  ErrorsByKind exact;       ///< ours without noise on seeded motions
  std::vector<AccuracyRow> rows;
};

/// Results of the "noise" case beside Figure 6.
struct Robustness {
  std::vector<ExcitationSweep> sweeps;
  std::vector<Silence> silences;
  double change_by_bias = 0;
  std::optional<AccuracyRow> random_buildings;
};

/// All results of `framewatch reproduce`; cases that were not requested are empty.
struct Reproduction {
  int seeds = 0;
  std::string hachinohe, el_centro;  ///< what stands for the paper's motions, in words
  std::vector<BuildingReproduction> buildings;
  std::optional<NoiseSweep> noise, denoise;
  std::optional<Robustness> robustness;
  std::vector<FewSensorsRow> few_sensors, wrong_models;
  std::vector<TableTest> tables;
  bool motions_missing = false;         ///< seeded ones stand in for at least one
  bool measured_table_missing = false;  ///< asked for and not there
};

/// Names of --case, in the order of the report.
const std::vector<std::string>& reproduction_cases();

/// only: one of reproduction_cases(), or empty for all. data: folder with the paper's motions and
/// the measured table; where it lacks them seeded motions stand in, and the results say so.
Reproduction reproduce_paper(const std::string& only, int seeds, const std::string& data,
                             const Workers& workers);

/// A promise of the accuracy table and whether it was kept.
struct Promise {
  std::string what;
  std::string measured;
  bool kept;
};
/// Of everything in `all`; empty with fewer than 20 seeds, which judge nothing.
std::vector<Promise> promises(const Reproduction& all);
inline constexpr int kSeedsToJudge = 20;

}  // namespace framewatch::daemon
