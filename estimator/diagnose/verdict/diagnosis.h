// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/gap.h"
#include "estimator/diagnose/fit/search_settings.h"
#include "estimator/diagnose/fit/unknowns.h"
#include "estimator/diagnose/locate/locate.h"
#include "estimator/diagnose/propose/law_kind.h"
#include "estimator/diagnose/trials/found_effect.h"
#include "estimator/diagnose/verdict/place_force.h"
#include "estimator/diagnose/verdict/residual.h"
#include "estimator/numeric/parallel.h"

namespace framewatch::estimator {

enum class Verdict { adequate, explained, partly_explained, unexplained };

struct WhereEntry {
  EffectPlace place;
  double ratio =
      0;  ///< Localisation::ratio: misfit with an arbitrary signal here; 1: only noise is left
  /// Time and frequency span of nine tenths of the needed signal, in the segment `record`; 0, 0:
  /// unknown.
  std::size_t record = 0;
  double from_s = 0, to_s = 0, low_hz = 0, high_hz = 0;
  double peak = 0;                ///< of that signal: N; for an axis m/s^2
  std::optional<KindOfLaw> kind;  ///< of the likeliest element, and of a floor that needs a law
};

/// The best of the laws that were tried and not named. Fitted to the training records, its free run
/// has a smaller gap in every record than the model without it.
struct LeadingLaw {
  Trial trial;
  double before = 0, after = 0;  ///< held-out gap without and with it
};

/// Pictures and numbers that let a reader check a diagnosis. They describe the held-out records, or
/// all records if none is held out.
struct Evidence {
  /// Forces at the named element laws; at the likeliest element if no law is named and something
  /// is left. They are of the last record.
  std::vector<PlaceForce> forces;
  ResidualSpectrum spectrum;
  std::vector<FloorGap> floors;
  ResidualCorrelation correlation;
};

struct Diagnosis {
  Verdict verdict = Verdict::unexplained;
  std::string reason;
  Model linear, model;  ///< fitted to all segments
  /// From declared_model(): values for a configuration file.
  Model declared;
  /// Fitted to the training segments alone, if several causes were chosen by it.
  std::optional<Model> trained;
  std::vector<Gap> before,
      after;  ///< of each segment, for models fitted to the training segments alone
  Model before_model, after_model;  ///< those of `before` and `after`
  /// The training segments alone do not determine the effects, so `after` is that of `model`.
  bool after_of_all = false;
  /// The parts that were not done, or only in part, because the time was over (is_over). If parts
  /// of the search are among them, no name is more likely right than wrong.
  std::vector<std::string> not_done;
  SearchSettings settings;                   ///< with which it was made
  std::vector<FoundEffect> known;            ///< effects of the configuration, fitted again
  std::vector<FoundEffect> effects;          ///< found, in their order
  std::vector<WhereEntry> where;             ///< the likeliest places, best first
  std::vector<WhereEntry> map;               ///< every place, without the signal
  std::vector<Trial> rejected;               ///< trials of the last round, if none was adopted
  std::vector<LeadingLaw> leading;           ///< if no effect was named, best first
  double ratio_before = 0, ratio_after = 0;  ///< misfit over its expectation
  double noise_corner_hz = 0;                ///< RecordSegment::corner_hz; 0: the noise is white
  /// That corner is what makes the residual at one place look like noise.
  bool noise_by_place = false;
  Evidence evidence;
};

/// Reports progress. what: the current work; done: share of the whole that is done, 0 to 1; then:
/// share when the work that begins now is done.
using ReportProgress = std::function<void(const std::string& what, double done, double then)>;

/// Share of the time after which a search ends: the models, errors and gaps of a large building
/// take about a third of a whole diagnosis.
inline constexpr double kSearchShare = 0.7;

struct DiagnosisOptions {
  Tolerances tolerances;
  SearchSettings settings;
  int rounds = 3;
  std::size_t holdout_from = 1;     ///< first segment that is held out
  std::vector<Effect> known;        ///< effects that the building is known to have
  std::vector<EffectKind> without;  ///< excluded names
  Parallel parallel;                ///< the result does not depend on it
  Parallel within;          ///< for the pieces of one call of `parallel`, and between its calls
  ReportProgress progress;  ///< between the calls of `parallel`
  /// Returns true once this share of the time for the diagnosis has passed. Asked before every
  /// piece of parallel work, by several threads at once. The search ends at kSearchShare with what
  /// it has found. At 1, models and gaps are left as the search fitted them. Empty: no limit.
  std::function<bool(double share)> is_over;
};

/// Describes the signal that each place needs: its time, frequencies and size. For the first
/// element and the first floor among the best three, also the kind of force.
std::vector<WhereEntry> where_of(const Fitter& fitter, const std::vector<Localisation>& places);

/// Returns every place, best first. Uses the iterated localization of a place if there is one,
/// otherwise the one after one step.
std::vector<WhereEntry> map_of(const Located& located);

}  // namespace framewatch::estimator
