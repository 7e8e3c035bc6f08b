#include "daemon/estimation/design_error.h"

#include "estimator/identify/groups/layout_prediction.h"

namespace framewatch::daemon {

estimator::PipelineConfig with_design_error(estimator::PipelineConfig config) {
  if (!config.parameters().grouped()) return config;
  config.design_error = predict_layout(config, estimator::noise_densities(config.axes), {},
                                       {config.profile_tolerance, config.mass_tolerance})
                            .design_error;
  return config;
}

}  // namespace framewatch::daemon
