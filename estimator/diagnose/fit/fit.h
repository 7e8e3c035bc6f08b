#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/linearised.h"
#include "estimator/numeric/parallel.h"

namespace framewatch::estimator {

/// Misfit, over that when the weights were those of the model, below which a large building's are
/// made anew: they take longer than a step.
inline constexpr double kNewWeights = 0.5;

struct FitOptions {
  Forcing forcing = Forcing::measured;
  int max_steps = 12;
  double tolerance = 0.3;  ///< converged when the cost falls by less than this
  /// Derivatives include those of the free run's motion: exact where laws act strongly, but slower.
  bool through_run = false;
  /// Masses, gains and clocks stay where they are but for those that are effects.
  bool holds_tolerated = false;
};

/// Options of an exact fit: free runs with their derivatives where the model has element laws.
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

/// Whether a fit is good, and of less cost than the other one or that is none.
inline bool is_better(const FitResult& fit, const FitResult& other) {
  return fit.good && (!other.good || fit.cost < other.cost);
}

/// Fits models of one plant to several segments by Gauss-Newton (Levenberg-Marquardt) on the
/// whitened equations.
class Fitter {
 public:
  /// within: called by fits, several at once: for small pieces of work that nobody counts.
  Fitter(const Plant& plant, const std::vector<RecordSegment>& segments,
         const Tolerances& tolerances, Parallel within = {});
  /// The same of other segments, which must outlive it.
  Fitter with(const std::vector<RecordSegment>& segments) const {
    return Fitter(plant_, segments, tolerances_, within_);
  }

  FitResult fit(const Model& start, const std::vector<Eigen::MatrixXcd>& motion,
                const FitOptions& options) const;
  /// The whitened equations of every segment; empty when the model cannot be computed.
  /// weights: systems whose weights are used; null: the model's own. caches: of every segment, or
  /// one for all of a large building, here and below; null: none.
  std::vector<Whitened> systems(const Model& model, const std::vector<Eigen::MatrixXcd>& motion,
                                Forcing forcing, const std::vector<Whitened>* weights = nullptr,
                                std::vector<RunCache>* caches = nullptr) const;
  /// systems: those of systems() for the same model. options: which derivatives.
  Linearised linearise(const Model& model, std::vector<Whitened> systems,
                       const FitOptions& options = {},
                       std::vector<RunCache>* caches = nullptr) const;
  double prior_cost(const Model& model) const;
  /// The model moved by a step of the unknowns, within their bounds; shortened so that no stiffness
  /// changes by more than half of its design.
  Model moved(const Model& model, const std::vector<Unknown>& unknowns,
              const Eigen::VectorXd& step) const;
  /// Expected misfit of a segment when only noise is left: its degrees of freedom.
  double expected(std::size_t record, const Model& model) const;
  double expected(const Model& model) const;  ///< of all segments
  const Plant& plant() const { return plant_; }
  const std::vector<RecordSegment>& segments() const { return segments_; }
  const Tolerances& tolerances() const { return tolerances_; }
  const Parallel& within() const { return within_; }
  /// Steps per sample of a record: in which measured motion drives laws, and of a model's runs.
  int ratio(std::size_t record) const { return ratio_[record]; }
  int ratio(std::size_t record, const Model& model) const;

 private:
  /// Calls work(record) for every segment: those of a large building one after the other.
  void of_all(const std::function<void(std::size_t)>& work) const;
  /// systems() of the same model with its own weights.
  std::vector<Whitened> reweighted(const Model& model, std::vector<Whitened> systems) const;

  const Plant& plant_;
  const std::vector<RecordSegment>& segments_;
  Tolerances tolerances_;
  Parallel within_;
  std::vector<int> ratio_;
};

}  // namespace framewatch::estimator
