// SPDX-License-Identifier: MIT
#include "daemon/tools/replay/replay_command.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <ratio>
#include <thread>

#include <framewatch/event_t.hpp>

#include <fmt/core.h>

#include "daemon/base/exit_code.h"
#include "daemon/base/log.h"
#include "daemon/base/printable.h"
#include "daemon/base/progress.h"
#include "daemon/config/learned_files.h"
#include "daemon/config/sections/config_problems.h"
#include "daemon/monitor/estimates/estimate_output.h"
#include "daemon/monitor/estimation/state_file.h"
#include "daemon/monitor/event_report/event_report_files.h"
#include "daemon/tools/replay/expectation.h"
#include "daemon/tools/replay/first_passes.h"
#include "daemon/tools/replay/floors_output.h"
#include "daemon/tools/replay/history_output.h"
#include "daemon/tools/replay/replay_summary.h"
#include "drivers/files/standard_streams.h"
#include "drivers/files/text_output.h"
#include "drivers/lcm/message_check.h"

namespace framewatch::daemon {
namespace {

constexpr int kNotAsExpected = 1;
using Clock = std::chrono::steady_clock;

/// Returns true if an output is the database of a history.
bool is_history(const std::string& out) {
  return out.ends_with(".sqlite");
}

/// Waits until an event's time has come, at `speed` times real time. Does not wait for a step back
/// or a step of more than kLongest_us, such as the night between two logs.
class Pace {
 public:
  explicit Pace(double speed) : speed_(speed) {}
  void wait_for(std::int64_t time_us) {
    if (speed_ <= 0) return;
    std::int64_t step_us = 0;
    const bool usual = started_ && !__builtin_sub_overflow(time_us, newest_us_, &step_us) &&
                       step_us >= 0 && step_us <= kLongest_us;
    if (usual)
      due_ += std::chrono::duration_cast<Clock::duration>(
          std::chrono::duration<double, std::micro>(static_cast<double>(step_us) / speed_));
    started_ = true;
    newest_us_ = time_us;
    std::this_thread::sleep_until(due_);
  }

 private:
  static constexpr std::int64_t kLongest_us = 10'000'000;
  double speed_;
  bool started_ = false;
  std::int64_t newest_us_ = 0;
  Clock::time_point due_ = Clock::now();
};

/// Prints the survey's notes and problems. Returns false when the replay must stop.
bool judge(const ReplaySurvey& survey) {
  for (const std::string& note : survey.notes()) fmt::print(stderr, "{}\n", printable_lines(note));
  for (const std::string& problem : survey.problems())
    fmt::print(stderr, "{}\n", printable_lines(problem));
  if (survey.salvageable())
    fmt::print(stderr, "framewatch replay: --salvage uses the intact parts\n");
  return survey.problems().empty();
}

/// Runs one replay, from the first byte to the summary.
class ReplayRun : private EstimationListener {
 public:
  ReplayRun(const ReplayArguments& a, const Config& config,
            std::optional<Expectations> expectations)
      : a_(a),
        input_{a.inputs, a.record, a.salvage, a.span},
        config_(config),
        expectations_(std::move(expectations)),
        event_channel_(config.lcm.prefix + "EVENT"),
        survey_(config, a.salvage, a.span),
        learner_(
            watched_parameters(config.pipeline.parameters(),
                               config.watch ? config.watch->options : estimator::WatchOptions{}),
            std::numeric_limits<double>::infinity()),
        series_(config.pipeline.parameters(), expectations_.has_value(),
                config.pipeline.options.min_snr),
        estimation_(config, sink(), this) {
    survey_.declare(a.record);
  }

