// SPDX-License-Identifier: MIT
#include "daemon/tools/session/session_export.h"

#include <array>
#include <memory>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/mat_file.h"
#include "daemon/monitor/estimates/estimate_output.h"
#include "daemon/tools/session/session_log.h"
#include "drivers/files/input_file.h"
#include "drivers/lcm/accel_codec.h"
#include "drivers/lcm/accel_log.h"
#include "drivers/lcm/lcm_log.h"
#include "drivers/records/record_csv_writer.h"

namespace framewatch::daemon {
namespace {

constexpr std::array<const char*, 3> kStageNames = {"quiet", "forced", "free"};

void take(const std::vector<drivers::Problem>& found, std::vector<std::string>& problems) {
  for (const drivers::Problem& p : found) problems.push_back(p.where + ": " + p.message);
}

/// Adds a file that was written to `files`, or the problem of one that was not to `problems`.
void add(const std::string& file, const std::string& problem, std::vector<std::string>& files,
         std::vector<std::string>& problems) {
  if (problem.empty())
    files.push_back(file);
  else
    problems.push_back(file + ": " + problem);
}

std::string write_csv(const std::string& path, const drivers::Record& record) {
  drivers::RecordCsvWriter file;
  bool good = file.open(path, record.names);
  std::vector<double> row(record.names.size());
  for (std::size_t i = 0; good && i < record.time_s.size(); ++i) {
    for (std::size_t c = 0; c < row.size(); ++c) row[c] = record.accel_mps2[c][i];
    good = file.write(record.time_s[i], row);
  }
  return good && file.close() ? "" : file.error();
}

std::string write_mat(const std::string& path, const drivers::Record& record) {
  const std::size_t channels = record.names.size(), instants = record.time_s.size();
  if (channels * instants * sizeof(double) > MatFile::kMaxBytes)
    return "a variable of a MATLAB 5 file holds at most 2 GiB";
  std::vector<double> values(channels * instants);
  for (std::size_t c = 0; c < channels; ++c)
    for (std::size_t i = 0; i < instants; ++i) values[i * channels + c] = record.accel_mps2[c][i];
  return write_mat_file(path, [&](MatFile& file) {
    return file.texts("channel", record.names) && file.matrix("time_s", record.time_s, 1) &&
           file.matrix("accel_mps2", values, channels);
  });
}

}  // namespace

void export_raw(const std::string& folder, bool csv, bool mat, std::vector<std::string>& files,
                std::vector<std::string>& problems) {
  if (!csv && !mat) return;
  const std::string log = folder + "/" + kRawLog;
  if (!drivers::is_absent(folder + "/" + kCanLog))
    problems.push_back("CAN frames are not converted: raw.can.log is a candump log");
  if (drivers::is_absent(log)) return;
  std::vector<drivers::Problem> found;
  const auto contents = drivers::log_contents(log, found);
  for (std::size_t i = 0; contents && i < contents->accel.size(); ++i) {
    const auto record = drivers::read_accel_log(log, contents->accel[i], found);
    if (!record) break;
    const std::string name = i == 0 ? "raw" : "raw." + contents->accel[i];
    const std::string path = folder + "/" + name;
    if (csv) add(name + ".csv", write_csv(path + ".csv", *record), files, problems);
    if (mat) add(name + ".mat", write_mat(path + ".mat", *record), files, problems);
  }
  take(found, problems);
}

void export_estimates(const Config& config, const std::string& folder, const std::string& log,
                      bool csv, bool mat, std::vector<std::string>& files,
                      std::vector<std::string>& problems) {
  for (const auto& [wanted, name] :
       {std::pair{csv, "estimates.csv"}, std::pair{mat, "estimates.mat"}}) {
    if (!wanted) continue;
    std::string error;
    const auto out = estimate_output(config, {folder + "/" + name}, error);
    std::vector<drivers::Problem> found;
    const bool whole = out && drivers::for_each_event(
                                  folder + "/" + log,
                                  [&](const drivers::LogEvent& event) {
                                    return out->put(event.timestamp_us, event.channel, event.data);
                                  },
                                  found);
    take(found, problems);
    if (whole && out->close())
      files.push_back(name);
    else
      problems.push_back(fmt::format("{}: {}", name, out ? out->error() : error));
  }
}

void export_stages(const std::string& folder, const std::vector<Stage>& stages,
                   std::vector<std::string>& files, std::vector<std::string>& problems) {
  if (drivers::is_absent(folder + "/" + kRawLog)) {
    problems.push_back("CAN frames are not split: session.json has the stages' times");
    return;
  }
  std::vector<std::unique_ptr<drivers::LcmLogWriter>> logs;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    names.push_back(fmt::format("stage-{}-{}.lcmlog", i + 1,
                                kStageNames[static_cast<std::size_t>(stages[i].kind)]));
    logs.push_back(std::make_unique<drivers::LcmLogWriter>());
    if (!logs.back()->open(folder + "/" + names.back()))
      problems.push_back(names.back() + ": " + logs.back()->error());
  }
  std::vector<drivers::Problem> found;
  drivers::for_each_event(
      folder + "/" + kRawLog,
      [&](const drivers::LogEvent& e) {
        const auto time_us = drivers::accel_time_us(e.data.data(), e.data.size());
        for (std::size_t i = 0; i < stages.size(); ++i) {
          const bool last = i + 1 == stages.size();
          // The last sample belongs to the last stage, channel tables to every stage.
          if (!time_us || (*time_us >= stages[i].from_us &&
                           (*time_us < stages[i].to_us || (last && *time_us <= stages[i].to_us))))
            (void)logs[i]->write(e.timestamp_us, e.channel, e.data.data(), e.data.size());
        }
        return true;
      },
      found);
  take(found, problems);
  for (std::size_t i = 0; i < logs.size(); ++i)
    add(names[i], logs[i]->close() ? "" : logs[i]->error(), files, problems);
}

}  // namespace framewatch::daemon
