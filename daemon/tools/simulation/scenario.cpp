// SPDX-License-Identifier: MIT
#include "daemon/tools/simulation/scenario.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <Eigen/Core>

#include "daemon/base/file_digest.h"
#include "daemon/base/toml_document.h"
#include "daemon/base/utc_time.h"
#include "daemon/config/config_size.h"
#include "daemon/config/keys/section.h"
#include "daemon/config/read_config.h"
#include "daemon/config/sections/effects.h"
#include "daemon/tools/simulation/scenario_motion.h"
#include "daemon/tools/simulation/simulation.h"
#include "drivers/files/standard_streams.h"
#include "estimator/simulate/building_model.h"
#include "estimator/structure/natural_frequencies.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::daemon {
namespace {

constexpr double kStandardGravity = 9.80665;
/// A delay needs a filter that is longer by the delay at both ends.
constexpr double kLongestDelay_s = 1;

/// Replaces values of `model` by the given keys.
void read_sensor(ConfigSection& s, bool has_climate, estimator::SensorModel& model,
                 double& noise_ratio) {
  const auto take = [&](const char* key, double& value, double factor = 1) {
    if (s.given(key)) value = factor * s.number(key);
  };
  take("noise_mps2_per_rthz", model.noise_density);
  take("noise_ratio", noise_ratio);
  take("bias_mps2", model.bias);
  take("ramp_mps3", model.thermal_ramp);
  take("bias_mps2_per_degc", model.bias_per_degc);
  take("gain_per_degc", model.gain_per_degc);
  take("full_scale_g", model.full_scale, kStandardGravity);
  if (s.given("bits")) model.bits = s.integer("bits");
  take("loss_ratio", model.loss_ratio);
  take("dead_from_s", model.dead_from_s);
  take("dead_to_s", model.dead_to_s);
  for (const std::string& rule : problems(model)) s.problem("", rule);
  for (const char* key : {"bias_mps2_per_degc", "gain_per_degc"})
    if (s.given(key) && !has_climate) s.problem(key, "needs [climate], which has the temperature");
}

/// Returns only those errors of all sensors that have no unit of acceleration.
estimator::SensorModel of_force(const estimator::SensorModel& common) {
  estimator::SensorModel out;
  out.loss_ratio = common.loss_ratio;
  return out;
}

void refuse_acceleration(ConfigSection& s) {
  for (const char* key : {"noise_mps2_per_rthz", "bias_mps2", "ramp_mps3", "bias_mps2_per_degc",
                          "gain_per_degc", "full_scale_g", "bits"})
    if (s.given(key))
      s.problem(key,
                "is of an accelerometer; a channel of a force has noise_ratio, loss_ratio, "
                "dead_from_s and dead_to_s");
}

/// Reads [sensors] (null if absent) for every axis of scenario.config and the [[sensor]] tables for
/// the channels they name. Sets scenario.sensors and scenario.noise_ratio.
void read_sensors(const TomlValue* all, const std::vector<const TomlValue*>& single,
                  Scenario& scenario, std::vector<TextProblem>& problems) {
  estimator::SensorModel common;
  double common_ratio = 0;
  ConfigSection section("sensors", "sensors", all, {1, 1}, problems);
  const bool has_climate = scenario.climate.has_value();
  read_sensor(section, has_climate, common, common_ratio);
  // Empty if the building has problems; then its channels are unknown.
  const std::vector<estimator::SensorAxis>& axes = scenario.config.pipeline.axes;
  scenario.sensors.assign(axes.size(), common);
  scenario.noise_ratio.assign(axes.size(), common_ratio);
  for (std::size_t a = 0; a < axes.size(); ++a)
    if (axes[a].is_force) scenario.sensors[a] = of_force(common);
  for (const TomlValue* table : single) {
    ConfigSection one("sensor", "sensor", table, {}, problems);
    const std::string name = one.text("channel");
    const auto at = std::find_if(axes.begin(), axes.end(),
                                 [&](const estimator::SensorAxis& a) { return a.name == name; });
    if (at != axes.end()) {
      const auto index = static_cast<std::size_t>(at - axes.begin());
      read_sensor(one, has_climate, scenario.sensors[index], scenario.noise_ratio[index]);
      if (axes[index].is_force) refuse_acceleration(one);
      continue;
    }
    if (!axes.empty() && one.given("channel"))
      one.problem("channel", fmt::format("no channel is named \"{}\"", name));
    estimator::SensorModel nobody;
    double ratio = 0;
    read_sensor(one, has_climate, nobody, ratio);
  }
  for (const estimator::SensorAxis& axis : axes)
    if (std::abs(axis.delay) > kLongestDelay_s)
      problems.push_back({{},
                          fmt::format("channel \"{}\": a delay_s beyond {:g} s is not simulated",
                                      axis.name, kLongestDelay_s)});
}

/// Reads the true parameters of the virtual building in table order, SI, from [truth] or else the
/// design (which may be empty). Missing damping is proportional to the stiffness.
class TruthReader {
 public:
  TruthReader(const estimator::Structure& structure, const Eigen::VectorXd& design,
              ConfigSection& section)
      : structure_(structure), table_(structure), section_(section), theta_(design) {}

