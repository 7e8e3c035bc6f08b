// SPDX-License-Identifier: MIT
#include "daemon/tools/diagnosis/diagnose_command.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <fmt/core.h>
#include <malloc.h>

#include "daemon/base/exit_code.h"
#include "daemon/base/file_digest.h"
#include "daemon/base/printable.h"
#include "daemon/base/progress.h"
#include "daemon/base/words.h"
#include "daemon/base/workers.h"
#include "daemon/config/sections/config_problems.h"
#include "daemon/config/sections/effects.h"
#include "daemon/tools/diagnosis/diagnose_records.h"
#include "daemon/tools/diagnosis/diagnose_verdict.h"
#include "drivers/files/text_output.h"
#include "estimator/diagnose/trials/catalogue_form.h"
#include "estimator/diagnose/trials/damping_form.h"
#include "estimator/diagnose/verdict/diagnose.h"

namespace framewatch::daemon {
namespace {

constexpr int kGapRemains = 1;
constexpr double kComponentMass = 0.1;  ///< tolerance of a component test's mass
constexpr double kMin = 1e-6;           ///< least value of a design, which must be positive

/// Returns a value of a design.
std::string positive(double value) {
  return fmt::format("{:.9g}", std::max(value, kMin));
}

/// Returns [story][frame] lists of `count` frames, as in [structure.design]. offset: 0 for
/// stiffness, table.elements() for damping.
std::string grid(const DiagnoseOutput& o, int from, int count, int offset) {
  return bracketed(o.plant.structure.stories, [&](int story) {
    return bracketed(count, [&](int f) {
      const int at = o.plant.table.frame_stiffness(story + 1, from + f) + offset;
      return positive(o.diagnosis.declared.theta[at]);
    });
  });
}

std::string panels(const DiagnoseOutput& o, int offset) {
  const estimator::Structure& s = o.plant.structure;
  return bracketed(s.stories, [&](int story) {
    return bracketed(s.n() - 1, [&](int l) {
      return bracketed(s.m() - 1, [&](int j) {
        const int at = o.plant.table.panel_stiffness(story + 1, l * (s.m() - 1) + j) + offset;
        return positive(o.diagnosis.declared.theta[at]);
      });
    });
  });
}

/// Returns the rotational stiffness at every floor of frames whose bending is part of the design.
std::string bending(const estimator::Plant& plant, const estimator::Model& model) {
  std::string out;
  for (const estimator::ModelEffect& e : model.effects) {
    const std::size_t along = e.place.direction == estimator::Direction::x ? 0 : 1;
    if (e.form != estimator::LawForm::bending || !(plant.bending[along] > 0)) continue;
    const double flexibility = std::max(e.parameters[0].plain(), kMin / plant.bending[along]);
    const auto of_floor = [&](int floor) {
      return fmt::format("{:.9g}", plant.bending.of_floor(along, static_cast<std::size_t>(floor)) /
                                       plant.bending[along] / flexibility);
    };
    out += fmt::format("kr{}_nmprad = {}\n", letter(e.place.direction),
                       bracketed(plant.structure.stories, of_floor));
  }
  return out;
}

/// Removes the table [name] or the tables [[name]] from a TOML text.
std::string without(const std::string& text, const std::string& name) {
  std::string out;
  bool inside = false;
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
    const std::string line = text.substr(at, end - at);
    const std::size_t first = line.find_first_not_of(" \t");
    if (first != std::string::npos && line[first] == '[')
      inside = line.compare(first, name.size() + 2, "[" + name + "]") == 0 ||
               line.compare(first, name.size() + 4, "[[" + name + "]]") == 0;
    if (!inside) out += line;
    at = end;
  }
  return out;
}

/// Returns model.toml: the configuration with the identified values as its design and the effects
/// as [[effect]].
std::string diagnosis_model_toml(const DiagnoseOutput& o) {
  std::string error;
  const auto text = read_text_file(o.config.path, error);
  const estimator::Structure& s = o.plant.structure;
  std::string out = "# Made by framewatch diagnose from " + o.config.path +
                    ": the design has the identified values, [[effect]] the effects found.\n";
  out += without(without(text.value_or(""), "structure.design"), "effect");
  if (out.back() != '\n') out += "\n";
  out += "\n[structure.design]\n";
  for (const bool damping : {false, true}) {
    const int offset = damping ? o.plant.table.elements() : 0;
    const char* unit = damping ? "nspm" : "npm";
    if (s.n() > 0)
      out += fmt::format("{}x_{} = {}\n", damping ? 'c' : 'k', unit, grid(o, 0, s.n(), offset));
    if (s.m() > 0)
      out += fmt::format("{}y_{} = {}\n", damping ? 'c' : 'k', unit, grid(o, s.n(), s.m(), offset));
    if (s.panels() > 0 && !o.plant.stiff_floors)
      out += fmt::format("g{} = {}\n", damping ? 'c' : 'k', panels(o, offset));
  }
  out += bending(o.plant, o.diagnosis.declared);
  std::vector<estimator::Effect> effects = estimator::modal_damping_effects(o.diagnosis.declared);
  for (const auto* list : {&o.diagnosis.known, &o.diagnosis.effects})
    for (const estimator::FoundEffect& f : *list)
      if (f.chosen.kind != estimator::EffectKind::modal_damping)
        effects.push_back(catalogue_effect(o.plant, o.segments, f, o.diagnosis.declared));
  if (!effects.empty()) out += "\n" + effects_toml(effects, s, o.plant.axes);
  return out;
}

/// Keeps freed memory in the heap: matrices of megabytes are allocated and freed by the thousand.
void keep_freed_memory() {
  constexpr int kLargest = 1 << 30;
  ::mallopt(M_ARENA_MAX, 1);
  ::mallopt(M_MMAP_THRESHOLD, kLargest);
  ::mallopt(M_TRIM_THRESHOLD, kLargest);
}

/// Prints the problems. Returns true if there are any.
bool print_all(const std::vector<std::string>& problems) {
  for (const std::string& p : problems) fmt::print(stderr, "{}\n", printable_lines(p));
  return !problems.empty();
}

std::vector<estimator::EffectKind> excluded_kinds(const std::vector<std::string>& names,
                                                  std::vector<std::string>& problems) {
  std::vector<estimator::EffectKind> out;
  for (const std::string& name : names) {
    if (const auto kind = estimator::find_effect(name))
      out.push_back(*kind);
    else
      problems.push_back(fmt::format("--without {}: no effect has this name", name));
  }
  return out;
}

std::vector<DiagnoseRecord> read_records(const Config& config, const DiagnoseArguments& a,
                                         std::vector<std::string>& problems) {
  const bool both_given = !a.train.empty() && !a.holdout.empty();
  const bool any_given = !a.train.empty() || !a.holdout.empty();
  if (a.event.empty() ? !both_given : any_given)
    problems.push_back("give --train and --holdout, or --event alone");
  if (!a.event.empty() && !any_given) return read_event_records(config, a.event, problems);
  std::vector<std::string> paths = a.train;
  paths.insert(paths.end(), a.holdout.begin(), a.holdout.end());
  return read_diagnose_records(config, paths, a.component, problems);
}

/// Runs the diagnosis with the requested number of threads, and shows its progress on a terminal.
/// Every piece of its parallel work counts.
estimator::Diagnosis run_diagnosis(const DiagnoseArguments& a,
                                   const estimator::DiagnosisInput& input,
                                   estimator::DiagnosisOptions options) {
  if (a.component.any()) options.tolerances.mass = kComponentMass;
  ProgressLine line("diagnose", a.quiet);
  struct {
    std::string what;
    double done, then;
  } step{"", 0, 0};  // set between the calls of Workers::run()
  const Workers workers(
      a.threads > 0 ? a.threads : static_cast<int>(std::thread::hardware_concurrency()),
      [&](const std::string&, int pieces, int of) {
        line(step.what, step.done + (step.then - step.done) * pieces / of);
      });
  options.parallel = [&](int count, const std::function<void(int)>& work) {
    workers.run("", count, work);
  };
  options.within = [&](int count, const std::function<void(int)>& work) {
    workers.run_within(count, work);
  };
  options.progress = [&](const std::string& what, double done, double then) {
    step = {what, done, then};
    line(what, done);
  };
  return diagnose(input.plant, input.segments, options);
}

bool write_outputs(const std::string& directory, const DiagnoseOutput& output) {
  std::error_code failure;
  std::filesystem::create_directories(directory, failure);
  if (failure) {
    fmt::print(stderr, "{}: {}\n", directory, failure.message());
    return false;
  }
  std::string why = drivers::write_text_file(directory + "/diagnosis.json", diagnosis_json(output));
  if (why.empty())
    why = drivers::write_text_file(directory + "/model.toml", diagnosis_model_toml(output));
  if (why.empty())
    why = drivers::write_text_file(directory + "/report.html", diagnosis_report(output));
  if (!why.empty()) fmt::print(stderr, "{}\n", why);
  return why.empty();
}

}  // namespace

