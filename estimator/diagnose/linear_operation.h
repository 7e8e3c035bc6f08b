#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/model.h"
#include "estimator/structure/complex.h"

namespace framewatch {

/// What a mass on a spring (LawForm::resonator) passes on of the motion of where it stands.
Complex passed_on(const ModelEffect& resonator, double w);

/// What a linear effect adds to the operation D(w) on the axes' motion (docs/equations.md 31): real
/// shapes, which hold at every frequency, times complex factors.
class LinearOperation {
 public:
  /// effect: not an element law. Those of channels and of forces from outside add nothing.
  LinearOperation(const Plant& plant, const Model& model, const ModelEffect& effect);

  /// equations x axes; w: rad/s.
  Eigen::MatrixXcd at(double w) const;
  void add_to(double w, Eigen::MatrixXcd& operation) const;

 private:
  struct Shape {
    /// Of acceleration, of -1/w^2 times it, of 1/(jw) times it, of what a resonator passes on.
    enum class Factor { inertia, stiffness, damping, resonance } factor;
    Eigen::MatrixXd of_axes;
  };

  Complex factor(Shape::Factor of, double w) const;

  Eigen::Index rows_, cols_;
  std::vector<Shape> shapes_;
  ModelEffect effect_;
};

}  // namespace framewatch