  Eigen::VectorXd read() {
    const bool has_design = theta_.size() == table_.size();
    if (!has_design) theta_ = Eigen::VectorXd::Zero(table_.size());
    const bool kx = frames("kx_npm", 0, structure_.n(), 0);
    const bool ky = frames("ky_npm", structure_.n(), structure_.m(), 0);
    const bool gk = panels("gk", 0);
    if (!has_design) {
      require(kx || structure_.n() == 0, "kx_npm");
      require(ky || structure_.m() == 0, "ky_npm");
      require(gk || structure_.panels() == 0, "gk");
    }
    const bool stiffness_known =
        table_.elements() > 0 && theta_.head(table_.elements()).minCoeff() > 0;
    if (stiffness_known && (kx || ky || gk || section_.given("damping_ratio") || !has_design))
      theta_ =
          with_proportional_damping(structure_, table_, theta_, section_.number("damping_ratio"));
    frames("cx_nspm", 0, structure_.n(), table_.elements());
    frames("cy_nspm", structure_.n(), structure_.m(), table_.elements());
    panels("gc", table_.elements());
    return theta_;
  }

 private:
  bool frames(const char* key, int first, int count, int offset) {
    if (!section_.given(key)) return false;
    const std::vector<double> grid = section_.grid(key, {structure_.stories, count});
    if (grid.empty()) return false;
    for (int story = 1; story <= structure_.stories; ++story)
      for (int f = 0; f < count; ++f)
        theta_[table_.frame_stiffness(story, first + f) + offset] =
            grid[static_cast<std::size_t>((story - 1) * count + f)];
    return true;
  }

  bool panels(const char* key, int offset) {
    if (!section_.given(key)) return false;
    if (structure_.panels() == 0) {
      section_.problem(key, "this building has no floor panels");
      return false;
    }
    const std::vector<double> grid =
        section_.grid(key, {structure_.stories, structure_.n() - 1, structure_.m() - 1});
    if (grid.empty()) return false;
    for (int story = 1; story <= structure_.stories; ++story)
      for (int p = 0; p < structure_.panels(); ++p)
        theta_[table_.panel_stiffness(story, p) + offset] =
            grid[static_cast<std::size_t>((story - 1) * structure_.panels() + p)];
    return true;
  }

  void require(bool holds, const char* key) {
    if (!holds && section_.good(key))
      section_.problem(key,
                       "is missing, and the building has no [structure.design] to take it from");
  }