  int run() {
    if (!a_.load_state.empty()) {
      bool touched = false;
      const LoadedState state = load_state(a_.load_state, config_, estimation_, touched);
      if (!state.problem.empty()) return refuse("replay", a_.load_state + ": " + state.problem);
      events_before_ = state.events_before;
      survey_.goes_on();
    }
    tune_first();
    if (!open_outputs()) return kBadInput;
    // In real time the user should not wait an hour to learn that the log's end is damaged.
    if (a_.speed > 0 && !sound_beforehand()) return kBadInput;
    read_everything();
    if (a_.speed > 0 ? !survey_.problems().empty() : !judge(survey_)) return kBadInput;
    const std::int64_t events = outputs_.empty() ? events_before_ : outputs_.front()->events();
    for (const auto& output : outputs_)
      if (failed_.empty() && !output->close()) fail(*output);
    if (failed_.empty() && floors_ && !floors_->close()) failed_ = floors_->error();
    if (!failed_.empty()) return refuse("replay", failed_);
    if (!a_.save_state.empty()) {
      const std::string problem =
          write_state(a_.save_state, saved_state(config_, estimation_, events));
      if (!problem.empty()) return refuse("replay", a_.save_state + ": " + problem);
    }
    return conclude();
  }

 private:
  void on_estimate(const estimator::WindowEstimate& e) override {
    series_.add(e);
    learner_.push(e);
    if (floors_) floors_->follow(e);
  }
  void on_shaken(const EventReport& report) override {
    if (a_.event_reports.empty()) return;
    const std::string problem = write_event_report(report, config_, a_.event_reports);
    if (failed_.empty()) failed_ = problem;
  }
  void on_instant(const estimator::SampleSet& instant) override {
    if (failed_.empty() && floors_ && !floors_->put(instant)) failed_ = floors_->error();
  }

  /// Returns an empty function when no output needs messages.
  MessageSink sink() {
    const bool wanted = !a_.out.empty() || a_.lcm || config_.watch ||
                        (expectations_.has_value() && !expectations_->events.empty());
    if (!wanted) return {};
    return [this](std::int64_t time_us, const std::string& channel,
                  const std::vector<std::uint8_t>& bytes) { put(time_us, channel, bytes); };
  }

  bool open_outputs() {
    std::string error;
    if (!a_.floors.empty()) {
      floors_.emplace(config_.pipeline);
      if (!floors_->open(a_.floors)) {
        refuse("replay", floors_->error());
        return false;
      }
    }
    const auto add = [&](std::unique_ptr<EstimateOutput> output, const std::string& name) {
      if (output)
        outputs_.push_back(std::move(output));
      else
        refuse("replay", name.empty() ? error : fmt::format("{}: {}", name, error));
      return error.empty();
    };
    const auto file = [&]() -> std::unique_ptr<EstimateOutput> {
      if (!is_history(a_.out))
        return estimate_output(config_,
                               {a_.out, a_.boxplot, !a_.load_state.empty(), events_before_}, error);
      auto history = std::make_unique<HistoryOutput>(config_);
      if (!history->open(a_.out)) error = history->error();
      return error.empty() ? std::move(history) : nullptr;
    };
    return (a_.out.empty() || add(file(), a_.out)) &&
           (!a_.lcm || add(lcm_estimate_output(config_, a_.lcm_url, error), ""));
  }

  bool sound_beforehand() const {
    ReplaySurvey survey(config_, a_.salvage, a_.span);
    survey.declare(a_.record);
    input_.add_to(survey);
    survey.finish();
    return judge(survey);
  }

  /// Tunes on the input, unless it is part of a longer one. Parts are estimated in one pass, so
  /// that together they give the same as the uncut input with --one-pass.
  void tune_first() {
    if (a_.one_pass || !a_.load_state.empty() || !a_.save_state.empty() || !can_be_tuned(config_))
      return;
    Progress progress("replay: tuning", input_.bytes(), "MB", 1e6, a_.quiet);
    const FirstPasses first(config_, input_, [&](std::int64_t bytes) { progress(bytes); });
    if (first.tuning()) estimation_.start_tuned(*first.tuning());
    if (!a_.quiet && first.read()) fmt::print(stderr, "{}\n", first.note());
  }

