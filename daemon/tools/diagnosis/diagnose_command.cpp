// SPDX-License-Identifier: MIT
#include "daemon/tools/diagnosis/diagnose_command.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <fmt/core.h>
#include <malloc.h>

#include "daemon/base/exit_code.h"
#include "daemon/base/file_digest.h"
#include "daemon/base/printable.h"
#include "daemon/base/progress.h"
#include "daemon/base/words.h"
#include "daemon/config/sections/config_problems.h"
#include "daemon/config/sections/effects.h"
#include "daemon/tools/diagnosis/diagnose_verdict.h"
#include "daemon/tools/export/model_matrices.h"
#include "drivers/files/text_output.h"
#include "estimator/diagnose/trials/catalogue_form.h"
#include "estimator/diagnose/trials/damping_form.h"

namespace framewatch::daemon {
namespace {

constexpr int kGapRemains = 1;
constexpr double kMin = 1e-6;  ///< least value of a design, which must be positive

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

/// Runs the diagnosis and shows its progress on a terminal.
std::unique_ptr<DiagnosisRun> run_shown(const Config& config, const DiagnoseArguments& a,
                                        std::vector<std::string>& problems) {
  ProgressLine line("diagnose", a.quiet);
  return run_diagnosis(
      config, a, {[&](const std::string& what, double share) { line(what, share); }, {}}, problems);
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
  std::optional<Config> config = load_config(a.config, config_problems);
  print_problems(config_problems);
  if (!config) return kBadInput;

  std::vector<std::string> problems;
  if (!a.design.empty()) {
    const auto design = read_matrix_design(config->pipeline.structure, a.design, problems);
    if (print_all(problems)) return kBadInput;
    config->pipeline.design = design->theta;
  }
  const std::unique_ptr<DiagnosisRun> run = run_shown(*config, a, problems);
  if (print_all(problems) || !run) return kBadInput;
  const DiagnoseOutput output = run->output();
  if (!write_outputs(a.out, output)) return kBadInput;
  if (!a.quiet) fmt::print("{}{}/report.html\n", diagnosis_text(output), a.out);
  const bool holds = run->diagnosis.verdict == estimator::Verdict::adequate ||
                     run->diagnosis.verdict == estimator::Verdict::explained;
  return holds ? 0 : kGapRemains;
}

}  // namespace framewatch::daemon
