#include "daemon/monitor/estimates/estimates_csv.h"

#include <array>
#include <cmath>
#include <optional>

#include <framewatch/parameter_table_t.hpp>

#include <fmt/core.h>

#include "drivers/files/number_text.h"
#include "drivers/lcm/lcm_log.h"
#include "drivers/lcm/message_check.h"

namespace framewatch::daemon {
namespace {

using drivers::LogEvent;
using drivers::Problem;

constexpr std::array<const char*, 3> kStatus = {"warming_up", "valid", "nothing_identifiable"};

std::string cell(double value) {
  return std::isfinite(value) ? "," + drivers::format_number(value) : ",";
}

/// The names of the parameters of a log, which must not change in it.
std::optional<std::vector<std::string>> parameter_names(const std::string& log,
                                                        std::vector<Problem>& problems) {
  std::optional<std::vector<std::string>> names;
  const bool whole = drivers::for_each_event(
      log,
      [&](const LogEvent& event) {
        if (drivers::fingerprint(event.data) != parameter_table_t::getHash()) return true;
        const auto table = drivers::decoded<parameter_table_t>(event.data);
        if (!table)
          problems.push_back(
              {place_of(log, event), drivers::why_not("parameter_table_t", event.data)});
        else if (names && *names != table->name)
          problems.push_back({place_of(log, event), "the parameter table changes inside the log"});
        else
          names = table->name;
        return problems.empty();
      },
      problems);
  if (whole && problems.empty() && !names)
    problems.push_back({log, "there is no parameter_table_t to name the parameters"});
  if (!problems.empty()) return std::nullopt;
  return names;
}

std::string header(const std::vector<std::string>& names, bool boxplot) {
  std::string line = "window_end_s,status";
  for (const std::string& name : names) {
    line += fmt::format(",{0},{0}.std_error,{0}.observable", name);
    if (boxplot)
      line += fmt::format(",{0}.q1,{0}.median,{0}.q3,{0}.whisker_low,{0}.whisker_high,{0}.outliers",
                          name);
  }
  return line + "\n";
}

std::string boxplot_cells(const window_estimate_t& estimate, std::size_t i) {
  if (i >= static_cast<std::size_t>(estimate.boxplots) || estimate.boxplot_count[i] == 0)
    return ",,,,,,";
  return cell(estimate.q1[i]) + cell(estimate.median[i]) + cell(estimate.q3[i]) +
         cell(estimate.whisker_low[i]) + cell(estimate.whisker_high[i]) +
         fmt::format(",{}", estimate.outliers[i]);
}

std::string row(const window_estimate_t& estimate, bool boxplot) {
  std::string line = drivers::format_number(static_cast<double>(estimate.window_end_us) / 1e6);
  line += fmt::format(",{}", kStatus[static_cast<std::size_t>(estimate.status)]);
  for (std::size_t i = 0; i < estimate.value.size(); ++i) {
    const bool observable = estimate.reason[i] == 0;
    line += observable ? cell(estimate.value[i]) + cell(estimate.std_error[i]) + ",1" : ",,,0";
    if (boxplot) line += boxplot_cells(estimate, i);
  }
  return line + "\n";
}

}  // namespace

std::string fault_of(const window_estimate_t& estimate, std::size_t parameters) {
  if (estimate.value.size() != parameters)
    return fmt::format("{} parameters where the table has {}", estimate.value.size(), parameters);
  if (estimate.boxplots != 0 && estimate.boxplots != estimate.parameters)
    return fmt::format("{} boxplots for {} parameters", estimate.boxplots, estimate.parameters);
  if (estimate.status < 0 || estimate.status >= static_cast<int>(kStatus.size()))
    return fmt::format("status {} is not 0, 1 or 2", estimate.status);
  for (std::size_t i = 0; i < parameters; ++i)
    if (estimate.reason[i] == 0 && !std::isfinite(estimate.value[i]))
      return fmt::format("parameter {} is observable and has no value", i);
  return "";
}

bool EstimatesCsvWriter::open(const std::string& path, const std::vector<std::string>& names,
                              const std::vector<std::string>&, bool boxplot) {
  parameters_ = names.size();
  boxplot_ = boxplot;
  return file_.open(path) && (continued_ || file_.write(header(names, boxplot)));
}

bool EstimatesCsvWriter::write(const window_estimate_t& estimate) {
  fault_ = fault_of(estimate, parameters_);
  return fault_.empty() && file_.write(row(estimate, boxplot_));
}

bool EstimatesCsvWriter::close() {
  return file_.close();
}

bool write_estimates_csv(const std::string& log, const std::string& channel, bool boxplot,
                         const std::string& out, std::vector<Problem>& problems) {
  const auto names = parameter_names(log, problems);
  if (!names) return false;
  EstimatesCsvWriter file;
  if (!file.open(out, *names, {}, boxplot)) {
    problems.push_back({out, file.error()});
    return false;
  }
  drivers::for_each_event(
      log,
      [&](const LogEvent& event) {
        if (event.channel != channel) return true;
        const auto estimate = drivers::decoded<window_estimate_t>(event.data);
        if (!estimate)
          problems.push_back(
              {place_of(log, event), drivers::why_not("window_estimate_t", event.data)});
        else if (!file.write(*estimate))
          problems.push_back({file.at_fault() ? place_of(log, event) : out, file.error()});
        return problems.empty();
      },
      problems);
  if (problems.empty() && !file.close()) problems.push_back({out, file.error()});
  return problems.empty();
}

}  // namespace framewatch::daemon
