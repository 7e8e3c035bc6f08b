#include "daemon/config/baseline_file.h"

#include <cmath>

#include <fmt/core.h>

#include "daemon/config/toml_file.h"
#include "daemon/documents/toml_document.h"
#include "daemon/keys/section.h"
#include "daemon/keys/suggest.h"
#include "drivers/base/input_file.h"

namespace framewatch::daemon {
namespace {

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
}

}  // namespace

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
