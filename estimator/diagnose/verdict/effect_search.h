#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "estimator/diagnose/locate/locate.h"
#include "estimator/diagnose/trials/trial_context.h"
#include "estimator/diagnose/verdict/diagnosis.h"
#include "estimator/diagnose/verdict/search_progress.h"

namespace framewatch::estimator {

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
  TrialContext context_of(const FitResult& now) const;
  /// Returns Localisation::ratio of the likeliest place in the last round.
  double alone() const { return alone_; }

 private:
  void search_with_free_damping(FitResult& now);
  void look_ahead(FitResult& now);
  void choose_laws_again(FitResult& now);
  void colour_by_place(FitResult& now, Located& located);
  void fit_with_corner(double corner_hz, FitResult& now);
  bool holds(const TrialContext& context, double bound, double needed, std::vector<Trial>& trials);
  bool find_beside_at(const Trial& lead, FitResult& now);
  bool explains_beside(const Trial& lead, FitResult& now);
  bool one_round(FitResult& now, std::size_t round);
  std::vector<Trial> trials_of(const FitResult& now, const Located& located, std::size_t round,
                               bool small, bool& holds);
  bool adopt_held(const std::vector<Trial>& trials, FitResult& now);
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
};

}  // namespace framewatch::estimator
