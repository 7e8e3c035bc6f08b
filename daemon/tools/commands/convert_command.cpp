// SPDX-License-Identifier: MIT
#include "daemon/tools/commands/convert_command.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/log.h"
#include "daemon/base/progress.h"
#include "daemon/base/words.h"
#include "daemon/config/channel_addresses.h"
#include "daemon/config/config.h"
#include "daemon/config/header_differences.h"
#include "daemon/monitor/estimates/estimate_output.h"
#include "daemon/tools/commands/convert_input.h"
#include "drivers/files/standard_streams.h"
#include "drivers/lcm/accel_log.h"
#include "drivers/records/record.h"
#include "drivers/records/record_csv_writer.h"
#include "estimator/motion/svd_denoise.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kNamed = 10;  ///< names in one message

/// Returns the warning of `convert` without a configuration about headers that `out` cannot store.
/// Empty if nothing is lost. `has_names`: the columns of `out` have names.
std::string lost_headers(const drivers::Record& record, const std::string& out, bool has_names) {
  std::vector<std::string> named;
  for (std::size_t c = 0; c < record.headers.size(); ++c)
    if (record.headers[c] != drivers::AxisHeader{}) named.push_back(record.names[c]);
  if (named.empty()) return {};
  return fmt::format(
      "{} does not keep what the headers say of {}: {}direction, place and unit; framewatch init "
      "--record makes a configuration of the same files, and convert --config holds them against "
      "one",
      out, listed(named, kNamed),
      has_names ? "" : "name (nodes are numbered in the order of the files), ");
}

using drivers::AxisAddress;
using drivers::Problem;
using drivers::Record;
using Problems = std::vector<Problem>;

constexpr std::size_t kProgressRows = 1 << 14;
constexpr std::int64_t kMaxStartUs = 4'000'000'000'000'000;

bool is_csv(const std::string& path) {
  return path == drivers::kStandardOutput || path.ends_with(".csv") || path.ends_with(".csv.gz");
}

/// Checks the arguments that need no file.
void check_arguments(const ConvertArguments& a, Problems& problems) {
  (void)record_options(a.record, problems);
  if (a.inputs.empty()) problems.push_back({"convert", "needs an input and an output file"});
  if (!is_csv(a.out) && !a.out.ends_with(".lcmlog"))
    problems.push_back({a.out,
                        "the output's name must end in .lcmlog, .csv or .csv.gz, or be - "
                        "(standard output, CSV)"});
  for (const std::string& in : a.inputs) {
    std::error_code error;
    if (in == a.out || std::filesystem::equivalent(in, a.out, error))
      problems.push_back({in, "is input and output"});
  }
  if (!a.config.empty() && !a.channel.empty())
    problems.push_back({"--channel", "the configuration names the LCM channels: leave one out"});
  if (std::abs(a.start_us) > kMaxStartUs)
    problems.push_back({"--start-us", fmt::format("must lie within +-{}", kMaxStartUs)});
}

std::vector<AxisAddress> numbered(const Record& record, bool devices, const std::string& channel) {
  std::vector<AxisAddress> result;
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(record.names.size()); ++i)
    result.push_back(
        {channel.empty() ? "ACCEL" : channel, devices ? i / 3 : i, devices ? i % 3 : 0});
  return result;
}

/// Keeps the columns that the configuration knows and sets their LCM channel and node.
std::vector<AxisAddress> configured(const Config& config, Record& record, Problems& problems) {
  const std::string& path = config.path;
  const std::vector<AxisAddress> known = addresses(config.sources);
  const auto& axes = config.pipeline.axes;
  Record kept{{}, std::move(record.time_s), {}, record.rate_hz, std::move(record.notes), {}, {}};
  std::vector<AxisAddress> result;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto at = std::find(record.names.begin(), record.names.end(), axes[i].name);
    if (at == record.names.end()) {
      problems.push_back({path, fmt::format("channel {} is not in the record", axes[i].name)});
      continue;
    }
    const auto c = static_cast<std::size_t>(at - record.names.begin());
    kept.names.push_back(axes[i].name);
    kept.accel_mps2.push_back(std::move(record.accel_mps2[c]));
    result.push_back(known[i]);
  }
  for (const std::string& name : record.names)
    if (std::find(kept.names.begin(), kept.names.end(), name) == kept.names.end())
      kept.notes.push_back(fmt::format("{}: not a channel of {}, left out", name, path));
  record = std::move(kept);
  return result;
}

/// Returns the channel of the main window among several windows' estimates, which other_windows_s
/// does not name, and prints it on stderr. Returns an empty text if that channel is missing
/// and `asked` is empty.
std::string main_window(const std::vector<std::string>& estimates, const std::string& asked) {
  constexpr std::string_view kMain = "ESTIMATE";
  const auto is_main = [&](const std::string& name) { return name.ends_with(kMain); };
  const auto main = std::find_if(estimates.begin(), estimates.end(), is_main);
  if (!asked.empty() || main == estimates.end() ||
      std::count_if(estimates.begin(), estimates.end(), is_main) > 1)
    return {};
  std::vector<std::string> others = estimates;
  std::erase(others, *main);
  log(LogLevel::notice, fmt::format("the main window's estimates, of {}; --channel takes those of "
                                    "another length: {}",
                                    *main, listed_channels(others)));
  return *main;
}

void write_csv(const std::string& out, const Record& record, ProgressLine& progress,
               Problems& problems) {
  progress.part_begins();
  drivers::RecordCsvWriter file;
  bool good = file.open(out, record.names);
  std::vector<double> row(record.names.size());
  for (std::size_t i = 0; good && i < record.time_s.size(); ++i) {
    for (std::size_t c = 0; c < row.size(); ++c) row[c] = record.accel_mps2[c][i];
    good = file.write(record.time_s[i], row);
    if (i % kProgressRows == 0)
      progress("writing " + out,
               static_cast<double>(i) / static_cast<double>(record.time_s.size()));
  }
  if (!good || !file.close()) problems.push_back({out, file.error()});
}

