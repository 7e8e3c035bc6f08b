// SPDX-License-Identifier: MIT
#include "daemon/tools/replay/replay_survey.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include <framewatch/accel_counts_t.hpp>
#include <framewatch/channel_table_t.hpp>

#include <fmt/core.h>

#include "daemon/base/numbers.h"
#include "daemon/base/words.h"
#include "daemon/config/channel_addresses.h"
#include "daemon/config/header_differences.h"
#include "drivers/can/can_log_file.h"
#include "drivers/files/input_file.h"
#include "drivers/files/standard_streams.h"
#include "drivers/lcm/count_block.h"
#include "drivers/lcm/message_check.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kStampsPerNode = 4096;
constexpr int kDamageLines = 20;

bool looks_like_record(const std::string& path) {
  if (drivers::is_event_log(path)) return false;
  const std::string name = std::filesystem::path(path).filename();
  return path == drivers::kStandardInput || name.find(".csv") != std::string::npos ||
         name.ends_with(".txt") || name.ends_with(".AT2") || name.ends_with(".at2") ||
         drivers::is_network_file(path);
}

constexpr double kRateTolerance = 0.02;
constexpr std::size_t kRateLag = 100;  ///< samples; times may be rounded to whole milliseconds

std::string list(const std::map<std::string, std::int64_t>& channels) {
  std::string text;
  int shown = 0;
  for (const auto& [name, count] : channels) {
    if (++shown > 10) return text + ", ...";
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", name, count);
  }
  return text;
}

}  // namespace

std::int64_t bytes_of(const drivers::Record& record) {
  return static_cast<std::int64_t>(record.time_s.size() * (1 + record.names.size()) *
                                   sizeof(double));
}

ReplaySurvey::ReplaySurvey(const Config& config, bool salvage, ReplaySpan span)
    : config_(config),
      salvage_(salvage),
      span_(span),
      spanned_(!span.whole()),
      place_(span.from_s > 0 ? Place::before : Place::inside),
      span_zero_us_(span.zero_us.value_or(std::numeric_limits<std::int64_t>::min())),
      intake_(
          wanted_axes(config), [](const estimator::AccelSample&) {}, intake_settings(config)),
      counts_(axis_names(config)) {}

void ReplaySurvey::add_fault(std::string message) {
  if (!salvage_) ++faults_;
  (salvage_ ? notes_ : problems_).push_back(std::move(message));
}

void ReplaySurvey::declare(const RecordFileArguments& arguments) {
  std::vector<drivers::Problem> found;
  record_options_ = record_options(arguments, found);
  RecordFileArguments of_records = arguments;
  of_records.zone.clear();
  declared_ = of_records.any();
  misdeclared_ = !found.empty();
  for (const drivers::Problem& p : found)
    problems_.push_back(fmt::format("{}: {}", p.where, p.message));
}

void ReplaySurvey::add(const std::string& path) {
  if (misdeclared_ || ended_()) return;
  if (const std::string why = drivers::why_no_file(path); !why.empty()) {
    problems_.push_back(fmt::format("{}: {}", path, why));
    return;
  }
  std::error_code failure;
  const auto size = std::filesystem::file_size(path, failure);
  if (failure) {
    problems_.push_back(fmt::format("{}: {}", path, failure.message()));
  } else if (size == 0) {
    problems_.push_back(fmt::format("{}: is empty", path));
  } else if (drivers::can_log_format(path) != drivers::CanLogFormat::none) {
    add_can_log(path);
    bytes_ += static_cast<std::int64_t>(size);
  } else if (const std::string unread = drivers::unread_can_log(path); !unread.empty()) {
    problems_.push_back(fmt::format("{}: {}", path, unread));
  } else if (!looks_like_record(path)) {
    add_log(path);
    bytes_ += static_cast<std::int64_t>(size);
  } else {
    std::vector<drivers::Problem> found;
    auto record = drivers::read_record(path, record_options_, found);
    for (const drivers::Problem& p : found)
      problems_.push_back(fmt::format("{}: {}", p.where, p.message));
    if (record) add_record({path, true, std::move(*record), {}}, static_cast<std::int64_t>(size));
    bytes_ += static_cast<std::int64_t>(size);
  }
}

void ReplaySurvey::add(const std::string& name, drivers::Record record) {
  if (ended_()) return;
  const std::int64_t bytes = bytes_of(record);
  add_record({name, true, std::move(record), {}}, bytes);
  bytes_ += bytes;
}

