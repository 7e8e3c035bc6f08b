// SPDX-License-Identifier: MIT
#include "daemon/tools/export/opensees_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>

#include <fmt/core.h>

#include "daemon/tools/export/opensees_material.h"
#include "drivers/files/number_text.h"
#include "estimator/simulate/building_model.h"
#include "estimator/structure/story_groups.h"

namespace framewatch::daemon {
namespace {

using estimator::Direction;
using estimator::Effect;
using estimator::EffectKind;
using estimator::PlaceKind;
using estimator::Structure;

/// Degrees of freedom of a node: 1 to 3 displacements along x, y, z, 4 to 6 rotations about them.
constexpr int kDofs = 6;
constexpr int kOtherNodes = 900'000'000;  ///< tags above it are not of a floor
constexpr int kHingeNodes = 100'000;      ///< above kOtherNodes: below the frames' hinges

/// Kinds whose stiffness or mass changes the modes of the model at rest.
bool changes_modes(const Effect& e) {
  switch (e.kind) {
    case EffectKind::bilinear_hysteresis:
    case EffectKind::bouc_wen:
    case EffectKind::coulomb_friction:
    case EffectKind::p_delta:
    case EffectKind::added_spring:
    case EffectKind::extra_mass:
    case EffectKind::tuned_mass_damper:
      return true;
    case EffectKind::one_sided_gap:
    case EffectKind::two_sided_gap:
      return !(e.value("gap_m") > 0);
    default:
      return false;
  }
}

class OpenSeesWriter {
 public:
  OpenSeesWriter(const ExportedModel& model, std::vector<std::string>& problems)
      : model_(model),
        s_(model.structure),
        table_(model.structure),
        problems_(problems),
        x_lines_(std::max(s_.m(), 1)),
        y_lines_(std::max(s_.n(), 1)) {
    while (per_floor_ < x_lines_ * y_lines_ + 2) per_floor_ *= 10;
    for (const Direction along : {Direction::x, Direction::y}) {
      rocking_[index(along)] = estimator::rocking_stiffness(model.effects, along);
      hinges_[index(along)] =
          estimator::hinge_stiffness(s_, model.effects, model.bending_nmprad, along);
    }
  }

  std::vector<OpenSeesCommand> commands() {
    refuse_impossible();
    add("wipe", {});
    add("model", {"basic", "-ndm", "3", "-ndf", "6"}, "N, m, kg, s; z is upward");
    for (int story = 0; story <= s_.stories; ++story) add_floor(story);
    for (const Direction along : {Direction::x, Direction::y}) add_base_rotation(along);
    for (int story = 1; story <= s_.stories; ++story)
      for (int f = 0; f < s_.frames(); ++f) add_frame(story, f);
    for (int story = 1; story <= s_.stories; ++story)
      for (int p = 0; p < s_.panels(); ++p) add_panel(story, p);
    for (const Effect& e : model_.effects) add_between_nodes(e);
    add("constraints", {is_rigid() ? "Transformation" : "Plain"});
    add_modal_damping();
    return std::move(out_);
  }

 private:
  using Words = std::vector<std::string>;

  static std::size_t index(Direction along) { return along == Direction::x ? 0 : 1; }
  static int dof_of(Direction along) { return along == Direction::x ? 1 : 2; }
  /// Returns the rotation that leans a frame along a direction.
  static int lean_dof(Direction along) { return along == Direction::x ? 5 : 4; }
  bool is_rigid() const { return s_.floor == estimator::FloorModel::rigid; }
  bool leans(Direction along) const {
    return rocking_[index(along)] > 0 || !hinges_[index(along)].empty();
  }

