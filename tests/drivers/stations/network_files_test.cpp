// SPDX-License-Identifier: MIT
// Records of CSMIP, ESM and GeoNet.
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/formats/record_file.h"
#include "drivers/stations/station_words.h"
#include "tests/drivers/stations/station_fixture.h"
#include "tests/support/station_files.h"

namespace framewatch::drivers {
namespace network_files_test {

using test::csmip;
using test::CsmipText;
using test::esm;
using test::geonet;
using test::replaced;

constexpr double kG = 9.80665;
constexpr double kNorthridge_utc_s = 758809864.1;  // 1994-01-17T12:31:04.1Z

class NetworkFile : public test::StationFileTest {};

TEST_F(NetworkFile, ReadsCsmipVolume1WithItsHeader) {
  const auto r = read(csmip());
  ASSERT_TRUE(r) << problems_[0].where << problems_[0].message;
  EXPECT_EQ(r->names, std::vector<std::string>{"24386.ch07"});
  EXPECT_DOUBLE_EQ(r->rate_hz, 200);
  EXPECT_NEAR(r->time_s[0], kNorthridge_utc_s, 1e-6);
  ASSERT_EQ(r->accel_mps2[0].size(), 3u);
  EXPECT_DOUBLE_EQ(r->accel_mps2[0][0], 0.01 * kG);
  EXPECT_DOUBLE_EQ(r->accel_mps2[0][1], -0.2 * kG);
  EXPECT_DOUBLE_EQ(r->accel_mps2[0][2], 0.0003 * kG);
  EXPECT_EQ(r->headers[0].azimuth_deg, 90);
  EXPECT_EQ(r->headers[0].place, "Roof - South Wall");
  EXPECT_EQ(level_of(r->headers[0]).kind, LevelKind::roof);
  EXPECT_EQ(side_of(r->headers[0]), (Side{0, -1}));
  EXPECT_EQ(r->notes[0], "24386.ch07: azimuth 90 deg, Roof - South Wall");
  EXPECT_EQ(r->lines, (std::vector<std::int64_t>{29, 29, 29}));
}

TEST_F(NetworkFile, ReadsCsmipVolume2AndLeavesVelocityOut) {
  CsmipText text;
  text.corrected = true;
  const auto r = read(csmip(text));
  ASSERT_TRUE(r) << problems_[0].where << problems_[0].message;
  EXPECT_DOUBLE_EQ(r->rate_hz, 50);
  EXPECT_DOUBLE_EQ(r->accel_mps2[0][0], 0.015);
  EXPECT_DOUBLE_EQ(r->accel_mps2[0][1], -2.50125);
  EXPECT_EQ(r->headers[0].unit, "cm/sec2");
  EXPECT_TRUE(r->notes[1].starts_with("corrected, 0.1 to 25 Hz kept")) << r->notes[1];
  EXPECT_EQ(r->notes.back(), "velocity and displacement in the file were left out");
  EXPECT_EQ(r->notes.size(), 3u) << "the peak agrees";
}

TEST_F(NetworkFile, ReadsTheWordsOfOlderCsmipFiles) {
  CsmipText older;
  older.channel = "CHAN  2: UP";
  older.start = "TRIGGER TIME: 05/02/83, 16:42:48.2 PDT";
  older.values =
      "2 POINTS OF ACCEL DATA EQUALLY SPACED AT .005 SEC.  (UNITS: G)\n"
      " -.000116  .000851\n";
  const auto r = read(csmip(older));
  ASSERT_TRUE(r) << problems_[0].where << problems_[0].message;
  EXPECT_EQ(r->names[0], "24386.ch02");
  EXPECT_NEAR(r->time_s[0], 420766968.2, 1e-6);  // 1983-05-02T23:42:48.2Z
  EXPECT_DOUBLE_EQ(r->accel_mps2[0][1], 0.000851 * kG);
  EXPECT_TRUE(r->notes[0].ends_with(": up")) << r->notes[0];

  CsmipText pairs;
  pairs.unit = "UNITS OF UNCOR ACCEL ARE SEC AND G/10.     MAX  =  -.200 G, AT  11.576 SEC.";
  pairs.points = "7";
  pairs.start = "";
  pairs.values =
      "   .000  -.006   .005   .007   .010   .007   .015   .006   .020   .006\n"
      "   .025  -.009   .030   .005\n";
  const auto times = read(csmip(pairs));
  ASSERT_TRUE(times) << problems_[0].where << problems_[0].message;
  EXPECT_DOUBLE_EQ(times->rate_hz, 200);
  EXPECT_EQ(times->time_s[0], 0);
  ASSERT_EQ(times->accel_mps2[0].size(), 7u);
  EXPECT_DOUBLE_EQ(times->accel_mps2[0][5], -0.0009 * kG);
  pairs.values = replaced(pairs.values, ".010", ".008");
  expect_refused(csmip(pairs), 1, "uneven times, up to 0.002 s off");
}

TEST_F(NetworkFile, ReadsAllChannelsOfACsmipFile) {
  CsmipText second;
  second.channel = "Chan  6: H1        Location: 3rd Floor";
  const auto r = read(csmip() + csmip(second));
  ASSERT_TRUE(r) << problems_[0].where << problems_[0].message;
  EXPECT_EQ(r->names, (std::vector<std::string>{"24386.ch07", "24386.ch06"}));
  EXPECT_FALSE(r->headers[1].azimuth_deg);
  EXPECT_EQ(level_of(r->headers[1]), (Level{LevelKind::floor, 3}));
  expect_refused(csmip() + csmip(), 0, "appears twice");
}

TEST_F(NetworkFile, RefusesDamagedCsmip) {
  const std::string good = csmip();
  expect_refused(good.substr(0, good.find("Van Nuys")), 5, "only 5 of 13 lines of text");
  expect_refused(replaced(good, "Station No.", "Place No. "), 5, "Station No.");
  expect_refused(replaced(good, "Chan  5:", "Axis  5:"), 7, "Chan");
  expect_refused(replaced(good, "    0    0    0", "    0   x0    0"), 14, "not a finite number");
  expect_refused(replaced(good, "in units of g ", "in units of v "), 28, "no unit of acceleration");
  expect_refused(replaced(good, "3 Accelerogram", "4 Accelerogram"), 29, "3 of 4 numbers");
  expect_refused(replaced(good, "3 Accelerogram", "x Accelerogram"), 28, "number of points");
  expect_refused(replaced(good, "  .000300\n", "  .00x300\n"), 29, "not a finite number");
  expect_refused(good.substr(0, good.find(".000300") + 4), 29, "cut off inside number 3");
  expect_refused(replaced(good, "1/17/94", "1/32/94"), 4, "not a valid time");
  expect_refused(replaced(good, "1/17/94", "1/1e9/94"), 4, "not a time");
  expect_refused(replaced(good, "UTC (GPS)", "EST      "), 4, "--zone");
  expect_refused(good.substr(0, good.find("3 Accel")), 27, "ends after a header");
  RecordOptions zone;
  zone.zone_min = -300;
  expect_refused(good, 4, "--zone does not apply", zone);
  const auto r = read(replaced(good, "UTC (GPS)", "EST      "), zone);
  ASSERT_TRUE(r);
  EXPECT_NEAR(r->time_s[0], kNorthridge_utc_s + 5 * 3600, 1e-6);
  expect_refused("Response and Fourier amplitude spectra (78 periods)\n" + good, 1, "volume 3");
  CsmipText pairs;
  pairs.values = "   .000  -.006   .005   .007\n";
  expect_refused(csmip(pairs), 1, "no number of points");
}

TEST_F(NetworkFile, ReadsEsmWithItsHeader) {
  const auto r = read(esm());
  ASSERT_TRUE(r) << problems_[0].where << problems_[0].message;
  EXPECT_EQ(r->names, std::vector<std::string>{"HI.ARS1..HNE"});
  EXPECT_DOUBLE_EQ(r->rate_hz, 200);
  EXPECT_NEAR(r->time_s[0], 1564330159.87, 1e-6);  // 2019-07-28T16:09:19.870Z
  ASSERT_EQ(r->accel_mps2[0].size(), 3u);
  EXPECT_DOUBLE_EQ(r->accel_mps2[0][0], 0.001);
  EXPECT_DOUBLE_EQ(r->accel_mps2[0][1], -0.025);
  EXPECT_DOUBLE_EQ(r->accel_mps2[0][2], 1e-5);
  EXPECT_EQ(r->headers[0].azimuth_deg, 90);
  EXPECT_TRUE(r->notes[1].starts_with("corrected, 0.1 to 30 Hz kept")) << r->notes[1];
  const auto deep = read(esm({{"STREAM", "HGZ"},
                              {"SENSOR_DEPTH_M", "30"},
                              {"UNITS", "m/s^2"},
                              {"PGA_CM/S^2", ""},
                              {"LOW_CUT_FREQUENCY_HZ", ""},
                              {"DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS", ""}}));
  ASSERT_TRUE(deep) << problems_[0].message;
  EXPECT_EQ(deep->time_s[0], 0);
  EXPECT_DOUBLE_EQ(deep->accel_mps2[0][1], -2.5);
  EXPECT_EQ(deep->notes[0], "HI.ARS1..HGZ: up, in a borehole, 30 m deep");
  EXPECT_TRUE(deep->notes[1].starts_with("uncorrected")) << deep->notes[1];
}

TEST_F(NetworkFile, LeavesOutAnEsmNumberThatMayBeCutOff) {
  const auto r = read(esm().substr(0, esm().size() - 3));
  ASSERT_TRUE(r) << problems_[0].message;
  EXPECT_EQ(r->accel_mps2[0].size(), 2u);
  EXPECT_NE(r->notes[1].find("line 19: the last number has no line end"), std::string::npos);
}

TEST_F(NetworkFile, RefusesDamagedEsm) {
  expect_refused(replaced(esm(), "STREAM:", "STREAMS:"), 0, "no STREAM");
  expect_refused(replaced(esm(), "NDATA:", "NDATUM:"), 0, "no NDATA");
  expect_refused(esm({{"NDATA", "4"}}), 8, "values, but the file has 3");
  expect_refused(esm({{"NDATA", "many"}}), 8, "must be a number");
  expect_refused(esm({{"SAMPLING_INTERVAL_S", "0"}}), 7, "must be a step");
  expect_refused(esm({{"SAMPLING_INTERVAL_S", "nan"}}), 7, "must be a step");
  expect_refused(esm({{"UNITS", "cm/s"}}), 10, "unit of acceleration");
  expect_refused(esm({{"DATA_TYPE", "VELOCITY"}}), 15, "must be an acceleration");
  expect_refused(esm({{"DATA_TYPE", "ACCELERATION RESPONSE SPECTRUM"}}), 15,
                 "must be an acceleration");
  for (const char* time : {"2019-07-28 16:09:19", "20190728_1609", "20191328_160919.870"})
    expect_refused(esm({{"DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS", time}}), 6, "is not a time");
  expect_refused(replaced(esm(), "-2.500000", "-2.5x"), 18, "not a finite number");
  expect_refused(replaced(esm(), "NETWORK: HI", "NETWORK HI"), 2, "neither KEY: value");
  expect_refused(esm().substr(0, esm().find("0.100000\n-2")), 8, "but the file has 0");
}

TEST_F(NetworkFile, ReadsGeonetWithItsHeader) {
  const auto r = read(geonet() + geonet("Up"));
  ASSERT_TRUE(r) << problems_[0].where << problems_[0].message;
  EXPECT_EQ(r->names, (std::vector<std::string>{"NZ.HSES.20.S14E", "NZ.HSES.20.Up"}));
  EXPECT_DOUBLE_EQ(r->rate_hz, 200);
  EXPECT_NEAR(r->time_s[0], 1479034940.5, 1e-6);  // 2016-11-13T11:02:20.500Z
  ASSERT_EQ(r->accel_mps2[0].size(), 12u);
  EXPECT_DOUBLE_EQ(r->accel_mps2[0][0], -0.0001);
  EXPECT_DOUBLE_EQ(r->accel_mps2[0][1], 2.3948);
  EXPECT_DOUBLE_EQ(r->accel_mps2[0][11], -0.0075);
  EXPECT_EQ(r->headers[0].azimuth_deg, 166);
  EXPECT_EQ(r->headers[1].elevation_deg, 90);
  const auto corrected = read(geonet("N10E", true) + geonet("N80W", true) + geonet("S75W", true));
  ASSERT_TRUE(corrected) << problems_[0].where << problems_[0].message;
  EXPECT_DOUBLE_EQ(corrected->rate_hz, 50);
  EXPECT_EQ(corrected->headers[0].azimuth_deg, 10);
  EXPECT_EQ(corrected->headers[1].azimuth_deg, 280);
  EXPECT_EQ(corrected->headers[2].azimuth_deg, 255);
}

TEST_F(NetworkFile, RefusesDamagedGeonet) {
  const std::string good = geonet();
  expect_refused(good.substr(0, good.find("Component")), 12, "only 12 of 16 lines of text");
  expect_refused(replaced(good, "    2016", "    20x6"), 17, "not a finite number");
  expect_refused(replaced(good, "    2016      11", "    2016      14"), 1, "not a valid time");
  expect_refused(replaced(good, "      12       0", "      -1       0"), 1, "-1 accelerations");
  expect_refused(replaced(good, "      12       0", "       0       0"), 1, "no number of acc");
  expect_refused(replaced(good, "      12       0", "      13       0"), 28, "of 13 numbers");
  expect_refused(replaced(good, "  0.0050  0.0050", "     0.0     0.0"), 1, "not a valid step");
  expect_refused(good + "more\n", 29, "does not begin a component");
  expect_refused(good + good, 0, "appears twice");
  expect_refused(good.substr(0, good.size() - 2), 28, "cut off inside number 12");
}

}  // namespace network_files_test
}  // namespace framewatch::drivers
