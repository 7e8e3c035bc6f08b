#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/model.h"
#include "estimator/diagnose/stretch.h"

namespace framewatch {

/// Motion of the element under one element law, at ratio steps per sample.
struct LawTrack {
  Eigen::VectorXd d, v;   ///< m, m/s
  Eigen::VectorXd force;  ///< N
};

struct FreeRun {
  bool good = false;
  std::vector<LawTrack> tracks;  ///< of the model's element laws, in their order
};

/// The model's motion under the measured motion of the base alone, from rest before the stretch's
/// lead. Integrates the linear part exactly in its complex modes; the laws act at the end of each
/// step, implicitly.
FreeRun free_run(const Plant& plant, const Model& model, const Stretch& stretch, std::size_t record,
                 int ratio);

/// Steps per sample that resolve the model's highest mode.
int steps_per_sample(const Plant& plant, double rate_hz);

/// The signal at ratio times its rate, later by `shift` samples, by a windowed sinc.
Eigen::VectorXd upsampled(const Eigen::VectorXd& signal, int ratio, double shift = 0);

}  // namespace framewatch
