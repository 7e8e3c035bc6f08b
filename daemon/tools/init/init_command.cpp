// SPDX-License-Identifier: MIT
#include "daemon/tools/init/init_command.h"

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "daemon/base/exit_code.h"
#include "daemon/base/printable.h"
#include "daemon/config/config.h"
#include "daemon/config/sections/config_problems.h"
#include "daemon/tools/init/building_toml.h"
#include "daemon/tools/init/dialogue.h"
#include "daemon/tools/init/plan_drawing.h"
#include "drivers/files/input_file.h"
#include "drivers/files/standard_streams.h"
#include "drivers/files/text_output.h"

namespace framewatch::daemon {
namespace {

bool has_person() {
  return ::isatty(STDIN_FILENO) == 1 && ::isatty(STDERR_FILENO) == 1;
}

Terminal terminal() {
  return {[]() -> std::optional<std::string> {
            std::string line;
            if (!std::getline(std::cin, line)) return std::nullopt;
            return line;
          },
          [](const std::string& text) { fmt::print(stderr, "{}", text); }};
}

/// Problems and warnings of `framewatch check`.
struct Judgement {
  std::vector<ConfigProblem> problems, doubts;
};

Judgement judge(const std::string& path, const std::string& text) {
  Judgement out;
  if (const auto config = parse_config(path, text, out.problems)) out.doubts = config->doubts;
  return out;
}

int refuse_answers(const InitReading& reading) {
  for (const OpenQuestion& open : reading.open) {
    std::string missing = fmt::format("is missing: {}", open.ask);
    std::replace(missing.begin(), missing.end(), '\n', ' ');
    if (open.option == "live") missing += " Or give a record: --record FILE";
    std::string option = "--" + open.option;
    if (!open.column.empty()) option += " " + printable(open.column) + "=PLACE";
    if (open.place) option += " NAME=" + place_option(reading.draft.plan.structure, *open.place);
    fmt::print(stderr, "{}: {}\n", option,
               printable_lines(open.problem.empty() ? missing : open.problem));
  }
  const std::size_t count = reading.open.size();
  return refuse(
      "init", fmt::format("{} answer{} missing or wrong; on a terminal, init asks for them", count,
                          count == 1 ? "" : "s"));
}

/// Returns a record and its options as arguments of `report --raw`, where --format is that of
/// pictures.
std::string raw_arguments(std::string record) {
  const std::string format = " --format ";
  if (const std::size_t at = record.find(format); at != std::string::npos)
    record.replace(at, format.size(), " --raw-format ");
  return record;
}

std::string next_steps(const BuildingPlan& plan, const std::string& path) {
  const std::string config = shell_word(path);
  std::string out = fmt::format("{}: written. Next steps:\n  framewatch check {}\n", path, config);
  if (plan.record_files > 1)
    out += fmt::format(
        "  framewatch convert FILES station.lcmlog   (the {0})\n"
        "  framewatch replay {1} station.lcmlog --out estimates.lcmlog\n"
        "  framewatch report estimates.lcmlog --config {1} --raw station.lcmlog --out "
        "report.html\n",
        plan.record, config);
  else if (!plan.record.empty())
    out += fmt::format(
        "  framewatch replay {0} {1} --out estimates.lcmlog\n"
        "  framewatch report estimates.lcmlog --config {0} --raw {2} --out report.html\n",
        config, plan.record, raw_arguments(plan.record));
  else if (plan.channels.front().column.source.empty())
    out += fmt::format(
        "  framewatch replay {} RECORD --out estimates.lcmlog   (its columns have the "
        "channels' names)\n",
        config);
  if (!plan.channels.front().column.source.empty())
    out += fmt::format("  framewatch run {}\n", config);
  return out;
}

int write(const BuildingPlan& plan, const InitArguments& a, const std::string& summary) {
  const std::string text = building_toml(plan);
  const Judgement found = judge(a.out, text);
  print_problems(found.problems);
  if (!found.problems.empty())
    return refuse("init", "these answers do not make a valid configuration; nothing was written");
  log_doubts(found.doubts);
  if (const std::string why = drivers::write_text_file(a.out, text); !why.empty())
    return refuse("init", why);
  if (!a.drawing.empty())
    if (const std::string why = drivers::write_text_file(a.drawing, plan_svg(plan)); !why.empty())
      return refuse("init", why);
  if (!a.quiet)
    fmt::print(a.out == drivers::kStandardOutput ? stderr : stdout, "{}",
               printable_lines(summary + plan_text(plan) + next_steps(plan, a.out)));
  return 0;
}

}  // namespace

int init(const InitArguments& a) {
  if (a.out != drivers::kStandardOutput && !a.force && !drivers::is_absent(a.out))
    return refuse(
        "init",
        a.out + ": already exists; use --force to overwrite it or --out FILE for another file");
  if (!a.drawing.empty() && !a.force && !drivers::is_absent(a.drawing))
    return refuse("init", a.drawing + ": already exists; use --force to overwrite it");
  if (!a.drawing.empty() && !a.drawing.ends_with(".svg"))
    return refuse("init", "--drawing " + a.drawing + ": the drawing is SVG; use a name in .svg");
  ColumnCache files;
  const InitReading reading = read_answers(a.answers, true, files);
  if (reading.open.empty()) {
    for (const std::string& note : reading.draft.notes)
      if (!a.quiet) fmt::print(stderr, "{}\n", printable_lines(note));
    return write(reading.draft.plan, a, summary_text(reading));
  }
  if (!has_person()) return refuse_answers(reading);
  const Remarks remarks = [&](const BuildingPlan& plan) {
    const Judgement found = judge(a.out, building_toml(plan));
    std::string out;
    for (const auto* list : {&found.problems, &found.doubts})
      for (const ConfigProblem& p : *list) out += printable_lines("  " + p.message) + "\n";
    return out;
  };
  const auto plan = ask_building(a.answers, a.out, remarks, files, terminal());
  if (!plan) return refuse("init", "stopped; nothing was written");
  return write(*plan, a, "");
}

}  // namespace framewatch::daemon
