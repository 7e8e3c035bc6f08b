// SPDX-License-Identifier: MIT
#pragma once

#include "estimator/identify/elements/guessed_design.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/structure/group_design.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::estimator {

/// Returns the design of every story: the configured one, or guessed_design() if the configuration
/// gives none.
inline GroupDesign story_design(const PipelineConfig& config) {
  return {config.design.size() > 0
              ? config.design
              : guessed_design(config.structure, ParameterTable(config.structure)),
          config.bending_nmprad};
}

}  // namespace framewatch::estimator