  int node(int story, int y_line, int x_line) const {
    return story * per_floor_ + y_line * x_lines_ + x_line + 1;
  }
  /// Returns the node that carries the frame's displacement.
  int lead(int story, int frame) const {
    return s_.direction(frame) == Direction::x ? node(story, frame, 0)
                                               : node(story, 0, frame - s_.n());
  }
  /// Returns the node of a rigid floor's motion.
  int master(int story) const { return story * per_floor_ + x_lines_ * y_lines_ + 1; }
  double x_m(int x_line) const { return s_.m() > 0 ? line_position(s_, s_.n() + x_line) : 0.0; }
  double y_m(int y_line) const { return s_.n() > 0 ? line_position(s_, y_line) : 0.0; }
  double z_m(int story) const {
    double out = 0;
    for (int i = 0; i < story; ++i) out += s_.story_height[static_cast<std::size_t>(i)];
    return out;
  }

  void add(const std::string& name, Words words, const std::string& comment = "") {
    out_.push_back({name, std::move(words), comment});
  }
  static std::string text(int number) { return fmt::format("{}", number); }

  void refuse(const Effect& e, const std::string& why) {
    problems_.push_back(fmt::format("{} at {}: {}; --without {} leaves it out", name_of(e.kind),
                                    place_text(e.place, s_, {}), why, name_of(e.kind)));
  }

  /// Refuses effects that are neither materials nor nodes.
  void refuse_impossible() {
    const bool plain_modes =
        std::none_of(model_.effects.begin(), model_.effects.end(), changes_modes);
    for (const Effect& e : model_.effects) {
      if (e.kind == EffectKind::floor_flexibility)
        refuse(e, "OpenSees' constraint handlers hold either rigid or flexible floors");
      if (e.kind == EffectKind::unmeasured_force)
        refuse(e, "a force is a load, not a part of the model");
      if (e.kind == EffectKind::base_rocking && is_rigid() && s_.stories > 1 &&
          hinges_[index(e.place.direction)].empty())
        refuse(e, "a node of a rigid floor cannot share a rotation as well");
      if (e.kind == EffectKind::modal_damping && !plain_modes)
        refuse(e, "another effect changes the modes that OpenSees would damp");
      if (e.kind == EffectKind::amplitude_dependence)
        refuse(e, "no material of OpenSees has its law");
      if (e.place.kind == PlaceKind::node_pair && leans(s_.direction(e.place.frame)))
        refuse(e, "a link between floors would turn with frames that bend or rock");
    }
  }

  void add_floor(int story) {
    const int crossings = x_lines_ * y_lines_;
    for (int c = 0; c < crossings; ++c) {
      const int x = c % x_lines_, y = c / x_lines_, tag = node(story, y, x);
      add("node",
          {text(tag), opensees_number(x_m(x)), opensees_number(y_m(y)),
           opensees_number(z_m(story))},
          story == 0 ? "base, " + crossing_name(s_, c)
                     : fmt::format("floor {}, {}", story, crossing_name(s_, c)));
      add_fix(story, y, x);
      if (story == 0) continue;
      double mass = s_.node_mass[static_cast<std::size_t>((story - 1) * crossings + c)];
      for (const Effect& e : model_.effects)
        if (e.kind == EffectKind::extra_mass && e.place.story == story && e.place.crossing == c)
          mass += e.value("mass_kg");
      const auto along = [&](int frames) { return opensees_number(frames > 0 ? mass : 0.0); };
      add("mass", {text(tag), along(s_.n()), along(s_.m()), "0.0", "0.0", "0.0", "0.0"});
    }
    if (story == 0) return;
    if (is_rigid())
      add_diaphragm(story);
    else
      add_equal_motions(story);
  }

  /// Fixes what does not move: the base, directions without frames, vertical motion, and rotations
  /// other than those of rigid floors and of frames that bend or rock.
  void add_fix(int story, int y, int x) {
    std::array<int, kDofs> fixed{1, 1, 1, 1, 1, 1};
    if (story > 0) {
      fixed[0] = s_.n() == 0 && !is_rigid();
      fixed[1] = s_.m() == 0 && !is_rigid();
      fixed[5] = !is_rigid();
    }
    // A frame's rotation of the story above is that of its node below.
    for (const Direction along : {Direction::x, Direction::y}) {
      const bool leads = along == Direction::x ? x == 0 && s_.n() > 0 : y == 0 && s_.m() > 0;
      if (leads && leans(along) && story < s_.stories)
        fixed[static_cast<std::size_t>(lean_dof(along) - 1)] = 0;
    }
    Words words{text(node(story, y, x))};
    for (const int one : fixed) words.push_back(text(one));
    add("fix", words);
  }