/// bytes: the record's share of bytes(), which grows by it as the record is passed on.
void ReplaySurvey::add_record(ReplayInput input, std::int64_t bytes) {
  const drivers::Record& record = input.record;
  for (const std::string& note : record.notes) notes_.push_back(input.path + ": " + note);
  const auto& axes = config_.pipeline.axes;
  std::vector<std::string> others;
  for (const std::string& name : record.names) {
    const auto at = std::find_if(axes.begin(), axes.end(), [&](const estimator::SensorAxis& axis) {
      return axis.name == name;
    });
    input.axis_of_column.push_back(at == axes.end() ? -1 : static_cast<int>(at - axes.begin()));
    if (at == axes.end()) others.push_back(name);
  }
  if (others.size() == record.names.size())
    problems_.push_back(fmt::format("{}: no column is named like a channel of {}; it has {}",
                                    input.path, config_.path, listed(others)));
  else if (!others.empty())
    notes_.push_back(
        fmt::format("{}: ignored columns without a channel: {}", input.path, listed(others)));
  for (const std::string& difference : header_differences(config_, record))
    notes_.push_back(fmt::format("{}: {}", input.path, difference));
  check_rate(input.path, record.rate_hz);
  std::vector<std::int64_t> used_us;
  for (const double time_s : record.time_s)
    if (const std::int64_t time_us = std::llround(time_s * 1e6); !outside(time_us))
      used_us.push_back(time_us);
  const bool in_order = used_us.empty() || extend(input.path, used_us.front(), used_us.back());
  if (in_order && estimation_ != nullptr) give_record(input, bytes);
  inputs_.push_back(std::move(input));
}

void ReplaySurvey::give_record(const ReplayInput& input, std::int64_t bytes) {
  const drivers::Record& record = input.record;
  const double bytes_of_instant =
      static_cast<double>(bytes) / static_cast<double>(record.time_s.size());
  for (std::size_t i = 0; i < record.time_s.size(); ++i) {
    const std::int64_t time_us = std::llround(record.time_s[i] * 1e6);
    if (outside(time_us)) continue;
    if (ended_()) return;
    if (step_)
      step_(bytes_ + static_cast<std::int64_t>(bytes_of_instant * static_cast<double>(i)), time_us);
    for (std::size_t c = 0; c < input.axis_of_column.size(); ++c)
      if (input.axis_of_column[c] >= 0)
        estimation_->sample({estimator::from_microseconds(time_us), input.axis_of_column[c],
                             record.accel_mps2[c][i]});
  }
}

/// Returns true if a sensor time lies outside the span. Without zero_us, the first time passed is
/// the span's zero.
bool ReplaySurvey::outside(std::int64_t time_us) {
  if (!spanned_) return false;
  if (span_zero_us_ == std::numeric_limits<std::int64_t>::min()) span_zero_us_ = time_us;
  const double time_s = static_cast<double>(time_us - span_zero_us_) * 1e-6;
  return time_s < span_.from_s || time_s >= span_.to_s;
}

bool ReplaySurvey::left_out(const drivers::LogEvent& event) {
  if (!spanned_) return false;
  const bool ours = intake().binding().carries(event.channel);
  const auto time_us = ours ? drivers::accel_time_us(event.data.data(), event.data.size())
                            : std::optional<std::int64_t>();
  if (time_us) {
    const bool is_outside = outside(*time_us);
    const double time_s = static_cast<double>(*time_us - span_zero_us_) * 1e-6;
    place_ = !is_outside ? Place::inside : time_s < span_.from_s ? Place::before : Place::after;
  }
  if (place_ != Place::before) return place_ == Place::after;
  // Tables before the span name the channels within it.
  return goes_on_ || drivers::stream_of_table(event.channel).empty();
}

