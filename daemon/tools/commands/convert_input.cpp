// SPDX-License-Identifier: MIT
#include "daemon/tools/commands/convert_input.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/words.h"
#include "drivers/formats/record_file.h"
#include "drivers/lcm/lcm_log.h"
#include "drivers/records/record_builder.h"

namespace framewatch::daemon {
namespace {

using drivers::Problem;
using drivers::Record;
using Problems = std::vector<Problem>;

constexpr std::size_t kNamedChannels = 10;  ///< in one message
constexpr double kRateTolerance = 0.02;

bool is_force(const Record& record, const std::string& name) {
  for (std::size_t c = 0; c < record.headers.size(); ++c)
    if (record.names[c] == name) return record.headers[c].unit == "N";
  return false;
}

/// Returns the range of the channel with that name, or of any accelerometer.
drivers::PlausibleRange range_of(const Config* config, const Record& record,
                                 const std::string& name) {
  drivers::PlausibleRange range;
  if (is_force(record, name)) range.range_mps2 = drivers::kMaxValue;
  if (config == nullptr) return range;
  for (const estimator::SensorAxis& axis : config->pipeline.axes) {
    if (axis.name != name) continue;
    range.scale = axis.scale;
    if (axis.is_force) range.range_mps2 = drivers::kMaxValue;
    if (axis.range > 0) range.range_mps2 = axis.range;
  }
  return range;
}

/// Warns of implausible values and contradictions to the configuration.
void look_at(const Record& record, const std::string& path, const Config* config, const Warn& warn,
             Problems& problems) {
  for (const std::string& doubt : drivers::implausible(
           record, path, [&](const std::string& name) { return range_of(config, record, name); },
           problems))
    warn(doubt);
  const double configured_hz =
      config != nullptr ? config->pipeline.options.rate_hz : record.rate_hz;
  if (std::abs(record.rate_hz / configured_hz - 1) > kRateTolerance)
    warn(fmt::format("{}: sampled at {:.4g} Hz, but {} has rate_hz = {:g}", path, record.rate_hz,
                     config->path, configured_hz));
}

std::vector<Record> read_records(const std::vector<std::string>& inputs,
                                 const RecordFileArguments& arguments, const Config* config,
                                 const Warn& warn, Problems& problems) {
  const drivers::RecordOptions options = record_options(arguments, problems);
  std::vector<Record> records;
  for (const std::string& in : inputs) {
    auto record = drivers::read_record(in, options, problems);
    if (record) look_at(*record, in, config, warn, problems);
    if (record) records.push_back(std::move(*record));
  }
  return records;
}

/// Lets records of devices begin at 0, because the zero of their clock has no meaning.
bool is_device(const Record& record) {
  return record.names == std::vector<std::string>{"x", "y", "z"};
}

}  // namespace

bool is_log_to_convert(const std::string& path) {
  return path.ends_with(".lcmlog") || drivers::is_event_log(path);
}

std::optional<Record> read_merged(const std::vector<std::string>& inputs,
                                  const RecordFileArguments& arguments, const Config* config,
                                  bool& devices, const Warn& warn, Problems& problems) {
  std::vector<Record> records = read_records(inputs, arguments, config, warn, problems);
  if (!problems.empty()) return std::nullopt;
  devices = std::all_of(records.begin(), records.end(), is_device);
  if (devices)
    for (std::size_t i = 0; i < records.size(); ++i)
      for (std::string& name : records[i].names) name = fmt::format("node{}.{}", i, name);
  auto merged =
      drivers::merge_records(std::move(records), inputs, drivers::MergeSpan::common, problems);
  if (merged && devices) {
    const double zero_s = merged->time_s.front();
    merged->notes.push_back(fmt::format("time 0 is {:.6f} s of the device clock", zero_s));
    for (double& time : merged->time_s) time -= zero_s;
  }
  return merged;
}

std::string listed_channels(const std::vector<std::string>& names) {
  return names.empty() ? "none" : listed(names, kNamedChannels);
}

std::string chosen_channel(const std::vector<std::string>& found, const std::string& asked) {
  if (!asked.empty())
    return std::find(found.begin(), found.end(), asked) != found.end() ? asked : "";
  return found.size() == 1 ? found[0] : "";
}

std::string no_channel(const drivers::LogContents& contents, const std::string& asked) {
  const std::string channels =
      fmt::format("accelerations: {}; estimates: {}; other: {}", listed_channels(contents.accel),
                  listed_channels(contents.estimates), listed_channels(contents.others));
  const std::string wanted = asked.empty() ? "ACCEL" : asked;
  const auto other = std::find(contents.others.begin(), contents.others.end(), wanted);
  if (other != contents.others.end() && (contents.accel.empty() || !asked.empty()))
    return fmt::format("the first message on channel {} is {}; {}", wanted,
                       contents.reasons[static_cast<std::size_t>(other - contents.others.begin())],
                       channels);
  if (contents.accel.empty() && contents.estimates.empty())
    return "holds neither accelerations nor estimates; " + channels;
  if (!asked.empty()) return fmt::format("channel {} is not one to convert; {}", asked, channels);
  return "choose one with --channel; " + channels;
}

std::optional<Record> read_doubted_log(const std::string& path, const std::string& channel,
                                       const Warn& warn, Problems& problems) {
  auto record = drivers::read_accel_log(path, channel, problems);
  Problems impossible;
  if (record) look_at(*record, path, nullptr, warn, impossible);
  for (const Problem& p : impossible) warn(fmt::format("{}: {}", p.where, p.message));
  return record;
}

std::optional<Record> read_to_convert(const std::vector<std::string>& inputs,
                                      const RecordFileArguments& arguments,
                                      const std::string& channel, const Warn& warn,
                                      Problems& problems) {
  if (std::none_of(inputs.begin(), inputs.end(), is_log_to_convert)) {
    bool devices = false;
    return read_merged(inputs, arguments, nullptr, devices, warn, problems);
  }
  const std::string& in = inputs[0];
  if (inputs.size() > 1) problems.push_back({in, "an event log is read alone"});
  if (arguments.any())
    problems.push_back({in, "what says how a record is to be read is not for event logs"});
  if (!problems.empty()) return std::nullopt;
  const auto contents = drivers::log_contents(in, problems);
  if (!contents) return std::nullopt;
  const std::string accel = chosen_channel(contents->accel, channel);
  if (!accel.empty()) return read_doubted_log(in, accel, warn, problems);
  problems.push_back(
      {in, contents->accel.empty() ? "holds no accelerations" : no_channel(*contents, channel)});
  return std::nullopt;
}

}  // namespace framewatch::daemon
