// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace framewatch::test {

/// Returns `count` numbers in columns; `other` for all that are not given.
inline std::string numbers(std::size_t count, std::size_t per_line, std::size_t width,
                           const std::map<std::size_t, std::string>& known,
                           const std::string& other) {
  std::string out;
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = known.find(i);
    out += fmt::format("{:>{}}", at == known.end() ? other : at->second, width);
    if ((i + 1) % per_line == 0 || i + 1 == count) out += '\n';
  }
  return out;
}

struct CosmosChannel {
  int number = 1;
  int unit = 4;
  int stage = 1;
  std::string azimuth = "90";  ///< to the reference, 180 deg
  std::string comment = "|<SCNL>8040.HNE.NP.01    <AUTH> 2019/05/28\n";
  std::string values =
      "4 acceleration pts, approx 0 secs, units=cm/sec2(04),Format=(3F9.3)\n"
      "    1.000 -200.000-9999.001\n   -2.500\n"
      "End-of-data for ChanHNE acceleration\n";
};

/// Returns a file of COSMOS v1.20 with this channel: comments on line 38, values from line 41.
inline std::string cosmos(const CosmosChannel& c = {}) {
  return fmt::format(
             "Uncorrected acceleration  (Format v01.20 with 5 text lines)\n"
             "Statn No: 02-008040 Code:NP-8040   USGS\n"
             "Rcrd start time: 2018/11/30 17:29:06.332 UTC (Q=5) RcrdId: (see comment)\n"
             "Sta Chan {:3}: 90 Deg (Rcrdr Chan  ?) Location:Basement NW corner\n"
             "Values used when parameter or data value is unknown/unspecified:   -999, "
             "-999.00\n",
             c.number) +
         " 100 Integer-header values follow on  10 lines, Format= (10I8)\n" +
         numbers(100, 10, 8,
                 {{0, fmt::format("{}", c.stage)},
                  {1, "1"},
                  {2, fmt::format("{}", c.unit)},
                  {20, "180"},
                  {39, "2018"},
                  {41, "11"},
                  {42, "30"},
                  {43, "17"},
                  {44, "29"},
                  {49, fmt::format("{}", c.number)},
                  {54, c.azimuth},
                  {75, "0"}},
                 "-999") +
         " 100 Real-header values follow on  20 lines, Format= (5F15.6)\n" +
         numbers(100, 5, 15,
                 {{21, "0.298024"},
                  {29, "6.332"},
                  {39, "223.976"},
                  {40, "0.697"},
                  {41, "1.2553"},
                  {46, "1.0"},
                  {53, "0.1"},
                  {56, "40.0"},
                  {61, "5.0"},
                  {63, "-9999.001"}},
                 "-999.000000") +
         fmt::format("   {} Comment line(s) follow, each starting with a \"|\":\n",
                     c.comment.empty() ? 0 : 1) +
         c.comment + c.values;
}

/// Returns a corrected accelerogram in the USGS' SMC format, with whole numbers changed by place.
inline std::string smc(const std::map<std::size_t, std::string>& changed = {}) {
  std::map<std::size_t, std::string> integers = {
      {0, "-32768"}, {1, "1994"}, {2, "17"},  {3, "12"}, {4, "31"}, {5, "3"},  {6, "250"}, {8, "2"},
      {9, "3"},      {12, "90"},  {13, "35"}, {15, "1"}, {16, "9"}, {17, "0"}, {24, "6"}};
  for (const auto& [at, text] : changed) integers[at] = text;
  std::string text = "2 CORRECTED ACCELEROGRAM\n*\n5108 and more\n";
  while (std::count(text.begin(), text.end(), '\n') < 11) text += "*\n";
  return text + numbers(48, 8, 10, integers, "-32768") +
         numbers(50, 5, 15, {{1, "0.2000000E+03"}}, "0.1700000E+39") + "| a comment\n" +
         " .1000E+01-.2000E+01 .3000E+01 .4000E+01 .5000E+01 .6000E+01 .7000E+01 .8000E+01\n"
         "-.9000E+02\n";
}