  void add_diaphragm(int story) {
    const int tag = master(story);
    const double x = x_m(x_lines_ - 1) / 2, y = y_m(y_lines_ - 1) / 2;
    add("node", {text(tag), opensees_number(x), opensees_number(y), opensees_number(z_m(story))},
        fmt::format("floor {}, middle of the rigid floor", story));
    const bool turns = s_.n() > 1 || s_.m() > 1;
    add("fix", {text(tag), text(s_.n() == 0), text(s_.m() == 0), "1", "1", "1", text(!turns)});
    Words words{"3", text(tag)};
    for (int c = 0; c < x_lines_ * y_lines_; ++c)
      words.push_back(text(node(story, c / x_lines_, c % x_lines_)));
    add("rigidDiaphragm", words);
  }

  void add_equal_motions(int story) {
    for (int y = 0; y < y_lines_; ++y)
      for (int x = 0; x < x_lines_; ++x) {
        const std::string tag = text(node(story, y, x));
        if (x > 0 && s_.n() > 0) add("equalDOF", {text(node(story, y, 0)), tag, "1"});
        if (y > 0 && s_.m() > 0) add("equalDOF", {text(node(story, 0, x)), tag, "2"});
      }
  }

  /// Adds a node at the base that turns only, and only if `free`.
  void add_turning_node(int tag, double x, double y, Direction along, bool free,
                        const std::string& what) {
    add("node", {text(tag), opensees_number(x), opensees_number(y), "0.0"}, what);
    Words words{text(tag)};
    for (int d = 1; d <= kDofs; ++d) words.push_back(text(!(free && d == lean_dof(along))));
    add("fix", words);
  }

  /// Adds the springs of the base that rocks, and of the frames' hinges on it. Links of no length
  /// join nodes at the same place.
  void add_base_rotation(Direction along) {
    if (!leans(along)) return;
    const std::string dof = text(lean_dof(along));
    const int ground = kOtherNodes + dof_of(along), rocker = ground + 2;
    const double rocking = rocking_[index(along)];
    const auto& hinges = hinges_[index(along)];
    if (rocking > 0) {
      add_turning_node(ground, 0, 0, along, false, "ground");
      add_turning_node(rocker, 0, 0, along, true, "rotation of the base");
      add_link("zeroLength", ground, rocker, {add_material(elastic_material(rocking, 0))}, {dof});
    }
    for (int f = 0; f < s_.frames(); ++f) {
      if (s_.direction(f) != along) continue;
      for (int story = 0; story < s_.stories && hinges.empty(); ++story)
        add("equalDOF", {text(rocker), text(lead(story, f)), dof});
      if (hinges.empty()) continue;
      const int below = kOtherNodes + kHingeNodes + f;
      const bool x = along == Direction::x;
      add_turning_node(below, x ? x_m(0) : x_m(f - s_.n()), x ? y_m(f) : y_m(0), along, rocking > 0,
                       "below the hinge of frame " + s_.frame_name(f));
      if (rocking > 0) add("equalDOF", {text(rocker), text(below), dof});
      add_link("zeroLength", below, lead(0, f), {add_material(elastic_material(hinges.front(), 0))},
               {dof});
    }
  }

  int add_material(const OpenSeesMaterial& material, const std::string& comment = "") {
    Words words{material.type, text(++materials_)};
    words.insert(words.end(), material.words.begin(), material.words.end());
    add("uniaxialMaterial", words, comment);
    return materials_;
  }

  void add_link(const std::string& type, int from, int to, const std::vector<int>& materials,
                const Words& directions, const Words& rest = {}) {
    Words words{type, text(++elements_), text(from), text(to), "-mat"};
    for (const int tag : materials) words.push_back(text(tag));
    words.emplace_back("-dir");
    words.insert(words.end(), directions.begin(), directions.end());
    words.insert(words.end(), rest.begin(), rest.end());
    add("element", words);
  }

