// SPDX-License-Identifier: MIT
#include "daemon/tools/replay/repair_command.h"

#include <filesystem>
#include <numeric>

#include <fmt/core.h>

#include "daemon/base/exit_code.h"
#include "daemon/base/json.h"
#include "daemon/base/printable.h"
#include "daemon/base/progress.h"
#include "drivers/lcm/accel_codec.h"

namespace framewatch::daemon {
namespace {

constexpr int kDamaged = 1;

/// Returns "night.repaired.lcmlog" for "night.lcmlog" and for "night.lcmlog.zst".
std::string beside(const std::string& log) {
  std::filesystem::path path(log);
  if (path.extension() == ".zst") path.replace_extension();
  const std::string ending = path.has_extension() ? path.extension().string() : ".lcmlog";
  return path.replace_extension(".repaired" + ending).string();
}

std::string time_text(const std::optional<std::int64_t>& time_us) {
  return time_us ? fmt::format("{:.6f} s", static_cast<double>(*time_us) * 1e-6) : "";
}

std::string text_of(const LostStretch& s) {
  std::string out =
      fmt::format("byte {}: {}, {} bytes: {}", s.damage.offset,
                  s.truncated ? "truncated" : "damaged", s.damage.bytes, s.damage.reason);
  if (s.places > 1) out += fmt::format("; {} places in all", s.places);
  const std::string before = time_text(s.before_us), after = time_text(s.after_us);
  if (!before.empty() && !after.empty())
    out += fmt::format("; between {} and {}", before, after);
  else if (!before.empty())
    out += "; after " + before;
  else if (!after.empty())
    out += "; before " + after;
  if (s.events >= 0) out += fmt::format("; events lost by their numbers: {}", s.events);
  for (const auto& [node, samples] : s.samples)
    out += fmt::format("; {} node {}: samples lost: {}", node.first, node.second, samples);
  return out;
}

std::string time_json(const std::optional<std::int64_t>& time_us) {
  return time_us ? std::to_string(*time_us) : "null";
}

std::string json_of(const LostStretch& s) {
  std::string samples;
  for (const auto& [node, count] : s.samples)
    samples += fmt::format("{}{{\"channel\": {}, \"node\": {}, \"samples\": {}}}",
                           samples.empty() ? "" : ", ", json_text(node.first), node.second, count);
  return fmt::format(
      "{{\"byte\": {}, \"bytes\": {}, \"places\": {}, \"kind\": \"{}\", \"reason\": {}, "
      "\"after_us\": {}, \"before_us\": {}, \"events\": {}, \"lost\": [{}]}}",
      s.damage.offset, s.damage.bytes, s.places, s.truncated ? "truncated" : "damaged",
      json_text(s.damage.reason), time_json(s.before_us), time_json(s.after_us),
      s.events < 0 ? "null" : std::to_string(s.events), samples);
}

void report(const RepairArguments& a, const LogSurvey& survey, const std::string& out) {
  if (a.json) {
    fmt::print(
        "{{\"schema\": \"framewatch.repair/1\", \"log\": {}, \"out\": {}, \"events\": {}, "
        "\"damaged_bytes\": {},\n \"damage\": [",
        json_text(a.log), out.empty() ? "null" : json_text(out), survey.events(),
        survey.damaged_bytes());
    const char* comma = "\n  ";
    for (const LostStretch& s : survey.lost()) {
      fmt::print("{}{}", comma, json_of(s));
      comma = ",\n  ";
    }
    fmt::print("]}}\n");
    return;
  }
  for (const LostStretch& s : survey.lost()) fmt::print("{}: {}\n", a.log, printable(text_of(s)));
  fmt::print("{}: {} intact events, {} damaged bytes in {} places{}\n", a.log, survey.events(),
             survey.damaged_bytes(), survey.damaged_places(),
             survey.lost().empty() ? ": nothing to repair"
             : out.empty()         ? ""
                                   : "; the intact events are in " + out);
}

/// A larger jump means that a node or a logger restarted, not a loss.
constexpr std::int64_t kMaxLost = 1'000'000;

/// Returns the numbers missing between two, or -1 when the jump is not a plausible loss.
std::int64_t between(std::int64_t oldest, std::int64_t newest) {
  std::int64_t step = 0;
  if (__builtin_sub_overflow(newest, oldest, &step) || step < 1 || step > kMaxLost) return -1;
  return step - 1;
}

}  // namespace

int repair(const RepairArguments& a) {
  const std::string out = a.check ? "" : a.out.empty() ? beside(a.log) : a.out;
  std::error_code none;
  if (!out.empty() && (out == a.log || std::filesystem::equivalent(out, a.log, none)))
    return refuse("repair", a.log + ": is input and output; name another output with --out");
  drivers::LcmLogReader reader;
  if (!reader.open(a.log)) return refuse("repair", fmt::format("{}: {}", a.log, reader.error()));
  drivers::LcmLogWriter writer;
  if (!out.empty() && !writer.open(out))
    return refuse("repair", fmt::format("{}: {}", out, writer.error()));

  LogSurvey survey;
  drivers::LogEvent event;
  Progress progress("repair", reader.size(), "MB", 1e6, false);
  for (auto read = reader.next(event); read != drivers::LogRead::end; read = reader.next(event)) {
    progress(reader.position());
    if (read == drivers::LogRead::error)
      return refuse("repair",
                    fmt::format("{}: byte {}: {}", a.log, reader.position(), reader.error()));
    if (read != drivers::LogRead::event) {
      survey.damaged(reader.damage(), read == drivers::LogRead::truncated);
      continue;
    }
    survey.intact(event);
    if (!out.empty() && !writer.copy(event))
      return refuse("repair", fmt::format("{}: {}", out, writer.error()));
  }
  if (survey.events() == 0) return refuse("repair", a.log + ": holds no intact LCM event");
  const bool whole = survey.lost().empty();
  if (!out.empty() && !whole && !writer.close())
    return refuse("repair", fmt::format("{}: {}", out, writer.error()));
  report(a, survey, whole ? "" : out);
  return !whole && a.check ? kDamaged : 0;
}

void LogSurvey::intact(const drivers::LogEvent& event) {
  if (open_) {
    LostStretch& stretch = lost_.back();
    stretch.after_us = event.timestamp_us;
    if (stretch.places > 1)
      stretch.events = -1;
    else if (events_ > 0)
      stretch.events = between(last_number_, event.number);
    open_ = false;
  }
  ++events_;
  last_number_ = event.number;
  last_us_ = event.timestamp_us;
  count_samples(event);
}

void LogSurvey::count_samples(const drivers::LogEvent& event) {
  const auto sample = drivers::decode_accel(event.data.data(), event.data.size());
  if (!sample) return;
  const auto [at, is_new] = nodes_.try_emplace({event.channel, sample->node});
  Node& node = at->second;
  if (!is_new && node.stretches < lost_.size()) {
    const std::int64_t missing = between(node.sequence, sample->sequence);
    if (missing > 0) lost_[node.stretches].samples[at->first] += missing;
  }
  node = {sample->sequence, lost_.size()};
}

void LogSurvey::damaged(const drivers::LogDamage& damage, bool truncated) {
  open_ = true;
  if (lost_.size() == kMaxStretches) {
    LostStretch& last = lost_.back();
    last.damage.bytes += damage.bytes;
    ++last.places;
    return;
  }
  LostStretch stretch;
  stretch.damage = damage;
  stretch.truncated = truncated;
  if (events_ > 0) stretch.before_us = last_us_;
  lost_.push_back(std::move(stretch));
}

std::int64_t LogSurvey::damaged_bytes() const {
  return std::accumulate(
      lost_.begin(), lost_.end(), std::int64_t{0},
      [](std::int64_t sum, const LostStretch& s) { return sum + s.damage.bytes; });
}

std::int64_t LogSurvey::damaged_places() const {
  return std::accumulate(lost_.begin(), lost_.end(), std::int64_t{0},
                         [](std::int64_t sum, const LostStretch& s) { return sum + s.places; });
}

}  // namespace framewatch::daemon
