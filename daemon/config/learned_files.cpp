// SPDX-License-Identifier: MIT
#include "daemon/config/learned_files.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/core.h>

#include "daemon/base/file_digest.h"
#include "daemon/base/toml_document.h"
#include "daemon/config/channel_addresses.h"
#include "daemon/config/keys/section.h"
#include "daemon/config/keys/suggest.h"
#include "daemon/config/read_config.h"
#include "drivers/files/input_file.h"

namespace framewatch::daemon {
namespace {

/// Returns how a model's building differs from this one, or an empty text.
std::string difference(const Config& config, const Config& model) {
  const estimator::Structure &a = config.pipeline.structure, &b = model.pipeline.structure;
  if (a.stories != b.stories || a.frames_x != b.frames_x || a.frames_y != b.frames_y ||
      a.floor != b.floor)
    return "has other stories, frames or floors";
  if (axis_names(config) != axis_names(model)) return "has other channels";
  return {};
}

/// Returns why these are not points of a curve, or an empty text.
std::string problem_of(const std::vector<double>& amplitudes, const std::vector<double>& values,
                       const std::vector<double>& errors) {
  constexpr std::size_t kMax = estimator::AmplitudeBins::kBins;
  if (amplitudes.size() > kMax)
    return fmt::format("{} amplitudes, at most {}", amplitudes.size(), kMax);
  if (values.size() != amplitudes.size() || errors.size() != amplitudes.size())
    return fmt::format(
        "{} amplitudes, {} values and {} standard errors: value_at_amplitude and "
        "std_error_at_amplitude need one each",
        amplitudes.size(), values.size(), errors.size());
  if (std::adjacent_find(amplitudes.begin(), amplitudes.end(), std::greater_equal<>()) !=
      amplitudes.end())
    return "amplitudes must ascend";
  return "";
}

void read_points(ConfigSection& s, std::vector<estimator::AmplitudePoint>& out) {
  const std::vector<double> amplitudes = s.list("amplitude_m");
  const std::vector<double> values = s.list("value_at_amplitude");
  const std::vector<double> errors = s.list("std_error_at_amplitude");
  for (const char* key : {"amplitude_m", "value_at_amplitude", "std_error_at_amplitude"})
    if (!s.good(key)) return;
  const std::string problem = problem_of(amplitudes, values, errors);
  if (!problem.empty()) return s.problem("amplitude_m", problem);
  for (std::size_t i = 0; i < amplitudes.size(); ++i)
    out.push_back({amplitudes[i], values[i], errors[i]});
}

std::string points_text(const std::vector<estimator::AmplitudePoint>& points) {
  const auto list = [&](const char* key, double estimator::AmplitudePoint::*of) {
    std::string out = fmt::format("{} = [", key);
    for (std::size_t i = 0; i < points.size(); ++i)
      out += fmt::format("{}{:.17g}", i > 0 ? ", " : "", points[i].*of);
    return out + "]\n";
  };
  if (points.empty()) return "";
  return list("amplitude_m", &estimator::AmplitudePoint::amplitude_m) +
         list("value_at_amplitude", &estimator::AmplitudePoint::value) +
         list("std_error_at_amplitude", &estimator::AmplitudePoint::std_error);
}

void read_parameter(const TomlValue& value, const estimator::ParameterTable& table,
                    estimator::Baseline& out, std::vector<TextProblem>& problems) {
  ConfigSection s("baseline.parameter", "parameter", &value, {}, problems);
  if (!s.given("name")) return;
  const std::string name = s.text("name");
  int found = -1;
  std::vector<std::string> names;
  for (int p = 0; p < table.size(); ++p) {
    names.push_back(table[p].name);
    if (table[p].name == name) found = p;
  }
  if (found < 0) {
    const std::string meant = nearest(name, names);
    s.problem("name", fmt::format("this building has no parameter {}{}", name,
                                  meant.empty() ? "" : fmt::format(": did you mean {}?", meant)));
    return;
  }
  const auto p = static_cast<std::size_t>(found);
  if (!std::isnan(out.value[p])) s.problem("name", fmt::format("{} is given twice", name));
  if (s.given("unit") && s.text("unit") != table[found].unit)
    s.problem("unit", fmt::format("{} is in {}", name, table[found].unit));
  if (!s.given("value") || !s.given("std_error")) return;
  out.value[p] = s.number("value");
  out.std_error[p] = s.number("std_error");
  if (s.given("temperature_degc")) out.degc[p] = s.number("temperature_degc");
  read_points(s, out.by_amplitude[p]);
}

}  // namespace

std::optional<estimator::GapModel> parse_gap_model(const Config& config, const std::string& path,
                                                   const std::string& text,
                                                   std::vector<ConfigProblem>& problems) {
  Config model;
  const bool good = read_toml(
      path, text,
      [&](const TomlValue& document, std::vector<TextProblem>& found) {
        if (!read_config(document, model, found)) return;
        const std::string other = difference(config, model);
        if (!other.empty())
          found.push_back({{}, fmt::format("is not a model of {}: it {}", config.path, other)});
        else if (model.pipeline.design.size() == 0)
          found.push_back({{}, "is not a model: [structure.design] is missing"});
      },
      problems);
  if (!good) return std::nullopt;
  return estimator::GapModel{model.pipeline.design, model.effects};
}

std::optional<estimator::GapModel> load_gap_model_file(const Config& config,
                                                       const std::string& path,
                                                       std::vector<ConfigProblem>& problems) {
  std::string error;
  const std::optional<std::string> text = read_text_file(path, error);
  if (text) return parse_gap_model(config, path, *text, problems);
  problems.push_back({path, error});
  return std::nullopt;
}

void load_gap_model(Config& config, std::vector<ConfigProblem>& problems) {
  if (!config.gap || config.gap->model_path.empty()) return;
  if (drivers::is_absent(config.gap->model_path)) return;
  config.gap->model = load_gap_model_file(config, config.gap->model_path, problems);
}

std::string segment_name(const Config& config, std::int64_t gap_id) {
  const bool stored = config.gap && !config.gap->store.empty();
  return stored ? fmt::format("gap-{}.lcmlog", gap_id) : "";
}

std::string baseline_text(const estimator::Baseline& baseline,
                          const estimator::ParameterTable& table) {
  return extended_baseline_text("# Reference parameters of framewatch's [watch].\n",
                                estimator::Baseline(static_cast<std::size_t>(table.size())),
                                baseline, table);
}

std::string extended_baseline_text(const std::string& text, const estimator::Baseline& written,
                                   const estimator::Baseline& baseline,
                                   const estimator::ParameterTable& table) {
  std::string out = text;
  for (int i = 0; i < table.size(); ++i) {
    const auto p = static_cast<std::size_t>(i);
    if (written.knows(p) || !baseline.knows(p)) continue;
    out += fmt::format(
        "\n[[parameter]]\nname = \"{}\"\nvalue = {:.17g}\nstd_error = {:.17g}\nunit = \"{}\"\n",
        table[i].name, baseline.value[p], baseline.std_error[p], table[i].unit);
    if (!std::isnan(baseline.degc[p]))
      out += fmt::format("temperature_degc = {:.17g}\n", baseline.degc[p]);
    out += points_text(baseline.by_amplitude[p]);
  }
  return out;
}

std::optional<estimator::Baseline> load_baseline(const std::string& path,
                                                 const estimator::ParameterTable& table,
                                                 std::vector<ConfigProblem>& problems) {
  estimator::Baseline out(static_cast<std::size_t>(table.size()));
  const bool good = read_toml_file(
      path,
      [&](const TomlValue& document, std::vector<TextProblem>& found) {
        const ConfigSection top("baseline", "baseline", &document, {}, found);
        const std::vector<const TomlValue*> parameters = tables_of(document, "parameter", found);
        for (const TomlValue* value : parameters) read_parameter(*value, table, out, found);
        if (parameters.empty() && found.empty())
          found.push_back({{}, "has no [[parameter]]: nothing could be watched"});
      },
      problems);
  if (!good) return std::nullopt;
  return out;
}

void load_watch_baseline(Config& config, std::vector<ConfigProblem>& problems) {
  if (!config.watch || config.watch->baseline_path.empty()) return;
  if (drivers::is_absent(config.watch->baseline_path)) return;
  config.watch->baseline =
      load_baseline(config.watch->baseline_path, config.pipeline.parameters(), problems);
}

}  // namespace framewatch::daemon
