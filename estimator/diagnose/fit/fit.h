// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/fit_columns.h"
#include "estimator/diagnose/fit/search_settings.h"
#include "estimator/numeric/parallel.h"

namespace framewatch::estimator {

/// Misfit, relative to the misfit when the weights were computed, below which a large building's
/// weights are computed again. They take longer than a step.
inline constexpr double kNewWeights = 0.5;

struct FitOptions {
  Forcing forcing = Forcing::measured;
  int max_steps = 12;
  double tolerance = 0.3;  ///< converged when the cost falls by less than this
  /// Include derivatives of the free run's motion: exact if laws act strongly, but slower.
  bool through_run = false;
  /// Hold masses, gains and clocks, except those that are effects.
  bool holds_tolerated = false;
};

/// Returns options of an exact fit: free runs with their derivatives if the model has element laws.
FitOptions thorough(const Model& model, int max_steps);

struct FitResult {
  bool good = false;
  Model model;
  double cost = 0;                       ///< misfit and prior
  std::vector<double> misfit;            ///< of each segment
  std::vector<Eigen::MatrixXcd> motion;  ///< of each segment
  int steps = 0;

  double total_misfit() const;
};

/// Returns true if `fit` is good and `other` is worse or not good.
inline bool is_better(const FitResult& fit, const FitResult& other) {
  return fit.good && (!other.good || fit.cost < other.cost);
}

/// Fits models of one plant to several segments by Gauss-Newton (Levenberg-Marquardt) on the
/// whitened equations.
class Fitter {
 public:
  /// within: runs small tasks of a fit in parallel. Fits that run at the same time share it. Not
  /// counted as progress. settings: those of the search that uses the fitter.
  Fitter(const Plant& plant, const std::vector<RecordSegment>& segments,
         const Tolerances& tolerances, Parallel within = {}, const SearchSettings& settings = {});
  /// Returns a fitter of other segments. They must outlive it.
  Fitter with(const std::vector<RecordSegment>& segments) const {
    return Fitter(plant_, segments, tolerances_, within_, settings_);
  }

  FitResult fit(const Model& start, const std::vector<Eigen::MatrixXcd>& motion,
                const FitOptions& options) const;
  /// Returns the whitened equations of every segment, or an empty list if the model cannot be
  /// computed. `weights`: systems whose weights to use; null: compute the model's weights.
  /// `caches`, here and below: one for each segment, or one for all segments of a large building;
  /// null: no cache.
  std::vector<Whitened> systems(const Model& model, const std::vector<Eigen::MatrixXcd>& motion,
                                Forcing forcing, const std::vector<Whitened>* weights = nullptr,
                                std::vector<RunCache>* caches = nullptr) const;
  /// Linearises around `model`. systems: from systems() for the same model. options: which
  /// derivatives to include.
  Linearised linearise(const Model& model, std::vector<Whitened> systems,
                       const FitOptions& options = {},
                       std::vector<RunCache>* caches = nullptr) const;
  double prior_cost(const Model& model) const;
  /// Returns the model moved by a step of the unknowns, within their bounds. Shortens the step so
  /// that no stiffness changes by more than half of its design value.
  Model moved(const Model& model, const std::vector<Unknown>& unknowns,
              const Eigen::VectorXd& step) const;
  /// Returns the expected misfit of a segment if only noise is left: its degrees of freedom.
  double expected(std::size_t record, const Model& model) const;
  double expected(const Model& model) const;  ///< of all segments
  const Plant& plant() const { return plant_; }
  const std::vector<RecordSegment>& segments() const { return segments_; }
  const Tolerances& tolerances() const { return tolerances_; }
  const SearchSettings& settings() const { return settings_; }
  const Parallel& within() const { return within_; }
  /// Returns the steps per sample of a record for laws driven by measured motion, or for a model's
  /// free runs.
  int ratio(std::size_t record) const { return ratio_[record]; }
  int ratio(std::size_t record, const Model& model) const;

 private:
  /// Calls work(record) for every segment, one after the other for a large building.
  void of_all(const std::function<void(std::size_t)>& work) const;
  /// Computes the model's weights for systems() of the same model.
  std::vector<Whitened> reweighted(const Model& model, std::vector<Whitened> systems) const;

  const Plant& plant_;
  const std::vector<RecordSegment>& segments_;
  Tolerances tolerances_;
  SearchSettings settings_;
  Parallel within_;
  std::vector<int> ratio_;
};

}  // namespace framewatch::estimator
