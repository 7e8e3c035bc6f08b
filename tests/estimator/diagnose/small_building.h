// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "estimator/diagnose/model/make_plant.h"
#include "estimator/diagnose/model/plant.h"
#include "estimator/diagnose/spectra/record_segment.h"
#include "estimator/simulate/linear_response.h"
#include "estimator/simulate/nonlinear_building.h"
#include "estimator/simulate/random.h"
#include "estimator/structure/matrices.h"
#include "estimator/structure/natural_frequencies.h"
#include "tests/support/noisy_stretch.h"
#include "tests/support/paper_buildings.h"

namespace framewatch::test {

inline constexpr double kRate_hz = 50;
inline constexpr double kNoise_mps2 = 0.01;
inline constexpr double kSeconds = 24;

/// One story of one bay, small enough for sanitizers: x-parallel frames y1, y2, y-parallel x1, x2.
struct Small {
  estimator::Structure structure = one_story();
  estimator::ParameterTable table{structure};
  std::vector<estimator::SensorAxis> axes;
  Eigen::VectorXd truth, design;

  Small() {
    truth = Eigen::VectorXd::Zero(table.size());
    const double frames[] = {9e6, 6e6, 8e6, 5e6};
    for (int f = 0; f < 4; ++f) truth[table.frame_stiffness(1, f)] = frames[f];
    truth[table.panel_stiffness(1, 0)] = 2e6;
    truth = with_proportional_damping(structure, table, truth, 0.02);
    design = 1.05 * truth;
    for (int f = 0; f < 4; ++f)
      axes.push_back({structure.frame_name(f), 1, structure.direction(f), f});
    axes.push_back({"base-x", 0, estimator::Direction::x, -1});
    axes.push_back({"base-y", 0, estimator::Direction::y, -1});
  }

  static estimator::Structure one_story() {
    estimator::Structure s = table1();
    s.stories = 1;
    s.story_height.resize(1);
    s.node_mass.resize(static_cast<std::size_t>(s.nodes()));
    return s;
  }

  /// Returns the readings of the axes with these effects.
  Eigen::MatrixXd record(const std::vector<estimator::Effect>& effects, std::uint64_t seed) const {
    return record(estimator::ResponseStream(structure, table, truth, oblique_motion(seed),
                                            {kRate_hz}, {}, {}, effects),
                  seed);
  }

  /// Returns the readings with a law in a frame that the catalog does not have.
  Eigen::MatrixXd record_with_law(int frame, std::unique_ptr<estimator::ElementLaw> law,
                                  std::uint64_t seed) const {
    const estimator::ResponseOptions options{kRate_hz};
    std::vector<estimator::PlacedLaw> laws;
    laws.push_back({table.frame_stiffness(1, frame), std::move(law), {}});
    auto building = std::make_unique<estimator::NonlinearBuilding>(
        structure, table, truth, std::vector<estimator::Effect>(), std::move(laws),
        estimator::ground_inputs(structure), estimator::fine_step_s(options));
    return record(
        estimator::ResponseStream(std::move(building), oblique_motion(seed), options, {}, {}),
        seed);
  }

  /// Returns the readings of a response, with noise.
  Eigen::MatrixXd record(estimator::ResponseStream stream, std::uint64_t seed) const {
    estimator::Random random(seed + 1000);
    const auto count = static_cast<Eigen::Index>(axes.size());
    Eigen::MatrixXd out(static_cast<Eigen::Index>(kSeconds * kRate_hz), count);
    for (Eigen::Index i = 0; i < out.rows(); ++i) {
      const Eigen::VectorXd& exact = stream.next();
      for (Eigen::Index a = 0; a < count; ++a) out(i, a) = exact[a] + kNoise_mps2 * random.normal();
    }
    return out;
  }

  estimator::Plant plant() const { return *make_plant(structure, axes, design, kRate_hz); }

  std::vector<estimator::RecordSegment> segments(
      const std::vector<Eigen::MatrixXd>& records) const {
    const std::vector<double> hz = natural_frequencies_hz(structure, table, design);
    std::vector<estimator::RecordSegment> out;
    for (const Eigen::MatrixXd& record : records)
      out.push_back(estimator::make_segment(record, kRate_hz,
                                            Eigen::VectorXd::Constant(record.cols(), kNoise_mps2),
                                            {0.4 * hz.front(), 1.6 * hz.back()}));
    return out;
  }
};

}  // namespace framewatch::test