  void read_everything() {
    Progress progress("replay", input_.bytes(), "MB", 1e6, a_.quiet);
    Pace pace(a_.speed);
    survey_.feed(estimation_);
    survey_.at_each([&](std::int64_t bytes, std::int64_t time_us) {
      progress(bytes);
      pace.wait_for(time_us);
    });
    input_.add_to(survey_);
    survey_.finish();
    if (a_.save_state.empty()) estimation_.finish();  // otherwise the input continues
  }

  void put(std::int64_t time_us, const std::string& channel,
           const std::vector<std::uint8_t>& bytes) {
    for (const auto& output : outputs_)
      if (failed_.empty() && !output->put(time_us, channel, bytes)) fail(*output);
    if (channel != event_channel_) return;
    const auto event = drivers::decoded<event_t>(bytes);
    if (!event || event->state != 1) return;
    events_.push_back({event->kind, event->place, event->since_us});
    if (!a_.quiet && !a_.json) alarms_ += fmt::format("alarm: {}\n", event->message);
  }

  void fail(const EstimateOutput& output) {
    failed_ = a_.out.empty() ? output.error() : fmt::format("{}: {}", a_.out, output.error());
  }

  int conclude() {
    const ReplayCounts counts = replay_counts(estimation_);
    const ReplayOutcome outcome{series_, counts, events_, survey_.first_us()};
    std::vector<Check> checks;
    if (expectations_) checks = check_expectations(*expectations_, outcome);
    std::string problem;
    if (!a_.junit.empty())
      problem = drivers::write_text_file(a_.junit, junit_xml(checks, a_.expect));
    if (problem.empty() && !a_.write_expect.empty())
      problem = drivers::write_text_file(a_.write_expect, written_expectations(outcome, command()));
    if (problem.empty() && !a_.write_baseline.empty()) problem = write_baseline();
    if (!problem.empty()) return refuse("replay", problem);

    if (counts.front().second == 0 && a_.save_state.empty())
      log(LogLevel::warning, why_no_window(config_, estimation_, survey_.measured_seconds()));
    const std::chrono::duration<double> work = Clock::now() - start_;
    const ReplaySummary summary{series_, counts, survey_, estimation_.can(), work.count()};
    const bool holds =
        std::all_of(checks.begin(), checks.end(), [](const Check& c) { return c.holds; });
    if (a_.json) {
      std::string json = summary.json();
      if (expectations_)
        json += fmt::format(",\n \"expectations\": {},\n \"differences\": {}", checks.size(),
                            differences_json(checks));
      fmt::print("{}}}\n", json);
    } else if (!a_.quiet) {
      std::FILE* const to = writes_standard_output(a_) ? stderr : stdout;
      fmt::print(to, "{}", printable_lines(summary.text() + alarms_));
      if (holds && expectations_)
        fmt::print(to, "\nas expected: {} of {}\n", checks.size(), a_.expect);
    }
    if (holds) return 0;
    print_differences(checks);
    return kNotAsExpected;
  }

  std::string write_baseline() const {
    const estimator::Baseline baseline = learner_.so_far();
    if (baseline.known() == 0)
      return "--write-baseline: no parameter has a value, free of the design's influence, in half "
             "of the windows";
    return drivers::write_text_file(a_.write_baseline,
                                    baseline_text(baseline, config_.pipeline.parameters()));
  }

  void print_differences(const std::vector<Check>& checks) const {
    int differences = 0;
    for (const Check& c : checks) {
      if (c.holds) continue;
      ++differences;
      fmt::print(stderr, "{}\n", printable_lines(c.text()));
    }
    fmt::print(stderr, "framewatch replay: {} of {} expectations of {} do not hold\n", differences,
               checks.size(), a_.expect);
  }

  std::string command() const {
    std::string text = "framewatch replay " + a_.config;
    for (const std::string& input : a_.inputs) text += " " + input;
    return text;
  }

