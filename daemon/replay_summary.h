#pragma once

#include <string>
#include <vector>

#include "daemon/estimation.h"
#include "daemon/replay_survey.h"

namespace framewatch::daemon {

/// What replay prints at the end: counts, and each parameter over all its observable windows.
class ReplaySummary {
 public:
  explicit ReplaySummary(const ParameterTable& table);

  void add(const WindowEstimate& estimate);
  /// `work_s`: wall time the replay took.
  std::string text(const Estimation& estimation, const ReplaySurvey& survey, double work_s) const;
  std::string json(const Estimation& estimation, const ReplaySurvey& survey, double work_s) const;

 private:
  struct Quartiles {
    double q1, median, q3, observable_ratio;
  };
  Quartiles quartiles(std::size_t parameter) const;

  std::vector<std::string> names_, units_;
  std::vector<std::vector<double>> values_;  ///< [parameter]: observable ones
  std::int64_t windows_ = 0;
};

}  // namespace framewatch::daemon
