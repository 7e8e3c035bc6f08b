// Record files of every format, and what `framewatch init` makes of their titles.
#include <cmath>
#include <set>

#include "daemon/init/column_places.h"
#include "drivers/records/record_file.h"
#include "tests/fuzz/targets.h"

namespace framewatch::test {
namespace {

using drivers::RecordFormat;

/// No title puts a column into two places.
void place_columns(const std::vector<std::string>& titles) {
  estimator::Structure building;
  building.stories = 2;
  building.frames_x = {"y1", "y2"};
  building.frames_y = {"x1"};
  const daemon::ColumnPlaces found = daemon::match_columns(building, titles, {});
  std::set<std::size_t> used;
  for (const auto& column : found.column_of_place)
    require(!column || (*column < titles.size() && used.insert(*column).second), "a place each");
}

/// How it is to be read, then the file.
void read_record_file(Bytes input) {
  Pieces pieces(input);
  const auto how = pieces.take<std::uint8_t>();
  drivers::RecordOptions options;
  options.format = static_cast<RecordFormat>(how % 8 % 6);
  if (how & 64) options.unit_mps2 = 9.80665;
  if (how & 128) options.step_s = 0.01;
  if (how & 32) options.decimal = ',';
  if (how & 16) options.zone_min = 540;
  if (how & 8) options.columns = {"a"};
  const InputFile file(pieces.rest());
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
      "Date;a [mg];\n2026-11-21T17:00:00.01+09:00;1;\n2026-11-21T17:00:00.02+09:00;2;\n"};
  std::vector<std::string> out;
  for (const char* table : tables)
    for (const int how : {0, 16, 32, 8}) out.push_back(static_cast<char>(how) + std::string(table));
  int format = 1;
  for (const char* text : texts) {
    const int declared = format == 3 ? 64 : format == 4 ? 64 + 128 : 0;
    for (const int how : {format, declared | format, declared})
      out.push_back(static_cast<char>(how) + std::string(text));
    ++format;
  }
  return out;
}

}  // namespace

const FuzzTarget kRecordTarget{"record", &read_record_file, &record_seeds};

}  // namespace framewatch::test
