// SPDX-License-Identifier: MIT
// The framewatch estimator inside a program: a building in code, samples in, estimates out.
//
// g++ -std=c++20 -O2 main.cpp $(pkg-config --cflags --libs framewatch) -o embed
#include <cmath>
#include <cstdio>

#include <framewatch/estimator/pipeline/pipeline.h>

namespace fw = framewatch::estimator;

int main() {
  fw::PipelineConfig config;  // two stories, one frame, a sensor on the base and on each floor
  config.structure.stories = 2;
  config.structure.frames_x = {"y1"};
  config.structure.story_height = {3, 3};     // m
  config.structure.node_mass = {5000, 5000};  // kg
  config.axes = {{.name = "base"},
                 {.name = "floor1", .story = 1, .frame = 0},
                 {.name = "floor2", .story = 2, .frame = 0}};
  config.options.hop_s = 2.5;  // between estimates
  for (const auto& problem : fw::problems(config)) return std::puts(problem.c_str()), 2;

  fw::Pipeline pipeline(config);
  double u1 = 0, u2 = 0, v1 = 0, v2 = 0;  // of the floors relative to the base, m and m/s
  for (int i = 0; i < 200'000; ++i) {     // 20 s in steps of 0.1 ms
    const double t = 1e-4 * i;
    const double base = std::sin(8 * t) + std::sin(21 * t) + std::sin(33 * t);              // m/s^2
    const double force1 = 4e6 * u1 + 2e4 * v1, force2 = 3e6 * (u2 - u1) + 2e4 * (v2 - v1);  // N
    const double accel[] = {base, (force2 - force1) / 5000, -force2 / 5000};  // absolute, m/s^2
    for (int axis = 0; axis < 3 && i % 100 == 0; ++axis)  // 100 samples per second
      for (const auto& result :
           pipeline.push({fw::from_microseconds(100LL * i), axis, accel[axis]})) {
        if (result.estimate == nullptr || result.estimate->status != fw::WindowStatus::valid)
          continue;
        std::printf("%.2f s:", fw::seconds_of(result.estimate->end));
        for (int p = 0; p < pipeline.parameters().size(); ++p)
          std::printf("  %s %.4g %s", pipeline.parameters()[p].name.c_str(),
                      result.estimate->value[std::size_t(p)],
                      pipeline.parameters()[p].unit.c_str());
        std::puts("");
      }
    v1 += 1e-4 * (accel[1] - base), v2 += 1e-4 * (accel[2] - base);
    u1 += 1e-4 * v1, u2 += 1e-4 * v2;
  }
}
