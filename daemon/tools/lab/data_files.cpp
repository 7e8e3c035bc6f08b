// SPDX-License-Identifier: MIT
#include "daemon/tools/lab/data_files.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "daemon/tools/simulation/scenario_motion.h"
#include "drivers/formats/record_file.h"
#include "drivers/records/record_builder.h"

namespace framewatch::daemon {
namespace {

std::optional<estimator::GroundMotion> read(const std::string& path,
                                            const MotionFileFormat& format) {
  std::string problem;
  estimator::GroundMotion motion = read_recorded_motion(path, format, problem);
  if (!problem.empty()) return std::nullopt;
  return motion;
}

constexpr const char* kFolder = "/mini_shake_table_xsens_2025/Flexible_vs_Stiff/Flexible_3_story/";

}  // namespace

std::optional<estimator::GroundMotion> el_centro_ns(const std::string& data) {
  return read(data + "/ground_motions/elcentro_NS.dat", {"g", 0, ""});
}

std::optional<estimator::GroundMotion> hachinohe_ns(const std::string& data) {
  return read(data + "/ground_motions/hachi.txt", {"gal", 0.01, ""});
}

const std::vector<MeasuredRun>& measured_runs() {
  static const std::vector<MeasuredRun> runs = {
      {"Northridge",
       {"Ground_Floor/(Northridge)Xsens_DOT_20250306_122607.csv.gz",
        "1st_Floor/(Northridge)Xsens_DOT_20250306_122607.csv.gz",
        "2nd_Floor/(Northridge)left_leg_20250306_122607.csv.gz",
        "3rd_Floor_top/(Northridge)Xsens_DOT_20250306_122607.csv.gz"}},
      {"Sine_1.0",
       {"Ground_Floor/(Sine_1.0)Xsens_DOT_20250306_122116.csv.gz",
        "1st_Floor/(Sine_1.0)Xsens_DOT_20250306_122116.csv.gz",
        "2nd_Floor/(Sine_1.0)left_leg_20250306_122116.csv.gz",
        "3rd_Floor_top/(Sine_1.0)Xsens_DOT_20250306_122116.csv.gz"}},
      {"Sine_1.5",
       {"Ground_Floor/(Sine_1.5)Xsens_DOT_20250306_121949.csv.gz",
        "1st_Floor/(Sine_1.5)Xsens_DOT_20250306_121949.csv.gz",
        "2nd_Floor/(Sine_1.5)left_leg_20250306_121949.csv.gz",
        "3rd_Floor_top/(Sine_1.5)Xsens_DOT_20250306_121949.csv.gz"}},
      {"Sine_2.0",
       {"Ground_Floor/(Sine_2.0)Xsens_DOT_20250306_122410.csv.gz",
        "1st_Floor/(Sine_2.0)Xsens_DOT_20250306_122410.csv.gz",
        "2nd_Floor/(Sine_2.0)left_leg_20250306_122410.csv.gz",
        "3rd_Floor_top/(Sine_2.0)Xsens_DOT_20250306_122410.csv.gz"}}};
  return runs;
}

std::optional<drivers::Record> read_measured_run(const std::string& data, const MeasuredRun& run) {
  std::vector<drivers::Record> levels;
  std::vector<drivers::Problem> problems;
  for (const std::string& file : run.files) {
    std::error_code error;
    if (!std::filesystem::exists(data + kFolder + file, error)) return std::nullopt;
    auto record = drivers::read_record(data + kFolder + file, {}, problems);
    if (!record) return std::nullopt;
    const auto x = std::find_if(record->names.begin(), record->names.end(), [](const auto& name) {
      return name.ends_with(".x") || name.ends_with("_X") || name == "x";
    });
    if (x == record->names.end()) return std::nullopt;
    record->accel_mps2 = {record->accel_mps2[static_cast<std::size_t>(x - record->names.begin())]};
    record->names = {"level" + std::to_string(levels.size())};
    levels.push_back(std::move(*record));
  }
  return drivers::merge_records(std::move(levels), run.files, drivers::MergeSpan::common, problems);
}

}  // namespace framewatch::daemon
