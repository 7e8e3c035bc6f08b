// SPDX-License-Identifier: MIT
#include "tests/study/study_record.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/tools/simulation/simulation_truth.h"
#include "drivers/files/text_output.h"
#include "drivers/records/record_csv_writer.h"
#include "estimator/simulate/nonlinear_building.h"
#include "estimator/simulate/sensor_model.h"
#include "tests/study/flicker_noise.h"

namespace framewatch::study {
namespace {

/// Steps of the integration's input: fine for written records, the sampling's for sizing.
constexpr double kFine_s = 1e-3;
constexpr double kBias_mps2 = 0.02;
constexpr double kFullScale_mps2 = 4 * 9.80665;
constexpr int kBits = 16;

Eigen::MatrixXd run(const StudyCase& c, int record, const std::vector<estimator::Effect>& more,
                    bool anti_alias) {
  const StudyBuilding& b = c.building;
  std::vector<estimator::Effect> effects = in_record(c.hidden.effects, record, c.options.seconds);
  effects.insert(effects.end(), more.begin(), more.end());
  effects.insert(effects.end(), c.ground_dampers.begin(), c.ground_dampers.end());
  std::vector<estimator::ResponseChannel> channels = response_channels(b.truth, b.axes);
  estimator::ChannelEffects channel_effects(effects);
  channel_effects.delay(channels);
  estimator::ResponseOptions options;
  options.rate_hz = c.options.rate_hz;
  options.anti_alias = anti_alias;
  options.longest_step_s = anti_alias ? kFine_s : 1 / options.rate_hz;
  std::vector<estimator::PlacedLaw> laws;
  for (const OtherLaw& law : c.hidden.laws) {
    const bool whole = law.place.kind == estimator::PlaceKind::whole_frame;
    for (int story = 1; story <= b.truth.stories; ++story)
      if (whole || story == law.place.story)
        laws.push_back({b.table().frame_stiffness(story, law.place.frame), law.make(record), {}});
  }
  estimator::ResponseStream stream(std::make_unique<estimator::NonlinearBuilding>(
                                       b.truth, b.table(), c.hidden.theta, effects, std::move(laws),
                                       estimator::ground_inputs(b.truth), fine_step_s(options)),
                                   c.motions[static_cast<std::size_t>(record)], options, {},
                                   channels);
  const auto rows = static_cast<Eigen::Index>(c.options.seconds * c.options.rate_hz);
  Eigen::MatrixXd out(rows, static_cast<Eigen::Index>(b.axes.size()));
  for (Eigen::Index i = 0; i < rows; ++i) {
    const Eigen::VectorXd& motion = stream.next();
    out.row(i) = channel_effects.apply(stream.time_s(), motion).transpose();
  }
  std::vector<estimator::SensorModel> models(b.axes.size());
  channel_effects.limit(models);
  for (std::size_t a = 0; a < models.size(); ++a) {
    const double level = models[a].clip_level;
    if (level <= 0) continue;
    auto column = out.col(static_cast<Eigen::Index>(a));
    column = column.cwiseMax(-level).cwiseMin(level).eval();
  }
  return out;
}

/// Returns the small errors that every instrument has.
std::vector<estimator::Effect> instrument_errors(const StudyBuilding& b) {
  std::vector<estimator::Effect> out;
  for (std::size_t i = 0; i < b.axes.size(); ++i) {
    estimator::EffectPlace place;
    place.kind = estimator::PlaceKind::channel;
    place.channel = static_cast<int>(i);
    out.push_back({estimator::EffectKind::gain_error, place, {b.gain_error[i]}});
    out.push_back({estimator::EffectKind::time_shift, place, {b.clock_error[i]}});
  }
  return out;
}

double quantised(double accel) {
  const double step = kFullScale_mps2 / std::exp2(kBits - 1);
  return step * std::round(accel / step);
}

std::string truth_text(const StudyCase& c, const std::string& name) {
  using Json = nlohmann::ordered_json;
  daemon::Scenario s;
  s.config.path = name;
  s.config.pipeline.structure = c.building.truth;
  s.config.pipeline.axes = c.building.axes;
  s.truth = c.hidden.theta;
  s.effects = c.hidden.effects;
  s.seed = c.options.seed;
  Json out = Json::parse(daemon::truth_json(s));
  for (const OtherLaw& law : c.hidden.laws) {
    out["effects"].push_back(
        {{"effect", law.name},
         {"location", daemon::location_json(law.place, c.building.truth, c.building.axes)},
         {"accepted", law.accepted},
         {"kind", estimator::law_kind_word(law.sort)}});
    out["hidden"] = out["effects"].front();
  }
  out["study"] = {{"group", c.group},
                  {"name", c.name},
                  {"building", c.options.building},
                  {"noise_ratio", c.options.noise_ratio},
                  {"gap_over_floor", c.gap_over_floor}};
  return out.dump(1) + "\n";
}

bool write_record(const StudyCase& c, int record, const std::string& path, std::string& error) {
  const Eigen::MatrixXd accel = measured(c, record);
  std::vector<std::string> names;
  for (const estimator::SensorAxis& axis : c.building.axes) names.push_back(axis.name);
  drivers::RecordCsvWriter out;
  bool good = out.open(path, names);
  std::vector<double> row(names.size());
  for (Eigen::Index i = 0; good && i < accel.rows(); ++i) {
    for (std::size_t a = 0; a < row.size(); ++a) row[a] = accel(i, static_cast<Eigen::Index>(a));
    good = out.write(static_cast<double>(i) / c.options.rate_hz, row);
  }
  if (good && out.close()) return true;
  error = out.error();
  return false;
}

}  // namespace

Eigen::MatrixXd clean_record(const StudyCase& c, int record) {
  return run(c, record, {}, c.filtered);
}

Eigen::MatrixXd measured(const StudyCase& c, int record) {
  Eigen::MatrixXd out = run(c, record, instrument_errors(c.building), true);
  std::vector<estimator::SensorModel> models(c.building.axes.size());
  estimator::ChannelEffects(c.hidden.effects).limit(models);
  for (Eigen::Index a = 0; a < out.cols(); ++a) {
    estimator::Random noise(c.options.seed, 100 + static_cast<std::uint64_t>(record) * 1000 +
                                                static_cast<std::uint64_t>(a));
    const double deviation = c.options.noise_ratio *
                             std::sqrt(out.col(a).squaredNorm() / static_cast<double>(out.rows()));
    const double bias = kBias_mps2 * (2 * noise.uniform() - 1);
    const double level = models[static_cast<std::size_t>(a)].clip_level;
    FlickerNoise flicker(noise);
    const double white = std::sqrt(1 - c.options.flicker_share),
                 pink = std::sqrt(c.options.flicker_share);
    for (Eigen::Index i = 0; i < out.rows(); ++i) {
      double seen = out(i, a) + deviation * (white * noise.normal() + pink * flicker.next()) + bias;
      if (level > 0) seen = std::clamp(seen, -level, level);
      out(i, a) = quantised(seen);
    }
  }
  return out;
}

bool write_case(const StudyCase& c, const std::string& directory, std::string& error) {
  std::error_code code;
  std::filesystem::create_directories(directory, code);
  const std::string name = std::filesystem::path(directory).filename().string();
  const auto write = [&](const char* file, const std::string& text) {
    error = drivers::write_text_file(directory + file, text);
    return error.empty();
  };
  return write("/config.toml", config_toml(c.building, c.options.rate_hz)) &&
         write_record(c, 0, directory + "/train.csv.gz", error) &&
         write_record(c, 1, directory + "/holdout.csv.gz", error) &&
         write("/truth.json", truth_text(c, name));
}

}  // namespace framewatch::study
