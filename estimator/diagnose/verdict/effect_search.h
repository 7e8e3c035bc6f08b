// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "estimator/diagnose/locate/locate.h"
#include "estimator/diagnose/trials/trial.h"
#include "estimator/diagnose/verdict/diagnosis.h"
#include "estimator/numeric/parallel.h"

namespace framewatch::estimator {

/// Thrown by a piece of work when the search is over.
struct SearchOver {};

/// Returns `parallel`, whose pieces throw SearchOver once `is_over` returns true.
Parallel until_over(std::function<bool()> is_over, Parallel parallel);

/// Parts of a search, in their order.
enum class SearchPart { labels, single, two_at_once, free_damping, rivals, several, redundant };

/// Returns what `part` and the parts after it would have done, the first one in part.
std::vector<std::string> parts_not_done(SearchPart part);

/// Shares of the search at which a round starts to locate, starts to fit laws, and ends.
struct RoundShares {
  double where, trials, end;

  /// Returns the share at which laws start if pairs of places are tried first.
  double laws() const { return trials + 0.3 * (end - trials); }
};
inline constexpr RoundShares kRounds[] = {{0.05, 0.15, 0.5}, {0.5, 0.57, 0.7}, {0.7, 0.72, 0.75}};

/// Reports the progress of a search. Stages have fixed shares of the whole, and so does parallel
/// work within a stage. The shares assume a search through all stages, so a shorter search ends
/// early.
class SearchProgress {
 public:
  /// report: empty: reports nothing.
  SearchProgress(ReportProgress report, Parallel parallel);
  SearchProgress(const SearchProgress&) = delete;
  SearchProgress& operator=(const SearchProgress&) = delete;

  /// Starts a stage that covers the shares `from` to `to`, but not below the share already reached.
  /// calls: shares of the stage for its calls of counted(), one after the other; each further call
  /// gets half of the rest.
  void begin(const std::string& what, double from, double to, std::vector<double> calls = {});
  /// Reports the current work of the stage.
  void describe(const std::string& what);
  /// Returns `parallel` with progress reports. Must not outlive this object.
  Parallel counted();

 private:
  void run(int count, const std::function<void(int)>& work);
  void report(double then) const;

  ReportProgress report_;
  Parallel parallel_;
  std::string what_;
  double from_ = 0, to_ = 0, done_ = 0;
  std::vector<double> calls_;
  std::size_t call_ = 0;
};

/// Searches for effects, one or two per round, and adds them to a diagnosis and to a fit. All
/// arguments of the constructor must outlive it.
class EffectSearch {
 public:
  /// segments: those of the fitter; the search sets their noise corner frequency. options: its
  /// `parallel` reports progress.
  EffectSearch(const Fitter& fitter, std::vector<RecordSegment>& segments,
               const DiagnosisOptions& options, SearchProgress& progress, Diagnosis& out)
      : fitter_(fitter), segments_(segments), options_(options), progress_(progress), out_(out) {}

  /// Searches until nothing more is found. now: the model that is extended.
  void run(FitResult& now);
  /// Searches for further effects, from round `first` on.
  void rounds(FitResult& now, std::size_t first);
  /// Adds the effect, or both, of the first of the trials. trials: best first.
  void adopt(const std::vector<Trial>& trials, FitResult& now);
  /// Fits what is not an effect: the form of the damping and the corner frequency of the noise.
  void complete(FitResult& now);
  void set_linear(const FitResult& now) {
    out_.linear = now.model;
    out_.ratio_before = ratio(now);
  }
  /// Limits the confidence in every effect to kDoubtful.
  void doubt_all() {
    for (FoundEffect& e : out_.effects) e.confidence = std::min(e.confidence, kDoubtful);
  }
  double ratio(const FitResult& now) const;  ///< misfit over its expectation
  TrialContext context_of(const FitResult& now);
  /// Returns Localisation::ratio of the likeliest place in the last round.
  double alone() const { return alone_; }

  /// Begins a part of the search.
  void begin_part(SearchPart part) { part_ = part; }
  /// Keeps the present state: end_early() returns to it.
  void keep(const FitResult& now);
  /// Returns to the state that was kept last because the search is over. Says in the diagnosis what
  /// was not done, doubts every name, and keeps the trials of the present round as rejected if
  /// nothing is named.
  void end_early(FitResult& now);

 private:
  void search_with_free_damping(FitResult& now);
  void look_ahead(FitResult& now);
  void replace_laws(FitResult& now);
  void set_noise_by_place(FitResult& now, Located& located);
  void fit_with_corner(double corner_hz, FitResult& now);
  bool accepts(const TrialContext& context, double bound, double needed,
               std::vector<Trial>& trials);
  bool find_second_law_at(const Trial& lead, FitResult& now);
  bool explains_with_second(const Trial& lead, FitResult& now);
  bool one_round(FitResult& now, std::size_t round);
  std::vector<Trial> trials_of(const FitResult& now, const Located& located, std::size_t round,
                               bool small, bool& found);
  bool adopt_accepted(const std::vector<Trial>& trials, FitResult& now);
  bool find_mass(FitResult& now, const Located& located);
  void withdraw(FitResult& now, std::size_t first);

  const Fitter& fitter_;
  std::vector<RecordSegment>& segments_;
  const DiagnosisOptions& options_;
  SearchProgress& progress_;
  Diagnosis& out_;
  double to_beat_ = 1e300;  ///< alone() of another search
  double alone_ = 0;
  bool by_place_ = false;   ///< the noise's corner frequency was estimated at a place, not from the
                            ///< model's residual
  double before_lead_ = 0;  ///< cost before a law that is assumed provisionally; 0: no such law

  /// A state to which the search can return.
  struct Kept {
    Diagnosis out;
    FitResult now;
    double corner_hz;
  };
  std::optional<Kept> kept_;
  bool provisional_ = false;   ///< the present state may be given up again
  std::vector<Trial> fitted_;  ///< of the present round
  SearchPart part_ = SearchPart::labels;
};

}  // namespace framewatch::estimator
