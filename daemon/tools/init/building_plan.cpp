#include "daemon/tools/init/building_plan.h"

#include <numeric>

#include "estimator/structure/natural_frequencies.h"

namespace framewatch::daemon {
namespace {

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

std::vector<double> shares_of_frames(const std::vector<double>& spans) {
  if (spans.empty()) return {1.0};
  std::vector<double> out(spans.size() + 1, 0.0);
  for (std::size_t i = 0; i < spans.size(); ++i) {
    out[i] += spans[i] / 2 / sum(spans);
    out[i + 1] += spans[i] / 2 / sum(spans);
  }
  return out;
}

std::vector<double> node_masses(const estimator::Structure& s,
                                const std::vector<double>& floor_mass_kg) {
  std::vector<double> out;
  for (const double mass : floor_mass_kg)
    for (const double y : shares_of_frames(s.span_y))
      for (const double x : shares_of_frames(s.span_x)) out.push_back(mass * y * x);
  return out;
}

double floor_area_m2(const estimator::Structure& s) {
  return sum(s.span_x) * sum(s.span_y);
}

std::vector<double> story_stiffness_npm(const std::vector<double>& floor_mass_kg, double first_hz) {
  estimator::Structure line;
  line.stories = static_cast<int>(floor_mass_kg.size());
  line.frames_x = {"y1"};
  line.node_mass = floor_mass_kg;
  line.story_height.assign(floor_mass_kg.size(), 1.0);
  const estimator::ParameterTable table(line);
  const double unit_hz = lowest_frequency_hz(line, table, Eigen::VectorXd::Ones(table.size()));
  const double stiffness = first_hz / unit_hz * (first_hz / unit_hz);
  return std::vector<double>(floor_mass_kg.size(), stiffness);
}

}  // namespace framewatch::daemon
