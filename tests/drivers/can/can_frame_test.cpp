// SPDX-License-Identifier: MIT
#include "drivers/can/can_frame.h"

#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace framewatch::drivers {
namespace can_frame_test {

using Data = std::array<std::uint8_t, 64>;

TEST(CanField, ReadsTheLayoutsOfRealSensors) {
  // Xsens: big-endian int16 at 2^-8 m/s^2; 0x09CF / 256 = 9.80859375.
  const Data xsens{0x09, 0xCF, 0xFF, 0x00, 0x80, 0x00};
  EXPECT_DOUBLE_EQ(physical({7, 16, false, true, CanValue::integer, 1.0 / 256, 0}, xsens),
                   9.80859375);
  EXPECT_DOUBLE_EQ(physical({23, 16, false, true, CanValue::integer, 1.0 / 256, 0}, xsens), -1);
  EXPECT_DOUBLE_EQ(physical({39, 16, false, true, CanValue::integer, 1.0 / 256, 0}, xsens), -128);
  // J1939 61485: 32000 is zero.
  const Data j1939{0x00, 0x7D, 0x64, 0x7D};
  EXPECT_DOUBLE_EQ(physical({0, 16, true, false, CanValue::integer, 0.01, -320}, j1939), 0);
  EXPECT_NEAR(physical({16, 16, true, false, CanValue::integer, 0.01, -320}, j1939), 1, 1e-12);
  // Bosch: uint16 - 0x8000.
  const Data bosch{0, 0, 0, 0, 0xFF, 0x7F};
  EXPECT_NEAR(physical({32, 16, true, false, CanValue::integer, 0.0001274, -4.1746432}, bosch),
              -0.0001274, 1e-12);
}

TEST(CanField, ReadsOddWidths) {
  const Data data{0xAB, 0xCD, 0xEF, 0x12};
  EXPECT_EQ(raw_bits({0, 12, true, false}, data), 0xDABu);
  EXPECT_EQ(raw_bits({12, 20, true, false}, data), 0x12EFCu);
  EXPECT_EQ(raw_bits({7, 12, false, false}, data), 0xABCu);
  EXPECT_EQ(raw_bits({3, 20, false, false}, data), 0xBCDEFu);
  EXPECT_EQ(raw_bits({7, 24, false, false}, data), 0xABCDEFu);
  EXPECT_EQ(raw_integer({0, 12, true, true}, data), 0xDAB - 0x1000);
  EXPECT_EQ(raw_integer({3, 1, true, true}, data), -1);
}

TEST(CanField, KnowsWhichValuesFit) {
  EXPECT_TRUE(fits({48, 16, true, false}, 8));
  EXPECT_FALSE(fits({49, 16, true, false}, 8));
  EXPECT_TRUE(fits({55, 16, false, false}, 8));
  EXPECT_FALSE(fits({63, 16, false, false}, 8));
  EXPECT_FALSE(fits({-1, 8, true, false}, 8));
  EXPECT_FALSE(fits({0, 65, true, false}, 64));
}

TEST(CanField, ReadsBackWrittenValues) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 20000; ++i) {
    CanField field;
    field.bits = static_cast<int>(random() % 64) + 1;
    field.little_endian = random() % 2 == 0;
    field.is_signed = random() % 2 == 0;
    field.start = static_cast<int>(random() % 512);
    if (!fits(field, 64)) continue;
    Data data, before;
    for (std::uint8_t& byte : data) byte = static_cast<std::uint8_t>(random());
    before = data;
    const std::uint64_t raw = field.bits == 64 ? random() : random() >> (64 - field.bits);
    const std::uint64_t old = raw_bits(field, data);
    put_bits(field, raw, data);
    ASSERT_EQ(raw_bits(field, data), raw);
    put_bits(field, old, data);
    ASSERT_EQ(data, before) << "other bits changed";
  }
}

TEST(CanField, KeepsNanInFloats) {
  Data data{};
  const CanField f32{0, 32, true, true, CanValue::float32, 1, 0};
  const CanField f64{71, 64, false, true, CanValue::float64, 1, 0};
  put_physical(f32, NAN, data);
  put_physical(f64, -1.5e-300, data);
  EXPECT_TRUE(std::isnan(physical(f32, data)));
  EXPECT_EQ(physical(f64, data), -1.5e-300);
  put_physical(f32, 0.25, data);
  EXPECT_EQ(physical(f32, data), 0.25);
}

TEST(CanField, ClampsValuesThatDoNotFit) {
  Data data{};
  const CanField field{0, 16, true, true, CanValue::integer, 0.001, 0};
  put_physical(field, 1e9, data);
  EXPECT_EQ(raw_integer(field, data), 32767);
  put_physical(field, -1e9, data);
  EXPECT_EQ(raw_integer(field, data), -32768);
  put_physical(field, -1.2345, data);
  EXPECT_EQ(raw_integer(field, data), -1234);
}

}  // namespace can_frame_test
}  // namespace framewatch::drivers
