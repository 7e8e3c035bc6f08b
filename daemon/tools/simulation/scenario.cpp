#include "daemon/tools/simulation/scenario.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/file_digest.h"
#include "daemon/base/toml_document.h"
#include "daemon/config/keys/section.h"
#include "daemon/config/read_config.h"
#include "daemon/config/sections/effects.h"
#include "daemon/tools/simulation/scenario_motion.h"
#include "daemon/tools/simulation/scenario_sensors.h"
#include "daemon/tools/simulation/scenario_truth.h"
#include "daemon/tools/simulation/simulation_size.h"
#include "drivers/files/standard_streams.h"
#include "estimator/simulate/building_model.h"

namespace framewatch::daemon {
namespace {

constexpr double kMaxChanged = 1e7;  // every change has a value of every parameter
constexpr std::array kSections = {"truth", "motion", "sensors", "sensor", "change", "effect"};

/// The file in three parts: top keys, sections of the scenario, the rest (the building).
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
    s.duration_s = top.given("duration_s") ? top.number("duration_s") : s.motion.duration_s();
    if (const std::string problem = building ? size_problem(s) : ""; !problem.empty())
      problems_.push_back({place_of_size(problem), problem});
    ConfigSection truth("truth", "truth", section(parts_, "truth"), {1, 1}, problems_);
    if (building) {
      const estimator::PipelineConfig& p = s.config.pipeline;
      s.truth = read_truth(truth, p.structure, p.design);
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
  const Config* building_;  ///< null: the file's own
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
