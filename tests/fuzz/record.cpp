// SPDX-License-Identifier: MIT
// Record files: text of every format, miniSEED, MATLAB; and the places that `framewatch init`
// reads from their titles.
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <set>

#include "daemon/tools/init/column_places.h"
#include "drivers/formats/record_file.h"
#include "tests/fuzz/scratch.h"
#include "tests/fuzz/targets.h"
#include "tests/support/mat.h"
#include "tests/support/miniseed.h"
#include "tests/support/station_files.h"

namespace framewatch::test {
namespace {

using drivers::RecordFormat;

/// Checks that no title puts a column into two places.
void place_columns(const std::vector<std::string>& titles) {
  estimator::Structure building;
  building.stories = 2;
  building.frames_x = {"y1", "y2"};
  building.frames_y = {"x1"};
  const daemon::ColumnPlaces found =
      daemon::match_columns(building, daemon::places_of(building), titles, {});
  std::set<std::size_t> used;
  for (const auto& column : found.column_of_place)
    require(!column || (*column < titles.size() && used.insert(*column).second), "a place each");
}

void read_and_check(Bytes file_bytes, const drivers::RecordOptions& options);

/// Reads the options, then the file.
void read_record_file(Bytes input) {
  Pieces pieces(input);
  const auto how = pieces.take<std::uint8_t>();
  drivers::RecordOptions options;
  options.format = static_cast<RecordFormat>(how % 8);
  if (how & 64) options.unit_mps2 = 9.80665;
  if (how & 128) options.step_s = 0.01;
  if (how & 32) options.decimal = ',';
  if (how & 16) options.zone_min = 540;
  if (how & 8) options.columns = {"a"};
  read_and_check(pieces.rest(), options);
}

/// Returns a changed miniSEED file.
void read_changed_miniseed(Bytes input) {
  Pieces pieces(input);
  const auto how = pieces.take<std::uint8_t>();
  drivers::RecordOptions options;
  options.unit_mps2 = 1e-6;
  if (how & 1) options.columns = {"XX.TEST.01.HN1"};
  SeedSpan first, second;
  for (int i = 0; i < 200; ++i) first.values.push_back(100 * (i % 7) - i);
  second.values = first.values;
  first.encoding = std::array{DE_STEIM1, DE_STEIM2, DE_INT16, DE_FLOAT32}[how / 2 % 4];
  second.start_us = how & 8 ? 2'000'000 : 1'500'000;
  first.record_bytes = second.record_bytes = 256;
  if (how & 16) second.channel = "HN2";
  const std::string whole = miniseed(first) + miniseed(second);
  const auto bytes = changed({whole.begin(), whole.end()}, pieces);
  read_and_check(bytes, options);
}

/// Returns bytes of a MATLAB file of level 5. Damage that HDF5 reads itself is not tested.
const std::vector<std::uint8_t>& good_mat(bool packed) {
  static const auto make = [](matio_compression compression) {
    const std::string path = scratch_folder() + "/good.mat";
    MatWriter(path, MAT_FT_MAT5, compression)
        .add_column("t", {0, 0.01, 0.02, 0.03})
        .add("acc", {1, 2, 3, 4, 5, 6, 7, 8}, 4, 2)
        .add_as<std::int16_t>("i", MAT_C_INT16, MAT_T_INT16, {1, 2, 3, 4})
        .add_text("who", "nobody")
        .add_complex("z", {1, 2, 3})
        .add_struct("run", {"t", "a"}, {{0, 0.01}, {1, 2}});
    std::ifstream file(path, std::ios::binary);
    return std::vector<std::uint8_t>{std::istreambuf_iterator<char>(file), {}};
  };
  static const auto plain = make(MAT_COMPRESSION_NONE), zlib = make(MAT_COMPRESSION_ZLIB);
  return packed ? zlib : plain;
}

void read_changed_mat(Bytes input) {
  Pieces pieces(input);
  const auto how = pieces.take<std::uint8_t>();
  drivers::RecordOptions options;
  options.unit_mps2 = 1;
  options.time_column = how & 1 ? "t" : "run.t";
  options.columns =
      how & 1 ? std::vector<std::string>{"acc", "i"} : std::vector<std::string>{"run.a"};
  if (how & 2) options.time_unit_s = 1e-3;
  read_and_check(changed(good_mat(how & 4), pieces), options);
}

void read_and_check(Bytes file_bytes, const drivers::RecordOptions& options) {
  const InputFile file(file_bytes);
  std::vector<drivers::Problem> problems;
  const auto record = drivers::read_record(file.path(), options, problems);
  require(record.has_value() == problems.empty(), "a record or a problem");
  if (!record) return;
  require(record->accel_mps2.size() == record->names.size(), "a name for every column");
  place_columns(record->names);
  for (std::size_t i = 1; i < record->time_s.size(); ++i)
    require(record->time_s[i - 1] < record->time_s[i], "time that increases");
  for (const auto& column : record->accel_mps2) {
    require(column.size() == record->time_s.size(), "a value for every instant");
    for (const double value : column) require(!std::isinf(value), "finite values");
  }
}

std::vector<std::string> record_seeds() {
  const char* const texts[] = {
      "time_s,base-x,F1-Y1,2nd floor x1 along y\n0.00,0.1,-0.2,0\n0.01,,1e-3,0\n0.02,0.3,0.25,0\n",
      "PEER NGA STRONG MOTION DATABASE RECORD\nEl Centro, 1940, 180\n"
      "ACCELERATION TIME SERIES IN UNITS OF G\nNPTS=   6, DT=   .0100 SEC\n"
      "  .1E-02  -.2E-02  .3E-02  .4E-02  -.5E-02\n  .6E-02\n",
      "0.00 0.001\n0.01 -0.002\n0.02 0.003\n", "0.001 -0.002 0.003\n0.004 0.005 0.006\n0.007\n",
      "// Start Time: Unknown\n// Update Rate: 100.0Hz\n// Filter Profile: general\n"
      "PacketCounter,SampleTimeFine,Acc_X,Acc_Y,Acc_Z\n"
      "00001,10000,0.1,0.2,9.81\n00002,20000,0.1,0.2,9.81\n00003,30000,0.1,0.2,9.81\n"};
  const char* const tables[] = {
      "Time;\"a [g]\";b (cm/s^2)\n0;\"0,5\";1,25\n0,01;-1;NA\n0,02;1;1\n",
      "# logger\nLogger 7\ntime\ta\n[ms]\t[m/s2]\n0\t1,234\n10\t2,345\n",
      "Date;a [mg];\n2026-11-21T17:00:00.01+09:00;1;\n2026-11-21T17:00:00.02+09:00;2;\n",
      ",a [g],b [g]\n2026-11-21 17:00:00.00,1,2\n2026-11-21 17:00:00.01,1,2\n",
      ";SampleRate, 100,Hz\n;Headers, time,Ax [g]\n0.00,1\n0.01,2D-02\n",
      "\"TOA5\",\"CR6\"\n\"TIMESTAMP\",\"RECORD\",\"A\"\n\"TS\",\"RN\",\"g\"\n\"\",\"\",\"Smp\"\n"
      "\"2026-11-21 17:00:00\",0,1\n\"2026-11-21 17:00:00.01\",1,2\n"};
  std::vector<std::string> out;
  for (const char* table : tables)
    for (const int how : {0, 16, 32, 8}) out.push_back(static_cast<char>(how) + std::string(table));
  CsmipText corrected, pairs;
  corrected.corrected = true;
  pairs.unit = "Units of uncor accel are sec and g/10.";
  pairs.points = "2";
  pairs.values = "   .000  -.006   .005   .007\n";
  for (const std::string& file :
       {cosmos(), smc(), knet(), sac(), sac(true), csmip(), csmip(corrected), csmip(pairs), esm(),
        geonet(), geonet("Up", true)})
    for (const int how : {0, 16, 64}) out.push_back(static_cast<char>(how) + file);
  int format = 1;
  for (const char* text : texts) {
    const int declared = format == 3 ? 64 : format == 4 ? 64 + 128 : 0;
    for (const int how : {format, declared | format, declared})
      out.push_back(static_cast<char>(how) + std::string(text));
    ++format;
  }
  return out;
}

std::vector<std::string> every_way() {
  std::vector<std::string> out;
  for (int how = 0; how < 32; ++how) out.emplace_back(1, static_cast<char>(how));
  return out;
}

}  // namespace

const FuzzTarget kMiniseedTarget{"miniseed", &read_changed_miniseed, &every_way};
const FuzzTarget kMatTarget{"mat", &read_changed_mat, &every_way};
const FuzzTarget kRecordTarget{"record", &read_record_file, &record_seeds};

}  // namespace framewatch::test
