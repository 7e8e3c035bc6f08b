// SPDX-License-Identifier: MIT
#include "tests/study/study_building.h"

#include "estimator/structure/natural_frequencies.h"

#include <algorithm>
#include <cassert>

#include <fmt/core.h>

namespace framewatch::study {
namespace {

constexpr double kMassError = 0.01;
constexpr double kDesignError = 0.05;
constexpr double kGainError = 0.005;
constexpr double kClockError_s = 0.25e-3;

double uniform(estimator::Random& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

/// Returns a normal deviation within three standard deviations.
double off(estimator::Random& random, double deviation) {
  return deviation * std::clamp(random.normal(), -3.0, 3.0);
}

std::vector<std::string> names(const char* prefix, int count) {
  std::vector<std::string> out;
  for (int i = 1; i <= count; ++i) out.push_back(prefix + std::to_string(i));
  return out;
}

estimator::Structure plan(const std::string& kind, estimator::FloorModel floor,
                          estimator::Random& random) {
  const int lines = kind == "2story_3x3" ? 4 : 2;
  estimator::Structure s;
  s.name = kind;
  s.stories = kind == "5story_1x1" ? 5 : 2;
  s.frames_x = names("y", lines);
  s.frames_y = names("x", lines);
  for (int i = 1; i < lines; ++i) s.span_x.push_back(uniform(random, 0.8, 1.2));
  for (int i = 1; i < lines; ++i) s.span_y.push_back(uniform(random, 0.8, 1.2));
  s.story_height.assign(static_cast<std::size_t>(s.stories), 1.0);
  s.floor = floor;
  for (int i = 0; i < s.stories * lines * lines; ++i)
    s.node_mass.push_back(uniform(random, 16, 24));
  return s;
}

Eigen::VectorXd true_theta(const estimator::Structure& s, estimator::Random& random) {
  const estimator::ParameterTable table(s);
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(table.size());
  const double frame = 15e3 * s.n() * (s.stories == 5 ? 3.0 : 1.0);  // first mode at 2 to 3 Hz
  for (int i = 0; i < table.elements(); ++i)
    theta[i] = frame * (table[i].kind == estimator::ParameterKind::frame_stiffness
                            ? uniform(random, 0.7, 1.3)
                            : uniform(random, 0.8, 1.6));
  theta = with_proportional_damping(s, table, theta, uniform(random, 0.01, 0.02));
  for (int i = table.elements(); i < table.size(); ++i) theta[i] *= uniform(random, 0.8, 1.2);
  return theta;
}

std::vector<estimator::SensorAxis> sensors(const estimator::Structure& s) {
  std::vector<estimator::SensorAxis> axes;
  for (const estimator::Direction direction : {estimator::Direction::x, estimator::Direction::y}) {
    estimator::SensorAxis base;
    base.name = direction == estimator::Direction::x ? "base-x" : "base-y";
    base.direction = direction;
    axes.push_back(base);
  }
  for (int story = 1; story <= s.stories; ++story) {
    for (int f = 0; f < s.frames(); ++f) {
      estimator::SensorAxis axis;
      axis.name = fmt::format("F{}-{}", story, s.frame_name(f));
      axis.story = story;
      axis.frame = f;
      axis.direction = s.direction(f);
      axes.push_back(axis);
    }
  }
  return axes;
}

std::string list(const double* values, int count) {
  std::string out = "[";
  for (int i = 0; i < count; ++i) out += fmt::format("{}{}", i ? ", " : "", values[i]);
  return out + "]";
}

/// Returns rows x columns of `values` as nested lists.
std::string grid(const std::vector<double>& values, int rows, int columns) {
  std::string out = "[";
  for (int r = 0; r < rows; ++r)
    out += (r ? ", " : "") + list(values.data() + r * columns, columns);
  return out + "]";
}

std::string quoted(const std::vector<std::string>& words) {
  std::string out = "[";
  for (const std::string& word : words) out += (out.size() > 1 ? ", \"" : "\"") + word + "\"";
  return out + "]";
}

}  // namespace

const std::vector<std::string>& building_kinds() {
  static const std::vector<std::string> kKinds{"2story_1x1", "2story_3x3", "5story_1x1"};
  return kKinds;
}

StudyBuilding random_building(const std::string& kind, estimator::FloorModel floor,
                              estimator::Random& random, double tolerance) {
  StudyBuilding b;
  b.kind = kind;
  b.believed = plan(kind, floor, random);
  b.truth = b.believed;
  for (double& mass : b.truth.node_mass) mass *= 1 + off(random, tolerance * kMassError);
  b.theta = true_theta(b.truth, random);
  b.design = b.theta;
  for (double& value : b.design) value *= 1 + off(random, tolerance * kDesignError);
  b.axes = sensors(b.truth);
  for (std::size_t i = 0; i < b.axes.size(); ++i) {
    b.gain_error.push_back(off(random, tolerance * kGainError));
    b.clock_error.push_back(off(random, tolerance * kClockError_s));
  }
  return b;
}

std::string config_toml(const StudyBuilding& b, double rate_hz) {
  const estimator::Structure& s = b.believed;
  const estimator::ParameterTable table(s);
  std::string out = fmt::format(
      "[structure]\nname = \"{}\"\nstories = {}\nframes_x = {}\nframes_y = {}\nspan_x_m = {}\n"
      "span_y_m = {}\nstory_height_m = {}\nfloor = \"{}\"\n",
      s.name, s.stories, quoted(s.frames_x), quoted(s.frames_y), list(s.span_x.data(), s.m() - 1),
      list(s.span_y.data(), s.n() - 1), list(s.story_height.data(), s.stories),
      s.floor == estimator::FloorModel::rigid ? "rigid" : "flexible");
  std::string masses;
  for (int story = 0; story < s.stories; ++story) {
    const double* first = s.node_mass.data() + story * s.n() * s.m();
    masses += (story ? ", " : "") + grid({first, first + s.n() * s.m()}, s.n(), s.m());
  }
  out += "node_mass_kg = [" + masses + "]\n\n[structure.design]\n";
  std::vector<double> kx, ky;
  for (int story = 1; story <= s.stories; ++story)
    for (int f = 0; f < s.frames(); ++f)
      (f < s.n() ? kx : ky).push_back(b.design[table.frame_stiffness(story, f)]);
  out += "kx_npm = " + grid(kx, s.stories, s.n()) + "\nky_npm = " + grid(ky, s.stories, s.m());
  std::string panels;
  for (int story = 1; s.panels() > 0 && story <= s.stories; ++story) {
    const double* first = b.design.data() + table.panel_stiffness(story, 0);
    panels += (story > 1 ? ", " : "") + grid({first, first + s.panels()}, s.n() - 1, s.m() - 1);
  }
  if (s.panels() > 0) out += "\ngk = [" + panels + "]";
  out += fmt::format("\ndamping_ratio = {}\n\n[estimator]\nrate_hz = {}\n", b.design_damping_ratio,
                     rate_hz);
  for (const estimator::SensorAxis& axis : b.axes)
    out += fmt::format("\n[[channel]]\nname = \"{}\"\nstory = {}\n{}", axis.name, axis.story,
                       axis.story > 0 ? fmt::format("frame = \"{}\"\n", s.frame_name(axis.frame))
                                      : fmt::format("direction = \"{}\"\n", letter(axis)));
  return out;
}

}  // namespace framewatch::study
