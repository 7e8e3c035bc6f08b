#include <fmt/core.h>

#include "daemon/config_effects.h"
#include "daemon/diagnose_output.h"
#include "daemon/file_digest.h"
#include "estimator/diagnose/catalogue_form.h"

namespace framewatch::daemon {
namespace {

/// [story][frame] lists, as read_design wants them.
std::string grid(const ParameterTable& table, const Eigen::VectorXd& theta, int stories, int from,
                 int count) {
  std::string out = "[";
  for (int story = 1; story <= stories; ++story) {
    out += story > 1 ? ", [" : "[";
    for (int f = from; f < from + count; ++f)
      out += fmt::format("{}{:.9g}", f > from ? ", " : "", theta[table.frame_stiffness(story, f)]);
    out += "]";
  }
  return out + "]";
}

std::string panels(const Structure& s, const ParameterTable& table, const Eigen::VectorXd& theta) {
  std::string out = "[";
  for (int story = 1; story <= s.stories; ++story) {
    out += story > 1 ? ", [" : "[";
    for (int l = 0; l < s.n() - 1; ++l) {
      out += l > 0 ? ", [" : "[";
      for (int j = 0; j < s.m() - 1; ++j)
        out += fmt::format("{}{:.9g}", j > 0 ? ", " : "",
                           theta[table.panel_stiffness(story, l * (s.m() - 1) + j)]);
      out += "]";
    }
    out += "]";
  }
  return out + "]";
}

/// First-mode damping ratio of the identified dampings: the frames' mean of c w1 / 2 k.
double damping_ratio(const Plant& plant, const Eigen::VectorXd& theta) {
  const double w1 = 2 * M_PI * natural_frequencies_hz(plant.structure, plant.table, theta).front();
  double k = 0, c = 0;
  for (Eigen::Index e = 0; e < plant.element_count(); ++e) {
    if (plant.table[static_cast<int>(e)].frame < 0) continue;
    k += theta[e];
    c += theta[e + plant.element_count()];
  }
  return std::min(1.0, std::max(1e-4, c * w1 / (2 * k)));
}

/// `text` without the table [name] or the tables [[name]].
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
  const Structure& s = o.plant.structure;
  const Eigen::VectorXd& theta = o.diagnosis.model.theta;
  std::string out = "# Made by framewatch diagnose from " + o.config.path +
                    ": identified values as the design, effects that were found.\n";
  out += without(without(text.value_or(""), "structure.design"), "effect");
  if (out.back() != '\n') out += "\n";
  out += "\n[structure.design]\n";
  if (s.n() > 0) out += "kx_npm = " + grid(o.plant.table, theta, s.stories, 0, s.n()) + "\n";
  if (s.m() > 0) out += "ky_npm = " + grid(o.plant.table, theta, s.stories, s.n(), s.m()) + "\n";
  if (s.panels() > 0 && !o.plant.stiff_floors)
    out += "gk = " + panels(s, o.plant.table, theta) + "\n";
  out += fmt::format("damping_ratio = {:.6g}\n", damping_ratio(o.plant, theta));
  std::vector<Effect> effects;
  for (const auto* list : {&o.diagnosis.known, &o.diagnosis.effects})
    for (const FoundEffect& f : *list)
      effects.push_back(catalogue_effect(o.plant, o.stretches, f, o.diagnosis.model));
  if (!effects.empty()) out += "\n" + effects_toml(effects, s, o.plant.axes);
  return out;
}

}  // namespace framewatch::daemon
