#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/whitened.h"

namespace framewatch {

/// How far things may be off that nobody measures exactly, one standard deviation.
struct Tolerances {
  double mass = 0.01;        ///< relative, of the mass at every degree of freedom
  double gain = 0.005;       ///< relative, of every axis
  double clock_s = 0.25e-3;  ///< of every axis
};

/// Which member of a model one unknown of a fit is.
struct Unknown {
  enum class Kind { theta, mass, gain, clock, knob, record_knob } kind;
  int index = 0;  ///< of theta, coordinate, axis; of the effect for knobs
  int knob = 0;
  int record = 0;
  double scale = 1;  ///< one unit of the unknown in the member
  double sigma = 0;  ///< of the prior, in units of the unknown; 0: none
  double centre = 0;
};

std::vector<Unknown> unknowns_of(const Plant& plant, const Model& model,
                                 const Tolerances& tolerances);
double value_of(const Model& model, const Unknown& unknown);
void set_value(Model& model, const Unknown& unknown, double value);

/// The whitened equations of all stretches around one model.
struct Linearised {
  std::vector<Unknown> unknowns;
  std::vector<Whitened> systems;         ///< of each stretch
  std::vector<Eigen::MatrixXd> columns;  ///< of each stretch: d(rows)/d(unknowns)
  /// Misfit over what noise explains, at least 1: a model that does not fit must not bend what is
  /// only tolerated, so the prior weighs as much more.
  double level = 1;
  Eigen::VectorXd prior, pull;  ///< level / (2 sigma^2); the same times (centre - value)
};

/// Of all stretches together, end terms eliminated, prior not included.
struct NormalEquations {
  Eigen::MatrixXd normal;
  Eigen::VectorXd gradient;  ///< columns' * rest
};

NormalEquations normal_equations(const Linearised& at);

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
  /// The model a step of the unknowns on, stiffnesses neither far nor below nothing.
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

/// What the unknowns change in a whitened stretch: rows x unknowns.
Eigen::MatrixXd columns_of(const Plant& plant, const Model& model, const Stretch& stretch,
                           std::size_t record, const Whitened& system,
                           const std::vector<Unknown>& unknowns, int ratio, bool through_run);

}  // namespace framewatch
