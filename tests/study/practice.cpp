// SPDX-License-Identifier: MIT
#include "tests/study/practice.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include <nlohmann/json.hpp>

#include "drivers/files/text_output.h"
#include "tests/study/study_building.h"

namespace framewatch::study {
namespace {

using Json = nlohmann::ordered_json;

/// The other program's words, in order: the first that occurs decides. Empty: the catalog has no
/// such effect.
struct Word {
  const char* word;
  std::vector<const char*> names;
};
const std::vector<Word>& words() {
  static const std::vector<Word> kWords{
      {"out of catalogue", {}},
      {"cubic", {"cubic_stiffness"}},
      {"quadratic", {"quadratic_stiffness"}},
      {"pinch", {"pinching"}},
      {"Bouc-Wen", {"bouc_wen"}},
      {"yielding", {"bilinear_hysteresis"}},
      {"bilinear", {"bilinear_hysteresis"}},
      {"friction", {"coulomb_friction", "bilinear_hysteresis"}},
      {"nonlinear viscous", {"quadratic_damping"}},
      {"two-sided", {"two_sided_gap"}},
      {"one-sided", {"one_sided_gap"}},
      {"pounding", {"one_sided_gap"}},
      {"whole frame", {"amplitude_dependence"}},
      {"amplitude", {"amplitude_dependence"}},
      {"P-delta", {"p_delta"}},
      {"P-Delta", {"p_delta"}},
      {"tuned mass", {"tuned_mass_damper"}},
      {"mass", {"extra_mass"}},
      {"rocking", {"base_rocking"}},
      {"bending", {"frame_bending"}},
      {"spring", {"added_spring"}},
      {"brace", {"added_spring"}},
      {"dashpot", {"added_damper"}},
      {"gain", {"gain_error"}},
      {"polarity", {"polarity"}},
      {"reversed", {"polarity"}},
      {"misalign", {"misalignment"}},
      {"rotated", {"misalignment"}},
      {"late", {"time_shift"}},
      {"clip", {"clipping"}},
      {"saturat", {"clipping"}},
      {"swap", {"swapped"}},
      {"bias", {"bias_drift"}},
      {"drift", {"stiffness_drift", "bias_drift"}},
      {"gradual", {"stiffness_drift"}},
      {"drop", {"stiffness_drop"}},
      {"loss", {"stiffness_drop"}},
      {"force", {"unmeasured_force"}},
      {"flexible", {"floor_flexibility"}},
  };
  return kWords;
}

Json accepted(const std::string& effect) {
  for (const Word& w : words())
    if (effect.find(w.word) != std::string::npos) return w.names;
  return Json::array();
}

/// Returns floor and line of "u_2_1" (floor 2, x-parallel frame y1) or "v_12_3" (floor 12, frame
/// x3).
Json node_of(const std::string& channel) {
  const bool along_x = channel.front() == 'u';
  return {{"kind", "node"},
          {"direction", along_x ? "x" : "y"},
          {"story", std::stoi(channel.substr(2))},
          {"frame", (along_x ? "y" : "x") + channel.substr(channel.rfind('_') + 1)}};
}

Json location_of(const Json& hidden) {
  const Json place = hidden.value("location", Json::object());
  const std::string channel = place.value("channel", "");
  if (hidden["effect"].get<std::string>().starts_with("sensor"))
    return {{"kind", channel.starts_with("base") ? "base" : "channel"}, {"channel", channel}};
  if (place.contains("line"))
    return {{"kind", "frame"},
            {"direction", place["direction"]},
            {"story", place["story"]},
            {"frame", place["line"]}};
  if (place.contains("direction")) return {{"kind", "building"}, {"direction", place["direction"]}};
  return channel.empty() ? place : node_of(channel);
}

StudyBuilding belief(const Json& in) {
  StudyBuilding b;
  b.kind = "practice";
  estimator::Structure& s = b.believed;
  s.name = in["case"];
  s.stories = in["stories"];
  for (int l = 1; l <= in["n"].get<int>(); ++l) s.frames_x.push_back("y" + std::to_string(l));
  for (int j = 1; j <= in["m"].get<int>(); ++j) s.frames_y.push_back("x" + std::to_string(j));
  s.span_x = in["spans_x_m"].get<std::vector<double>>();
  s.span_y = in["spans_y_m"].get<std::vector<double>>();
  s.story_height = in["story_heights_m"].get<std::vector<double>>();
  const estimator::ParameterTable table(s);
  b.design = Eigen::VectorXd::Zero(table.size());
  const Json& k = in["nominal_stiffness"];
  for (int story = 1; story <= s.stories; ++story) {
    const auto i = static_cast<std::size_t>(story - 1);
    for (std::size_t l = 0; l < s.frames_x.size(); ++l)
      for (std::size_t j = 0; j < s.frames_y.size(); ++j)
        s.node_mass.push_back(in["nominal_node_mass_kg"][i][j][l]);
    for (int f = 0; f < s.frames(); ++f)
      b.design[table.frame_stiffness(story, f)] =
          f < s.n() ? k["kx_N_per_m"][i][static_cast<std::size_t>(f)]
                    : k["ky_N_per_m"][i][static_cast<std::size_t>(f - s.n())];
    for (int p = 0; p < s.panels(); ++p)
      b.design[table.panel_stiffness(story, p)] =
          k["G_N_per_m_per_rad"][i][static_cast<std::size_t>(p % (s.m() - 1))]
           [static_cast<std::size_t>(p / (s.m() - 1))];
  }
  b.design_damping_ratio = in["nominal_damping_ratio"];
  for (const Json& channel : in["channels"]) {
    estimator::SensorAxis axis;
    axis.name = channel["name"];
    axis.direction =
        channel["direction"] == "x" ? estimator::Direction::x : estimator::Direction::y;
    axis.story = channel.value("floor", 0);
    const std::string line = channel.value("line", "");
    for (int f = 0; f < s.frames(); ++f)
      if (s.frame_name(f) == line) axis.frame = f;
    b.axes.push_back(axis);
  }
  return b;
}

Json read_json(const std::string& path) {
  std::ifstream in(path);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  return Json::parse(text, nullptr, false);
}

/// Returns the effects to find: of two effects each, without those that equal a lower stiffness in
/// every record.
Json effects_of(const Json& hidden) {
  Json out = Json::array();
  const std::string name = hidden["effect"];
  if (name == "none") return out;
  for (const Json& one : hidden.value("effects", Json::array({hidden}))) {
    const std::string effect = one["effect"];
    const Json names = accepted(effect);
    if (std::find(names.begin(), names.end(), "p_delta") == names.end())
      out.push_back({{"effect", effect}, {"location", location_of(one)}, {"accepted", names}});
  }
  return out;
}

Json truth_of(const Json& in) {
  const Json& hidden = in["hidden"];
  const std::string name = hidden["effect"];
  const Json effects = effects_of(hidden);
  const bool outside = !effects.empty() && effects[0]["accepted"].empty();
  return {{"case", in["case"]},
          {"hidden", hidden},
          {"effects", effects},
          {"study",
           {{"group", effects.empty() ? "nothing"
                      : outside       ? "outside"
                                      : "practice"},
            {"name", name},
            {"building", "structure " + in["structure"].get<std::string>()},
            {"noise_ratio", 0.01}}}};
}

}  // namespace

bool import_practice(const std::string& source, const std::string& directory, std::string& error) {
  const Json structure = read_json(source + "/structure.json");
  const Json truth = read_json(source + "/truth.json");
  if (structure.is_discarded() || truth.is_discarded()) {
    error = source + ": structure.json or truth.json cannot be read";
    return false;
  }
  std::error_code code;
  std::filesystem::create_directories(directory, code);
  const auto copy = [&](const char* from, const char* to) {
    std::filesystem::copy_file(source + from, directory + to,
                               std::filesystem::copy_options::overwrite_existing, code);
    if (code) error = source + from + ": " + code.message();
    return !code;
  };
  const auto write = [&](const char* file, const std::string& text) {
    error = drivers::write_text_file(directory + file, text);
    return error.empty();
  };
  return copy("/record_1.csv.gz", "/train.csv.gz") && copy("/record_2.csv.gz", "/holdout.csv.gz") &&
         write("/config.toml", config_toml(belief(structure), structure["sampling_hz"])) &&
         write("/truth.json", truth_of(truth).dump(1) + "\n");
}

}  // namespace framewatch::study
