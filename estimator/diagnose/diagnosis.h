#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/gap.h"
#include "estimator/diagnose/propose.h"

namespace framewatch {

enum class Verdict { adequate, explained, partly_explained, unexplained };
const char* verdict_word(Verdict verdict);

/// A candidate that was fitted to the end.
struct Trial {
  EffectKind kind = EffectKind::cubic_stiffness;
  EffectPlace place;
  double cost = 0;      ///< misfit of the free run over all records, with the prior
  double fraction = 0;  ///< of the misfit beyond noise that it takes away
  std::vector<double> misfit;
  Model model;
  /// A second effect that was found together with it.
  std::optional<std::pair<EffectKind, EffectPlace>> second;
};

/// One effect that was added.
struct FoundEffect {
  Trial chosen;
  std::vector<Trial> alternatives;  ///< best first
  std::vector<EffectKind> like;     ///< names that the data do not tell from it
  double confidence = 0;
  double before = 0, after = 0;   ///< held-out free-run NRMSE
  int index = -1;                 ///< in the model's effects; -1: of an axis
  std::vector<double> std_error;  ///< of the catalogue's parameters; 0: not known
};

struct WhereEntry {
  EffectPlace place;
  double ratio = 0;  ///< what is left if this place may do anything, 1: noise
  double from_s = 0, to_s = 0, low_hz = 0, high_hz = 0;  ///< where nine tenths of its force are
};

struct Diagnosis {
  Verdict verdict = Verdict::unexplained;
  std::string reason;
  Model linear, model;
  std::vector<Gap> before, after;  ///< of each stretch
  std::vector<FoundEffect> effects;
  std::vector<WhereEntry> where;
  std::vector<Trial> rejected;               ///< best of what did not earn its place
  double ratio_before = 0, ratio_after = 0;  ///< misfit over what noise explains
};

struct DiagnosisOptions {
  Tolerances tolerances;
  int rounds = 3;
  std::size_t holdout_from = 1;  ///< first stretch that is held out
  /// Told what is going on, and a share of the whole between 0 and 1.
  std::function<void(const std::string&, double)> progress;
};

/// The whole method of docs/diagnosis.md on stretches of one building. Deterministic.
Diagnosis diagnose(const Plant& plant, const std::vector<Stretch>& stretches,
                   const DiagnosisOptions& options);

}  // namespace framewatch
