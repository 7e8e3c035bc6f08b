#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/linearised.h"

namespace framewatch {

struct FitOptions {
  Forcing forcing = Forcing::measured;
  int max_steps = 12;
  double tolerance = 0.3;  ///< converged when the cost falls by less than this
  /// Derivatives go through the free run: exact where laws act strongly, dearer.
  bool through_run = false;
};

/// Free runs with derivatives through them, of a linear model its equations.
FitOptions thorough(const Model& model, int max_steps);

struct FitResult {
  bool good = false;
  Model model;
  double cost = 0;                       ///< misfit and prior
  std::vector<double> misfit;            ///< of each stretch
  std::vector<Eigen::MatrixXcd> motion;  ///< of each stretch
  int steps = 0;

  double total_misfit() const;
};

/// Laws act on the motion of the model's own free run, of a linear model there is nothing to run.
Forcing forcing_of(const Model& model);

/// Fits models of one plant to several stretches by Gauss-Newton (Levenberg-Marquardt) on the
/// whitened equations.
class Fitter {
 public:
  Fitter(const Plant& plant, const std::vector<Stretch>& stretches, const Tolerances& tolerances);

  FitResult fit(const Model& start, const std::vector<Eigen::MatrixXcd>& motion,
                const FitOptions& options) const;
  /// The equations of every stretch; empty when the model cannot be computed. weights: those of a
  /// linearisation, else the model's own.
  std::vector<Whitened> systems(const Model& model, const std::vector<Eigen::MatrixXcd>& motion,
                                Forcing forcing,
                                const std::vector<Whitened>* weights = nullptr) const;
  /// systems: of the model.
  Linearised linearise(const Model& model, std::vector<Whitened> systems,
                       bool through_run = false) const;
  double prior_cost(const Model& model) const;
  /// The model a step of the unknowns on, within their bounds and stiffnesses not far.
  Model moved(const Model& model, const std::vector<Unknown>& unknowns,
              const Eigen::VectorXd& step) const;
  /// Degrees of freedom of a stretch: what the misfit is when nothing but noise is left.
  double expected(std::size_t record, const Model& model) const;
  double expected(const Model& model) const;  ///< of all
  const Plant& plant() const { return plant_; }
  const std::vector<Stretch>& stretches() const { return stretches_; }
  const Tolerances& tolerances() const { return tolerances_; }
  int ratio(std::size_t record) const { return ratio_[record]; }

 private:
  /// Systems of the model with its own weights, laws as they acted.
  std::vector<Whitened> reweighted(const Model& model, const std::vector<Whitened>& systems) const;

  const Plant& plant_;
  const std::vector<Stretch>& stretches_;
  Tolerances tolerances_;
  std::vector<int> ratio_;
};

}  // namespace framewatch
