// SPDX-License-Identifier: MIT
#include "daemon/tools/lab/data_files.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/core.h>

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
  static const std::vector<MeasuredRun> runs = [] {
    std::vector<MeasuredRun> out;
    for (const auto& [name, time] :
         {std::pair{"Northridge", "122607"}, std::pair{"Sine_1.0", "122116"},
          std::pair{"Sine_1.5", "121949"}, std::pair{"Sine_2.0", "122410"}}) {
      out.push_back({name, {}});
      for (const auto& [level, sensor] :
           {std::pair{"Ground_Floor", "Xsens_DOT"}, std::pair{"1st_Floor", "Xsens_DOT"},
            std::pair{"2nd_Floor", "left_leg"}, std::pair{"3rd_Floor_top", "Xsens_DOT"}})
        out.back().files.push_back(
            fmt::format("{}/({}){}_20250306_{}.csv.gz", level, name, sensor, time));
    }
    return out;
  }();
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
