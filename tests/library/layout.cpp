// SPDX-License-Identifier: MIT
// Prints the sizes of the public types. tests/library/run compares them with those of the number of
// the binary interface: a program that was compiled before the change would read the wrong bytes.
#include <cstdio>

#include <framewatch/estimator/pipeline/pipeline.h>
#include <framewatch/estimator/pipeline/pipeline_size.h>

namespace fw = framewatch::estimator;

int main() {
#define PRINT_SIZE(type) std::printf(#type " %zu\n", sizeof(fw::type))
  PRINT_SIZE(AccelSample);
  PRINT_SIZE(AxisCounters);
  PRINT_SIZE(BendingStiffness);
  PRINT_SIZE(BoxplotStatistics);
  PRINT_SIZE(EstimatorOptions);
  PRINT_SIZE(ModelFit);
  PRINT_SIZE(Parameter);
  PRINT_SIZE(ParameterTable);
  PRINT_SIZE(Pipeline);
  PRINT_SIZE(PipelineConfig);
  PRINT_SIZE(PipelineCounters);
  PRINT_SIZE(PipelineResult);
  PRINT_SIZE(PipelineSize);
  PRINT_SIZE(PlanPlace);
  PRINT_SIZE(Problem);
  PRINT_SIZE(SampleSet);
  PRINT_SIZE(SensorAxis);
  PRINT_SIZE(StateReader);
  PRINT_SIZE(StateWriter);
  PRINT_SIZE(StoryGroup);
  PRINT_SIZE(StoryGroups);
  PRINT_SIZE(Structure);
  PRINT_SIZE(Tuning);
  PRINT_SIZE(WantedGroups);
  PRINT_SIZE(WindowEstimate);
}
