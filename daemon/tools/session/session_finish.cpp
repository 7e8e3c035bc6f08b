// SPDX-License-Identifier: MIT
#include "daemon/tools/session/session_finish.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include <fmt/core.h>

#include "daemon/base/exit_code.h"
#include "daemon/base/printable.h"
#include "daemon/config/config.h"
#include "daemon/config/sections/config_problems.h"
#include "daemon/monitor/estimates/session_estimates.h"
#include "daemon/tools/replay/repair_command.h"
#include "daemon/tools/replay/replay_command.h"
#include "daemon/tools/report/report_command.h"
#include "daemon/tools/report/session_file.h"
#include "daemon/tools/session/session_export.h"
#include "daemon/tools/session/session_log.h"
#include "drivers/files/input_file.h"
#include "drivers/files/text_output.h"

namespace framewatch::daemon {
namespace {

namespace fs = std::filesystem;
constexpr double kMissing_s = 2;  // after so long without an estimate they are computed again

class Finishing {
 public:
  Finishing(const FinishArguments& a, const Config& config, SessionFile& session)
      : a_(a), config_(config), session_(session) {}

  /// Gives partial files of a crash their final names. Event logs lose their torn end.
  void recover() {
    for (const char* name : {kRawLog, kCanLog, kEstimatesLog}) {
      const std::string path = a_.folder + "/" + name, partial = path + ".partial";
      if (!drivers::is_absent(path) || drivers::is_absent(partial)) continue;
      const std::string repaired = path + ".repaired";
      const bool whole = name == kCanLog || repair({partial, repaired}) == 0;
      const bool copied = name != kCanLog && !drivers::is_absent(repaired);
      std::error_code error;
      if (whole) fs::rename(copied ? repaired : partial, path, error);
      if (whole && copied && !error) fs::remove(partial, error);
      if (whole && !error) {
        session_.files.push_back(name);
        note(std::string(name) + ": the recording was cut off; its contents are intact");
      } else {
        problem(std::string(name) + ".partial: cannot be recovered: " + error.message());
      }
    }
  }

  void find_stages() {
    for (const char* name : {kRawLog, kCanLog})
      if (!drivers::is_absent(a_.folder + "/" + name)) raw_.push_back(a_.folder + "/" + name);
    std::vector<std::string> found;
    motion_ = raw_.empty() ? std::nullopt : read_session_motion(config_, raw_, found);
    for (std::string& p : found) problem(std::move(p));
    if (!motion_) return problem("there are no raw samples to evaluate");
    session_.stages = daemon::find_stages(*motion_);
    if (session_.end_us == 0) session_.end_us = motion_->time_us(motion_->accel.rows() - 1);
  }

  /// Reads the recorded estimates, or computes new ones when they do not cover the samples.
  void choose_estimates() {
    read_estimates(kEstimatesLog);
    if (!motion_) return;
    const std::string missing = missing_estimates();
    if (missing.empty()) return;
    ReplayArguments again;
    again.config = a_.config;
    again.inputs = raw_;
    again.out = a_.folder + "/" + kReplayedLog;
    again.salvage = again.quiet = true;
    if (replay(again) != 0) return problem(missing + ", and replay cannot compute them");
    read_estimates(kReplayedLog);
    session_.files.push_back(kReplayedLog);
    note(missing + fmt::format(": computed again from the raw samples, {}", kReplayedLog));
  }

  void write_report() {
    if (!a_.report) return;
    if (!estimates_) return problem("no report, because there are no estimates");
    SessionReport r;
    r.test = r.title = session_.request.test;
    r.operator_name = session_.request.operator_name;
    r.notes = session_.request.notes;
    r.session = session_;
    r.config = config_;
    r.estimates = *std::move(estimates_);
    r.motion = std::move(motion_);
    std::vector<std::pair<std::string, std::string>> files{
        {"estimates", a_.folder + "/" + estimates_log_}, {"configuration", a_.config}};
    for (const std::string& raw : raw_) files.push_back({"raw samples", raw});
    const std::string page =
        a_.reports.empty() ? a_.folder + "/" + kReportPage
                           : a_.reports + "/" + fs::path(a_.folder).filename().string() + ".html";
    const std::string why = daemon::write_report(std::move(r), files, page);
    if (!why.empty()) return problem("no report: " + why);
    session_.report = page;
  }

