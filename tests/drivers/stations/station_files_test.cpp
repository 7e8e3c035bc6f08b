// SPDX-License-Identifier: MIT
// Records in the formats of strong-motion networks.
#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <utility>

#include <gtest/gtest.h>

#include "drivers/formats/record_file.h"
#include "drivers/records/record_builder.h"
#include "tests/drivers/stations/station_fixture.h"
#include "tests/support/data.h"
#include "tests/support/station_files.h"

namespace framewatch::drivers {
namespace station_files_test {

using test::cosmos;
using test::CosmosChannel;
using test::knet;
using test::replaced;
using test::sac;
using test::smc;

constexpr double kG = 9.80665;
constexpr double kStart_utc_s = 1543598946;  // 2018-11-30T17:29:06Z

class StationFile : public test::StationFileTest {};

TEST_F(StationFile, ReadsNameUnitStartAndDirectionFromCosmos) {
  const auto r = read(cosmos());
  ASSERT_TRUE(r) << (problems_.empty() ? "" : problems_[0].message);
  EXPECT_EQ(r->names, std::vector<std::string>{"NP.8040.01.HNE"});
  EXPECT_DOUBLE_EQ(r->rate_hz, 200);
  EXPECT_NEAR(r->time_s[0], kStart_utc_s + 0.332, 1e-6);
  ASSERT_EQ(r->accel_mps2[0].size(), 4u);
  EXPECT_DOUBLE_EQ(r->accel_mps2[0][0], 0.01);
  EXPECT_DOUBLE_EQ(r->accel_mps2[0][2], -99.99001);
  EXPECT_DOUBLE_EQ(r->accel_mps2[0][3], -0.025);
  EXPECT_EQ(r->notes,
            (std::vector<std::string>{
                "NP.8040.01.HNE: azimuth 270 deg, Basement NW corner",
                "uncorrected; not used from the header: coordinates, event, the sensor's "
                "natural frequency 224 Hz (damping 0.7); begins 2018-11-30T17:29:06.332Z"}));
}

TEST_F(StationFile, ReadsCosmosWithCountsAndSeveralQuantitiesAndChannels) {
  const auto raw = read(cosmos({1, 50, 0, "400", "",
                                "2 raw accel.   pts, approx 0 secs, units= counts(50),"
                                "Format=(1I8)\n -160876\n  100000\n"}));
  ASSERT_TRUE(raw);
  EXPECT_EQ(raw->names, std::vector<std::string>{"NP.8040.ch01"});
  EXPECT_NEAR(raw->accel_mps2[0][0], -160876 * 0.298024e-6 / 1.2553 * kG, 1e-12);
  EXPECT_EQ(raw->notes[0], "NP.8040.ch01: up, Basement NW corner");
  EXPECT_TRUE(raw->notes[1].starts_with("raw, 2.3282")) << raw->notes[1];

  CosmosChannel first, second;
  first.stage = second.stage = 2;
  first.values +=
      "4 velocity pts, approx 0 secs, units=cm/sec(05),Format=(4F9.3)\n"
      "    1.000    1.000    1.000    1.000\n";
  second.comment = "|<SCNL>8040.HNN.NP.02\n";
  const auto both = read(cosmos(first) + cosmos(second));
  ASSERT_TRUE(both);
  EXPECT_EQ(both->names, (std::vector<std::string>{"NP.8040.01.HNE", "NP.8040.02.HNN"}));
  EXPECT_EQ(both->accel_mps2[0], both->accel_mps2[1]);
  const auto said = [&](const std::string& words) {
    return std::any_of(both->notes.begin(), both->notes.end(), [&](const std::string& note) {
      return note.find(words) != std::string::npos;
    });
  };
  EXPECT_TRUE(said("corrected, 0.1 to 40 Hz kept"));
  EXPECT_TRUE(said("velocity and displacement in the file were left out"));
}

TEST_F(StationFile, ReadsCosmosInOtherLettersAndFormats) {
  const auto r = read(replaced(replaced(cosmos(), "4 acceleration", "4 Acceleration"),
                               "Format=(3F9.3)", "Format=(1P,3F9.3) (free)"));
  ASSERT_TRUE(r) << problems_[0].message;
  EXPECT_DOUBLE_EQ(r->accel_mps2[0][3], -0.025);
}

TEST_F(StationFile, ReadsTheEndLinesOfCosmosFromDifferentNetworks) {
  const auto usual = read(cosmos());
  const auto other = read(replaced(cosmos(), "End-of-data for ChanHNE acceleration",
                                   "/&  ----------  End of data for channel  1  ----------"));
  ASSERT_TRUE(usual && other) << problems_[0].message;
  EXPECT_EQ(other->accel_mps2, usual->accel_mps2);
}

TEST_F(StationFile, ReportsACosmosPeakThatDiffersFromTheValues) {
  const auto r = read(replaced(cosmos(), "-9999.001    -999", "-5000.001    -999"));
  ASSERT_TRUE(r);
  EXPECT_EQ(r->notes.back(), "the header says a peak of 50 m/s2, the values have 99.99");
}

TEST_F(StationFile, RefusesDamagedCosmos) {
  const std::string good = cosmos();
  expect_refused(replaced(good, "with 5 text", "with many text"), 1, "text lines");
  expect_refused(replaced(good, "100 Integer", "10 Integer"), 6, "at least 76");
  expect_refused(replaced(good, "(5F15.6)", "(free)"), 17, "a format such as");
  expect_refused(replaced(good, "    2018", "    20x8"), 10, "not a finite number");
  expect_refused(good.substr(0, 600), -1, "nteger-header values: ");
  expect_refused(replaced(good, "4 acceleration", "5 acceleration"), 42, "4 of 5 numbers");
  expect_refused(replaced(good, "4 acceleration", "0 acceleration"), 40, "number and format");
  expect_refused(replaced(good, "-200.000-9999", "-200.000-99x9"), 41, "finite");
  expect_refused(cosmos({1, 5}), 1, "unit 5");
  expect_refused(replaced(good, "06.332 UTC", "06.332    "), 1, "--zone");
  CosmosChannel raw{1, 50};
  expect_refused(replaced(cosmos(raw), "         1.2553", "    -999.000000"), 1, "volts per g");
  expect_refused(good + good, 0, "appears twice");
  expect_refused(good.substr(0, good.find("-2.500") + 4), 42, "cut off inside number 4");
  expect_refused(replaced(good, "      11", "     257"), 1, "not a valid time");
  expect_refused(replaced(good, "    2018", "   67554"), 1, "not a valid time");
  expect_refused(replaced(good, "8040.HNE", "8040.H,E"), 0, "must not contain");
  RecordOptions zone;
  zone.zone_min = -540;
  expect_refused(good, 1, "--zone does not apply", zone);
  const auto r = read(replaced(good, "06.332 UTC", "06.332    "), zone);
  ASSERT_TRUE(r);
  EXPECT_NEAR(r->time_s[0], kStart_utc_s + 0.332 + 9 * 3600, 1e-6);
}

TEST_F(StationFile, ReadsSmcWithItsHeader) {
  const auto r = read(smc());
  ASSERT_TRUE(r) << problems_[0].where << problems_[0].message;
  EXPECT_EQ(r->names, std::vector<std::string>{"5108.ch02"});
  EXPECT_DOUBLE_EQ(r->rate_hz, 200);
  EXPECT_NEAR(r->time_s[0], 758809863.25, 1e-6);  // 1994-01-17T12:31:03.250Z
  ASSERT_EQ(r->accel_mps2[0].size(), 9u);
  EXPECT_DOUBLE_EQ(r->accel_mps2[0][1], -0.02);
  EXPECT_DOUBLE_EQ(r->accel_mps2[0][8], -0.9);
  EXPECT_TRUE(r->notes[0].ends_with(": azimuth 35 deg, floor 6")) << r->notes[0];
  const auto undated = read(smc({{1, "-32768"}, {12, "0"}, {13, "-32768"}}));
  ASSERT_TRUE(undated);
  EXPECT_EQ(undated->time_s[0], 0);
  EXPECT_TRUE(undated->notes[0].ends_with(": up, floor 6"));
}

TEST_F(StationFile, RefusesDamagedSmc) {
  expect_refused(smc().substr(0, 40), 0, "11 lines of text");
  expect_refused(smc({{16, "10"}}), 30, "9 of 10 numbers");
  expect_refused(smc({{16, "-1"}}), 14, "number of values");
  expect_refused(smc({{15, "2"}}), 29, "1 of 2 comment lines");
  expect_refused(smc({{2, "400"}}), 12, "not a valid time");
  expect_refused(smc({{1, "1995"}, {2, "366"}}), 12, "not a valid time");
  RecordOptions forced;
  forced.format = RecordFormat::smc;
  expect_refused(replaced(smc(), "2 CORRECTED ACCELEROGRAM", ""), 1, "neither", forced);
  expect_refused(replaced(smc(), "2 CORRECTED ACCELEROGRAM", "3 VELOCITY"), 1, "neither", forced);
  expect_refused(replaced(smc(), "0.2000000E+03", "0.0000000E+00"), 18, "samples per second");
  expect_refused(replaced(smc(), "0.2000000E+03", "0.1700000E+39"), 18,
                 "digitized at uneven times");
  expect_refused(smc().substr(0, smc().size() - 3), 30, "cut off inside number 9");
  expect_refused(replaced(smc(), " .4000E+01", " .4zzzE+01"), 29, "not a finite number");
}

TEST_F(StationFile, ReadsKnetWithItsHeader) {
  const auto r = read(knet());
  ASSERT_TRUE(r) << problems_[0].where << problems_[0].message;
  EXPECT_EQ(r->names, std::vector<std::string>{"AKT001.EW"});
  EXPECT_DOUBLE_EQ(r->rate_hz, 100);
  EXPECT_NEAR(r->time_s[0], kStart_utc_s, 1e-6);
  ASSERT_EQ(r->accel_mps2[0].size(), 10u);
  EXPECT_DOUBLE_EQ(r->accel_mps2[0][9], -22645 * (3920.0 / 6182761 * 0.01));
  EXPECT_TRUE(r->notes[0].ends_with(": azimuth 90 deg")) << r->notes[0];
  const auto deep = read(replaced(knet(), "E-W", "3"));
  ASSERT_TRUE(deep);
  EXPECT_EQ(deep->names, std::vector<std::string>{"AKT001.UD1"});
  EXPECT_TRUE(deep->notes[0].ends_with(": up, in the borehole"));
}

TEST_F(StationFile, LeavesOutAKnetNumberThatMayBeCutOff) {
  const auto r = read(knet().substr(0, knet().size() - 3));  // -22645 without 45 and line end
  ASSERT_TRUE(r) << problems_[0].message;
  EXPECT_EQ(r->accel_mps2[0].size(), 9u);
  EXPECT_NE(r->notes[1].find("line 19: the last number has no line end"), std::string::npos);
  const auto longer = read(replaced(knet(), "(s)  0.1", "(s)  0.05"));
  ASSERT_TRUE(longer);
  EXPECT_NE(longer->notes[1].find("10 samples, the header's duration has 5"), std::string::npos);
}

TEST_F(StationFile, RefusesDamagedKnet) {
  expect_refused(knet().substr(0, 200), 0, "17 lines");
  expect_refused(replaced(knet(), "Station Code", "Station Cod_"), 0, "no Station Code");
  expect_refused(replaced(knet(), "E-W", "7"), 13, "must be N-S");
  expect_refused(replaced(knet(), "(gal)", "(g)"), 14, "3920(gal)");
  expect_refused(replaced(knet(), "/6182761", "/0"), 14, "3920(gal)");
  expect_refused(replaced(knet(), "100Hz", "0Hz"), 11, "rate");
  expect_refused(replaced(knet(), "02:29:21", "02:29"), 10, "not a time");
  expect_refused(replaced(knet(), "22651", "2265x"), 18, "whole number");
  expect_refused(replaced(knet(), "   22641    22642", "   22641"), 12,
                 "are 10 samples at 100 Hz, but the file has 9");
  expect_refused(replaced(knet(), "   22640   -22645\n", "   22640"), 12, "cut off");
  expect_refused(replaced(knet(), "(s)  0.1", "(s)  min"), 12, "must be a number");
}

RecordOptions declared(double unit_mps2) {
  RecordOptions options;
  options.unit_mps2 = unit_mps2;
  return options;
}

TEST_F(StationFile, ReadsSacInEitherByteOrder) {
  for (const bool other : {false, true}) {
    const auto r = read(sac(other), declared(0.5));
    ASSERT_TRUE(r) << problems_[0].message;
    EXPECT_EQ(r->names, std::vector<std::string>{"NP.8040..HNE"});
    EXPECT_DOUBLE_EQ(r->rate_hz, 200);
    EXPECT_NEAR(r->time_s[0], kStart_utc_s + 0.832, 1e-6);
    EXPECT_EQ(r->accel_mps2[0], (std::vector<double>{0.5, -1, 1.5}));
    EXPECT_EQ(r->notes[0], "NP.8040..HNE: azimuth 35 deg");
  }
  const auto undated = read(sac(false, {{70, -12345}}), declared(1));
  ASSERT_TRUE(undated);
  EXPECT_EQ(undated->time_s[0], 0);
}

TEST_F(StationFile, RefusesDamagedSacAndOtherQuantities) {
  expect_refused(sac(), 0, "--unit");
  const auto refused = [&](const std::string& text, const std::string& rule) {
    expect_refused(text, 0, rule, declared(1));
  };
  refused(sac().substr(0, 640), "3 values");
  refused(sac(false, {{86, 7}}), "velocities");
  refused(sac(false, {{85, 2}}), "spectrum");
  refused(sac(false, {{105, 0}}), "uneven");
  refused(sac(false, {{71, 0}}), "not a valid time");
  refused(sac(false, {{5, std::bit_cast<int>(1e20F)}}), "it begins at 1e+20 s");
  refused(sac(false, {{79, 1 << 30}}), "at most");
}

/// Returns every file in `folder` with this ending.
std::vector<std::string> files_of(const std::string& folder, const std::string& ending) {
  std::vector<std::string> out;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().string().ends_with(ending)) out.push_back(entry.path().string());
  std::sort(out.begin(), out.end());
  return out;
}

TEST_F(StationFile, ReadsTheWholeStationOfARealBuilding) {
  FRAMEWATCH_DATA_OR_SKIP(folder, "atwood_np8040_anchorage2018");
  const std::vector<std::string> files = files_of(folder, ".V1c.gz");
  ASSERT_EQ(files.size(), 52u);
  std::vector<Record> records;
  for (const std::string& file : files) {
    auto record = read_record(file, {}, problems_);
    ASSERT_TRUE(record) << file;
    EXPECT_EQ(record->notes.size(), 2u) << record->notes.back();
    records.push_back(std::move(*record));
  }
  const auto all = merge_records(std::move(records), files, MergeSpan::common, problems_);
  ASSERT_TRUE(all) << problems_[0].message;
  EXPECT_EQ(all->names.size(), 52u);
  EXPECT_EQ(all->time_s.size(), 42000u);
  EXPECT_NEAR(all->time_s[0], 1543598946.332, 1e-3);
  EXPECT_DOUBLE_EQ(all->rate_hz, 200);
  EXPECT_EQ(all->notes.size(), 53u);  // the place of each sensor, and notes on all
}

TEST_F(StationFile, ConvertsRawCountsOfARealSensorAsItsNetworkDid) {
  FRAMEWATCH_DATA_OR_SKIP(folder, "atwood_np8040_anchorage2018");
  const auto raw = read_record(files_of(folder, "HNE.01.V0c.gz").at(0), {}, problems_);
  const auto made = read_record(files_of(folder, "HNE.01.V1c.gz").at(0), {}, problems_);
  ASSERT_TRUE(raw && made);
  EXPECT_EQ(raw->names, made->names);
  const std::vector<double>& counts = raw->accel_mps2[0];
  const double mean =
      std::accumulate(counts.begin(), counts.end(), 0.0) / static_cast<double>(counts.size());
  double worst = 0;
  for (std::size_t i = 0; i < counts.size(); ++i)
    worst = std::max(worst, std::abs(counts[i] - mean - made->accel_mps2[0][i]));
  EXPECT_LT(worst, 1e-5);
}

}  // namespace station_files_test
}  // namespace framewatch::drivers