  const estimator::Structure& structure_;
  estimator::ParameterTable table_;
  ConfigSection& section_;
  Eigen::VectorXd theta_;
};

/// Reads [climate], null if absent.
std::optional<ClimateSettings> read_climate(const TomlValue* table,
                                            std::vector<TextProblem>& problems) {
  if (table == nullptr) return std::nullopt;
  ConfigSection s("climate", "climate", table, {}, problems);
  ClimateSettings out;
  const std::string start = s.text("start");
  if (const auto start_us = read_utc(start))
    out.start_us = *start_us;
  else if (s.good("start"))
    s.problem("start",
              fmt::format("\"{}\" is not a time in UTC such as 2026-01-31T12:00:00Z", start));
  estimator::Climate& c = out.climate;
  c.mean_degc = s.number("mean_degc");
  c.season_degc = s.number("season_degc");
  c.day_degc = s.number("day_degc");
  c.front_degc = s.number("front_degc");
  c.mean_wind_mps = s.number("mean_wind_mps");
  c.per_degc = s.number("per_degc");
  c.frozen_per_degc = s.number("frozen_per_degc");
  c.per_pct = s.number("per_pct");
  c.per_mps = s.number("per_mps");
  c.occupied_mass_ratio = s.number("occupied_mass_ratio");
  c.spread_ratio = s.number("spread_ratio");
  c.shortest_lag_days = s.number("shortest_lag_days");
  c.longest_lag_days = s.number("longest_lag_days");
  if (c.longest_lag_days < c.shortest_lag_days)
    s.problem("longest_lag_days",
              fmt::format("is shorter than shortest_lag_days = {:g}", c.shortest_lag_days));
  c.wander_ratio = s.number("wander_ratio");
  c.wander_alike_ratio = s.number("wander_alike_ratio");
  c.damping_exponent = s.number("damping_exponent");
  out.stiffness_error_ratio = s.number("stiffness_error_ratio");
  out.damping_error_ratio = s.number("damping_error_ratio");
  return out;
}

constexpr double kMaxChanged = 1e7;  // values; every change stores all parameters
constexpr std::array kSections = {"truth",  "motion", "sensors", "sensor",
                                  "change", "effect", "climate"};

/// The three parts of the file: top keys, sections of the scenario, the building.
struct Parts {
  TomlValue top;
  TomlValue sections;
  TomlValue building;
};

Parts split(const TomlValue& root) {
  Parts out;
  for (const TomlEntry& entry : root.entries) {
    const bool plain = entry.value.kind != TomlKind::table && entry.value.kind != TomlKind::array;
    const bool ours = std::find(kSections.begin(), kSections.end(), entry.key) != kSections.end();
    (plain ? out.top : ours ? out.sections : out.building).entries.push_back(entry);
  }
  return out;
}

const TomlValue* section(const Parts& parts, std::string_view name) {
  const TomlEntry* entry = parts.sections.find(name);
  return entry ? &entry->value : nullptr;
}

class ScenarioReader {
 public:
  ScenarioReader(Parts parts, std::string path, std::string digest, const Config* building,
                 std::vector<ConfigProblem>& out)
      : parts_(std::move(parts)),
        path_(std::move(path)),
        sha256_(std::move(digest)),
        building_(building),
        out_(out) {}

  std::optional<Scenario> read() {
    const std::size_t before = out_.size();
    Scenario s;
    ConfigSection top("scenario", "scenario", &parts_.top, {1, 1}, problems_);
    const bool building = read_building(top, s.config);
    if (!building) s.config = {};
    s.rate_hz = top.given("rate_hz") ? top.number("rate_hz") : s.config.pipeline.options.rate_hz;
    s.seed = static_cast<std::uint64_t>(top.integer("seed"));

    ConfigSection motion("motion", "motion", section(parts_, "motion"), {1, 1}, problems_);
    s.motion = read_motion(motion, relative(""), s.seed);
    s.climate = read_climate(section(parts_, "climate"), problems_);
    s.duration_s = top.given("duration_s") ? top.number("duration_s") : s.motion.duration_s();
    // Years of a climate are not simulated instant by instant: `simulate` checks what is asked for.
    const std::string problem = !building   ? ""
                                : s.climate ? simulated_size_problem(s.config.pipeline.structure)
                                            : size_problem(s);
    if (!problem.empty()) problems_.push_back({place_of_size(problem), problem});
    ConfigSection truth("truth", "truth", section(parts_, "truth"), {1, 1}, problems_);
    if (building) {
      const estimator::PipelineConfig& p = s.config.pipeline;
      s.truth = TruthReader(p.structure, p.design, truth).read();
    }
    read_sensors(section(parts_, "sensors"), tables_of(parts_.sections, "sensor", problems_), s,
                 problems_);
    read_changes(s, building);
    read_effects_of(s, building);

    for (const TextProblem& p : problems_)
      out_.push_back(
          {p.place.line > 0 ? fmt::format("{}:{}:{}", path_, p.place.line, p.place.column) : path_,
           p.message});
    if (out_.size() > before) return std::nullopt;
    return s;
  }

 private:
  TextPlace place_of_size(const std::string& problem) const {
    const TomlEntry* entry =
        parts_.top.find(problem.starts_with("duration") ? "duration_s" : "config");
    return entry != nullptr ? entry->place : TextPlace{};
  }

