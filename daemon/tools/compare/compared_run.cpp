// SPDX-License-Identifier: MIT
#include "daemon/tools/compare/compared_run.h"

#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include <fmt/core.h>

#include "daemon/config/config.h"
#include "daemon/config/sections/config_problems.h"
#include "daemon/monitor/estimates/parameter_message.h"
#include "daemon/monitor/history/history_request.h"
#include "daemon/tools/replay/replay_command.h"
#include "daemon/tools/session/session_log.h"
#include "drivers/files/input_file.h"
#include "estimator/identify/elements/story_design.h"
#include "estimator/numeric/nan.h"
#include "estimator/structure/group_design.h"

namespace framewatch::daemon {
namespace {

namespace fs = std::filesystem;

/// A folder for the estimates of a replay, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::error_code error;
    std::string name = (fs::temp_directory_path(error) / "framewatch-compare-XXXXXX").string();
    if (::mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code error;
    if (!path_.empty()) fs::remove_all(path_, error);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

class RunReader {
 public:
  RunReader(const std::string& source, const RunOptions& options,
            std::vector<std::string>& problems)
      : source_(source), options_(options), problems_(problems) {
    run_.name = fs::path(source).filename().string();
    if (run_.name.empty()) run_.name = fs::path(source).parent_path().filename().string();
  }

  bool read() {
    const std::size_t before = problems_.size();
    const std::size_t at = source_.rfind('@');
    std::error_code error;
    if (at != std::string::npos && source_.find("..", at) != std::string::npos)
      read_history(source_.substr(0, at), source_.substr(at + 1));
    else if (fs::exists(source_ + "/" + kSessionJson, error))
      read_session();
    else if (source_.ends_with(".toml"))
      read_design();
    else
      read_log_or_record();
    if (problems_.size() != before) return false;
    run_.modes = run_modes(run_.report, run_.values);
    return true;
  }

  ComparedRun take() { return std::move(run_); }

 private:
  void problem(const std::string& message) { problems_.push_back(source_ + ": " + message); }

  bool load(const std::string& path) {
    std::vector<ConfigProblem> found;
    run_.report.config = load_config(path, found);
    for (const ConfigProblem& p : found) problems_.push_back(p.where + ": " + p.message);
    if (run_.report.config)
      run_.report.files.push_back({"configuration", path, run_.report.config->sha256});
    return run_.report.config.has_value();
  }

  bool read_estimates(const std::string& path) {
    std::vector<drivers::Problem> found;
    auto estimates = read_session_estimates(path, found);
    for (const drivers::Problem& p : found) problems_.push_back(p.where + ": " + p.message);
    if (!estimates) return false;
    run_.report.estimates = *std::move(estimates);
    return true;
  }

  /// Returns true if the configuration identifies the parameters that the estimates have.
  bool is_of_config() {
    if (!run_.report.config) return true;
    const Config& config = *run_.report.config;
    const parameter_table_t& has = run_.report.estimates.table;
    const parameter_table_t wanted = parameter_message(config, config.pipeline.parameters());
    if (has.name == wanted.name) return true;
    problem(fmt::format("has {} parameters of \"{}\"; {} identifies {} others of \"{}\"",
                        has.name.size(), has.structure, config.path, wanted.name.size(),
                        wanted.structure));
    return false;
  }

  /// Reads the samples and evaluates everything.
  void evaluate_with(const std::vector<std::string>& raw) {
    if (!is_of_config()) return;
    if (run_.report.config && !raw.empty()) {
      std::vector<std::string> found;
      run_.report.motion = read_session_motion(*run_.report.config, raw, found, options_.record);
      problems_.insert(problems_.end(), found.begin(), found.end());
      if (!run_.report.motion) return;
    }
    evaluate(run_.report);
    take_values();
  }

  void take_values() {
    const SessionEstimates& e = run_.report.estimates;
    for (std::size_t p = 0; p < e.parameters(); ++p) {
      const auto windows = separate_windows(e, p);
      run_.values.push_back(estimator::mean_of(windows, 0, windows.size()));
    }
    for (const ElementChange& c : run_.report.changes) {
      if (!c.measured()) continue;
      run_.values[c.parameter] = c.after;
      run_.notes.push_back(fmt::format(
          "{}: {} changed by {:+.1f} % within this run; its value is that after the change.",
          run_.name, element_of(run_.report, c.parameter), 100 * c.ratio));
    }
  }

  void read_session() {
    run_.what = "session";
    std::string error;
    run_.report.session = read_session_file(source_ + "/" + kSessionJson, error);
    if (!run_.report.session) return problem(std::string(kSessionJson) + ": " + error);
    const std::string config =
        options_.config.empty() ? run_.report.session->config_path : options_.config;
    if (!load(config)) return;
    if (run_.report.config->sha256 != run_.report.session->config_sha256)
      run_.notes.push_back(run_.name + ": " + config +
                           " differs from the configuration of the recording.");
    std::vector<std::string> raw;
    std::string estimates = kEstimatesLog;
    for (const std::string& file : run_.report.session->files) {
      if (file == kRawLog || file == kCanLog) raw.push_back(source_ + "/" + file);
      if (file.starts_with("estimates-replayed")) estimates = file;
    }
    if (read_estimates(source_ + "/" + estimates)) evaluate_with(raw);
  }

  void read_log_or_record() {
    if (drivers::is_absent(source_)) return problem("no such file");
    std::vector<drivers::Problem> found;
    auto estimates = source_.ends_with(".lcmlog") || source_.ends_with(".zst")
                         ? read_session_estimates(source_, found)
                         : std::nullopt;
    if (estimates) {
      run_.what = "log of estimates";
      run_.report.estimates = *std::move(estimates);
      if (!options_.config.empty() && !load(options_.config)) return;
      return evaluate_with({});
    }
    run_.what = "record";
    if (options_.config.empty())
      return problem("holds no estimates; give --config, with which samples are replayed");
    const TemporaryFolder folder;
    ReplayArguments again;
    again.config = options_.config;
    again.inputs = {source_};
    again.record = options_.record;
    again.quiet = true;
    again.out = folder.path() + "/estimates.lcmlog";
    if (replay(again) != 0) return problem("cannot be replayed with " + options_.config);
    if (load(options_.config) && read_estimates(again.out)) evaluate_with({source_});
  }

  /// Takes the table of a configuration, without windows.
  void take_table(const Config& config, const std::string& structure) {
    const estimator::ParameterTable table = config.pipeline.parameters();
    parameter_table_t& out = run_.report.estimates.table;
    out = parameter_message(config, table);
    out.structure = structure;
    const Eigen::VectorXd design = group_parameters(config.pipeline.structure, table,
                                                    estimator::story_design(config.pipeline));
    out.design.assign(design.begin(), design.end());
    out.design.resize(out.name.size());
    run_.report.units = ReportUnits(out);
    run_.report.labels = frame_labels(config.pipeline.structure);
  }

  void read_design() {
    run_.what = "configuration";
    if (!load(source_)) return;
    if (run_.report.config->pipeline.design.size() == 0)
      return problem("has no [structure.design], so there is nothing to compare");
    take_table(*run_.report.config, run_.report.config->pipeline.structure.name);
    for (const double value : run_.report.estimates.table.design)
      run_.values.push_back({value > 0 ? value : estimator::kNaN, 0, 0});
  }

  void read_history(const std::string& place, const std::string& period) {
    run_.what = "history";
    const std::size_t between = period.find("..");
    HistoryArguments arguments;
    arguments.place = place;
    arguments.from = period.substr(0, between);
    arguments.to = period.substr(between + 2);
    SummaryQuery summaries;
    std::vector<std::string> found;
    const auto request = read_history_request(arguments, summaries, found);
    problems_.insert(problems_.end(), found.begin(), found.end());
    if (!request) return;
    const std::string config = options_.config.empty() ? place : options_.config;
    if (!request->config && options_.config.empty())
      return problem("a folder of a history needs --config, which describes its building");
    if (!load(config)) return;
    take_table(*run_.report.config, summaries.structure());
    // Summaries of longer periods have fewer rows; the shortest ones say most about the scatter.
    std::int64_t period_s = 0;
    for (const SummaryPeriods& p : summaries.periods())
      if (period_s == 0 || p.period_s < period_s) period_s = p.period_s;
    for (const std::string& name : run_.report.estimates.table.name) {
      std::vector<estimator::WindowValue> values;
      for (const SummaryParameter& stored : summaries.parameters()) {
        if (stored.name != name) continue;
        for (const SummaryRow& row :
             summaries.rows(stored.id, period_s, request->from_us, request->to_us))
          if (row.observable > 0 && std::isfinite(row.mean))
            values.push_back({estimator::from_microseconds(row.start_us),
                              estimator::from_microseconds(row.last_us), row.mean, row.std_error});
      }
      run_.values.push_back(estimator::mean_of(values, 0, values.size()));
    }
    if (const std::string why = summaries.problem(); !why.empty()) problem(why);
  }

  const std::string& source_;
  const RunOptions& options_;
  std::vector<std::string>& problems_;
  ComparedRun run_;
};

}  // namespace

std::optional<ComparedRun> read_run(const std::string& source, const RunOptions& options,
                                    std::vector<std::string>& problems) {
  RunReader reader(source, options, problems);
  if (!reader.read()) return std::nullopt;
  return reader.take();
}

}  // namespace framewatch::daemon
