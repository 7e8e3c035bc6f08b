#pragma once

#include "estimator/setup/pipeline_config.h"

namespace framewatch::daemon {

/// The configuration with PipelineConfig::design_error, change_error and change_leak, predicted for
/// the usual shaking from the tolerances of masses and stories; unchanged where every story is
/// identified. Up to seconds for a tall building that bends.
estimator::PipelineConfig with_design_error(estimator::PipelineConfig config);

}  // namespace framewatch::daemon
