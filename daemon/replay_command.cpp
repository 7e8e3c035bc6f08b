#include "daemon/replay_command.h"

#include <unistd.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <optional>

#include <fmt/core.h>

#include "daemon/estimation.h"
#include "daemon/replay_summary.h"
#include "daemon/replay_survey.h"

namespace framewatch::daemon {
namespace {

constexpr int kBadInput = 2;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

int refuse(const std::string& message) {
  fmt::print(stderr, "framewatch replay: {}\n", message);
  return kBadInput;
}

/// Percent on stderr, when that is a terminal and the work takes over 2 s.
class Progress {
 public:
  Progress(std::int64_t total, bool quiet) : total_(total), on_(!quiet && ::isatty(2) == 1) {}
  ~Progress() {
    if (next_s_ > 2) fmt::print(stderr, "\n");
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void operator()(std::int64_t done) {
    if (!on_ || ++calls_ % 256 != 0 || done <= 0) return;
    const double elapsed_s = seconds_since(start_);
    if (elapsed_s < next_s_) return;
    next_s_ = elapsed_s + 0.5;
    const double share = static_cast<double>(done) / static_cast<double>(total_);
    fmt::print(stderr, "\rreplay: {:3.0f} %, {:.1f} MB/s, {:.0f} s left ", 100 * share,
               1e-6 * static_cast<double>(done) / elapsed_s, elapsed_s * (1 / share - 1));
  }

 private:
  std::int64_t total_, calls_ = 0;
  bool on_;
  double next_s_ = 2;
  Clock::time_point start_ = Clock::now();
};

bool replay_log(const std::string& path, Estimation& estimation, Progress& progress,
                std::int64_t done, std::string& error) {
  drivers::LcmLogReader reader;
  drivers::LogEvent event;
  auto read = reader.open(path) ? reader.next(event) : drivers::LogRead::error;
  for (; read != drivers::LogRead::end && read != drivers::LogRead::error;
       read = reader.next(event)) {
    if (read == drivers::LogRead::event)
      estimation.message(event.channel, event.data.data(), event.data.size());
    progress(done + reader.position());
  }
  error = reader.error();
  return read == drivers::LogRead::end;
}

void replay_record(const ReplayInput& input, Estimation& estimation) {
  const drivers::Record& record = input.record;
  for (std::size_t i = 0; i < record.time_s.size(); ++i) {
    const Time time = from_microseconds(std::llround(record.time_s[i] * 1e6));
    for (std::size_t c = 0; c < input.axis_of_column.size(); ++c)
      if (input.axis_of_column[c] >= 0)
        estimation.sample({time, input.axis_of_column[c], record.accel_mps2[c][i]});
  }
}

/// What is wrong with the name of the output; empty when nothing is.
std::string output_problem(const ReplayArguments& a) {
  if (a.out.empty()) return {};
  if (!a.out.ends_with(".lcmlog"))
    return a.out + ": the output's name must end in .lcmlog; framewatch convert makes a CSV of it";
  std::vector<std::string> inputs = a.inputs;
  inputs.push_back(a.config);
  for (const std::string& input : inputs) {
    std::error_code error;
    if (input == a.out || std::filesystem::equivalent(input, a.out, error))
      return input + ": is input and output";
  }
  return {};
}

}  // namespace

int replay(const ReplayArguments& a) {
  if (const std::string problem = output_problem(a); !problem.empty()) return refuse(problem);
  std::vector<ConfigProblem> config_problems;
  const std::optional<Config> config = load_config(a.config, config_problems);
  for (const ConfigProblem& p : config_problems) fmt::print(stderr, "{}: {}\n", p.where, p.message);
  if (!config) return kBadInput;

  const Clock::time_point start = Clock::now();
  ReplaySurvey survey(*config, a.salvage);
  for (const std::string& path : a.inputs) survey.add(path);
  survey.finish();
  for (const std::string& note : survey.notes()) fmt::print(stderr, "{}\n", note);
  for (const std::string& problem : survey.problems()) fmt::print(stderr, "{}\n", problem);
  if (survey.salvageable())
    fmt::print(stderr, "framewatch replay: --salvage uses what is intact\n");
  if (!survey.problems().empty()) return kBadInput;

  drivers::LcmLogWriter writer;
  if (!a.out.empty() && !writer.open(a.out))
    return refuse(fmt::format("{}: {}", a.out, writer.error()));
  const ParameterTable table(config->pipeline.structure);
  ReplaySummary summary(table);
  const auto write = [&](std::int64_t time_us, const std::string& channel,
                         const std::vector<std::uint8_t>& bytes) {
    if (!a.out.empty()) (void)writer.write(time_us, channel, bytes.data(), bytes.size());
  };
  Estimation estimation(*config, write, [&](const WindowEstimate& e) { summary.add(e); });
  {
    Progress progress(survey.bytes(), a.quiet);
    std::int64_t done = 0;
    std::string error;
    for (const ReplayInput& input : survey.inputs()) {
      if (input.is_record)
        replay_record(input, estimation);
      else if (!replay_log(input.path, estimation, progress, done, error))
        return refuse(fmt::format("{}: {}", input.path, error));
      drivers::LcmLogReader size;
      if (size.open(input.path)) done += size.size();
    }
  }
  estimation.finish();
  if (!a.out.empty() && !writer.close())
    return refuse(fmt::format("{}: {}", a.out, writer.error()));
  const double work_s = seconds_since(start);
  if (a.json)
    fmt::print("{}", summary.json(estimation, survey, work_s));
  else if (!a.quiet)
    fmt::print("{}", summary.text(estimation, survey, work_s));
  return 0;
}

}  // namespace framewatch::daemon