inline std::string knet() {
  return "Origin Time       2018/11/30 17:29:00\nLat.              35.1\nLong.             139.1\n"
         "Depth. (km)       40\nMag.              7.0\nStation Code      AKT001\n"
         "Station Lat.      39.3\nStation Long.     140.9\nStation Height(m) 29\n"
         "Record Time       2018/12/01 02:29:21\nSampling Freq(Hz) 100Hz\n"
         "Duration Time(s)  0.1\nDir.              E-W\nScale Factor      3920(gal)/6182761\n"
         "Max. Acc. (gal)   12.3\nLast Correction   2018/12/01 02:29:06\nMemo.             \n"
         "   22640    22645    22650    22651    22640    22630    22641    22642\n"
         "   22640   -22645\n";
}

/// One channel of a CSMIP file.
struct CsmipText {
  bool corrected = false;
  std::string channel = "Chan  5:  90 Deg (Sta Chn:  7)  Location: Roof - South Wall";
  std::string start = "Start time:  1/17/94, 12:31: 4.1 UTC (GPS)";
  std::string unit = "Units of uncor data are sec and g .";
  std::string points = "0";  ///< whole number 28
  std::string values;        ///< empty: three values in the unit of the volume
};

inline std::string csmip(const CsmipText& c = {}) {
  const std::string text =
      "Uncorrected Accelerogram Data             Processed: 02/08/94, CGS  test\n"
      "Rcrd of Mon Jan 17, 1994 04:31:04.1 PST\nCSMIP Processing\n"
      "24386-S3492-94021.02                 " +
      c.start +
      "\nStation No. 24386   34.221N, 118.471W    Etna    s/n 1  (16 Chns of 16 at Sta)\n"
      "Van Nuys - 7-story Hotel                  CGS   Data: Acceleration\n" +
      c.channel +
      "\nRcrd of Mon Jan 17, 1994\nHypocenter:  To be determined.\nInstr Period =  .0397 sec\n"
      "No. of Points =  3  Record Length =   .015 sec   at 200 Samples/sec\n" +
      c.unit + "        Max  =   .200 g\nRMS accel of complete record =  .021 g.\n";
  std::string lines = c.corrected ? "Corrected accelerogram   24386-S3492-94021.02\n" + text : text;
  for (int i = 0; c.corrected && i < 11; ++i) lines += "a line\n";
  const std::map<std::size_t, std::string> reals = {
      {60, ".0200000"}, {61, ".1000000"}, {65, "-250.1250"}, {72, "25.000000"}};
  const std::string usual =
      c.corrected ? "3 points of accel data equally spaced at  .020 sec, in cm/sec2. (8f10.6)\n"
                    "  1.500000-250.12500   .000300\n"
                    "3 points of veloc data equally spaced at  .020 sec, in cm/sec.  (8f10.6)\n"
                    "   .000001   .000002   .000003\n"
                  : "3 Accelerogram points at 200 pts/sec in units of g .      Format: (8f9.6)\n"
                    "  .010000-0.200000  .000300\n";
  return lines + numbers(100, 16, 5, {{27, c.points}}, "0") +
         numbers(c.corrected ? 100 : 50, 8, 10, reals, ".000") +
         (c.values.empty() ? usual : c.values) +
         "/&  ----------  End of data for channel  5  ----------\n";
}

