// SPDX-License-Identifier: MIT
#include "drivers/lcm/message_check.h"

#include <random>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/files/encoded.h"
#include "tests/drivers/lcm/example_messages.h"

namespace framewatch::drivers {
namespace message_check_test {

/// Truncates and extends payloads, makes every 32-bit word huge, negative or zero, and tries random
/// bytes. Decoding must not read outside the payload, which the sanitizers check, nor allocate much
/// memory.
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
  examples::for_each([](const char*, const auto& message) {
    attack(encoded(message), [](const auto& bytes) {
      return decoded<std::decay_t<decltype(message)>>(bytes).has_value();
    });
  });
}

}  // namespace message_check_test
}  // namespace framewatch::drivers
