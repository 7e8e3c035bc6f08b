// SPDX-License-Identifier: MIT
#include "daemon/tools/export/model_matrices.h"

#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/mat_file.h"
#include "daemon/tools/export/opensees_material.h"
#include "drivers/files/text_output.h"
#include "estimator/simulate/building_model.h"
#include "estimator/structure/matrices.h"
#include "estimator/structure/story_groups.h"

namespace framewatch::daemon {
namespace {

using estimator::Direction;
using estimator::Effect;
using estimator::EffectKind;
using estimator::Structure;

bool is_in_matrices(EffectKind kind) {
  switch (kind) {
    case EffectKind::p_delta:
    case EffectKind::extra_mass:
    case EffectKind::tuned_mass_damper:
    case EffectKind::base_rocking:
    case EffectKind::frame_bending:
    case EffectKind::added_spring:
    case EffectKind::added_damper:
    case EffectKind::modal_damping:
    case EffectKind::floor_flexibility:
      return true;
    default:
      return false;
  }
}

bool is_flexible(const Structure& s, const std::vector<Effect>& effects, int story) {
  bool out = s.floor == estimator::FloorModel::flexible;
  for (const Effect& e : effects)
    out = out || (e.kind == EffectKind::floor_flexibility && e.place.story == story);
  return out;
}

/// Fills the rows of a floor and its frames' displacements, one column for each row.
void add_floor(const Structure& s, int story, bool flexible, std::vector<MatrixRow>& rows,
               std::vector<Eigen::VectorXd>& columns) {
  const auto size = s.degrees_of_freedom();
  if (flexible) {
    for (int f = 0; f < s.frames(); ++f) {
      rows.push_back({fmt::format("floor {}, frame {}", story, s.frame_name(f)),
                      letter(s.direction(f)), "m", story});
      columns.emplace_back(Eigen::VectorXd::Unit(size, s.dof(story, f)));
    }
    return;
  }
  double middle_x = 0, middle_y = 0;
  for (int f = 0; f < s.frames(); ++f)
    (s.direction(f) == Direction::x ? middle_y : middle_x) = line_position(s, f) / 2;
  Eigen::VectorXd along_x = Eigen::VectorXd::Zero(size), along_y = along_x, turn = along_x;
  for (int f = 0; f < s.frames(); ++f) {
    const bool x = s.direction(f) == Direction::x;
    (x ? along_x : along_y)[s.dof(story, f)] = 1;
    turn[s.dof(story, f)] = x ? middle_y - line_position(s, f) : line_position(s, f) - middle_x;
  }
  const auto add = [&](const Eigen::VectorXd& column, const char* name, const char* along,
                       const char* unit) {
    if (column.isZero(0)) return;
    rows.push_back({fmt::format("floor {}, {}", story, name), along, unit, story});
    columns.push_back(column);
  };
  add(along_x, "middle along x", "x", "m");
  add(along_y, "middle along y", "y", "m");
  add(turn, "rotation", "z", "rad");
}

/// Rows of a building, and the displacements of its degrees of freedom for each of them.
struct Coordinates {
  std::vector<MatrixRow> rows;
  Eigen::MatrixXd motion;  ///< degrees of freedom and hidden masses x rows
};

Coordinates coordinates(const Structure& s, const std::vector<Effect>& effects) {
  Coordinates out;
  std::vector<Eigen::VectorXd> columns;
  for (int story = 1; story <= s.stories; ++story)
    add_floor(s, story, is_flexible(s, effects, story), out.rows, columns);
  const auto frames = static_cast<Eigen::Index>(columns.size());
  for (const Effect& e : effects)
    if (e.kind == EffectKind::tuned_mass_damper)
      out.rows.push_back({fmt::format("hidden mass at floor {}, frame {}", e.place.story,
                                      s.frame_name(e.place.frame)),
                          letter(s.direction(e.place.frame)), "m", e.place.story});
  const Eigen::Index hidden = static_cast<Eigen::Index>(out.rows.size()) - frames;
  const Eigen::Index size = s.degrees_of_freedom();
  out.motion = Eigen::MatrixXd::Zero(size + hidden, frames + hidden);
  for (Eigen::Index c = 0; c < frames; ++c)
    out.motion.col(c).head(size) = columns[static_cast<std::size_t>(c)];
  out.motion.bottomRightCorner(hidden, hidden).setIdentity();
  return out;
}

std::string market_text(const Eigen::MatrixXd& m, const std::string& comment) {
  std::string entries;
  int count = 0;
  for (Eigen::Index c = 0; c < m.cols(); ++c)
    for (Eigen::Index r = 0; r < m.rows(); ++r)
      if (m(r, c) != 0) {
        entries += fmt::format("{} {} {}\n", r + 1, c + 1, opensees_number(m(r, c)));
        ++count;
      }
  return fmt::format("%%MatrixMarket matrix coordinate real general\n% {}\n{} {} {}\n", comment,
                     m.rows(), m.cols(), count) +
         entries;
}

std::string rows_text(const ModelMatrices& m) {
  std::string out = "row,name,floor,along,unit\n";
  for (std::size_t r = 0; r < m.rows.size(); ++r)
    out += fmt::format("{},\"{}\",{},{},{}\n", r + 1, m.rows[r].name, m.rows[r].floor,
                       m.rows[r].along, m.rows[r].unit);
  return out;
}

std::vector<double> row_major(const Eigen::MatrixXd& m) {
  std::vector<double> out;
  for (Eigen::Index r = 0; r < m.rows(); ++r)
    for (Eigen::Index c = 0; c < m.cols(); ++c) out.push_back(m(r, c));
  return out;
}

}  // namespace

ModelMatrices model_matrices(const ExportedModel& model, std::vector<std::string>& problems) {
  const Structure& s = model.structure;
  std::vector<Effect> held;
  for (const Effect& e : model.effects) {
    if (is_channel_effect(e.kind)) continue;
    if (is_in_matrices(e.kind))
      held.push_back(e);
    else
      problems.push_back(
          fmt::format("{} at {}: it is not linear, so no matrix holds it; --without {} leaves it "
                      "out",
                      name_of(e.kind), place_text(e.place, s, {}), name_of(e.kind)));
  }
  const estimator::ParameterTable table(s);
  const estimator::LinearModel linear = linear_model(
      s, table, model.theta, held, estimator::ground_influence(s), model.bending_nmprad);
  Eigen::MatrixXd stiffness = linear.stiffness();
  for (const Effect& e : held) {
    if (e.kind != EffectKind::p_delta) continue;
    const Eigen::VectorXd& b =
        linear.linear[static_cast<std::size_t>(table.frame_stiffness(e.place.story, e.place.frame))]
            .b;
    stiffness -= e.value("weight_n") / s.story_height[static_cast<std::size_t>(e.place.story - 1)] *
                 b * b.transpose();
  }
  const Coordinates at = coordinates(s, held);
  ModelMatrices out;
  out.rows = at.rows;
  const Eigen::MatrixXd& t = at.motion;
  out.mass = t.transpose() * linear.mass.asDiagonal() * t;
  out.damping = t.transpose() * linear.damping() * t;
  out.stiffness = t.transpose() * stiffness * t;
  // Rows that measure a translation follow the base; rotations do not.
  out.influence = Eigen::MatrixXd::Zero(t.cols(), 2);
  for (std::size_t r = 0; r < out.rows.size(); ++r)
    if (out.rows[r].along != "z")
      out.influence(static_cast<Eigen::Index>(r), out.rows[r].along == "x" ? 0 : 1) = 1;
  out.frames = t.topRows(s.degrees_of_freedom());
  return out;
}

std::string write_matrices(const ModelMatrices& m, const std::string& folder) {
  const auto path = [&](const char* name) { return folder + "/" + name; };
  for (const auto& [name, matrix, comment] :
       {std::tuple("M.mtx", &m.mass, "mass, kg, kg*m, kg*m^2; rows.csv says what each row is"),
        std::tuple("C.mtx", &m.damping, "damping, N*s/m, N*s, N*m*s; rows.csv has the rows"),
        std::tuple("K.mtx", &m.stiffness, "stiffness, N/m, N, N*m; rows.csv has the rows"),
        std::tuple("r.mtx", &m.influence, "displacement of the rows with the base along x and y"),
        std::tuple("frames.mtx", &m.frames,
                   "displacements of the frames, floor by floor, for each row")})
    if (const std::string why = drivers::write_text_file(path(name), market_text(*matrix, comment));
        !why.empty())
      return why;
  if (const std::string why = drivers::write_text_file(path("rows.csv"), rows_text(m));
      !why.empty())
    return why;
  return write_mat_file(path("matrices.mat"), [&](MatFile& file) {
    std::vector<std::string> names;
    for (const MatrixRow& row : m.rows) names.push_back(row.name + ", " + row.unit);
    return file.matrix("M", row_major(m.mass), m.rows.size()) &&
           file.matrix("C", row_major(m.damping), m.rows.size()) &&
           file.matrix("K", row_major(m.stiffness), m.rows.size()) &&
           file.matrix("r", row_major(m.influence), 2) &&
           file.matrix("frames", row_major(m.frames), m.rows.size()) && file.texts("rows", names);
  });
}

}  // namespace framewatch::daemon
