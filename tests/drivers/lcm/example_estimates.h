// SPDX-License-Identifier: MIT
#pragma once

#include <framewatch/accel_t.hpp>
#include <framewatch/channel_table_t.hpp>
#include <framewatch/parameter_table_t.hpp>
#include <framewatch/status_t.hpp>
#include <framewatch/window_estimate_t.hpp>

// Examples of samples, estimates and related messages; part of example_messages.h.
namespace framewatch::drivers::examples {

inline accel_t accel() {
  accel_t m{};
  m.time_us = 1'700'000'000'123'456;
  m.sequence = 77;
  m.node = 3;
  m.accel_abs_mps2[0] = 0.125;
  m.accel_abs_mps2[1] = -9.75;
  m.accel_abs_mps2[2] = 1e-9;
  return m;
}

inline channel_table_t channel_table() {
  channel_table_t m{};
  m.time_us = 1;
  m.rate_hz = 100;
  m.channels = 2;
  m.name = {"base-x", "F1-Y1"};
  m.node = {0, 2};
  m.axis = {0, 1};
  return m;
}

inline parameter_table_t parameter_table() {
  parameter_table_t m{};
  m.time_us = 2;
  m.structure = "table";
  m.config_sha256 = "00ff";
  m.version = "0.1.0";
  m.rate_hz = 100;
  m.window_rows = 500;
  m.hop_rows = 1;
  m.boxplot_windows = 500;
  m.parameters = 2;
  m.name = {"kx_1_y1", "cx_1_y1"};
  m.unit = {"N/m", "N*s/m"};
  m.kind = {0, 2};
  m.story = {1, 1};
  m.design = {34e3, 53};
  m.other_windows = 1;
  m.other_channel = {"FRAMEWATCH_ESTIMATE_1S"};
  m.other_rows = {100};
  return m;
}

inline window_estimate_t window_estimate() {
  window_estimate_t m{};
  m.window_start_us = 10;
  m.window_end_us = 20;
  m.sequence = 5;
  m.status = 1;
  m.rows = 500;
  m.residual_ratio = 0.25;
  m.parameters = 2;
  m.value = {34000.5, 53.25};
  m.std_error = {12.5, 0.5};
  m.reason = {0, 2};
  m.snr = {100, 3};
  m.prior_share = {0, 0.5F};
  m.noise_share = {0.125F, 0};
  m.held = 1;
  m.held_index = {1};
  m.held_value = {53};
  m.held_std_error = {0.75};
  m.held_end_us = {15};
  m.boxplot_windows = 500;
  m.boxplots = 2;
  m.q1 = {1, 2};
  m.median = {3, 4};
  m.q3 = {5, 6};
  m.whisker_low = {0.5, 1.5};
  m.whisker_high = {7, 8};
  m.outliers = {0, 9};
  m.boxplot_count = {500, 499};
  return m;
}

inline status_t status() {
  status_t m{};
  m.time_us = 30;
  m.config_sha256 = "00ff";
  m.version = "0.1.0";
  m.windows = 1;
  m.sample_sets = 2;
  m.gaps = 3;
  m.rejected_messages = 4;
  m.queue_high_water = 5;
  m.queue_dropped = 6;
  m.latency_s = 0.5;
  m.channels = 1;
  m.name = {"base-x"};
  m.received = {7};
  m.lost = {8};
  m.late = {9};
  m.repaired = {10};
  m.rejected = {11};
  m.stuck = {12};
  m.clipped = {13};
  m.noise_mps2_per_rthz = {1e-4};
  return m;
}

}  // namespace framewatch::drivers::examples
