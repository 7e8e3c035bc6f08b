// SPDX-License-Identifier: MIT
#include "daemon/page/web/session_playback.h"

#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <framewatch/parameter_table_t.hpp>

#include "daemon/base/json.h"
#include "daemon/base/served_file.h"
#include "daemon/base/words.h"
#include "daemon/page/view/page_watch.h"
#include "daemon/page/web/web_sessions.h"
#include "daemon/tools/report/session_file.h"
#include "daemon/tools/session/session_log.h"
#include "drivers/lcm/message_check.h"

namespace framewatch::daemon {
namespace {

constexpr std::int64_t kFlushEvery_us = 50'000;        // as `serve` does
constexpr std::int64_t kLongestPause_us = 10'000'000;  // a longer one is shown as this long
constexpr std::size_t kPart = 32768, kMaxNotes = 20;
constexpr int kTableWithin = 1000;  // events of a log in which its first table is searched
constexpr unsigned char kLogStart[] = {0xED, 0xA1, 0xDA, 0x01};

/// Returns the configuration without the folders of what happens now.
Config of_the_past(Config config) {
  config.event_report.reset();
  config.history.reset();
  return config;
}

std::vector<std::string> names_of(const std::vector<ChannelResult>& results) {
  std::vector<std::string> out;
  for (const ChannelResult& r : results) out.push_back(r.name);
  return out;
}

/// Names what only one of both buildings has.
std::string other_building(const char* what, const std::vector<std::string>& theirs,
                           const std::vector<std::string>& ours) {
  const auto only = [](const std::vector<std::string>& of, const std::vector<std::string>& other) {
    std::vector<std::string> out;
    for (const std::string& name : of)
      if (std::find(other.begin(), other.end(), name) == other.end()) out.push_back(name);
    return out.empty() ? std::string("none") : listed(out, 4);
  };
  return fmt::format(
      "this session is of another building: of its {0}, this page lacks {1}; of the {0} of this "
      "page, the session lacks {2}. Open it with framewatch serve and its own configuration",
      what, only(theirs, ours), only(ours, theirs));
}

}  // namespace

SessionPlayback::SessionPlayback(const Config& config)
    : config_(of_the_past(config)),
      view_(
          config_,
          [this](std::int64_t, const std::string& channel, const std::vector<std::uint8_t>& bytes) {
            published_.emplace_back(channel, bytes);
          },
          [](const std::string&, const CommandPacket&) { return CommandAnswer{}; }),
      cursor_(view_.join()) {}

std::unique_ptr<SessionPlayback> SessionPlayback::open(const Config& config,
                                                       const std::string& folder,
                                                       const std::string& name, std::string& why) {
  const auto refused = [&why](std::string text) {
    why = std::move(text);
    return nullptr;
  };
  const auto text = is_session_name(name) ? read_served_file(folder, {name, kSessionJson})
                                          : std::optional<std::string>();
  if (!text) return refused("there is no such session");
  std::string error;
  const std::optional<SessionFile> session = parse_session(*text, error);
  if (!session) return refused("its session.json cannot be read: " + error);
  if (session->state == "recording")
    return refused(
        "it is being recorded, or its recording was cut off: then framewatch record "
        "CONFIG --finish FOLDER completes it");
  std::vector<std::string> ours;
  for (const estimator::SensorAxis& axis : config.pipeline.axes) ours.push_back(axis.name);
  const std::vector<std::string> theirs = names_of(session->run);
  if (session->config_sha256 != config.sha256 && !theirs.empty() && theirs != ours)
    return refused(other_building("channels", theirs, ours));

  std::unique_ptr<SessionPlayback> out(new SessionPlayback(config));
  const bool has_lcm = out->add(folder, name, kRawLog), has_can = out->add_frames(folder, name);
  if (!has_lcm && !has_can)
    return refused(fmt::format("it has no {} or {} that can be read", kRawLog, kCanLog));
  if (!has_lcm && config.can.empty())
    return refused(
        "its samples are CAN frames, and the page's configuration has no [[can]]. Open it with "
        "framewatch serve and its own configuration");
  if (!(has_lcm && out->logs_.front()->has) && !(has_can && out->can_->next() != nullptr))
    return refused("it holds no samples");
  const bool has_estimates =
      out->add(folder, name, kReplayedLog) || out->add(folder, name, kEstimatesLog);
  if (!has_estimates) out->notes_.emplace_back("it has no estimates");
  out->first_us_ = std::numeric_limits<std::int64_t>::max();
  for (const auto& log : out->logs_)
    if (log->has) out->first_us_ = std::min(out->first_us_, log->event.timestamp_us);
  if (has_can && out->can_->next() != nullptr)
    out->first_us_ = std::min(out->first_us_, out->can_->next()->stamp_us);
  out->flush_us_ = out->first_us_ + kFlushEvery_us;

  // The table of parameters stands near the start of the estimates.
  if (has_estimates) {
    drivers::LcmLogReader reader;
    drivers::LogEvent event;
    if (reader.open(fmt::format("/proc/self/fd/{}", out->logs_.back()->file.get())))
      for (int i = 0; i < kTableWithin && reader.next(event) == drivers::LogRead::event; ++i) {
        const auto table = event.channel == config.lcm.prefix + "PARAMETERS"
                               ? drivers::decoded<parameter_table_t>(event.data)
                               : std::nullopt;
        if (!table) continue;
        if (table->name != parameter_names(config))
          return refused(other_building("parameters", table->name, parameter_names(config)));
        break;
      }
  }
  const double length_s = 1e-6 * static_cast<double>(session->end_us - session->trigger_us);
  out->text_ = EventRing::text(
      "begin", json_line({{"test", session->request.test},
                          {"seconds", std::max(0.0, length_s) + session->request.pre_trigger_s},
                          {"same_config", session->config_sha256 == config.sha256}}));
  return out;
}

bool SessionPlayback::add(const std::string& folder, const std::string& session,
                          const std::string& file) {
  auto log = std::make_unique<Log>();
  log->name = file;
  log->file = open_served_file(folder, {session, file});
  // Packed logs would be unpacked as a whole first, which takes too long here.
  unsigned char start[sizeof kLogStart] = {};
  const ssize_t got = log->file.get() < 0 ? -1 : ::pread(log->file.get(), start, sizeof start, 0);
  if (got < 0 || (got > 0 && std::memcmp(start, kLogStart, sizeof start) != 0)) return false;
  if (!log->reader.open(fmt::format("/proc/self/fd/{}", log->file.get()))) return false;
  next(*log);
  logs_.push_back(std::move(log));
  return true;
}

bool SessionPlayback::add_frames(const std::string& folder, const std::string& session) {
  drivers::Descriptor file = open_served_file(folder, {session, kCanLog});
  if (file.get() < 0) return false;
  can_ = std::make_unique<CanPlayback>(
      config_.can, std::move(file), kCanLog,
      [this](const estimator::AccelSample& sample) { view_.sample(sample); });
  return true;
}

/// Reads the next event of a log past any damage.
void SessionPlayback::next(Log& log) {
  for (;;) {
    const drivers::LogRead read = log.reader.next(log.event);
    log.has = read == drivers::LogRead::event;
    if (log.has || read == drivers::LogRead::end) return;
    if (notes_.size() < kMaxNotes)
      notes_.push_back(read == drivers::LogRead::error
                           ? fmt::format("{}: {}", log.name, log.reader.error())
                           : fmt::format("{}: byte {}: {}", log.name, log.reader.damage().offset,
                                         read == drivers::LogRead::truncated
                                             ? "the recording is cut off here"
                                             : log.reader.damage().reason));
    if (read == drivers::LogRead::error) return;
  }
}

/// Passes the next message or frame on, or flushes when its time has come.
void SessionPlayback::advance() {
  Log* first = nullptr;
  for (const auto& log : logs_)
    if (log->has && (first == nullptr || log->event.timestamp_us < first->event.timestamp_us))
      first = log.get();
  const drivers::CanFrame* frame = can_ ? can_->next() : nullptr;
  const bool from_can =
      frame != nullptr && (first == nullptr || frame->stamp_us < first->event.timestamp_us);
  const std::int64_t next_us = from_can ? frame->stamp_us
                               : first  ? first->event.timestamp_us
                                        : std::numeric_limits<std::int64_t>::max();
  if (next_us >= flush_us_) {
    flush();
    if (first == nullptr && !from_can) {
      if (can_)
        for (std::string& note : can_->notes()) notes_.push_back(std::move(note));
      text_ += EventRing::text("end", json_line({{"notes", notes_}}));
      ended_ = true;
      return;
    }
    const std::int64_t skipped_us =
        std::max<std::int64_t>(0, next_us - flush_us_ - kLongestPause_us);
    first_us_ += skipped_us;
    flush_us_ += kFlushEvery_us + skipped_us;
    return;
  }
  if (from_can) return can_->advance();
  view_.message(first->event.channel, first->event.data.data(), first->event.data.size(), {},
                first->event.timestamp_us);
  next(*first);
  for (const auto& [channel, bytes] : std::exchange(published_, {}))
    view_.message(channel, bytes.data(), bytes.size());
}

void SessionPlayback::flush() {
  view_.flush();
  std::string part(kPart, '\0');
  bool any = false;
  for (std::size_t got; (got = view_.read(cursor_, part.data(), part.size())) > 0;) {
    if (!any)
      text_ += EventRing::text(
          "time", fmt::format("{:.3f}", 1e-6 * static_cast<double>(flush_us_ - first_us_)));
    any = true;
    text_.append(part, 0, got);
  }
}

std::size_t SessionPlayback::read(char* buffer, std::size_t size) {
  if (offset_ == text_.size()) {
    text_.clear();
    offset_ = 0;
    while (text_.empty() && !ended_) advance();
  }
  const std::size_t copied = std::min(size, text_.size() - offset_);
  std::memcpy(buffer, text_.data() + offset_, copied);
  offset_ += copied;
  return copied;
}

}  // namespace framewatch::daemon
