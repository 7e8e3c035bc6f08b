#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/model/model.h"
#include "estimator/diagnose/model/run_cache.h"
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

/// A change of an element's stiffness, N/m, so small that its force at the end of a step moves
/// nothing within it.
struct SmallSpring {
  Eigen::Index element;
  double stiffness;
};

/// Simulates the model under the measured motion of the base alone, from rest, or as measured
/// within the segment's lead (initial_motion). The linear part is integrated exactly in its complex
/// modes; the forces of the laws at the end of each step are solved implicitly. record: index of
/// the segment's record. cache: of one thread; null: none.
FreeRun free_run(const Plant& plant, const Model& model, const RecordSegment& segment,
                 std::size_t record, int ratio, RunCache* cache = nullptr,
                 const std::vector<SmallSpring>& springs = {});

/// Steps per sample that resolve the model's highest mode.
int steps_per_sample(const Plant& plant, double rate_hz);
/// Those of a model: finer where it has contacts.
int steps_of(const Model& model, int ratio);

}  // namespace framewatch::estimator