  /// Adds an element's spring and dashpot and the laws on it, and returns the tag of all together.
  int add_law(double stiffness, double damping, const MaterialScale& scale,
              const std::function<bool(const Effect&)>& here, int story, const std::string& name) {
    std::vector<int> tags{add_material(elastic_material(stiffness, damping, scale), name)};
    for (const Effect& e : model_.effects) {
      if (!here(e)) continue;
      std::string why;
      const double height_m = s_.story_height[static_cast<std::size_t>(story - 1)];
      for (const OpenSeesMaterial& m : opensees_materials(e, height_m, scale, why))
        tags.push_back(add_material(m, std::string(name_of(e.kind))));
      if (!why.empty()) refuse(e, why);
    }
    if (tags.size() == 1) return tags.front();
    Words words;
    for (const int tag : tags) words.push_back(text(tag));
    return add_material({"Parallel", words}, "all of them");
  }

  static Words orientation(Direction along) {
    return along == Direction::x ? Words{"-orient", "1.0", "0.0", "0.0"}
                                 : Words{"-orient", "0.0", "1.0", "0.0"};
  }

  void add_frame(int story, int f) {
    const int stiffness = table_.frame_stiffness(story, f);
    const Direction along = s_.direction(f);
    const int tag = add_law(
        model_.theta[stiffness], model_.theta[stiffness + table_.elements()], {},
        [&](const Effect& e) {
          return e.place.kind == PlaceKind::frame && e.place.story == story && e.place.frame == f;
        },
        story, fmt::format("story {}, frame {}", story, s_.frame_name(f)));
    std::vector<int> materials{tag};
    Words directions{"2"};
    const auto& hinges = hinges_[index(along)];
    if (story < s_.stories && !hinges.empty()) {
      materials.push_back(add_material(elastic_material(hinges[static_cast<std::size_t>(story)], 0),
                                       fmt::format("hinge at floor {}", story)));
      directions.emplace_back("6");
    }
    Words rest = orientation(along);  // last, because it may have three or six numbers
    if (leans(along)) rest.insert(rest.begin(), {"-shearDist", "1.0", "1.0"});
    add_link("twoNodeLink", lead(story - 1, f), lead(story, f), materials, directions, rest);
  }

  /// The elongation of the diagonal is (Lx du + Ly dv) / D, the panel's deformation times
  /// sqrt(Lx Ly) / D.
  void add_panel(int story, int p) {
    const int x = p % (s_.m() - 1), y = p / (s_.m() - 1);
    const double lx = s_.span_x[static_cast<std::size_t>(x)];
    const double ly = s_.span_y[static_cast<std::size_t>(y)];
    const double diagonal = std::hypot(lx, ly), stretch = diagonal * diagonal / std::sqrt(lx * ly);
    const int stiffness = table_.panel_stiffness(story, p);
    const int tag = add_law(
        model_.theta[stiffness], model_.theta[stiffness + table_.elements()],
        {stretch, stretch / diagonal},
        [&](const Effect& e) {
          return e.place.kind == PlaceKind::panel && e.place.story == story && e.place.panel == p;
        },
        story, fmt::format("floor {}, panel {}", story, panel_name(s_, p)));
    add("element", {"truss", text(++elements_), text(node(story, y, x)),
                    text(node(story, y + 1, x + 1)), "1.0", text(tag)});
  }

