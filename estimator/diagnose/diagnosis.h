#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/gap.h"
#include "estimator/diagnose/parallel.h"
#include "estimator/diagnose/propose.h"

namespace framewatch {

enum class Verdict { adequate, explained, partly_explained, unexplained };
const char* verdict_word(Verdict verdict);

/// How far a candidate came.
enum class Fate {
  fitted,     ///< to the end, as a free run
  outrun,     ///< not run: others of its place were better when the measured motion drove the law
  ran_away,   ///< its free run came to no end
  other_law,  ///< its values make another law of it, or a name that must not be given
};

/// A candidate. Only one that was fitted to the end is ever chosen; the cost of `outrun` and
/// `ran_away` is that under the measured motion.
struct Trial {
  Fate fate = Fate::fitted;
  EffectKind kind = EffectKind::cubic_stiffness;
  EffectPlace place;
  double cost = 0;      ///< misfit of the free run over all records, with the prior
  double fraction = 0;  ///< of the misfit beyond noise that it takes away
  std::vector<double> misfit;
  Model model;
  /// A second effect that was found together with it.
  std::optional<std::pair<EffectKind, EffectPlace>> second;
};

/// One effect of the model.
struct FoundEffect {
  Trial chosen;
  std::vector<Trial> alternatives;  ///< best first
  std::vector<EffectKind> like;     ///< names that the data do not tell from it
  double confidence = 0;            ///< 0 to 1 in the name
  /// More than noise is left: what acts is not quite it, or something else acts besides.
  bool approximate = false;
  double before = 0, after = 0;   ///< held-out free-run NRMSE
  int index = -1;                 ///< in the model's effects; -1: of an axis
  std::vector<double> ramp_mps3;  ///< bias_drift: slope in every stretch
  std::vector<double> ramp_from_s;
  std::vector<double> std_error;  ///< of the catalogue's parameters; 0: not known
};

struct WhereEntry {
  EffectPlace place;
  double ratio = 0;  ///< what is left if this place may do anything, 1: noise
  /// Where nine tenths of the signal that it needs are, of the stretch `record`; 0, 0: not known.
  std::size_t record = 0;
  double from_s = 0, to_s = 0, low_hz = 0, high_hz = 0;
  double peak = 0;  ///< of that signal: N, of an axis m/s^2
};

struct Diagnosis {
  Verdict verdict = Verdict::unexplained;
  std::string reason;
  Model linear, model;  ///< fitted to all stretches
  /// The same with masses, gains and clocks as they are declared, but for those that are effects:
  /// what a file can say, and what simulates the declared building.
  Model declared;
  std::vector<Gap> before, after;  ///< of each stretch, models fitted to the training ones alone
  /// The training stretches alone do not determine the effects: `after` is of `model`.
  bool after_of_all = false;
  std::vector<FoundEffect> known;            ///< that the configuration has, fitted again
  std::vector<FoundEffect> effects;          ///< that were found, in their order
  std::vector<WhereEntry> where;             ///< the likeliest places, best first
  std::vector<WhereEntry> map;               ///< what is left of every place, without the signal
  std::vector<Trial> rejected;               ///< best of what did not earn its place
  double ratio_before = 0, ratio_after = 0;  ///< misfit over what noise explains
};

struct DiagnosisOptions {
  Tolerances tolerances;
  int rounds = 3;
  std::size_t holdout_from = 1;     ///< first stretch that is held out
  std::vector<Effect> known;        ///< effects that the building is known to have
  std::vector<EffectKind> without;  ///< names that are never given
  Parallel parallel;                ///< the result does not depend on it
  /// Told what is going on, and a share of the whole between 0 and 1.
  std::function<void(const std::string&, double)> progress;
};

/// Stiffness and damping of the linear model that fits best, theta order; empty when none does.
Eigen::VectorXd fitted_linear(const Plant& plant, const std::vector<Stretch>& stretches,
                              const Tolerances& tolerances);

/// The whole method of docs/diagnosis.md on stretches of one building. Deterministic.
Diagnosis diagnose(const Plant& plant, const std::vector<Stretch>& stretches,
                   const DiagnosisOptions& options);

}  // namespace framewatch
