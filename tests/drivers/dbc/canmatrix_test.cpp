// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <random>
#include <sstream>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "drivers/dbc/dbc.h"
#include "tests/support/temporary.h"

namespace framewatch::drivers {
namespace canmatrix_test {

constexpr int kFiles = 3, kMessages = 12, kFramesEach = 4;

std::string output_of(const std::string& command) {
  std::string out;
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return out;
  std::array<char, 4096> buffer;
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
    out.append(buffer.data(), n);
  ::pclose(pipe);
  return out;
}

/// Makes messages with signals at random places that do not overlap; every second message is
/// multiplexed.
std::string random_dbc(std::mt19937& random) {
  std::string text = "VERSION \"\"\n\nBS_:\n\nBU_: A B\n\n", types;
  for (int m = 0; m < kMessages; ++m) {
    const bool extended = m % 3 == 0, multiplexed = m % 2 == 0;
    const unsigned id = extended ? 0x80000000u + 0x1000u * static_cast<unsigned>(m) + 5
                                 : 100u + static_cast<unsigned>(m);
    text += fmt::format("BO_ {} M{}: 8 A\n", id, m);
    std::bitset<64> taken;
    int signals = 0;
    const auto put = [&](int bits, bool little, bool is_signed, const std::string& mux) {
      for (int attempt = 0; attempt < 50; ++attempt) {
        const CanField field{static_cast<int>(random() % 64), bits, little};
        if (!fits(field, 8)) continue;
        std::bitset<64> here;
        for_each_bit(field, [&](int bit) { here.set(static_cast<std::size_t>(bit)); });
        if ((here & taken).any()) continue;
        taken |= here;
        text += fmt::format(" SG_ S{}{} : {}|{}@{}{} (0.5,-3) [0|0] \"\" B\n", signals, mux,
                            field.start, bits, little ? 1 : 0, is_signed ? '-' : '+');
        if (bits == 32 && m % 4 == 3)
          types += fmt::format("SIG_VALTYPE_ {} S{} : 1;\n", id, signals);
        ++signals;
        return;
      }
    };
    if (multiplexed) put(2, true, false, " M");
    for (const int bits : {32, 12, 5, 9, 3}) {
      const std::string mux = multiplexed && bits < 12 ? fmt::format(" m{}", random() % 3) : "";
      put(bits, random() % 2 == 0, random() % 2 == 0, mux);
    }
    text += "\n";
  }
  return text + types;
}

TEST(Dbc, DecodesAsCanmatrixDoes) {
  if (std::system("/usr/bin/python3 -c 'import canmatrix.formats' 2>/dev/null") != 0)
    GTEST_SKIP() << "python3-canmatrix is not installed";
  std::mt19937 random(11);
  const test::TemporaryDirectory directory;
  int compared = 0;
  for (int f = 0; f < kFiles; ++f) {
    const std::string path = directory.path("a.dbc"), text = random_dbc(random);
    test::write_file(path, text);
    std::vector<Problem> problems;
    const auto dbc = parse_dbc(path, text, problems);
    ASSERT_TRUE(dbc) << problems.front().where << ": " << problems.front().message;
    std::string frames, ours;
    for (const DbcMessage& m : dbc->messages)
      for (int i = 0; i < kFramesEach; ++i) {
        std::array<std::uint8_t, 8> data;
        frames += fmt::format("{} ", m.id | (m.extended ? 0x80000000u : 0u));
        for (std::uint8_t& byte : data)
          frames += fmt::format("{:02x}", byte = static_cast<std::uint8_t>(random()));
        frames += "\n";
        for (const DbcSignal& s : m.signals) {
          const std::vector<CanSwitch> switches = switches_of(m, s);
          if (!std::all_of(switches.begin(), switches.end(),
                           [&](const CanSwitch& multiplexor) { return is_on(multiplexor, data); }))
            continue;
          ours += fmt::format("{}.{} {:.17g}\n", m.name, s.name, physical(s.field, data));
        }
        ours += ".\n";
      }
    test::write_file(directory.path("frames"), frames);
    const std::string theirs = output_of("/usr/bin/python3 " FRAMEWATCH_SOURCE_DIR
                                         "/tests/drivers/dbc/canmatrix_oracle.py " +
                                         path + " < " + directory.path("frames") + " 2>/dev/null");
    std::istringstream a(ours), b(theirs);
    std::string name, line;
    std::map<std::string, double> expected;
    while (std::getline(b, line)) {
      if (line != ".") {
        std::istringstream fields(line);
        std::string raw;
        double factor = 0, offset = 0;
        fields >> name >> raw >> factor >> offset;
        expected[name] = std::strtod(raw.c_str(), nullptr) * factor + offset;
        continue;
      }
      std::size_t seen = 0;
      while (std::getline(a, line) && line != ".") {
        std::istringstream fields(line);
        std::string value;
        fields >> name >> value;
        const double decoded = std::strtod(value.c_str(), nullptr);
        ASSERT_TRUE(expected.contains(name)) << name;
        if (std::isnan(decoded))
          EXPECT_TRUE(std::isnan(expected[name])) << name;
        else
          EXPECT_DOUBLE_EQ(decoded, expected[name]) << name;
        ++seen;
        ++compared;
      }
      EXPECT_EQ(seen, expected.size());
      expected.clear();
    }
    EXPECT_FALSE(std::getline(a, line)) << "canmatrix stopped early:\n" << theirs.substr(0, 500);
  }
  EXPECT_GT(compared, kFiles * kMessages * kFramesEach * 2);
}

}  // namespace canmatrix_test
}  // namespace framewatch::drivers