/// Returns three values of a DYNA 1.2 file, with some lines of the header changed.
inline std::string esm(const std::map<std::string, std::string>& changed = {}) {
  const std::vector<std::pair<std::string, std::string>> lines = {
      {"EVENT_NAME", "GREECE"},
      {"NETWORK", "HI"},
      {"STATION_CODE", "ARS1"},
      {"LOCATION", ""},
      {"SENSOR_DEPTH_M", "0.0"},
      {"DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS", "20190728_160919.870"},
      {"SAMPLING_INTERVAL_S", "0.005000"},
      {"NDATA", "3"},
      {"STREAM", "HNE"},
      {"UNITS", "cm/s^2"},
      {"PGA_CM/S^2", "-2.5"},
      {"LOW_CUT_FREQUENCY_HZ", "0.100"},
      {"HIGH_CUT_FREQUENCY_HZ", "30.000"},
      {"HEADER_FORMAT", "DYNA 1.2"},
      {"DATA_TYPE", "ACCELERATION"},
      {"USER1", "http://example.org: a tool"}};
  std::string out;
  for (const auto& [key, value] : lines) {
    const auto at = changed.find(key);
    out += key + ": " + (at == changed.end() ? value : at->second) + "\n";
  }
  return out + "0.100000\n-2.500000\n1.0e-3\n";
}

/// Returns one component of a GeoNet file with twelve accelerations.
inline std::string geonet(const std::string& component = "S14E", bool corrected = false) {
  const std::string one = corrected ? "Corrected" : "Uncorrected";
  std::string text = one +
                     " accelerogram 20161113_110256_HSES_20 GNS Science\n"
                     "Site HSES      42 31 24S  172 49 50E     Basalt file:  x\n";
  for (int i = 2; i < 12; ++i) text += "a line\n";
  text += "Component " + component + "  Longitudinal Accelerometer Axis\na line\na line\na line\n";
  text += numbers(40, 10, 8,
                  {{8, "2016"},
                   {9, "11"},
                   {18, "13"},
                   {19, "11"},
                   {33, "12"},
                   {34, corrected ? "1" : "0"},
                   {35, corrected ? "1" : "0"},
                   {38, "2"},
                   {39, "20500"}},
                  "0");
  text += numbers(60, 10, 8,
                  {{24, "0.0050"},
                   {25, corrected ? "0.0200" : "0.0050"},
                   {30, "2394.8"},
                   {35, "2394.8"},
                   {52, "0.250"},
                   {55, "24.500"}},
                  "0.0");
  return text + numbers(12, 10, 8, {{0, "-0.1"}, {1, "2394.8"}, {11, "-7.5"}}, "0.0") +
         (corrected ? "     1.0\n     2.0\n" : "");
}

struct SacChange {
  std::size_t word = 0;
  int integer = 0;
};

/// Returns a SAC file of three values, 1, -2 and 3, at 200 Hz, in either byte order.
inline std::string sac(bool other_byte_order = false, const std::vector<SacChange>& changed = {}) {
  std::vector<std::uint32_t> words(110, static_cast<std::uint32_t>(-12345));
  const auto put = [&](std::size_t at, float value) {
    words[at] = std::bit_cast<std::uint32_t>(value);
  };
  for (std::size_t i = 0; i < 70; ++i) put(i, -12345.0F);
  put(0, 0.005F);
  put(5, 0.5F);
  put(57, 35.0F);
  put(58, 90.0F);
  const int time[] = {2018, 334, 17, 29, 6, 332, 6};
  for (std::size_t i = 0; i < 7; ++i) words[70 + i] = static_cast<std::uint32_t>(time[i]);
  words[79] = 3;
  words[85] = words[105] = 1;
  for (const SacChange& change : changed)
    words[change.word] = static_cast<std::uint32_t>(change.integer);
  std::string text(192, ' ');
  for (std::size_t at = 0; at < text.size(); at += 8) text.replace(at, 8, "-12345  ");
  text.replace(0, 8, "8040    ");
  text.replace(160, 8, "HNE     ");
  text.replace(168, 8, "NP      ");
  const auto append = [&](std::string& out, std::uint32_t word) {
    if (other_byte_order) word = __builtin_bswap32(word);
    out.append(reinterpret_cast<const char*>(&word), sizeof word);
  };
  std::string out;
  for (const std::uint32_t word : words) append(out, word);
  out += text;
  for (const float value : {1.0F, -2.0F, 3.0F}) append(out, std::bit_cast<std::uint32_t>(value));
  return out;
}

}  // namespace framewatch::test
