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

ScalarFit scalar_fit(const std::vector<Needed>& needed,
                     const std::vector<std::vector<Eigen::VectorXcd>>& columns);

/// The signal that the first suspect of a localisation needs, of every stretch.
std::vector<Needed> needed_of(const Fitter& fitter, const Localisation& place);

/// Every law of an element.
std::vector<Proposal> element_proposals(const Fitter& fitter, const Localisation& place,
                                        const std::vector<Needed>& needed, int element);
/// A hidden oscillator, and forces from outside.
void add_node_proposals(const Fitter& fitter, const Localisation& place,
                        const std::vector<Needed>& needed, const EffectPlace& node,
                        std::vector<Proposal>& out);
/// What may be wrong with an axis.
void add_axis_proposals(const Fitter& fitter, const Localisation& place,
                        std::vector<Proposal>& out);

}  // namespace framewatch
