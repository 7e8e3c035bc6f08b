#pragma once

#include <limits>
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
  double low = -std::numeric_limits<double>::infinity();  ///< bounds, in units of the unknown
  double high = std::numeric_limits<double>::infinity();
};

std::vector<Unknown> unknowns_of(const Plant& plant, const Model& model,
                                 const Tolerances& tolerances);
double value_of(const Model& model, const Unknown& unknown);
/// Within the unknown's bounds.
void set_value(Model& model, const Unknown& unknown, double value);

/// The whitened equations of all stretches around one model.
struct Linearised {
  std::vector<Unknown> unknowns;
  std::vector<Whitened> systems;   ///< of each stretch
  std::vector<RowMatrix> columns;  ///< of each stretch: d(rows)/d(unknowns)
  /// Misfit over what noise explains, at least 1: a model that does not fit must not bend what is
  /// only tolerated, so the prior weighs as much more.
  double level = 1;
  Eigen::VectorXd prior, pull;  ///< level / (2 sigma^2); the same times (centre - value)
};

/// What the unknowns change in a whitened stretch: rows x unknowns.
RowMatrix columns_of(const Plant& plant, const Model& model, const Stretch& stretch,
                     std::size_t record, const Whitened& system,
                     const std::vector<Unknown>& unknowns, int ratio, bool through_run);

/// Rows of one bin: some unknowns and the residual.
void put_rows(const Linearised& at, std::size_t record, const std::vector<Eigen::Index>& kept,
              Eigen::Index bin, Eigen::Block<RowMatrix> out);
/// Squares and products of some unknowns, the residual and the end terms, in this order.
Eigen::MatrixXd square_of(const Linearised& at, std::size_t record,
                          const std::vector<Eigen::Index>& kept);

/// Of unknowns, end terms eliminated, prior not included.
struct NormalEquations {
  Eigen::MatrixXd normal;
  Eigen::VectorXd gradient;  ///< columns' * rest
  double misfit = 0;         ///< rest' * rest

  NormalEquations& operator+=(const NormalEquations& other);
};

/// Solves normal * step = right within bounds: unknowns that would leave them go as far as they
/// may, the others make the best of that. Not finite when there is no solution.
Eigen::VectorXd bounded_step(const Eigen::MatrixXd& normal, const Eigen::VectorXd& right,
                             const Model& model, const std::vector<Unknown>& unknowns);

/// square: as square_of() gives it; ends: how many end terms.
NormalEquations without_ends(const Eigen::MatrixXd& square, Eigen::Index ends);
/// Of all stretches together.
NormalEquations normal_equations(const Linearised& at);

}  // namespace framewatch
