#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "estimator/refine/max_likelihood.h"
#include "estimator/setup/pipeline_config.h"

namespace framewatch::daemon {

/// A stretch refined once more with frames that bend, of a design that has none.
struct BendingTrial {
  /// Along x and y, at the base, N*m/rad, and its standard error; NaN: no frames along it.
  std::array<double, 2> stiffness_nmprad, std_error_nmprad;
  double misfit_ratio = 0;  ///< as Refinement::misfit_ratio
  bool needed = false;      ///< the stretch shows that the frames bend
};

/// rigid: what the stretch gave without bending, of config.parameters(). Empty where the design
/// bends already, where floor panels are identified (they are not beside bending), and where no
/// values are found.
std::optional<BendingTrial> try_bending(const estimator::PipelineConfig& config,
                                        const Eigen::MatrixXd& accel,
                                        const estimator::Refinement& rigid,
                                        estimator::RefineOptions options);

}  // namespace framewatch::daemon
