// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <framewatch/event_t.hpp>
#include <framewatch/parameter_table_t.hpp>
#include <framewatch/summary_t.hpp>

#include "drivers/files/encoded.h"
#include "fleet/link/link.h"
#include "fleet/message/address.h"

// Messages of buildings, and a hub that holds them until they are acknowledged.
namespace framewatch::fleet {

inline constexpr std::int64_t kHub_us = 1'795'305'600'000'000;  // 2026-11-22T00:00:00Z

inline event_t event(std::int64_t id) {
  event_t e{};
  e.kind = "stiffness_change";
  e.id = id;
  e.time_us = kHub_us - 1'000'000 * id;
  e.state = 1;
  e.severity = 2;
  e.place = "kx_1_y1";
  e.unit = "N/m";
  e.message = "lost 15 %";
  return e;
}

inline Message event_message(const std::string& building, std::int64_t id) {
  const event_t e = event(id);
  return packed(up_subject(building, "event"), message_key(building, event_key(e)), "event_t",
                drivers::encoded(e), "");
}

inline Message summary_message(const std::string& building, std::int32_t period_s,
                               std::int64_t start_us) {
  summary_t s{};
  s.start_us = start_us;
  s.period_s = period_s;
  s.windows = period_s;
  s.config_sha256 = std::string(64, 'a');
  s.parameters = 2;
  for (auto* list : {&s.observable, &s.boxed, &s.outliers}) list->assign(2, 5);
  for (auto* list : {&s.mean, &s.std_error, &s.min, &s.max, &s.q1, &s.median, &s.q3, &s.whisker_low,
                     &s.whisker_high})
    list->assign(2, 34e3F);
  return packed(up_subject(building, "summary." + std::to_string(period_s)),
                message_key(building, SummaryKey{period_s, start_us}), "summary_t",
                drivers::encoded(s), s.config_sha256);
}

inline Message parameters_message(const std::string& building) {
  parameter_table_t t{};
  t.config_sha256 = std::string(64, 'a');
  t.parameters = 2;
  t.name = {"kx_1_y1", "cx_1_y1"};
  t.unit = {"N/m", "N*s/m"};
  t.kind = {0, 2};
  t.story = {1, 1};
  t.design = {1, 2};
  return packed(up_subject(building, "parameters"), newest_key(building, "parameters", 1),
                "parameter_table_t", drivers::encoded(t), t.config_sha256);
}

/// A hub with consumers: delivers its messages on request, and again if they are not acknowledged.
class HubLink : public Link {
 public:
  void hold(Message message) {
    const bool is_event = message.subject.ends_with(".event");
    const bool is_newest = message.subject.ends_with(".inventory");
    const std::string stream = is_event ? "FW_EVENT" : is_newest ? "FW_LAST" : "FW_SUMMARY";
    message.reply = "$JS.ACK." + stream + ".store.1." + std::to_string(++number_);
    held_[message.reply] = std::move(message);
  }
  /// Delivers unacknowledged messages again.
  void time_is_over() { given_.clear(); }
  std::size_t held() const { return held_.size(); }
  void cut() { ++connections_; }
  int requests() const { return requests_; }
  const std::vector<Message>& commands() const { return commands_; }
  int given_back() const { return given_back_; }

  bool publish(const Message& message) override {
    if (message.subject.starts_with("$JS.API.CONSUMER.MSG.NEXT.")) {
      ++requests_;
      for (const auto& [reply, one] : held_)
        if (message.subject.find(reply.substr(8, reply.find('.', 8) - 8)) != std::string::npos &&
            given_.insert({reply, true}).second)
          come_.insert(come_.end(), subscriptions_, one);
    } else if (message.subject.starts_with("fw.down.")) {
      commands_.push_back(message);
    } else if (message.bytes.empty()) {
      held_.erase(message.subject);
    } else {  // -NAK: deliver again
      given_.erase(message.subject);
      ++given_back_;
    }
    return true;
  }
  void listen(const std::string& subject) override {
    // A server delivers a message to each matching subscription; a link has one for its inbox.
    if (subject.starts_with(inbox())) ++subscriptions_;
  }
  std::vector<Message> take() override { return std::exchange(come_, {}); }
  std::int64_t connections() const override { return connections_; }
  bool is_connected() const override { return true; }
  std::string trouble() const override { return ""; }
  std::string inbox() const override { return "_INBOX_worker.x"; }

 private:
  std::map<std::string, Message> held_;
  std::map<std::string, bool> given_;
  std::vector<Message> come_, commands_;
  std::int64_t connections_ = 1, number_ = 0;
  std::size_t subscriptions_ = 1;
  int requests_ = 0, given_back_ = 0;
};

}  // namespace framewatch::fleet
