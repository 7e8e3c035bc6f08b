// SPDX-License-Identifier: MIT
#include "daemon/tools/report/report_command.h"

#include <filesystem>

#include <fmt/core.h>

#include "daemon/base/exit_code.h"
#include "daemon/base/file_digest.h"
#include "daemon/base/printable.h"
#include "daemon/base/progress.h"
#include "drivers/files/standard_streams.h"
#include "drivers/files/text_output.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {
namespace {

std::string out_path(const ReportArguments& a) {
  return a.out.empty() ? std::filesystem::path(a.estimates).replace_extension(".html").string()
                       : a.out;
}

/// Returns true if the configuration describes the building of the estimates.
bool fits(const Config& config, const SessionEstimates& estimates) {
  const estimator::ParameterTable table = config.pipeline.parameters();
  if (static_cast<std::size_t>(table.size()) != estimates.parameters()) return false;
  for (int p = 0; p < table.size(); ++p)
    if (table[p].name != estimates.table.name[static_cast<std::size_t>(p)]) return false;
  return true;
}

}  // namespace

std::string write_report(SessionReport r,
                         const std::vector<std::pair<std::string, std::string>>& files,
                         const std::string& path, const std::string& floors_path,
                         const std::string& drifts_path, const PictureFiles& figures) {
  for (const auto& [use, file] : files) r.files.push_back({use, file, sha256_of_file(file)});
  evaluate(r);
  std::string problem;
  if (!figures.folder.empty()) problem = write_pictures(session_pictures(r), figures);
  if (problem.empty()) problem = drivers::write_text_file(path, session_report_html(r));
  if (problem.empty() && !drifts_path.empty())
    problem = drivers::write_text_file(drifts_path, drifts_json(*r.drifts, *r.config));
  if (!problem.empty() || floors_path.empty()) return problem;
  return drivers::write_text_file(floors_path, floors_json(*r.floors, *r.config, *r.motion));
}

int report(const ReportArguments& a) {
  if (!a.raw.empty() && a.config.empty())
    return refuse("report", "--raw needs --config, which describes the channels");
  if (!a.floors.empty() && a.raw.empty())
    return refuse("report", "--floors needs --config and --raw: it is computed from the samples");
  if (!a.drifts.empty() && a.raw.empty())
    return refuse("report",
                  "--drifts needs --config and --raw: they are computed from the samples");
  if (a.raw.empty() && a.record.any())
    return refuse("report", "--unit, --step and the like are for the record files of --raw");
  const std::string path = out_path(a);
  if (const std::string problem = problem_of_page_name(path); !problem.empty())
    return refuse("report", problem + ". --figures writes the pictures as files");
  std::vector<std::string> inputs = a.raw;
  inputs.insert(inputs.end(), {a.estimates, a.config});
  for (const std::string& input : inputs) {
    for (const std::string& out : {path, a.floors, a.drifts}) {
      std::error_code error;
      if (!out.empty() && (input == out || std::filesystem::equivalent(input, out, error)))
        return refuse("report", out + ": is input and output; name another output");
    }
  }
  SessionReport r;
  r.title = a.title;
  r.test = a.test;
  r.operator_name = a.operator_name;
  r.notes = a.notes;
  bool good = true;
  const auto complain = [&](const std::string& problem) {
    fmt::print(stderr, "{}\n", printable_lines(problem));
    good = false;
  };
  if (!a.config.empty()) {
    std::vector<ConfigProblem> problems;
    r.config = load_config(a.config, problems);
    for (const ConfigProblem& p : problems) complain(p.where + ": " + p.message);
  }
  if (!a.about.empty()) {
    std::vector<ConfigProblem> problems;
    auto about = read_about(a.about, problems);
    for (const ConfigProblem& p : problems) complain(p.where + ": " + p.message);
    if (about) r.about = *std::move(about);
  }
  if (!a.session.empty()) {
    std::string error;
    r.session = read_session_file(a.session, error);
    if (!r.session) complain(a.session + ": " + error);
  }
  ProgressLine progress("report", a.quiet);
  progress.follow_reading("reading " + a.estimates, {a.estimates}, 1);
  std::vector<drivers::Problem> problems;
  auto estimates = read_session_estimates(a.estimates, problems);
  for (const drivers::Problem& p : problems) complain(p.where + ": " + p.message);
  if (estimates && r.config && !fits(*r.config, *estimates))
    complain(a.config + ": describes another building than " + a.estimates);
  if (r.config && !a.floors.empty() && !r.config->pipeline.parameters().grouped())
    complain("--floors: every frame of " + a.config +
             " has a channel on every floor; replay --floors writes their motion");
  if (good && !a.raw.empty()) {
    progress.follow_reading("reading the raw samples", a.raw, 1);
    std::vector<std::string> raw_problems;
    r.motion = read_session_motion(*r.config, a.raw, raw_problems, a.record);
    for (const std::string& p : raw_problems) complain(p);
  }
  if (!good || !estimates) return kBadInput;
  r.estimates = *std::move(estimates);
  std::vector<std::pair<std::string, std::string>> files{{"estimates", a.estimates}};
  if (!a.config.empty()) files.push_back({"configuration", a.config});
  for (const std::string& raw : a.raw) files.push_back({"raw samples", raw});
  progress("making the page", 0);
  const std::string problem =
      write_report(std::move(r), files, path, a.floors, a.drifts, a.figures);
  if (!problem.empty()) return refuse("report", problem);
  if (!a.quiet && !a.floors.empty()) fmt::print(stderr, "{}\n", a.floors);
  if (!a.quiet && !a.drifts.empty()) fmt::print(stderr, "{}\n", a.drifts);
  if (!a.quiet && !a.figures.folder.empty()) fmt::print(stderr, "{}\n", a.figures.folder);
  if (!a.quiet && path != drivers::kStandardOutput) fmt::print("{}\n", path);
  return 0;
}

}  // namespace framewatch::daemon
