#include "drivers/message_check.h"

#include <random>

#include <gtest/gtest.h>

#include "drivers/encoded.h"

namespace framewatch::drivers {
namespace {

parameter_table_t parameter_table() {
  parameter_table_t table{};
  table.structure = "s";
  table.parameters = 2;
  table.name = {"kx_1_y1", "cx_1_y1"};
  table.unit = {"N/m", "N*s/m"};
  table.kind = {0, 2};
  table.story = {1, 1};
  table.design = {1e6, 1e3};
  table.other_windows = 1;
  table.other_channel = {"FRAMEWATCH_ESTIMATE_1S"};
  table.other_rows = {100};
  return table;
}

window_estimate_t estimate() {
  window_estimate_t e{};
  e.parameters = 2;
  e.value = e.std_error = {1, 2};
  e.reason = {0, 3};
  e.snr = e.prior_share = e.noise_share = {1, 1};
  e.held = 1;
  e.held_index = {1};
  e.held_value = e.held_std_error = {2};
  e.held_end_us = {5};
  e.boxplots = 2;
  e.q1 = e.median = e.q3 = e.whisker_low = e.whisker_high = {1, 2};
  e.outliers = e.boxplot_count = {0, 4};
  return e;
}

service_t service() {
  service_t s{};
  s.config = "b.toml";
  s.buckets = 2;
  s.limit_s = {0.1, 1};
  s.steps = s.latencies = {1, 2};
  s.channels = 1;
  s.name = {"base"};
  s.newest_us = {3};
  s.raised = 1;
  s.event_id = s.event_since_us = {4};
  s.event_severity = {2};
  s.event_kind = s.event_place = s.event_message = {"gap"};
  return s;
}

/// Truncations, extensions, every 32-bit word made huge, negative or zero, random bytes: nothing
/// may be read outside the payload, and what is decoded is no larger than it.
template <typename Decode>
void attack(const std::vector<std::uint8_t>& whole, const Decode& decode) {
  ASSERT_TRUE(decode(whole));
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(decode(std::vector<std::uint8_t>(
        whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size))));
  auto longer = whole;
  longer.push_back(0);
  EXPECT_FALSE(decode(longer));
  for (std::size_t i = 0; i < 8; ++i) {
    auto foreign = whole;
    foreign[i] ^= 1;
    EXPECT_FALSE(decode(foreign));
  }
  for (const std::uint32_t word : {0x7fffffffU, 0xffffffffU, 0x80000000U, 0U, 0x01312d00U})
    for (std::size_t at = 8; at + 4 <= whole.size(); ++at) {
      auto hostile = whole;
      for (std::size_t i = 0; i < 4; ++i)
        hostile[at + i] = static_cast<std::uint8_t>(word >> (24 - 8 * i));
      decode(hostile);
    }
  std::mt19937 random(20190812);
  for (int trial = 0; trial < 2000; ++trial) {
    auto noisy = whole;
    for (int flips = 0; flips < 4; ++flips)
      noisy[8 + random() % (noisy.size() - 8)] = static_cast<std::uint8_t>(random());
    decode(noisy);
  }
}

TEST(MessageCheck, DecodesOnlyWhatItsLengthsAllow) {
  attack(encoded(parameter_table()),
         [](const auto& b) { return decode_parameter_table(b).has_value(); });
  attack(encoded(estimate()), [](const auto& b) { return decode_window_estimate(b).has_value(); });
  attack(encoded(service()), [](const auto& b) { return decode_service(b).has_value(); });
}

TEST(MessageCheck, GivesTheValuesBack) {
  EXPECT_EQ(decode_parameter_table(encoded(parameter_table()))->design[1], 1e3);
  EXPECT_EQ(decode_window_estimate(encoded(estimate()))->boxplot_count[1], 4);
}

}  // namespace
}  // namespace framewatch::drivers
