// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/model/model.h"
#include "estimator/numeric/complex.h"

namespace framewatch::estimator {

/// Returns the motion of a mass on a spring (LawForm::resonator) over that of its support. w:
/// rad/s.
Complex transmissibility(const ModelEffect& resonator, double w);

/// Change of the operation D(w) on the axes' motion by a linear effect (docs/equations.md 31):
/// constant real matrices times complex factors.
class LinearOperation {
 public:
  /// effect: not an element law. Errors of axes and external forces add nothing.
  LinearOperation(const Plant& plant, const Model& model, const ModelEffect& effect);

  /// Returns the change: equations x axes. w: rad/s.
  Eigen::MatrixXcd at(double w) const;
  void add_to(double w, Eigen::MatrixXcd& operation) const;
  /// Adds the operation, or its adjoint, times the column of every frequency. motion: axes x
  /// frequencies, or equations x frequencies for the adjoint.
  void add_times(const Eigen::VectorXd& w, const Eigen::MatrixXcd& motion, bool adjoint,
                 Eigen::MatrixXcd& out) const;

 private:
  struct Shape {
    /// 1, -1/w^2, 1/(jw), and the transmissibility of a resonator.
    enum class Factor { inertia, stiffness, damping, resonance } factor;
    Eigen::MatrixXd of_axes;
  };

  Complex factor(Shape::Factor of, double w) const;

  Eigen::Index rows_, cols_;
  std::vector<Shape> shapes_;
  ModelEffect effect_;
};

}  // namespace framewatch::estimator
