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
#include "drivers/files/standard_streams.h"
#include "drivers/formats/record_file.h"
#include "drivers/lcm/accel_log.h"
#include "drivers/lcm/lcm_log.h"
#include "drivers/records/record.h"
#include "drivers/records/record_builder.h"
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

constexpr double kRateTolerance = 0.02;
constexpr std::size_t kProgressRows = 1 << 14;
constexpr std::int64_t kMaxStartUs = 4'000'000'000'000'000;

bool is_csv(const std::string& path) {
  return path == drivers::kStandardOutput || path.ends_with(".csv") || path.ends_with(".csv.gz");
}

bool is_log(const std::string& path) {
  return path.ends_with(".lcmlog") || drivers::is_event_log(path);
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

bool is_force(const Record& record, const std::string& name) {
  for (std::size_t c = 0; c < record.headers.size(); ++c)
    if (record.names[c] == name) return record.headers[c].unit == "N";
  return false;
}

/// Returns the range of the channel with that name, or of any accelerometer.
drivers::PlausibleRange range_of(const std::optional<Config>& config, const Record& record,
                                 const std::string& name) {
  drivers::PlausibleRange range;
  if (is_force(record, name)) range.range_mps2 = drivers::kMaxValue;
  if (!config) return range;
  for (const estimator::SensorAxis& axis : config->pipeline.axes) {
    if (axis.name != name) continue;
    range.scale = axis.scale;
    if (axis.is_force) range.range_mps2 = drivers::kMaxValue;
    if (axis.range > 0) range.range_mps2 = axis.range;
  }
  return range;
}

/// Logs implausible values and contradictions to the configuration.
void look_at(const Record& record, const std::string& path, const std::optional<Config>& config,
             Problems& problems) {
  for (const std::string& doubt : drivers::implausible(
           record, path, [&](const std::string& name) { return range_of(config, record, name); },
           problems))
    log(LogLevel::warning, doubt);
  const double configured_hz = config ? config->pipeline.options.rate_hz : record.rate_hz;
  if (std::abs(record.rate_hz / configured_hz - 1) > kRateTolerance)
    log(LogLevel::warning, fmt::format("{}: sampled at {:.4g} Hz, but {} has rate_hz = {:g}", path,
                                       record.rate_hz, config->path, configured_hz));
}

std::vector<Record> read_records(const ConvertArguments& a, const std::optional<Config>& config,
                                 Problems& problems) {
  const drivers::RecordOptions options = record_options(a.record, problems);
  std::vector<Record> records;
  for (const std::string& in : a.inputs) {
    auto record = drivers::read_record(in, options, problems);
    if (record) look_at(*record, in, config, problems);
    if (record) records.push_back(std::move(*record));
  }
  return records;
}

/// Lets records of devices begin at 0, because the zero of their clock has no meaning.
bool is_device(const Record& record) {
  return record.names == std::vector<std::string>{"x", "y", "z"};
}

std::optional<Record> read_merged(const ConvertArguments& a, const std::optional<Config>& config,
                                  bool& devices, Problems& problems) {
  std::vector<Record> records = read_records(a, config, problems);
  if (!problems.empty()) return std::nullopt;
  devices = std::all_of(records.begin(), records.end(), is_device);
  if (devices)
    for (std::size_t i = 0; i < records.size(); ++i)
      for (std::string& name : records[i].names) name = fmt::format("node{}.{}", i, name);
  auto merged =
      drivers::merge_records(std::move(records), a.inputs, drivers::MergeSpan::common, problems);
  if (merged && devices) {
    const double zero_s = merged->time_s.front();
    merged->notes.push_back(fmt::format("time 0 is {:.6f} s of the device clock", zero_s));
    for (double& time : merged->time_s) time -= zero_s;
  }
  return merged;
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

/// Returns the channel that was asked for, or else the only one of `found`.
std::string chosen(const std::vector<std::string>& found, const std::string& asked) {
  if (!asked.empty())
    return std::find(found.begin(), found.end(), asked) != found.end() ? asked : "";
  return found.size() == 1 ? found[0] : "";
}

std::string list(const std::vector<std::string>& names) {
  return names.empty() ? "none" : listed(names, kNamed);
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
                                    *main, list(others)));
  return *main;
}

/// Returns why there is not exactly one channel to convert.
std::string no_choice(const drivers::LogContents& contents, const std::string& asked) {
  const std::string channels =
      fmt::format("accelerations: {}; estimates: {}; other: {}", list(contents.accel),
                  list(contents.estimates), list(contents.others));
  if (contents.accel.empty() && contents.estimates.empty())
    return "holds neither accelerations nor estimates; " + channels;
  if (!asked.empty()) return fmt::format("channel {} is not one to convert; {}", asked, channels);
  return "choose one with --channel; " + channels;
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
  const std::string accel = chosen(contents->accel, a.channel);
  std::string estimates = chosen(contents->estimates, a.channel);
  if (accel.empty() && estimates.empty()) estimates = main_window(contents->estimates, a.channel);
  if (accel.empty() == estimates.empty()) {
    problems.push_back({in, no_choice(*contents, a.channel)});
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
  auto record = drivers::read_accel_log(in, accel, problems);
  Problems impossible;  // a log cannot be corrected by hand: convert it and warn
  if (record) look_at(*record, in, {}, impossible);
  for (const Problem& p : impossible)
    log(LogLevel::warning, fmt::format("{}: {}", p.where, p.message));
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
  auto record = read_merged(a, config, devices, problems);
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
    if (std::any_of(arguments.inputs.begin(), arguments.inputs.end(), is_log))
      convert_log(arguments, progress, problems);
    else
      convert_records(arguments, progress, problems);
  }
  for (const Problem& problem : problems)
    log(LogLevel::error, fmt::format("{}: {}", problem.where, problem.message));
  return problems.empty() ? 0 : 2;
}

}  // namespace framewatch::daemon