void warn(const std::string& doubt) {
  log(LogLevel::warning, doubt);
}

void report(const Record& record) {
  for (const std::string& note : record.notes) log(LogLevel::notice, note);
}

/// Applies the paper's noise removal, P1 (22)-(27), to every channel.
void denoise(Record& record, Problems& problems) {
  const estimator::SvdDenoising denoising;
  if (record.time_s.size() < static_cast<std::size_t>(denoising.segment_rows())) {
    problems.push_back({"--denoise", fmt::format("needs {} samples at least, the record has {}",
                                                 denoising.segment_rows(), record.time_s.size())});
    return;
  }
  for (std::size_t c = 0; c < record.names.size(); ++c) {
    Eigen::Map<Eigen::VectorXd> channel(record.accel_mps2[c].data(),
                                        static_cast<Eigen::Index>(record.accel_mps2[c].size()));
    if (channel.allFinite())
      channel = svd_denoised(channel, denoising);
    else
      problems.push_back({"--denoise", record.names[c] + " has missing samples"});
  }
  record.notes.push_back(fmt::format("noise removed, p = {}, q = {}, s(r) >= {}",
                                     denoising.interval_rows, denoising.intervals,
                                     denoising.norm_ratio));
}

void convert_log(const ConvertArguments& a, ProgressLine& progress, Problems& problems) {
  const std::string& in = a.inputs[0];
  if (a.inputs.size() > 1) problems.push_back({in, "an event log is converted alone"});
  if (!is_csv(a.out)) problems.push_back({a.out, "an event log is converted to .csv or .csv.gz"});
  if (a.record.any() || !a.config.empty() || a.start_us != 0)
    problems.push_back({in,
                        "--config, --start-us and what says how a record is to be read are for "
                        "records, not for event logs"});
  if (!problems.empty()) return;
  progress.follow_reading("reading " + in, a.inputs, 1);
  const auto contents = drivers::log_contents(in, problems);
  if (!contents) return;
  const std::string accel = chosen_channel(contents->accel, a.channel);
  std::string estimates = chosen_channel(contents->estimates, a.channel);
  if (accel.empty() && estimates.empty()) estimates = main_window(contents->estimates, a.channel);
  if (accel.empty() == estimates.empty()) {
    problems.push_back({in, no_channel(*contents, a.channel)});
    return;
  }
  if (!estimates.empty()) {
    if (a.denoise)
      problems.push_back({"--denoise", "needs accelerations; this log has no accelerations"});
    if (!problems.empty()) return;
    progress.follow_reading("converting " + in, a.inputs, 2);
    write_estimates_csv(in, estimates, a.boxplot, a.out, problems);
    return;
  }
  if (a.boxplot) problems.push_back({"--boxplot", "needs estimates; this log has no estimates"});
  progress.follow_reading("reading " + in, a.inputs, 1);
  auto record = read_doubted_log(in, accel, warn, problems);
  if (record && a.denoise) denoise(*record, problems);
  if (!record || !problems.empty()) return;
  report(*record);
  write_csv(a.out, *record, progress, problems);
}

void convert_records(const ConvertArguments& a, ProgressLine& progress, Problems& problems) {
  if (a.boxplot) problems.push_back({"--boxplot", "is for event logs of estimates"});
  if (!problems.empty()) return;
  std::optional<Config> config;
  if (!a.config.empty()) {
    std::vector<ConfigProblem> found;
    config = load_config(a.config, found);
    for (const ConfigProblem& p : found) problems.push_back({p.where, p.message});
  }
  bool devices = false;
  progress.follow_reading(a.inputs.size() == 1 ? "reading " + a.inputs[0] : "reading the records",
                          a.inputs, 1);
  auto record =
      read_merged(a.inputs, a.record, config ? &*config : nullptr, devices, warn, problems);
  if (!record) return;
  auto where = numbered(*record, devices, a.channel);
  if (!config)
    if (const std::string lost = lost_headers(*record, a.out, is_csv(a.out)); !lost.empty())
      log(LogLevel::notice, lost);
  if (config) {
    for (const std::string& difference : header_differences(*config, *record))
      log(LogLevel::warning, difference);
    where = configured(*config, *record, problems);
  }
  if (a.denoise && problems.empty()) denoise(*record, problems);
  if (!problems.empty()) return;
  report(*record);
  if (is_csv(a.out)) {
    for (double& time : record->time_s) time += static_cast<double>(a.start_us) / 1e6;
    write_csv(a.out, *record, progress, problems);
    return;
  }
  progress.part_begins();
  const std::string error =
      drivers::write_accel_log(a.out, *record, where, a.start_us,
                               [&](double share) { progress("writing " + a.out, share); });
  if (!error.empty()) problems.push_back({a.out, error});
}

}  // namespace

int convert(const ConvertArguments& arguments) {
  Problems problems;
  check_arguments(arguments, problems);
  if (problems.empty()) {
    ProgressLine progress("convert", false);
    if (std::any_of(arguments.inputs.begin(), arguments.inputs.end(), is_log_to_convert))
      convert_log(arguments, progress, problems);
    else
      convert_records(arguments, progress, problems);
  }
  for (const Problem& problem : problems)
    log(LogLevel::error, fmt::format("{}: {}", problem.where, problem.message));
  return problems.empty() ? 0 : 2;
}

}  // namespace framewatch::daemon