void ReplaySurvey::add_log(const std::string& path) {
  drivers::LcmLogReader reader;
  if (!reader.open(path)) {
    problems_.push_back(fmt::format("{}: {}", path, reader.error()));
    return;
  }
  std::error_code ignored;
  const auto packed_bytes = static_cast<std::int64_t>(std::filesystem::file_size(path, ignored));
  LogSeen seen;
  stamps_.clear();
  int damages = 0;
  const std::int64_t malformed = intake().counters().malformed;
  const std::int64_t backwards = intake().backwards();
  estimation_ != nullptr ? estimation_->log_begins() : intake_.log_begins();
  counts_.log_begins();
  const std::int64_t damaged_before = damaged_bytes_;
  drivers::LogEvent event;
  for (auto read = reader.next(event); read != drivers::LogRead::end; read = reader.next(event)) {
    if (read == drivers::LogRead::error) {
      problems_.push_back(fmt::format("{}: byte {}: {}", path, reader.position(), reader.error()));
      return;
    }
    if (ended_()) return;
    if (read == drivers::LogRead::event) {
      if (step_)
        step_(bytes_ + reader.position() * packed_bytes / reader.size(), event.timestamp_us);
      take_event(event, seen);
      continue;
    }
    damaged_bytes_ += reader.damage().bytes;
    if (++damages <= kDamageLines)
      add_fault(fmt::format("{}: byte {}: {}, {} bytes skipped: {}", path, reader.damage().offset,
                            read == drivers::LogRead::truncated ? "truncated" : "damaged",
                            reader.damage().bytes, reader.damage().reason));
  }
  if (damages > kDamageLines)
    add_fault(fmt::format("{}: {} damaged places in all, {} bytes", path, damages,
                          damaged_bytes_ - damaged_before));
  if (intake().backwards() == backwards) seen.backwards_offset = -1;  // it was another sender's
  judge_log(path, seen, intake().counters().malformed - malformed);
  inputs_.push_back({path, false, {}, {}});
}

void ReplaySurvey::add_can_log(const std::string& path) {
  if (config_.can.empty()) {
    problems_.push_back(
        fmt::format("{}: is a log of CAN frames, and no channel of {} has a source on CAN", path,
                    config_.path));
    return;
  }
  any_dated_ = any_dated_ || drivers::can_log_format(path) != drivers::CanLogFormat::candump;
  drivers::CanIntake unfed(config_.can, [](const estimator::AccelSample&) {});
  const drivers::CanIntake& intake = estimation_ != nullptr ? estimation_->can() : unfed;
  const auto taken = [&] {
    std::int64_t frames = 0;
    for (std::size_t n = 0; n < config_.can.nodes.size(); ++n) frames += intake.node(n).frames;
    return frames;
  };
  const std::int64_t before = taken();
  std::map<std::string, std::int64_t, std::less<>> others;
  std::vector<drivers::Problem> found;
  std::vector<std::string> unknown;
  std::int64_t first_us = INT64_MAX, last_us = INT64_MIN;
  const std::int64_t bytes_before = drivers::bytes_read();
  drivers::read_can_log(
      path, record_options_.zone_min,
      [&](const drivers::CanFrame& frame, std::string_view interface) {
        const int bus = intake.bus_of(interface);
        if (bus < 0) {
          const auto at = others.find(interface);
          ++(at == others.end() ? others[std::string(interface)] : at->second);
          return;
        }
        if (outside(frame.stamp_us) || ended_()) return;
        first_us = std::min(first_us, frame.stamp_us);
        last_us = std::max(last_us, frame.stamp_us);
        if (step_) step_(bytes_ + drivers::bytes_read() - bytes_before, frame.stamp_us);
        if (estimation_ != nullptr)
          estimation_->frame(bus, frame);
        else
          unfed.frame(bus, frame);
      },
      unknown, found);
  for (const std::string& note : unknown) notes_.push_back(fmt::format("{}: {}", path, note));
  for (const drivers::Problem& p : found) add_fault(fmt::format("{}: {}", p.where, p.message));
  for (const auto& [interface, count] : others)
    notes_.push_back(fmt::format("{}: ignored {} frames of {}, an interface that {} does not use",
                                 path, count, interface, config_.path));
  if (taken() == before && !spanned_)
    problems_.push_back(fmt::format("{}: no frame for the channels of {}", path, config_.path));
  if (first_us <= last_us) extend(path, first_us, last_us);
  inputs_.push_back({path, false, {}, {}, record_options_.zone_min});
}

