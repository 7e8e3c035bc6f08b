// SPDX-License-Identifier: MIT
#include "fleet/message/message.h"

#include <string>

#include <gtest/gtest.h>

namespace framewatch::fleet {
namespace message_test {

constexpr std::size_t kMax = 1 << 20;

Bytes repeated(std::size_t count) {
  Bytes out;
  for (std::size_t i = 0; i < count; ++i) out.push_back(static_cast<std::uint8_t>(i / 64));
  return out;
}

TEST(Message, UnpacksWhatWasPacked) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{10}, std::size_t{100'000}}) {
    const Message m = packed("fw.up.a.event", "a/event/1", "event_t", repeated(size), "abc");
    std::string why;
    const auto back = unpacked(m, kMax, why);
    ASSERT_TRUE(back) << why;
    EXPECT_EQ(*back, repeated(size));
    EXPECT_EQ(m.header(header::kEncoding), size > 1000 ? "zstd" : "");
    EXPECT_EQ(m.header(header::kKey), "a/event/1");
    EXPECT_EQ(m.header(header::kConfig), "abc");
  }
}

TEST(Message, RefusesTooLargeContentBeforeAllocating) {
  const Message m = packed("s", "k", "raw", repeated(kMax + 1), "");
  EXPECT_LT(m.bytes.size(), kMax / 10);
  std::string why;
  EXPECT_FALSE(unpacked(m, kMax, why));
  EXPECT_NE(why.find("more than"), std::string::npos) << why;
}

TEST(Message, RefusesDamagedBytesAndForeignEncodings) {
  Message m = packed("s", "k", "raw", repeated(10'000), "");
  ASSERT_EQ(m.header(header::kEncoding), "zstd");
  std::string why;
  Message cut = m;
  cut.bytes.resize(cut.bytes.size() / 2);
  EXPECT_FALSE(unpacked(cut, kMax, why));
  Message noise = m;
  noise.bytes.assign(100, 0x55);
  EXPECT_FALSE(unpacked(noise, kMax, why));
  m.headers[header::kEncoding] = "lzma";
  EXPECT_FALSE(unpacked(m, kMax, why));
}

}  // namespace message_test
}  // namespace framewatch::fleet