  void export_others() {
    std::vector<std::string> found;
    export_raw(a_.folder, a_.csv, a_.mat, session_.files, found);
    export_estimates(config_, a_.folder, estimates_log_, a_.csv, a_.mat, session_.files, found);
    if (a_.split) export_stages(a_.folder, session_.stages, session_.files, found);
    for (std::string& p : found) problem(std::move(p));
  }

  void save() {
    const std::string why =
        drivers::write_text_file(a_.folder + "/" + kSessionJson, session_json(session_));
    if (!why.empty()) problem(why);
  }

  bool good() const { return good_; }
  void problem(std::string text) {
    note(std::move(text));
    good_ = false;
  }

 private:
  /// Prints and stores a note for the user; nothing has failed.
  void note(std::string text) {
    fmt::print(stderr, "framewatch record: {}\n", printable_lines(text));
    session_.finishing.push_back(std::move(text));
  }
  void read_estimates(const char* log) {
    std::vector<drivers::Problem> found;
    estimates_log_ = log;
    estimates_ = read_session_estimates(a_.folder + "/" + log, found);
  }
  std::string missing_estimates() const {
    const auto& e = estimates_;
    if (!e) return "there are no estimates";
    const double most_s = kMissing_s + 2 * config_.pipeline.options.hop_s;
    const auto seconds = [](std::int64_t from_us, std::int64_t to_us) {
      return 1e-6 * static_cast<double>(to_us - from_us);
    };
    const double first_s = config_.pipeline.options.window_s + most_s;
    if (seconds(motion_->first_us, e->end_us.front()) > first_s)
      return "the first estimates are missing";
    if (seconds(e->end_us.back(), motion_->time_us(motion_->accel.rows() - 1)) > most_s)
      return "the last estimates are missing";
    for (std::size_t w = 1; w < e->end_us.size(); ++w)
      if (seconds(e->end_us[w - 1], e->end_us[w]) > most_s)
        return "estimates in between are missing";
    return "";
  }

  const FinishArguments& a_;
  const Config& config_;
  SessionFile& session_;
  std::vector<std::string> raw_;
  std::optional<SessionMotion> motion_;
  std::string estimates_log_;
  std::optional<SessionEstimates> estimates_;
  bool good_ = true;
};

}  // namespace

int finish_session(const FinishArguments& a) {
  std::vector<ConfigProblem> problems;
  const auto config = load_config(a.config, problems);
  print_problems(problems);
  std::string error;
  auto session = read_session_file(a.folder + "/" + kSessionJson, error);
  if (!session) fmt::print(stderr, "{}/{}: {}\n", a.folder, kSessionJson, printable_lines(error));
  if (!config || !session) return kBadInput;
  for (const char* name : {kRawLog, kCanLog, kEstimatesLog})
    if (drivers::DurableFile::in_use(a.folder + "/" + name)) {
      fmt::print(stderr, "framewatch record: {}: is being recorded\n", a.folder);
      return kBadInput;
    }
  // The recorder may be recording the next session.
  (void)!::nice(5);
  session->finishing.clear();  // notes of an earlier try
  Finishing finishing(a, *config, *session);
  if (config->sha256 != session->config_sha256)
    finishing.problem(a.config + ": differs from the configuration of the recording");
  finishing.recover();
  finishing.find_stages();
  finishing.save();
  finishing.choose_estimates();
  finishing.write_report();
  finishing.export_others();
  session->state = "finished";
  std::sort(session->files.begin(), session->files.end());
  session->files.erase(std::unique(session->files.begin(), session->files.end()),
                       session->files.end());
  finishing.save();
  if (!a.quiet && !session->report.empty()) fmt::print("{}\n", session->report);
  return finishing.good() ? 0 : 1;
}

}  // namespace framewatch::daemon