int diagnose_command(const DiagnoseArguments& a) {
  keep_freed_memory();
  std::vector<ConfigProblem> config_problems;
  const std::optional<Config> config = load_config(a.config, config_problems);
  print_problems(config_problems);
  if (!config) return kBadInput;

  std::vector<std::string> problems;
  const estimator::PipelineConfig& pipeline = config->pipeline;
  if (a.component.any() && (pipeline.structure.stories != 1 || pipeline.structure.frames() != 1))
    problems.push_back(a.config + ": a component test has one story and one frame");
  estimator::DiagnosisOptions options;
  options.holdout_from = a.event.empty() ? a.train.size() : 1;
  options.without = excluded_kinds(a.without, problems);
  std::vector<DiagnoseRecord> records = read_records(*config, a, problems);
  if (print_all(problems)) return kBadInput;

  const ComparedChannels compared = compared_channels(*config, records);
  options.known = compared.known;
  std::vector<estimator::RecordSamples> samples;
  for (DiagnoseRecord& record : records) samples.push_back(std::move(record.samples));
  const auto input = estimator::diagnosis_input(pipeline.structure, compared.axes, pipeline.design,
                                                a.component, samples, pipeline.bending_nmprad);
  if (!input) {
    fmt::print(stderr,
               "{}: its channels do not measure every motion that diagnose needs; see "
               "docs/diagnosis.md\n",
               a.config);
    return kBadInput;
  }
  for (std::size_t r = 0; r < records.size(); ++r)
    add_segment_problems(records[r].path, *input, r, a.component, problems);
  if (print_all(problems)) return kBadInput;

  const estimator::Diagnosis diagnosis = run_diagnosis(a, *input, options);
  const DiagnoseOutput output{*config,         input->plant,         records,
                              input->segments, options.holdout_from, diagnosis};
  if (!write_outputs(a.out, output)) return kBadInput;
  if (!a.quiet) fmt::print("{}{}/report.html\n", diagnosis_text(output), a.out);
  const bool holds = diagnosis.verdict == estimator::Verdict::adequate ||
                     diagnosis.verdict == estimator::Verdict::explained;
  return holds ? 0 : kGapRemains;
}

}  // namespace framewatch::daemon