void ReplaySurvey::take_event(const drivers::LogEvent& event, LogSeen& seen) {
  ++seen.events;
  if (seen.newest == nullptr || seen.newest->first != event.channel)
    seen.newest = &*seen.channels.try_emplace(event.channel, 0).first;
  ++seen.newest->second;
  if (is_of_raw_log(event.channel)) {
    take_counts(event, seen);
    return;
  }
  if (left_out(event)) {
    seen.left_out = true;
    return;
  }
  const std::int64_t backwards = intake().backwards();
  const drivers::IntakeCounters before = intake().counters();
  const auto give = [&](auto& to) {
    return to.message(event.channel, event.data.data(), event.data.size(), {}, event.timestamp_us);
  };
  const auto result = estimation_ != nullptr ? give(*estimation_) : give(intake_);
  if (result == drivers::IntakeResult::malformed && seen.first_malformed_offset < 0) {
    seen.first_malformed_offset = event.offset;
    const char* type = drivers::type_of_lcm_channel(event.channel);
    seen.malformed =
        event.channel + ": " + drivers::why_not(type == nullptr ? "accel_t" : type, event.data);
  }
  const drivers::IntakeCounters& now = intake().counters();
  if (now.elsewhere > before.elsewhere && seen.elsewhere_offset < 0)
    seen.elsewhere_offset = event.offset;
  if (now.renamed > before.renamed && seen.renamed_offset < 0) seen.renamed_offset = event.offset;
  if (result != drivers::IntakeResult::samples) return;
  const drivers::SensorNodeSample& sample = intake().last_sample();
  const std::int64_t time_us = to_microseconds(sample.time);
  if (intake().backwards() > backwards && seen.backwards_offset < 0)
    seen.backwards_offset = event.offset;
  for (const double value : sample.accel_abs_mps2)
    if (std::isinf(value) && seen.infinite_offset < 0) seen.infinite_offset = event.offset;
  log_first_us_ = seen.samples == 0 ? time_us : std::min(log_first_us_, time_us);
  log_last_us_ = seen.samples == 0 ? time_us : std::max(log_last_us_, time_us);
  ++seen.samples;
  if (intake().last_node() >= stamps_.size()) stamps_.resize(intake().last_node() + 1);
  NodeStamps& node = stamps_[intake().last_node()];
  if (node.stamps.empty()) node.place = {event.channel, sample.node};
  if (node.stamps.size() < kStampsPerNode) node.stamps.push_back({sample.sequence, time_us});
}

// Nodes need not stop at the same time at the end of a log, so the next one may begin earlier by
// lateness_s.
bool ReplaySurvey::extend(const std::string& path, std::int64_t first_us, std::int64_t last_us) {
  const auto allowed_us = static_cast<std::int64_t>(config_.pipeline.options.lateness_s * 1e6);
  const bool in_order = !any_ || first_us > last_us_ - allowed_us;
  if (!in_order)
    problems_.push_back(
        fmt::format("{}: its time, {:.6f} s to {:.6f} s, is not after {}, which ends at {:.6f} s: "
                    "give the files in order of time, without overlap",
                    path, static_cast<double>(first_us) * 1e-6, static_cast<double>(last_us) * 1e-6,
                    last_path_, static_cast<double>(last_us_) * 1e-6));
  first_us_ = any_ ? std::min(first_us_, first_us) : first_us;
  last_us_ = any_ ? std::max(last_us_, last_us) : last_us;
  any_ = true;
  last_path_ = path;
  return in_order;
}

void ReplaySurvey::finish() {
  if (problems_.empty() && spanned_ && !any_)
    problems_.push_back("--from, --to: no sample of the input lies there");
  const bool only_logs = std::none_of(inputs_.begin(), inputs_.end(),
                                      [](const ReplayInput& input) { return input.is_record; });
  if (!only_logs || !problems_.empty()) return;
  if (declared_ || (record_options_.zone_min && !any_dated_))
    problems_.push_back("--unit, --step and the like are for record files: a log contains them");
  const std::string names = listed(any_raw_ ? counts_.missing() : intake().binding().unbound());
  if (!names.empty())
    notes_.push_back(
        fmt::format("channels of {} that no message carries: {}", config_.path, names));
}

