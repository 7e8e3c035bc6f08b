// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include <framewatch/summary_t.hpp>
#include <framewatch/uplink_status_t.hpp>

// Examples of messages that framewatch-fleet sends; part of example_messages.h.
namespace framewatch::drivers::examples {

inline summary_t summary() {
  summary_t m{};
  m.start_us = 600'000'000;
  m.period_s = 600;
  m.windows = 60000;
  m.config_sha256 = "abc";
  m.parameters = 2;
  m.observable = {50000, 0};
  m.boxed = {1000, 0};
  m.outliers = {3, 0};
  const float none = std::numeric_limits<float>::quiet_NaN();
  m.mean = m.median = {1.5F, none};
  m.std_error = {0.25F, none};
  m.min = m.whisker_low = {1, none};
  m.max = m.whisker_high = {2, none};
  m.q1 = {1.25F, none};
  m.q3 = {1.75F, none};
  m.channels = 1;
  m.received = {60000};
  m.lost = {1};
  m.late = {2};
  m.repaired = {3};
  m.rejected = {4};
  m.stuck = {5};
  m.clipped = {6};
  m.noise = {1e-5};
  return m;
}

inline uplink_status_t uplink_status() {
  uplink_status_t m{};
  m.time_us = 150;
  m.started_us = 100;
  m.building = "kobe-03";
  m.version = "0.1.0";
  m.connected = 1;
  m.connections = 2;
  m.acknowledged_us = 140;
  m.events_waiting = 3;
  m.summaries_waiting = 4;
  m.pieces_waiting = 5;
  m.under_way = 6;
  m.acknowledged = 7;
  m.sent_again = 8;
  m.refused = 9;
  m.sent_bytes = 10;
  m.commands_obeyed = 11;
  m.commands_refused = 12;
  m.link_trouble = "no servers available for connection";
  m.refusal = "maximum bytes exceeded";
  m.store_trouble = "disk I/O error";
  m.resident_bytes = 13;
  m.cpu_s = 0.5;
  return m;
}

}  // namespace framewatch::drivers::examples
