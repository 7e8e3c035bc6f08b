// SPDX-License-Identifier: MIT
#include "drivers/can/vector_log.h"

#include <algorithm>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/can/can_log_file.h"
#include "tests/support/temporary.h"
#include "tests/support/vector_logs.h"

namespace framewatch::drivers {
namespace vector_log_test {

using test::BlfWriter;

/// 2026-11-27 23:30:05.250 UTC.
constexpr std::int64_t kStart_us = 1'795'822'205'250'000;

/// Every frame as a line of candump, then every note and every problem.
std::string read(const std::string& bytes, std::optional<int> zone_min = 0) {
  const test::TemporaryDirectory directory;
  test::write_file(directory.path("log"), bytes);
  std::string out;
  std::vector<std::string> notes;
  std::vector<Problem> problems;
  const bool good = read_can_log(
      directory.path("log"), zone_min,
      [&](const CanFrame& frame, std::string_view interface) {
        out += candump_line(frame, interface) + "\n";
      },
      notes, problems);
  EXPECT_EQ(good, problems.empty());
  for (const std::string& note : notes) out += note + "\n";
  for (const Problem& p : problems)
    out += p.where.substr(directory.path("").size()) + ": " + p.message + "\n";
  return out;
}

const std::string kHead =
    "date Fri Nov 27 11:30:05.250 pm 2026\nbase hex  timestamps absolute\n"
    "internal events logged\n// version 9.0.0\n";

/// Returns the frame of one line of a text log, as candump would write it at the start of 2026.
std::string frame_of(const std::string& line, const std::string& base = "hex") {
  return read("date Thu Jan 1 00:00:00 2026\nbase " + base + "  timestamps absolute\n" + line +
              "\n");
}

TEST(Asc, ReadsEveryKindOfFrame) {
  // 2026-01-01 is 1767225600 s after 1970.
  EXPECT_EQ(frame_of("   0.002367 1  390             Rx   d 8 17 00 14 00 C0 00 08 A1"),
            "(1767225600.002367) can0 390#17001400C00008A1\n");
  EXPECT_EQ(
      frame_of("3.098426 2  18EBFF00x Tx d 3 01 A0 0f Length = 273910 BitCount = 141 ID = 1x"),
      "(1767225603.098426) can1 18EBFF00#01A00F\n");
  EXPECT_EQ(frame_of("13.2587 1  3FF  Tx   d D 55 AA 01 02 03 04 05 06  Length = 1"),
            "(1767225613.258700) can0 3FF#55AA010203040506\n");
  EXPECT_EQ(frame_of("2.520002 3 200 Tx r Length = 1704000 BitCount = 145 ID = 88888888x"),
            "(1767225602.520002) can2 200#R\n");
  EXPECT_EQ(frame_of("2.584921 4 300 Rx r 8 Length = 1704000"),
            "(1767225602.584921) can3 300#R8\n");
  EXPECT_EQ(frame_of("2.501010 1 ErrorFrame ECC: 10100010"),
            "(1767225602.501010) can0 20000080#0000000000000000\n");
  EXPECT_EQ(frame_of("-0.000001 1  1  Rx d 0"), "(1767225599.999999) can0 001#\n");
  EXPECT_EQ(frame_of("1.123456789 1  12  Rx d 2 17 255", "dec"),
            "(1767225601.123456) can0 00C#11FF\n");
}

TEST(Asc, ReadsFramesOfFlexibleChannels) {
  EXPECT_EQ(
      frame_of("21.671796 CANFD   1 Tx         11  msgCanFdFr1                      1 0 a 16 "
               "00 00 00 00 00 00 00 00 00 00 00 00 00 00 59 c0 100000  214   223040 80000000 "
               "46500250 460a0250 20011736 20010205"),
      "(1767225621.671796) can0 011##1000000000000000000000000000059C0\n");
  EXPECT_EQ(frame_of("0.045636 CANFD  62 Rx  167x  0 1 8  8 00 00 f6 90 00 00 00 01  105812  137  "
                     "301000 d001b0b3 46500250"),
            "(1767225600.045636) can61 00000167##00000F69000000001\n");
  // Flags without the bit of CAN FD: a classical frame, and a remote one, on a CAN FD channel.
  EXPECT_EQ(frame_of("0.045636 CANFD  1 Rx  7d Brake 0 0 2 2 01 1b 104812  132   300000 a800f6c9"),
            "(1767225600.045636) can0 07D#011B\n");
  EXPECT_EQ(frame_of("30.300981 CANFD 3 Tx 50005x 0 0 5 0 140000 73 200050 7a60 46500250"),
            "(1767225630.300981) can2 00050005#R5\n");
  EXPECT_EQ(frame_of("0.1 CANFD 1 Rx 1 1 0 9 12 01 02 03 04 05 06 07 08 09 0a 0b 0c"),
            "(1767225600.100000) can0 001##10102030405060708090A0B0C\n");
  EXPECT_EQ(frame_of("0.1 CANFD 2 Rx ErrorFrame Not Acknowledge error 8 0 0"),
            "(1767225600.100000) can1 20000080#0000000000000000\n");
}

TEST(Asc, PassesOverOtherEvents) {
  for (const char* line :
       {"", "   0.000000 Start of measurement", "Begin Triggerblock Fri Nov 27 23:30:05.250 2026",
        "   0.015991 CAN 1 Status:chip status error passive - TxErr: 132 RxErr: 0",
        "   1.015991 1  Statistic: D 0 R 0 XD 0 XR 0 E 0 O 0 B 0.00%",
        "   3.297743 1  J1939TP FEE3p        6    0  0   -   Rx   d 23 A0 0F A6 60 3B",
        "   0.1 1  390  TxRq d 2 17 00", "   0.1 CANFD 1 TxRq 11 1 0 2 2 00 01",
        "   0.5 Li 3c  Rx 8 01 02 03 04 05 06 07 08 checksum = 1", "   0.7 1 OverloadFrame",
        "// 0.1 1 390 Rx d 1 00", "End TriggerBlock", "  2.1 SV: 2 0 1 ::Name = 3"})
    EXPECT_EQ(frame_of(line), "") << line;
}

TEST(Asc, AddsRelativeStampsOfAllEvents) {
  EXPECT_EQ(read("date Thu Jan 1 00:00:00 2026\nbase hex timestamps relative\n"
                 "0.5 1 1 Rx d 1 01\n0.25 Start of measurement\n0.125 1 2 Rx d 1 02\n"),
            "(1767225600.500000) can0 001#01\n(1767225600.875000) can0 002#02\n");
}

TEST(Asc, ReadsTheDateOfItsStart) {
  const auto start = [](const std::string& date, std::optional<int> zone_min = 0) {
    return read(date + "base hex  timestamps absolute\n0.0 1 1 Rx d 0\n", zone_min);
  };
  const std::string half_past_eleven = "(1795822205.250000) can0 001#\n";
  for (const char* date :
       {"date Fri Nov 27 23:30:05.250 2026\n", "date Fri Nov 27 11:30:05.250 pm 2026\n",
        "date Fre Nov 27 11:30:05.25 PM 2026\n"})
    EXPECT_EQ(start(date), half_past_eleven) << date;
  EXPECT_EQ(start("date Mit M\xE4r 4 12:00:00 am 2026\n"), "(1772582400.000000) can0 001#\n");
  EXPECT_EQ(start("date Mit Mai 4 12:00:00 pm 2022\n"), "(1651665600.000000) can0 001#\n");
  EXPECT_EQ(start("date Fri Nov 27 23:30:05.250 2026\n", 60), "(1795818605.250000) can0 001#\n");
  EXPECT_EQ(start("date Fri Nov 27 23:30:05.250 2026\n", std::nullopt),
            half_past_eleven +
                "the date of the start has no time zone: it counts as UTC without --zone\n");
  for (const char* date :
       {"", "date yesterday\n", "date Fri Nov 31 23:30:05.250 2026\n",
        "date Fri Nov 27 25:30:05.250 2026\n", "date Fri Foo 27 23:30:05 2026\n"})
    EXPECT_EQ(start(date),
              "(0000000000.000000) can0 001#\n"
              "the start has no date that is understood: times begin at 0\n")
        << date;
}

TEST(Asc, TellsMalformedLines) {
  const auto problem = [](const std::string& line, const std::string& base = "hex") {
    const std::string all = frame_of(line, base);
    EXPECT_TRUE(all.starts_with("log:3: the line ")) << all;
    return all;
  };
  problem("0.1 1  390  Rx   d 8 17 00 14");
  problem("0.1 1  390  Rx   d 2 17 0");
  problem("0.1 1  390  Rx   d 2 17 g0");
  problem("0.1 1  390  Rx   d 10 17 00 14");
  problem("0.1 1  800  Rx   d 1 17");
  problem("0.1 1  20000000x  Rx   d 1 17");
  problem("0.1 1  Engine_1  Rx   d 1 17");
  problem("0.1 1  390  Rx");
  problem("0.1 1  390  Rx   d");
  problem("0.1 1  390  Rx   q 1 17");
  problem("0.1 CANFD 1 Tx");
  problem("0.1 CANFD 1 Tx 11");
  problem("0.1 CANFD x Tx 11 1 0 2 2 00 01");
  problem("0.1 CANFD 1 Tx 11 1 0 2");
  problem("0.1 CANFD 1 Tx 11 1 0 2 2 00");
  problem("0.1 CANFD 1 Tx 11 2 0 2 2 00 01");
  problem("0.1 CANFD 1 Tx 11 1 0 a 2 00 01 0 0 1000");
  problem("0.1 CANFD 1 Tx 11 1 0 9 13 00 01 02 03 04 05 06 07 08 09 0a 0b 0c");
  problem("0.1 1  12  Rx d 2 17 256", "dec");
  const std::string far = read(
      "base hex timestamps relative\n1999999999 1 1 Rx d 0\n"
      "1999999999 1 1 Rx d 0\n0.5 1 1 Rx d 0\n");
  EXPECT_NE(far.find("log:3: the line is more than 60 years after the start"), std::string::npos)
      << far;
  // The last line may be cut off within a decimal number, but not within two digits.
  EXPECT_EQ(read(kHead + "0.5 1 390 Rx d 2 17 00"), "(1795822205.750000) can0 390#1700\n");
  EXPECT_TRUE(read("base dec timestamps absolute\n0.5 1 390 Rx d 2 17 2").find("cut off") !=
              std::string::npos);
}

CanFrame numbered(std::uint32_t id, unsigned value) {
  CanFrame frame;
  frame.id = id;
  frame.length = 8;
  for (std::size_t i = 0; i < 8; ++i) frame.data[i] = static_cast<std::uint8_t>(value + i);
  return frame;
}

TEST(Blf, ReadsEveryKindOfFrame) {
  CanFrame extended = numbered(0x18EBFF00, 1);
  extended.extended = true;
  extended.length = 3;
  CanFrame remote = numbered(0x200, 0);
  remote.remote = true;
  std::string flexible, flexible64, error, error64;
  BlfWriter::put(flexible, 2, 2);  // channel
  BlfWriter::put(flexible, 1, 1);  // sent
  BlfWriter::put(flexible, 9, 1);  // 12 bytes
  BlfWriter::put(flexible, 0x123, 4);
  BlfWriter::put(flexible, 0, 5);
  BlfWriter::put(flexible, 3, 1);  // CAN FD, bit rate switch
  BlfWriter::put(flexible, 12, 1);
  BlfWriter::put(flexible, 0, 5);
  for (unsigned i = 0; i < 64; ++i) BlfWriter::put(flexible, i, 1);
  BlfWriter::put(flexible64, 3, 1);
  BlfWriter::put(flexible64, 10, 1);  // 16 bytes
  BlfWriter::put(flexible64, 16, 1);
  BlfWriter::put(flexible64, 0, 1);
  BlfWriter::put(flexible64, 0x9C4D80A7u, 4);
  BlfWriter::put(flexible64, 0, 4);
  BlfWriter::put(flexible64, 0x1000, 4);  // CAN FD
  BlfWriter::put(flexible64, 0, 24);
  for (unsigned i = 0; i < 16; ++i) BlfWriter::put(flexible64, 0xF0 + i, 1);
  BlfWriter::put(error, 1, 2);
  BlfWriter::put(error, 0, 2);
  BlfWriter::put(error64, 2, 1);
  BlfWriter::put(error64, 0, 15);
  const std::string objects =
      BlfWriter::message(numbered(0x390, 0x10), 1, 2'367'000) +
      BlfWriter::message(extended, 2, 3'000'000'400, 86) +
      BlfWriter::message(remote, 1, 4'000'000'600) +
      BlfWriter::object(100, 5'000'000'000, flexible) +
      BlfWriter::object(101, 600'000, flexible64, 1, 2) +
      BlfWriter::object(2, 7'000'000'000, error) + BlfWriter::object(104, 8'000'000'000, error64) +
      BlfWriter::message(numbered(0x390, 0), 1, 9'000'000'000, 1, 2) +  // a request to send
      BlfWriter::object(65, 9'000'000'000, std::string(5001, 'x')) +    // a text
      BlfWriter::message(numbered(0x7FF, 0), 1, 10'000'000'000);
  const std::string expected =
      "(1795822205.252367) can0 390#1011121314151617\n"
      "(1795822208.250000) can1 18EBFF00#010203\n"
      "(1795822209.250001) can0 200#R8\n"
      "(1795822210.250000) can1 123##1000102030405060708090A0B\n"
      "(1795822211.250000) can2 1C4D80A7##0F0F1F2F3F4F5F6F7F8F9FAFBFCFDFEFF\n"
      "(1795822212.250000) can0 20000080#0000000000000000\n"
      "(1795822213.250000) can1 20000080#0000000000000000\n"
      "(1795822215.250000) can0 7FF#0001020304050607\n";
  EXPECT_EQ(read(BlfWriter::file(BlfWriter::container(objects))), expected);
  EXPECT_EQ(read(BlfWriter::file(BlfWriter::container(objects, 0))), expected);
  EXPECT_EQ(read(BlfWriter::file(objects)), expected) << "objects need no container";
  for (const std::size_t bytes : {1, 17, 100, 4096}) {
    std::string pieces;
    for (std::size_t at = 0; at < objects.size(); at += bytes)
      pieces += BlfWriter::container(objects.substr(at, bytes), at % 2 == 0 ? 2 : 0);
    EXPECT_EQ(read(BlfWriter::file(pieces)), expected) << bytes << " bytes in each container";
  }
}

TEST(Blf, TellsDamageAndReadsTheRest) {
  std::string first, second;
  for (unsigned i = 0; i < 10; ++i) first += BlfWriter::message(numbered(0x100, i), 1, 1000 * i);
  for (unsigned i = 0; i < 10; ++i) second += BlfWriter::message(numbered(0x200, i), 1, 1000 * i);
  const std::string one = BlfWriter::container(first), two = BlfWriter::container(second);
  const auto outcome = [](const std::string& bytes) {
    const std::string all = read(bytes);
    return std::pair(std::count(all.begin(), all.end(), '#'), all.substr(all.find("log: ")));
  };
  const auto expect = [&](const std::string& bytes, long frames, const std::string& problem) {
    const auto [found, problems] = outcome(bytes);
    EXPECT_EQ(found, frames) << problem;
    EXPECT_NE(problems.find(problem), std::string::npos) << problem << "\nin\n" << problems;
  };
  const std::string whole = BlfWriter::file(one + two);
  expect(whole.substr(0, whole.size() - 9), 10, "is cut off");
  expect(whole.substr(0, 100), 0, "the header is cut off");
  std::string bad = whole;
  bad[144 + 32 + 20] = static_cast<char>(~bad[144 + 32 + 20]);
  expect(bad, 10, "byte 144: an object of type 10 is damaged: it does not unpack");
  bad = whole;
  bad[144 + 16] = 7;
  expect(bad, 10, "byte 144: an object of type 10 is packed by an unknown method");
  bad = whole;
  bad.replace(144 + 24, 4, "\xFF\xFF\xFF\x7F");
  expect(bad, 10, "unpacks to more than 16 MiB");
  bad = whole;
  bad.replace(144 + 8, 4, std::string("\x0F\0\0\0", 4));
  expect(bad, 10, "byte 144: an object of type 10 has 15 bytes, not 16 to 16777216");
  bad = whole;
  bad.replace(144 + 8, 4, "\xFF\xFF\xFF\x7F");
  expect(bad, 10, "byte 144: an object of type 10 has 2147483647 bytes");
  expect(BlfWriter::file(one + std::string(9, 'x') + two), 20, "9 bytes belong to no object");
  expect(BlfWriter::file(one + std::string(900, 'x')), 10, "is cut off");
  std::string objects = first;
  objects.insert(48 * 3, std::string(20, '\0'));
  expect(BlfWriter::file(BlfWriter::container(objects)), 10,
         "unpacked byte 144: 20 bytes belong to no object");
  for (const auto& [at, byte, problem] : {std::tuple(4, 31, "has a header that does not fit"),
                                          std::tuple(31, 0x7F, "is 60 years after the start"),
                                          std::tuple(35, 16, "has a data length code above 15"),
                                          std::tuple(39, 0x20, "has an id that no frame has")}) {
    objects = first;
    objects[static_cast<std::size_t>(48 + at)] = static_cast<char>(byte);
    expect(BlfWriter::file(BlfWriter::container(objects)), 9,
           std::string("unpacked byte 48: an object of type 1 ") + problem);
  }
  expect(BlfWriter::file(BlfWriter::object(1, 0, "short")), 0, "has no data");
  expect(BlfWriter::file(BlfWriter::object(101, 0, std::string(39, '\0'))), 0, "has no data");
  expect(BlfWriter::file(BlfWriter::object(2, 0, "")), 0, "has no channel");
}

TEST(CanLogFile, ReadsTheSameFramesFromEveryFormat) {
  std::string candump, asc = kHead, objects;
  for (unsigned i = 0; i < 3000; ++i) {
    CanFrame frame = numbered(0x181 + i % 2, i);
    frame.extended = i % 3 == 0;
    frame.length = static_cast<std::uint8_t>(i % 9);
    std::fill(frame.data.begin() + frame.length, frame.data.end(), std::uint8_t{0});
    const std::int64_t after_us = 5000 * std::int64_t{i} + 135 + i % 7;
    frame.stamp_us = kStart_us + after_us;
    candump += candump_line(frame, i % 5 == 0 ? "can1" : "can0") + "\n";
    asc += test::asc_line(frame, i % 5 == 0 ? 2 : 1,
                          fmt::format("{}.{:06}", after_us / 1'000'000, after_us % 1'000'000));
    objects +=
        BlfWriter::message(frame, i % 5 == 0 ? 2 : 1, static_cast<std::uint64_t>(after_us) * 1000);
  }
  std::string pieces;
  for (std::size_t at = 0; at < objects.size(); at += 0x2000)
    pieces += BlfWriter::container(objects.substr(at, 0x2000));
  EXPECT_EQ(read(candump), candump);
  EXPECT_EQ(read(asc), candump);
  EXPECT_EQ(read(BlfWriter::file(pieces)), candump);
}

TEST(CanLogFile, NamesWhatIsNotRead) {
  const test::TemporaryDirectory directory;
  const auto named = [&](const std::string& bytes) {
    test::write_file(directory.path("a"), bytes);
    EXPECT_EQ(can_log_format(directory.path("a")), CanLogFormat::none) << bytes;
    return unread_can_log(directory.path("a"));
  };
  const auto expect = [&](const std::string& bytes, const std::string& part) {
    EXPECT_NE(named(bytes).find(part), std::string::npos) << named(bytes);
  };
  expect(" (1700000000.000300)  can0  181   [8]  64 00 00 00 00 00 00 00\n", "candump -l");
  expect("  can0  12345678   [02]  64 00\n", "candump -l");
  expect(" (000.000000)  can0  RX - -  181   [3]  64 00 00   'd..'\n", "candump -l");
  expect("(1700000000.000) can0 181#6400000000000000\n", "stamps of 3 decimals");
  expect(";$FILEVERSION=1.1\n;$STARTTIME=37704.5364870833\n", "PCAN trace (TRC)");
  expect(";####\n;   C:\\Trace.trc\n;\n", "IN.trc OUT.log");
  expect("MDF     4.10    framewat\n", "ASAM MDF");
  expect("UnFinMF 4.10    framewat\n", "IN.mf4 OUT.log");
  expect("***BUSMASTER Ver 3.2.2***\n", "BUSMASTER");
  for (const char* other :
       {"", "time_s,a,b\n0,1,2\n", "0.1 0.2 [3] 0.4\n", "(a) b c\n", "\x01\x02"})
    EXPECT_EQ(named(other), "") << other;
}

}  // namespace vector_log_test
}  // namespace framewatch::drivers
