#include "daemon/tools/diagnosis/diagnose_model.h"

#include <algorithm>

#include <fmt/core.h>

#include "daemon/base/file_digest.h"
#include "daemon/config/sections/effects.h"
#include "estimator/diagnose/trials/catalogue_form.h"
#include "estimator/diagnose/trials/damping_form.h"

namespace framewatch::daemon {
namespace {

constexpr double kMin = 1e-6;  ///< values of a design must be positive

/// [story][frame] lists of stiffness or damping, as in [structure.design].
std::string grid(const estimator::ParameterTable& table, const Eigen::VectorXd& theta, int stories,
                 int from, int count, bool damping) {
  std::string out = "[";
  for (int story = 1; story <= stories; ++story) {
    out += story > 1 ? ", [" : "[";
    for (int f = from; f < from + count; ++f) {
      const int at = damping ? table.frame_damping(story, f) : table.frame_stiffness(story, f);
      out += fmt::format("{}{:.9g}", f > from ? ", " : "", std::max(theta[at], kMin));
    }
    out += "]";
  }
  return out + "]";
}

std::string panels(const estimator::Structure& s, const estimator::ParameterTable& table,
                   const Eigen::VectorXd& theta, bool damping) {
  std::string out = "[";
  for (int story = 1; story <= s.stories; ++story) {
    out += story > 1 ? ", [" : "[";
    for (int l = 0; l < s.n() - 1; ++l) {
      out += l > 0 ? ", [" : "[";
      for (int j = 0; j < s.m() - 1; ++j) {
        const int panel = l * (s.m() - 1) + j;
        const int at =
            damping ? table.panel_damping(story, panel) : table.panel_stiffness(story, panel);
        out += fmt::format("{}{:.9g}", j > 0 ? ", " : "", std::max(theta[at], kMin));
      }
      out += "]";
    }
    out += "]";
  }
  return out + "]";
}

/// Rotational stiffness of frames whose bending is part of the design, of every floor.
std::string bending(const estimator::Plant& plant, const estimator::Model& model) {
  std::string out;
  for (const estimator::ModelEffect& e : model.effects) {
    const std::size_t along = e.place.direction == estimator::Direction::x ? 0 : 1;
    if (e.form != estimator::LawForm::bending || !(plant.bending[along] > 0)) continue;
    const double flexibility = std::max(e.parameters[0].plain(), kMin / plant.bending[along]);
    out += along == 0 ? "krx_nmprad = [" : "kry_nmprad = [";
    for (int floor = 0; floor < plant.structure.stories; ++floor)
      out += fmt::format("{}{:.9g}", floor > 0 ? ", " : "",
                         plant.bending.of_floor(along, static_cast<std::size_t>(floor)) /
                             plant.bending[along] / flexibility);
    out += "]\n";
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

}  // namespace

std::string diagnosis_model_toml(const DiagnoseOutput& o) {
  std::string error;
  const auto text = read_text_file(o.config.path, error);
  const estimator::Structure& s = o.plant.structure;
  const Eigen::VectorXd& theta = o.diagnosis.declared.theta;
  std::string out = "# Made by framewatch diagnose from " + o.config.path +
                    ": identified values as the design, effects that were found.\n";
  out += without(without(text.value_or(""), "structure.design"), "effect");
  if (out.back() != '\n') out += "\n";
  out += "\n[structure.design]\n";
  const estimator::ParameterTable& table = o.plant.table;
  for (const bool damping : {false, true}) {
    if (s.n() > 0)
      out += fmt::format("{} = {}\n", damping ? "cx_nspm" : "kx_npm",
                         grid(table, theta, s.stories, 0, s.n(), damping));
    if (s.m() > 0)
      out += fmt::format("{} = {}\n", damping ? "cy_nspm" : "ky_npm",
                         grid(table, theta, s.stories, s.n(), s.m(), damping));
    if (s.panels() > 0 && !o.plant.stiff_floors)
      out += fmt::format("{} = {}\n", damping ? "gc" : "gk", panels(s, table, theta, damping));
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

}  // namespace framewatch::daemon
