// SPDX-License-Identifier: MIT
// Every message type: decoded, encoded again, printed.
#include <framewatch/message_layouts.hpp>

#include <nlohmann/json.hpp>

#include "daemon/monitor/events/event_messages.h"
#include "daemon/monitor/history/history_overview.h"
#include "daemon/page/view/page_json.h"
#include "drivers/files/encoded.h"
#include "drivers/lcm/accel_codec.h"
#include "drivers/lcm/message_check.h"
#include "tests/drivers/lcm/example_messages.h"
#include "tests/fuzz/targets.h"

namespace framewatch::test {
namespace {

void require_json(const std::string& text) {
  require(nlohmann::json::accept(text), "JSON");
  require(text.find('\n') == std::string::npos, "one line");
}

void show(const auto&) {}
void show(const window_estimate_t& estimate) {
  require_json(daemon::estimate_json(estimate, 10));
  require_json(daemon::boxes_json(estimate));
}
void show(const status_t& status) {
  require_json(daemon::status_json(status, "00ff"));
}
void show(const gap_t& gap) {
  require_json(daemon::gap_json(gap));
}
void show(const can_status_t& status) {
  require_json(daemon::can_json(status));
}
void show(const session_status_t& status) {
  require_json(daemon::session_status_json(status));
}
void show(const event_t& event) {
  require_json(daemon::alarm_json(event, true, {event.time_us, event.place, event.message}));
  require_json(daemon::event_json(event, "table"));
  (void)daemon::event_line(event);
}

template <typename Message>
void read_message(const std::vector<std::uint8_t>& payload) {
  const auto message = drivers::decoded<Message>(payload);
  if (!message) {
    (void)drivers::why_not(Message::getTypeName(), payload);
    return;
  }
  require(drivers::encoded(*message).size() == payload.size(), "the size it came with");
  show(*message);
}

/// Returns a payload of the type with this number: its fingerprint, then bytes of the input.
void read_one(Bytes input) {
  Pieces pieces(input);
  const int wanted = pieces.take<std::uint8_t>();
  int number = 0;
  drivers::examples::for_each([&](const char*, const auto& example) {
    if (number++ != wanted) return;
    std::vector<std::uint8_t> payload = drivers::encoded(example);
    payload.resize(8);
    const Bytes body = pieces.rest();
    payload.insert(payload.end(), body.begin(), body.end());
    read_message<std::decay_t<decltype(example)>>(payload);
    (void)drivers::decode_accel(payload.data(), payload.size());
    (void)drivers::accel_time_us(payload.data(), payload.size());
    (void)drivers::decode_channel_table(payload.data(), payload.size());
  });
}

std::vector<std::string> message_seeds() {
  std::vector<std::string> out;
  drivers::examples::for_each([&](const char*, const auto& example) {
    const std::vector<std::uint8_t> payload = drivers::encoded(example);
    PiecesWriter seed;
    out.push_back(seed.put(static_cast<std::uint8_t>(out.size()))
                      .put_bytes(Bytes(payload).subspan(8))
                      .text());
  });
  return out;
}

}  // namespace

const FuzzTarget kMessagesTarget{"messages", &read_one, &message_seeds};

}  // namespace framewatch::test
