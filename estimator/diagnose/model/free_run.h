// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/model/model.h"
#include "estimator/diagnose/model/run_system.h"
#include "estimator/diagnose/spectra/record_segment.h"

namespace framewatch::estimator {

/// Deformation of an element and the force of its law, at `ratio` steps per sample.
struct LawTrack {
  Eigen::VectorXd d, v;   ///< m, m/s
  Eigen::VectorXd force;  ///< N
};

struct FreeRun {
  bool good = false;             ///< false: not computable, or the motion diverged
  std::vector<LawTrack> tracks;  ///< of the model's element laws, in their order
};

/// A change of an element's stiffness, N/m. It must be so small that its force at the end of a step
/// causes no motion within the step.
struct SmallSpring {
  Eigen::Index element;
  double stiffness;
};

/// Simulates the model under the measured motion of the base alone. Starts from rest, or from the
/// motion measured in the segment's lead. Integrates the linear part exactly in its complex modes
/// and solves for the forces of the laws implicitly at the end of each step. `record`: index of the
/// segment's record. `ratio`: steps per sample. `cache`: not shared between threads; null: no
/// cache.
FreeRun free_run(const Plant& plant, const Model& model, const RecordSegment& segment,
                 std::size_t record, int ratio, RunCache* cache = nullptr,
                 const std::vector<SmallSpring>& springs = {});

/// Returns the steps per sample that resolve the floors' measured displacement, but no frequency
/// above the highest mode of the design.
int steps_per_sample(const Plant& plant, const RecordSegment& segment);
/// Returns the steps per sample of a model: more than `ratio` if it has contacts.
int steps_of(const Model& model, int ratio);

}  // namespace framewatch::estimator