  const ReplayArguments& a_;
  const TuningInput input_;
  const Config& config_;
  Clock::time_point start_ = Clock::now();
  std::optional<Expectations> expectations_;
  std::string event_channel_;
  std::int64_t events_before_ = 0;  ///< events of the earlier parts
  ReplaySurvey survey_;
  estimator::BaselineLearner learner_;
  EstimateSeries series_;
  std::vector<RaisedEvent> events_;
  std::string alarms_;
  std::vector<std::unique_ptr<EstimateOutput>> outputs_;
  std::string failed_;
  std::optional<FloorsOutput> floors_;
  Estimation estimation_;
};

}  // namespace

bool writes_standard_output(const ReplayArguments& a) {
  const auto outputs = {a.out, a.write_expect, a.write_baseline, a.junit, a.floors};
  return std::find(outputs.begin(), outputs.end(), drivers::kStandardOutput) != outputs.end();
}

std::vector<std::string> argument_problems(const ReplayArguments& a) {
  std::vector<std::string> found;
  if (!a.out.empty() && !is_history(a.out))
    if (const std::string problem = problem_of_output_name(a.out); !problem.empty())
      found.push_back(problem);
  std::vector<std::string> inputs = a.inputs;
  inputs.push_back(a.config);
  for (const std::string& input : {a.expect, a.load_state})
    if (!input.empty()) inputs.push_back(input);
  for (const std::string& out :
       {a.out, a.write_expect, a.write_baseline, a.junit, a.save_state, a.floors})
    for (const std::string& input : inputs) {
      std::error_code error;
      if (!out.empty() && (input == out || std::filesystem::equivalent(input, out, error)))
        found.push_back(input + ": is input and output; name another output");
    }
  if (!a.junit.empty() && a.expect.empty())
    found.push_back("--junit: needs --expect, whose expectations are its test cases");
  if (!a.expect.empty() && !a.write_expect.empty())
    found.push_back("--write-expect: cannot be combined with --expect");
  if (a.json && writes_standard_output(a))
    found.push_back("--json: needs standard output, but an output is named -");
  if (!a.floors.empty() && a.floors == a.out)
    found.push_back("--floors: " + a.floors + " is also the file of --out");
  if (!a.floors.empty() && !a.floors.ends_with(".csv") && !a.floors.ends_with(".csv.gz") &&
      a.floors != drivers::kStandardOutput)
    found.push_back("--floors: writes .csv or .csv.gz, not " + a.floors);
  if (!(a.span.to_s > a.span.from_s)) found.push_back("--to: must be later than --from");
  if (a.boxplot && (a.out.empty() || a.out.ends_with(".lcmlog") || is_history(a.out)))
    found.push_back(
        "--boxplot: is for --out with .csv or .mat; a log or .sqlite always has boxplots");
  if (is_history(a.out) && !a.load_state.empty())
    found.push_back(
        "--load-state: cannot be combined with --out .sqlite, which needs whole periods");
  return found;
}

int replay(const ReplayArguments& a) {
  const std::vector<std::string> wrong = argument_problems(a);
  for (const std::string& problem : wrong) refuse("replay", problem);
  if (!wrong.empty()) return kBadInput;
  std::vector<ConfigProblem> problems;
  std::optional<Config> config = load_config(a.config, problems);
  print_problems(problems);
  if (!config) return kBadInput;
  log_doubts(config->doubts);
  const bool boxplots_are_read =
      !a.out.empty() || a.lcm || !a.save_state.empty() || !a.load_state.empty();
  if (!boxplots_are_read) config->pipeline.options.boxplot_windows = 0;
  if (!a.event_reports.empty() && !config->event_report)
    return refuse("replay", "--event-reports: needs [event_report] in " + a.config);
  std::optional<Expectations> expectations;
  if (!a.expect.empty()) {
    problems.clear();
    expectations = load_expectations(a.expect, config->pipeline.parameters(), problems);
    print_problems(problems);
    if (!expectations) return kBadInput;
  }
  return ReplayRun(a, *config, std::move(expectations)).run();
}

}  // namespace framewatch::daemon