void ReplaySurvey::judge_log(const std::string& path, const LogSeen& seen, std::int64_t malformed) {
  if (seen.is_raw) {
    judge_raw_log(path, seen);
    return;
  }
  const std::string malformed_text = fmt::format(
      "{}: byte {}: {} messages on our channels are not accel_t or channel_table_t, the first: {}",
      path, seen.first_malformed_offset, malformed, seen.malformed);
  if (malformed > 0 && seen.samples > 0) add_fault(malformed_text);
  if (malformed > 0 && seen.samples == 0) problems_.push_back(malformed_text);
  if (seen.elsewhere_offset >= 0)
    add_fault(
        fmt::format("{}: byte {}: a channel table puts channels elsewhere than their source in {}. "
                    "The configuration applies. `framewatch convert --config` makes a log that "
                    "agrees with it from a record",
                    path, seen.elsewhere_offset, config_.path));
  if (seen.renamed_offset >= 0)
    notes_.push_back(
        fmt::format("{}: byte {}: a channel table names channels differently from {}. The "
                    "configuration's sources apply",
                    path, seen.renamed_offset, config_.path));
  if (seen.infinite_offset >= 0)
    add_fault(fmt::format("{}: byte {}: infinite acceleration", path, seen.infinite_offset));
  if (seen.events == 0)
    problems_.push_back(fmt::format("{}: holds no intact LCM event", path));
  else if (seen.samples == 0 && malformed == 0 && !seen.left_out)
    problems_.push_back(fmt::format("{}: no message for the channels of {}; it has {}", path,
                                    config_.path, list(seen.channels)));
  const bool in_order = seen.samples == 0 || extend(path, log_first_us_, log_last_us_);
  if (in_order && seen.backwards_offset >= 0)
    problems_.push_back(fmt::format(
        "{}: byte {}: time runs backwards: a node's sample is not newer than the one before", path,
        seen.backwards_offset));
  std::sort(stamps_.begin(), stamps_.end(),
            [](const NodeStamps& a, const NodeStamps& b) { return a.place < b.place; });
  for (const auto& [node, stamps] : stamps_) {
    if (stamps.empty()) continue;
    const std::size_t lag = std::min(kRateLag, stamps.size() - 1);
    std::vector<double> steps;
    for (std::size_t i = lag; lag > 0 && i < stamps.size(); ++i) {
      const auto sequence_step = stamps[i].sequence - stamps[i - lag].sequence;
      const auto time_step_us = stamps[i].time_us - stamps[i - lag].time_us;
      if (sequence_step > 0 && time_step_us > 0)
        steps.push_back(static_cast<double>(time_step_us) / static_cast<double>(sequence_step));
    }
    if (steps.empty()) continue;
    check_rate(fmt::format("{}: {} node {}", path, node.first, node.second),
               1e6 / median(std::move(steps)));
  }
}

void ReplaySurvey::check_rate(const std::string& place, double rate_hz) {
  const double configured = config_.pipeline.options.rate_hz;
  if (std::abs(rate_hz / configured - 1) > kRateTolerance)
    problems_.push_back(fmt::format("{}: sampled at {:.4g} Hz, but {} says rate_hz = {:g}", place,
                                    rate_hz, config_.path, configured));
}

/// Takes an event of a raw log. An intake has checked its samples already when they were recorded.
void ReplaySurvey::take_counts(const drivers::LogEvent& event, LogSeen& seen) {
  seen.is_raw = any_raw_ = true;
  const auto give = [&](const estimator::AccelSample& sample) {
    const std::int64_t time_us = to_microseconds(sample.time);
    if (outside(time_us)) {
      seen.left_out = true;
      const bool before = static_cast<double>(time_us - span_zero_us_) * 1e-6 < span_.from_s;
      place_ = before ? Place::before : Place::after;
      return;
    }
    place_ = Place::inside;
    log_first_us_ = seen.samples == 0 ? time_us : std::min(log_first_us_, time_us);
    log_last_us_ = seen.samples == 0 ? time_us : std::max(log_last_us_, time_us);
    ++seen.samples;
    if (estimation_ != nullptr) estimation_->sample(sample);
  };
  const auto result = counts_.message(event.channel, event.data, give);
  if (result != drivers::IntakeResult::malformed) return;
  if (seen.malformed_counts++ > 0) return;
  seen.first_malformed_offset = event.offset;
  const bool is_table = event.channel == drivers::kCountsTableChannel;
  const bool whole = drivers::is_well_formed(
      event.data, is_table ? channel_table_t::getHash() : accel_counts_t::getHash());
  seen.malformed =
      event.channel + ": " +
      (!whole     ? drivers::why_not(is_table ? "channel_table_t" : "accel_counts_t", event.data)
       : is_table ? "names too many channels"
                  : "no channel table before it, or an invalid resolution");
}

void ReplaySurvey::judge_raw_log(const std::string& path, const LogSeen& seen) {
  if (seen.malformed_counts > 0) {
    const std::string text =
        fmt::format("{}: byte {}: {} messages are not valid in a raw log, the first: {}", path,
                    seen.first_malformed_offset, seen.malformed_counts, seen.malformed);
    if (seen.samples > 0)
      add_fault(text);
    else
      problems_.push_back(text);
  }
  if (seen.samples == 0 && seen.malformed_counts == 0 && !seen.left_out)
    problems_.push_back(fmt::format("{}: no channel is named like one of {}; it has {}", path,
                                    config_.path, listed(counts_.unknown())));
  else if (std::exchange(ignored_, listed(counts_.unknown())) != ignored_ && !ignored_.empty())
    notes_.push_back(fmt::format("{}: ignored channels that {} does not have: {}", path,
                                 config_.path, ignored_));
  if (seen.samples > 0) extend(path, log_first_us_, log_last_us_);
  if (counts_.rate_hz() > 0) check_rate(path, counts_.rate_hz());
}

}  // namespace framewatch::daemon
