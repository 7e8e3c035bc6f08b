// SPDX-License-Identifier: MIT
#include "daemon/tools/session/session_log.h"

#include <filesystem>
#include <utility>

#include "drivers/lcm/lcm_log.h"

namespace framewatch::daemon {

std::size_t MessageRing::cost(const KeptMessage& message) {
  return sizeof message + message.channel.size() + message.bytes.size();
}

void MessageRing::push(KeptMessage message) {
  const std::int64_t oldest_us = message.received_us - span_us_;
  bytes_ += cost(message);
  messages_.push_back(std::move(message));
  while (!messages_.empty() && (bytes_ > most_bytes_ || messages_.front().received_us < oldest_us))
    drop_oldest();
}

void MessageRing::drop_oldest() {
  bytes_ -= cost(messages_.front());
  messages_.pop_front();
}

void MessageRing::clear() {
  messages_.clear();
  bytes_ = 0;
}

bool SessionLog::open(const std::string& folder, bool lcm, bool can, std::string& error) {
  return (!lcm || raw_.open(folder + "/" + kRawLog, error)) &&
         (!can || can_.open(folder + "/" + kCanLog, error)) &&
         estimates_.open(folder + "/" + kEstimatesLog, error);
}

void SessionLog::write(const KeptMessage& m) {
  messages_ += m.kind != MessageKind::estimate;
  if (m.kind == MessageKind::frame) {
    (void)can_.append(m.bytes);  // failures are counted by the file
    return;
  }
  const bool raw = m.kind == MessageKind::raw;
  // A dropped event leaves its number missing in the log.
  std::int64_t& number = raw ? raw_events_ : estimate_events_;
  event_.clear();
  drivers::append_log_event(event_, number++, m.received_us, m.channel, m.bytes.data(),
                            m.bytes.size());
  (void)(raw ? raw_ : estimates_).append(event_);
}

std::int64_t SessionLog::dropped() const {
  return raw_.counters().dropped + can_.counters().dropped + estimates_.counters().dropped;
}

std::int64_t SessionLog::bytes() const {
  return raw_.counters().bytes + can_.counters().bytes + estimates_.counters().bytes;
}

std::string SessionLog::trouble() const {
  for (const drivers::DurableFile* file : {&raw_, &can_, &estimates_})
    if (std::string why = file->trouble(); !why.empty()) return why;
  return "";
}

void SessionLog::close(std::vector<std::string>& files, std::vector<std::string>& problems) {
  for (const auto& [file, name] : {std::pair{&raw_, kRawLog}, std::pair{&can_, kCanLog},
                                   std::pair{&estimates_, kEstimatesLog}}) {
    if (!file->is_open()) continue;
    std::string error;
    if (file->close(error))
      files.push_back(name);
    else
      problems.push_back(std::move(error));
  }
}

}  // namespace framewatch::daemon
