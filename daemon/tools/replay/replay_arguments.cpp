#include "daemon/tools/replay/replay_arguments.h"

#include <algorithm>
#include <filesystem>

#include "daemon/monitor/estimates/estimate_output.h"
#include "drivers/files/standard_streams.h"

namespace framewatch::daemon {

bool writes_standard_output(const ReplayArguments& a) {
  const auto outputs = {a.out, a.write_expect, a.write_baseline, a.junit, a.floors};
  return std::find(outputs.begin(), outputs.end(), drivers::kStandardOutput) != outputs.end();
}

bool is_history(const std::string& out) {
  return out.ends_with(".sqlite");
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
        found.push_back(input + ": is input and output");
    }
  if (!a.junit.empty() && a.expect.empty())
    found.push_back("--junit: needs --expect, its test cases are the expectations");
  if (!a.expect.empty() && !a.write_expect.empty())
    found.push_back("--write-expect: leave --expect out, it is about the old file");
  if (a.json && writes_standard_output(a))
    found.push_back("--json: standard output is taken by an output that is named -");
  if (!a.floors.empty() && a.floors == a.out)
    found.push_back("--floors: " + a.floors + " is the file of --out already");
  if (!a.floors.empty() && !a.floors.ends_with(".csv") && !a.floors.ends_with(".csv.gz") &&
      a.floors != drivers::kStandardOutput)
    found.push_back("--floors: writes .csv or .csv.gz, not " + a.floors);
  if (!(a.span.to_s > a.span.from_s)) found.push_back("--to: must be later than --from");
  if (a.boxplot && (a.out.empty() || a.out.ends_with(".lcmlog") || is_history(a.out)))
    found.push_back("--boxplot: is for --out with .csv or .mat; a log or .sqlite always has them");
  if (is_history(a.out) && !a.load_state.empty())
    found.push_back("--load-state: is not for --out with .sqlite, whose periods are whole");
  return found;
}

}  // namespace framewatch::daemon
