#include "daemon/monitor/estimation/design_error.h"

#include <utility>

#include "estimator/identify/groups/layout_prediction.h"

namespace framewatch::daemon {

estimator::PipelineConfig with_design_error(estimator::PipelineConfig config) {
  if (!config.parameters().grouped()) return config;
  estimator::LayoutPrediction foreseen =
      predict_layout(config, estimator::noise_densities(config.axes), {},
                     {config.profile_tolerance, config.mass_tolerance});
  config.design_error = std::move(foreseen.design_error);
  config.change_error = std::move(foreseen.change_error);
  config.change_leak = std::move(foreseen.change_leak);
  return config;
}

}  // namespace framewatch::daemon
