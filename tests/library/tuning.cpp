// SPDX-License-Identifier: MIT
// Passes vectors of Eigen to the library and back, so that one side frees what the other allocated.
// Compiled for another instruction set than the library, it crashes if the two sides allocate
// differently.
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include <Eigen/Core>

#include <framewatch/estimator/pipeline/pipeline.h>

namespace fw = framewatch::estimator;

int main() {
  fw::PipelineConfig config;
  config.structure.stories = 1;
  config.structure.frames_x = {"y1"};
  config.structure.story_height = {3};
  config.structure.node_mass = {1000};
  config.axes = {{.name = "base"}, {.name = "roof", .story = 1, .frame = 0}};
  config.design = Eigen::VectorXd::Zero(2);
  config.design << 1e5, 500;
  if (!fw::problems(config).empty()) return 1;
  fw::Pipeline first(config);
  double u = 0, v = 0;
  for (int i = 0; i < 30'000; ++i) {
    const double base = std::sin(6e-3 * i) + std::sin(14e-3 * i);
    const double roof = -(1e5 * u + 500 * v) / 1000;
    if (i % 10 == 0) {
      (void)first.push({fw::from_microseconds(1000LL * i), 0, base});
      (void)first.push({fw::from_microseconds(1000LL * i), 1, roof});
    }
    v += 1e-3 * (roof - base);
    u += 1e-3 * v;
  }
  std::optional<fw::Tuning> tuning = first.tuning();  // allocated by the library
  if (!tuning) return 2;
  tuning->theta0 = Eigen::VectorXd(2.0 * tuning->theta0);  // freed and allocated here
  fw::Pipeline second(config);
  second.start_tuned(*tuning);
  const double ratio = second.theta0()[0] / first.theta0()[0];
  const fw::Tuning moved = std::move(*tuning);
  fw::StateWriter written;
  first.save(written);
  fw::StateReader reader(written.bytes());
  fw::Pipeline third(config);
  const bool loaded = third.load(reader) && reader.whole();
  std::printf("stiffness %.3g N/m, twice %.3g, state %s\n", first.theta0()[0], moved.theta0[0],
              loaded ? "loaded" : "refused");
  return std::abs(ratio - 2) < 1e-12 && loaded ? 0 : 3;
}
