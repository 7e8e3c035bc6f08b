// SPDX-License-Identifier: MIT
#include "daemon/tools/simulation/simulated_history.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/utc_time.h"
#include "daemon/monitor/estimates/parameter_message.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/summary_store.h"
#include "drivers/files/partial_file.h"
#include "drivers/files/text_output.h"
#include "estimator/simulate/random.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {
namespace {

constexpr int kWindowsOfHour = 30;
constexpr std::size_t kHoursOfBatch = 24 * 7;  // in one transaction
constexpr std::uint64_t kStreamOfErrors = 1;   // the climate has its own random numbers

/// Returns the windows of an hour. start_us: of the summary that has them.
PeriodData windows_of(std::int64_t start_us, const Scenario& s, const Eigen::VectorXd& truth,
                      int elements, estimator::Random& random) {
  PeriodData out;
  out.start_us = start_us;
  out.whole = true;
  out.windows = kWindowsOfHour;
  out.last_us = start_us + kSecond_us;
  out.parameters.resize(static_cast<std::size_t>(truth.size()));
  for (Eigen::Index p = 0; p < truth.size(); ++p) {
    ParameterData& data = out.parameters[static_cast<std::size_t>(p)];
    const double ratio =
        p < elements ? s.climate->stiffness_error_ratio : s.climate->damping_error_ratio;
    const double error = ratio * truth[p];
    data.observable = kWindowsOfHour;
    for (int w = 0; w < kWindowsOfHour; ++w) {
      const double value = truth[p] + error * random.normal();
      data.sum += value;
      data.error_squares += error * error;
      data.min = std::min(data.min, value);
      data.max = std::max(data.max, value);
      data.box.push_back(value);
    }
  }
  return out;
}

bool write_weather(drivers::TextOutput& out, std::int64_t time_us,
                   const estimator::WeatherHour& w) {
  return out.write(fmt::format("{},{:.2f},{:.1f},{:.2f},{:.0f}\n", utc_text(time_us),
                               w.outside_degc, w.humidity_pct, w.wind_mps, w.occupied_pct));
}

/// Returns the periods of summaries that hours determine: those of the configuration from an hour
/// on, or hours.
std::vector<std::int64_t> periods_of(std::vector<std::int64_t> summary_s) {
  std::erase_if(summary_s, [](std::int64_t period_s) { return period_s % kHour_s != 0; });
  if (summary_s.empty()) summary_s.push_back(kHour_s);
  return summary_s;
}

/// Returns why a scenario has no history, or an empty text.
std::string problem_of(const Scenario& s, const std::string& directory) {
  if (!s.climate) return "--history and --weather need a [climate] in the scenario";
  if (s.config.pipeline.parameters().size() !=
      estimator::ParameterTable(s.config.pipeline.structure).size())
    return "--history needs a configuration that identifies every story";
  std::error_code none;
  if (std::filesystem::exists(directory, none) && !std::filesystem::is_empty(directory, none))
    return fmt::format("{} is not empty", directory);
  return {};
}

}  // namespace

std::string write_simulated_history(const Scenario& s, const std::string& directory,
                                    const std::string& weather_path,
                                    const std::function<void(std::int64_t done)>& step) {
  if (std::string problem = problem_of(s, directory); !problem.empty()) return problem;
  HistorySettings settings = s.config.history.value_or(HistorySettings{});
  settings.directory = directory;
  settings.summary_s = periods_of(settings.summary_s);
  SummaryStore store(settings);
  std::error_code none;
  std::filesystem::create_directories(directory, none);
  const std::string path = summary_file(directory);
  drivers::PartialFile file;
  if (!file.open(path)) return fmt::format("{}: {}", path, file.error());
  if (const std::string problem = store.open_new(path + ".partial"); !problem.empty())
    return fmt::format("{}: {}", path, problem);
  drivers::TextOutput weather;
  const bool tells = !weather_path.empty();
  const auto unwritten = [&] { return fmt::format("{}: {}", weather_path, weather.error()); };
  if (tells && !(weather.open(weather_path) &&
                 weather.write("time,outside_degc,humidity_pct,wind_mps,occupied_pct\n")))
    return unwritten();

  const estimator::ParameterTable table(s.config.pipeline.structure);
  estimator::ClimateStream climate = climate_of(s);
  estimator::Random random(s.seed, kStreamOfErrors);
  SummaryBatch batch;
  batch.parameters = parameter_message(s.config, table);
  batch.parameters.time_us = s.climate->start_us;
  const std::int64_t count = hours(s);
  const std::int64_t first_us = floor_to(s.climate->start_us, kHour_s * kSecond_us);
  for (std::int64_t h = 0; h < count; ++h) {
    const double at_s = static_cast<double>(h) * estimator::ClimateStream::kStep_s;
    const std::int64_t at_us = first_us + h * kHour_s * kSecond_us;
    const estimator::WeatherHour& now = climate.next();
    if (tells && !write_weather(weather, at_us, now)) return unwritten();
    for (const auto& [name, value] :
         {std::pair("outside_degc", now.outside_degc), std::pair("humidity_pct", now.humidity_pct),
          std::pair("wind_mps", now.wind_mps), std::pair("occupied_pct", now.occupied_pct)})
      batch.weather.push_back({name, at_us, value});
    batch.periods.push_back(
        windows_of(at_us, s, weathered(truth_at(s, at_s), climate), table.elements(), random));
    if (batch.periods.size() < kHoursOfBatch && h + 1 < count) continue;
    if (const std::string problem = store.add(batch); !problem.empty())
      return fmt::format("{}: {}", path, problem);
    batch.periods.clear();
    batch.weather.clear();
    step(h + 1);
  }
  store.close();
  if (!file.commit()) return fmt::format("{}: {}", path, file.error());
  return !tells || weather.close() ? std::string() : unwritten();
}

}  // namespace framewatch::daemon
