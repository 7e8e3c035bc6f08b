// SPDX-License-Identifier: MIT
#include "daemon/tools/simulation/simulation.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "daemon/config/config_size.h"

namespace framewatch::daemon {
namespace {

constexpr double kMaxInstants = 1e9;  // 116 days at 100 Hz

/// Returns the truth from time 0 on, then every later change, also of the climate by the hour.
std::vector<estimator::ParameterChange> course_of(const Scenario& s) {
  std::vector<estimator::ParameterChange> out;
  if (!s.climate) {
    out.push_back({0, s.truth});
    out.insert(out.end(), s.changes.begin(), s.changes.end());
    return out;
  }
  estimator::ClimateStream climate = climate_of(s);
  auto change = s.changes.begin();
  for (double hour_s = 0; hour_s <= s.duration_s; hour_s += estimator::ClimateStream::kStep_s) {
    climate.next();
    out.push_back({hour_s, weathered(truth_at(s, hour_s), climate)});
    for (; change != s.changes.end() && change->at_s < hour_s + estimator::ClimateStream::kStep_s;
         ++change)
      if (change->at_s > hour_s) out.push_back({change->at_s, weathered(change->theta, climate)});
  }
  return out;
}

/// Returns how much warmer than its mean the outside of a climate is, at the start of every hour.
std::vector<double> warmer_by_hour(const Scenario& s) {
  std::vector<double> out;
  if (!s.climate) return out;
  estimator::ClimateStream climate = climate_of(s);
  for (std::int64_t hour = 0; hour <= hours(s); ++hour)
    out.push_back(climate.next().outside_degc - s.climate->climate.mean_degc);
  return out;
}

/// Returns values of the hours, interpolated; 0 without values.
double at_hour(const std::vector<double>& values, double hour) {
  if (values.empty()) return 0;
  const auto from = std::min(static_cast<std::size_t>(hour), values.size() - 1);
  const std::size_t to = std::min(from + 1, values.size() - 1);
  return values[from] + (hour - static_cast<double>(from)) * (values[to] - values[from]);
}

estimator::ResponseStream response_of(const Scenario& s) {
  const estimator::Structure& structure = s.config.pipeline.structure;
  estimator::ResponseOptions options;
  options.rate_hz = s.rate_hz;
  std::vector<estimator::ResponseChannel> channels =
      response_channels(structure, s.config.pipeline.axes);
  estimator::ChannelEffects(s.effects).delay(channels);
  std::vector<estimator::ParameterChange> course = course_of(s);
  const Eigen::VectorXd first = course.front().theta;
  course.erase(course.begin());
  return {
      structure, estimator::ParameterTable(structure), first, s.motion, options, course, channels,
      s.effects};
}

/// Converts the sensors' noise ratios to densities, by a run in advance.
std::vector<estimator::SensorModel> sensors_of(const Scenario& s) {
  std::vector<estimator::SensorModel> models = s.sensors;
  estimator::ChannelEffects(s.effects).limit(models);
  const bool wanted = std::any_of(s.noise_ratio.begin(), s.noise_ratio.end(),
                                  [](double ratio) { return ratio > 0; });
  if (!wanted) return models;
  estimator::ResponseStream response = response_of(s);
  const std::int64_t count = instants(s);
  Eigen::ArrayXd squares = response.next().array().square();
  for (std::int64_t i = 1; i < count; ++i) squares += response.next().array().square();
  for (std::size_t i = 0; i < models.size(); ++i) {
    const double rms =
        std::sqrt(squares[static_cast<Eigen::Index>(i)] / static_cast<double>(count));
    models[i].noise_density = std::hypot(
        models[i].noise_density, estimator::noise_density_of(s.noise_ratio[i], rms, s.rate_hz));
  }
  return models;
}

}  // namespace

const Eigen::VectorXd& truth_at(const Scenario& s, double time_s) {
  const Eigen::VectorXd* theta = &s.truth;
  for (const estimator::ParameterChange& change : s.changes)
    if (change.at_s <= time_s) theta = &change.theta;
  return *theta;
}

Eigen::VectorXd weathered(const Eigen::VectorXd& theta, const estimator::ClimateStream& climate) {
  const std::vector<double>& factor = climate.stiffness_factor();
  const auto elements = static_cast<Eigen::Index>(factor.size());
  Eigen::VectorXd out = theta;
  for (Eigen::Index e = 0; e < elements; ++e) {
    out[e] *= factor[static_cast<std::size_t>(e)];
    out[elements + e] *= climate.damping_factor(static_cast<int>(e));
  }
  return out;
}

estimator::ClimateStream climate_of(const Scenario& s) {
  const int elements = estimator::ParameterTable(s.config.pipeline.structure).elements();
  return {s.climate->climate, elements, static_cast<double>(s.climate->start_us) * 1e-6, s.seed};
}

std::string size_problem(const Scenario& s) {
  const double instants = s.duration_s * s.rate_hz;
  if (!(instants <= kMaxInstants))
    return fmt::format(
        "duration: {:g} s at {:g} Hz are {:.3g} instants, at most {:g} are simulated", s.duration_s,
        s.rate_hz, instants, kMaxInstants);
  return simulated_size_problem(s.config.pipeline.structure);
}

Simulation::Simulation(const Scenario& s)
    : response_(response_of(s)),
      channel_effects_(s.effects),
      sensors_(s.config.pipeline.axes, sensors_of(s), s.rate_hz, s.seed),
      warmer_degc_(warmer_by_hour(s)) {}

const std::vector<double>& Simulation::next() {
  constexpr double kLargest_mps2 = 1e6;
  const Eigen::VectorXd& motion = response_.next();
  collapsed_ = !motion.allFinite() || motion.cwiseAbs().maxCoeff() > kLargest_mps2;
  const double time_s = response_.time_s();
  return sensors_.measure(time_s, channel_effects_.apply(time_s, motion),
                          at_hour(warmer_degc_, time_s / estimator::ClimateStream::kStep_s));
}

std::int64_t hours(const Scenario& s) {
  return std::max<std::int64_t>(
      static_cast<std::int64_t>(std::ceil(s.duration_s / estimator::ClimateStream::kStep_s)), 1);
}

std::int64_t instants(const Scenario& s) {
  return static_cast<std::int64_t>(std::floor(s.duration_s * s.rate_hz + 1e-6)) + 1;
}

}  // namespace framewatch::daemon
