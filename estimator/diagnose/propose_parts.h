#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/propose.h"

namespace framewatch {

/// The signal that a place needs, with its noise: what any law there has to explain.
struct Needed {
  Eigen::VectorXcd force;    ///< per bin
  Eigen::VectorXd weight;    ///< 1 / variance of it
  Eigen::VectorXcd d;        ///< deformation of the element, or displacement of the node, m
  Eigen::VectorXd d_t, v_t;  ///< in time, fine
};

/// Knobs of a fit: of any size, positive, between limits.
Knob linear_knob(double value, double step);
Knob logarithmic_knob(double value, double low, double high);
Knob bounded_knob(double value, double step, double low, double high, bool free = true);

/// Columns of a linear element with the needed deformation: its spring, its damper.
std::vector<Eigen::VectorXcd> linear_columns(const Needed& needed, const Eigen::VectorXd& w);

/// Weighted least squares of the needed force on complex columns with real coefficients; the last
/// is the law's.
struct ScalarFit {
  double misfit = 1e300;
  Eigen::VectorXd coefficients;
};

/// What one record says about the coefficients; of several they add up.
struct ScalarSums {
  Eigen::MatrixXd normal;
  Eigen::VectorXd right;
  double total = 0;  ///< misfit of no column

  ScalarSums& operator+=(const ScalarSums& more);
  ScalarFit fit() const;
};

ScalarSums scalar_sums(const Needed& needed, const std::vector<Eigen::VectorXcd>& columns);
ScalarFit scalar_fit(const std::vector<Needed>& needed,
                     const std::vector<std::vector<Eigen::VectorXcd>>& columns);

/// The signal that the first suspect of a localisation needs, of every stretch.
std::vector<Needed> needed_of(const Fitter& fitter, const Localisation& place);

/// Columns of one record for an element: those of a linear one, and that of a law on the motion
/// that is needed.
std::vector<Eigen::VectorXcd> columns_with(const ModelEffect& effect, const Fitter& fitter,
                                           const std::vector<Needed>& needed, std::size_t record);

/// Every law of an element.
std::vector<Proposal> element_proposals(const Fitter& fitter, const Localisation& place,
                                        const std::vector<Needed>& needed, int element);
/// Since when a stiffness is another one and how long it took to become so, in every record: those
/// two of an effect of the form `changing`, its amplitude shared by the records.
ModelEffect timed_change(const Fitter& fitter, const std::vector<Needed>& needed,
                         ModelEffect effect, bool sudden);
/// A hidden oscillator, and forces from outside.
void add_node_proposals(const Fitter& fitter, const Localisation& place,
                        const std::vector<Needed>& needed, const EffectPlace& node,
                        std::vector<Proposal>& out);
/// What may be wrong with an axis.
void add_axis_proposals(const Fitter& fitter, const Localisation& place,
                        std::vector<Proposal>& out);

}  // namespace framewatch