  void add_between_nodes(const Effect& e) {
    const auto frame = e.place.frame;
    if (e.kind == EffectKind::tuned_mass_damper) {
      const double mass = e.value("mass_kg");
      if (!(mass > 0)) return;
      const double omega = 2 * M_PI * e.value("frequency_hz");
      const Direction along = s_.direction(frame);
      const int at = lead(e.place.story, frame), tag = kOtherNodes + 10 + ++absorbers_;
      const int y = along == Direction::x ? frame : 0,
                x = along == Direction::x ? 0 : frame - s_.n();
      add("node",
          {text(tag), opensees_number(x_m(x)), opensees_number(y_m(y)),
           opensees_number(z_m(e.place.story))},
          "tuned_mass_damper");
      Words fix{text(tag)}, masses{text(tag)};
      for (int d = 1; d <= kDofs; ++d) {
        fix.push_back(text(d != dof_of(along)));
        masses.push_back(opensees_number(d == dof_of(along) ? mass : 0.0));
      }
      add("fix", fix);
      add("mass", masses);
      const int material = add_material(
          elastic_material(mass * omega * omega, 2 * e.value("damping_ratio") * mass * omega));
      add_link("zeroLength", at, tag, {material}, {text(dof_of(along))});
    } else if (e.place.kind == PlaceKind::node_pair) {
      std::string why;
      std::vector<int> tags;
      for (const OpenSeesMaterial& m : opensees_materials(e, 1, {}, why))
        tags.push_back(add_material(m, std::string(name_of(e.kind))));
      if (!why.empty()) return refuse(e, why);
      for (const int tag : tags)
        add_link("twoNodeLink", lead(e.place.to_story, frame), lead(e.place.story, frame), {tag},
                 {"2"}, orientation(s_.direction(frame)));
    }
  }

  void add_modal_damping() {
    std::vector<double> ratios;
    for (const Effect& e : model_.effects) {
      if (e.kind != EffectKind::modal_damping) continue;
      const auto mode = static_cast<std::size_t>(e.place.mode);
      if (ratios.size() < mode) ratios.resize(mode, 0.0);
      ratios[mode - 1] += e.value("damping_ratio");
    }
    if (ratios.empty()) return;
    const std::string count = text(static_cast<int>(ratios.size()));
    const bool massless = leans(Direction::x) || leans(Direction::y);
    add("eigen", massless ? Words{count} : Words{"-fullGenLapack", count});
    Words words;
    for (const double ratio : ratios) words.push_back(opensees_number(ratio));
    add("modalDamping", words, "beside the dashpots");
  }

  const ExportedModel& model_;
  const Structure& s_;
  estimator::ParameterTable table_;
  std::vector<std::string>& problems_;
  int x_lines_, y_lines_;
  int per_floor_ = 10;  ///< tags of a floor: a power of ten
  std::array<double, 2> rocking_{};
  std::array<std::vector<double>, 2> hinges_;
  int materials_ = 0, elements_ = 0, absorbers_ = 0;
  std::vector<OpenSeesCommand> out_;
};

bool is_number(const std::string& word) {
  return drivers::parse_number(word).has_value();
}

}  // namespace

std::vector<OpenSeesCommand> opensees_model(const ExportedModel& model,
                                            std::vector<std::string>& problems) {
  return OpenSeesWriter(model, problems).commands();
}

std::string tcl_text(const std::vector<OpenSeesCommand>& commands,
                     const std::vector<std::string>& head) {
  std::string out;
  for (const std::string& line : head) out += fmt::format("# {}\n", line);
  for (const OpenSeesCommand& c : commands) {
    out += c.name;
    for (const std::string& word : c.words) out += " " + word;
    out += c.comment.empty() ? "\n" : fmt::format("; # {}\n", c.comment);
  }
  return out;
}

std::string python_text(const std::vector<OpenSeesCommand>& commands,
                        const std::vector<std::string>& head) {
  std::string out;
  for (const std::string& line : head) out += fmt::format("# {}\n", line);
  out += "import openseespy.opensees as ops\n\n";
  for (const OpenSeesCommand& c : commands) {
    std::string words;
    for (const std::string& word : c.words)
      words += fmt::format("{}{}", words.empty() ? "" : ", ",
                           is_number(word) ? word : fmt::format("'{}'", word));
    out +=
        fmt::format("ops.{}({}){}\n", c.name, words, c.comment.empty() ? "" : "  # " + c.comment);
  }
  return out;
}

}  // namespace framewatch::daemon