  std::string relative(const std::string& file) const {
    return (std::filesystem::path(drivers::folder_of_paths_in(path_)) / file).string();
  }

  bool read_building(ConfigSection& top, Config& config) {
    if (building_) {
      config = *building_;
      return true;
    }
    if (top.given("config")) {
      for (const TomlEntry& entry : parts_.building.entries)
        problems_.push_back(
            {entry.place, fmt::format("{}: the building is that of {} (key config): "
                                      "only one of both may be here",
                                      entry.key, top.text("config"))});
      std::vector<ConfigProblem> problems;
      const auto found = load_config(relative(top.text("config")), problems);
      out_.insert(out_.end(), problems.begin(), problems.end());
      if (found) config = *found;
      return found.has_value();
    }
    config.path = path_;
    config.sha256 = sha256_;
    return read_config(parts_.building, config, problems_);
  }

  void read_effects_of(Scenario& s, bool building) {
    const auto tables = tables_of(parts_.sections, "effect", problems_);
    if (!building) return;
    const estimator::PipelineConfig& p = s.config.pipeline;
    s.effects = s.config.effects;
    const std::vector<estimator::Effect> own = read_effects(tables, p.structure, p.axes, problems_);
    s.effects.insert(s.effects.end(), own.begin(), own.end());
    const bool known = problems_.empty() && s.truth.size() > 0;
    if (known && !stands(p.structure, estimator::ParameterTable(p.structure), s.truth, s.effects))
      problems_.push_back({tables.empty() ? TextPlace{} : tables.front()->place,
                           "effect: the building cannot stand: with what is lost its stiffness is "
                           "not positive"});
  }

  void read_changes(Scenario& s, bool building) {
    struct Change {
      double at_s;
      int parameter;
      double factor;
    };
    std::vector<Change> changes;
    std::optional<estimator::ParameterTable> table;
    if (building) table.emplace(s.config.pipeline.structure);
    for (const TomlValue* value : tables_of(parts_.sections, "change", problems_)) {
      ConfigSection c("change", "change", value, {}, problems_);
      if (!table || !c.given("at_s") || !c.given("parameter") || !c.given("factor")) continue;
      const auto index = table->find(c.text("parameter"));
      if (index)
        changes.push_back({c.number("at_s"), *index, c.number("factor")});
      else
        c.problem("parameter", fmt::format("this building has no parameter \"{}\"; `framewatch "
                                           "check` lists them",
                                           c.text("parameter")));
    }
    std::stable_sort(changes.begin(), changes.end(),
                     [](const Change& a, const Change& b) { return a.at_s < b.at_s; });
    if (static_cast<double>(changes.size()) * static_cast<double>(s.truth.size()) > kMaxChanged) {
      problems_.push_back({{},
                           fmt::format("change: {} changes of a building of {} parameters: at "
                                       "most {:.0f} are simulated",
                                       changes.size(), s.truth.size(),
                                       kMaxChanged / static_cast<double>(s.truth.size()))});
      return;
    }
    Eigen::VectorXd theta = s.truth;
    for (const Change& change : changes) {
      theta[change.parameter] *= change.factor;
      s.changes.push_back({change.at_s, theta});
    }
  }

  Parts parts_;
  std::string path_;
  std::string sha256_;
  const Config* building_;  ///< null for the building in the file
  std::vector<ConfigProblem>& out_;
  std::vector<TextProblem> problems_;
};

}  // namespace

std::optional<Scenario> read_scenario(const std::string& text, const std::string& path,
                                      std::vector<ConfigProblem>& problems,
                                      const Config* building) {
  std::vector<TextProblem> syntax;
  const std::optional<TomlValue> root = parse_toml(text, syntax);
  for (const TextProblem& p : syntax)
    problems.push_back({fmt::format("{}:{}:{}", path, p.place.line, p.place.column), p.message});
  if (!root || !syntax.empty()) return std::nullopt;
  return ScenarioReader(split(*root), path, sha256(text), building, problems).read();
}

std::optional<Scenario> load_scenario(const std::string& path,
                                      std::vector<ConfigProblem>& problems) {
  std::string error;
  const std::optional<std::string> text = read_text_file(path, error);
  if (!text) {
    problems.push_back({path, error});
    return std::nullopt;
  }
  return read_scenario(*text, path, problems);
}

}  // namespace framewatch::daemon
