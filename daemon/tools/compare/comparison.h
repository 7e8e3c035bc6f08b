// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/tools/compare/compared_run.h"

namespace framewatch::daemon {

/// Limits beyond which a stiffness or a natural frequency is different.
struct DifferenceLimits {
  /// Least relative difference of a stiffness; 0: 3 % of a frame's and 20 % of a floor panel's,
  /// which are the least changes that [watch] announces.
  double ratio = 0;
  double errors = estimator::kChangeErrors;  ///< least difference in its standard errors

  /// kind: of a parameter_table_t.
  double least(int kind) const;
  /// Half the least difference of a frame: a frequency follows the root of the stiffness.
  double least_frequency() const;
};

/// A number of a later run against the same one of the first run.
struct Difference {
  double ratio = 0, std_error = 0;  ///< later over first - 1; NaN: one of them has no value
  bool judged = false;     ///< it has a limit, and a difference of twice the limit would show
  bool different = false;  ///< beyond both limits, and judged or not

  /// Returns the size in standard errors: infinite between two exact values that differ, 0 between
  /// equal ones.
  double errors() const;
};

/// A mode of the first run against the one of a later run that is most like it.
struct ModeDifference {
  int later = -1;                 ///< index in RunModes::modes of the later run; -1: none is alike
  Difference frequency, damping;  ///< damping has no limit
  double mac = 0;                 ///< of the shapes at all degrees of freedom; NaN without a pair
};

/// Amplification of the top floor over the base in two runs, by frequency.
struct TransferDifference {
  std::size_t first = 0, later = 0;          ///< index in ComparedRun::transfer() of each run
  std::vector<double> frequency_hz, errors;  ///< later less first, in standard errors; may be NaN
};

/// Runs side by side. The first one is what the others are compared with.
struct Comparison {
  std::vector<ComparedRun> runs;  ///< at least two, of the same building
  DifferenceLimits limits;
  std::vector<std::vector<Difference>> differences;       ///< [run - 1][parameter]
  std::vector<std::vector<ModeDifference>> modes;         ///< [run - 1][mode of the first run]
  std::vector<std::vector<Difference>> drifts;            ///< [run - 1][story - 1], without limits
  std::vector<std::vector<TransferDifference>> transfer;  ///< [run - 1]
  std::vector<std::string> notes;
  ReportAbout about;

  bool different() const;  ///< a stiffness or a natural frequency of some later run
  bool judged() const;     ///< some stiffness of every later run could be judged
  /// Returns the modes of the first run that it measured, or whose difference from some later run
  /// is known within 5 %.
  std::vector<std::size_t> known_modes() const;
};

/// Returns why two runs are not of the same building; "" if they are: same stories, frames, groups,
/// heights and spans. Masses and names may differ.
std::string why_unlike(const ComparedRun& a, const ComparedRun& b);

/// Compares runs of one building.
Comparison compare_runs(std::vector<ComparedRun> runs, const DifferenceLimits& limits);

/// Returns the relative standard error of a transfer function's absolute value. segments: of a Hann
/// window that overlap by half. NaN below two segments or without coherence.
double transfer_error(double coherence, int segments);

/// Returns the peak drift of a story, mm; NaN if the run does not show it.
estimator::WindowMean drift_mm(const ComparedRun& run, int story);

/// Returns the verdict: for each later run a sentence about stiffness and, if both runs have modes,
/// one about natural frequencies.
std::vector<std::string> verdict_sentences(const Comparison& comparison);

/// Returns the pictures of the page, with stable names.
std::vector<Picture> comparison_pictures(const Comparison& comparison);
/// Returns the whole page.
std::string comparison_html(const Comparison& comparison);
/// Returns JSON of schema framewatch.compare/1 (docs/formats.md).
std::string comparison_json(const Comparison& comparison);
/// Returns the verdict and the tables as text for a terminal.
std::string comparison_text(const Comparison& comparison);

}  // namespace framewatch::daemon
