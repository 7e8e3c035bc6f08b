// SPDX-License-Identifier: MIT
#include "daemon/tools/export/opensees_model.h"

#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "daemon/tools/export/model_matrices.h"
#include "estimator/simulate/linear_building.h"
#include "estimator/simulate/nonlinear_building.h"
#include "estimator/simulate/random.h"
#include "estimator/structure/natural_frequencies.h"
#include "estimator/structure/story_groups.h"
#include "tests/daemon/tools/export/opensees_interpreter.h"
#include "tests/support/example_effects.h"

namespace framewatch::daemon {
namespace opensees_model_test {

using estimator::Direction;
using estimator::Effect;
using estimator::EffectKind;
using estimator::EffectPlace;
using estimator::Structure;
using test::OpenSeesInterpreter;

// Limits. Shares of the largest entry, or of the largest displacement.
constexpr double kSame = 1e-9;
/// Both schemes step across corners of a law, which no step size finds exactly; the ten springs of
/// `spread` have the most.
constexpr double kSameWithCorners = 1e-6, kSameWithSprings = 5e-4;
constexpr double kVisible = 1e-6;  // least change of the response by an effect

constexpr double kStep_s = 0.01;
constexpr int kSteps = 200;

/// A building whose plan, masses and heights have no symmetry.
ExportedModel building(int stories, int frames_x, int frames_y,
                       estimator::FloorModel floor = estimator::FloorModel::flexible) {
  Structure s;
  s.name = "uneven";
  s.stories = stories;
  s.floor = floor;
  for (int i = 1; i <= frames_x; ++i) s.frames_x.push_back(fmt::format("y{}", i));
  for (int i = 1; i <= frames_y; ++i) s.frames_y.push_back(fmt::format("x{}", i));
  for (int i = 1; i < frames_x; ++i) s.span_y.push_back(3 + 0.5 * i);
  for (int i = 1; i < frames_y; ++i) s.span_x.push_back(5 - 0.7 * i);
  for (int i = 0; i < stories; ++i) s.story_height.push_back(3.5 - 0.1 * i);
  for (int i = 0; i < s.nodes(); ++i) s.node_mass.push_back(900 + 37 * ((i * 7) % 11));
  const estimator::ParameterTable table(s);
  Eigen::VectorXd theta(table.size());
  for (int i = 0; i < table.size(); ++i)
    theta[i] = i < table.elements() ? 4e5 + 1.3e4 * ((i * 5) % 13) : 1e3 + 70.0 * ((i * 3) % 17);
  return {s, theta, {}, {}};
}

std::vector<std::string> problems_of(const ExportedModel& model) {
  std::vector<std::string> out;
  opensees_model(model, out);
  return out;
}

OpenSeesInterpreter interpreted(const ExportedModel& model) {
  std::vector<std::string> problems;
  const auto commands = opensees_model(model, problems);
  EXPECT_EQ(problems, std::vector<std::string>{});
  return OpenSeesInterpreter(test::tcl_lines(tcl_text(commands, {"a head"})));
}

/// Rows of the interpreter's motion that are the building's degrees of freedom.
std::vector<Eigen::Index> frame_rows(const Structure& s, const OpenSeesInterpreter& tcl) {
  std::vector<Eigen::Index> out;
  double z = 0;
  for (int story = 1; story <= s.stories; ++story) {
    z += s.story_height[static_cast<std::size_t>(story - 1)];
    for (int f = 0; f < s.frames(); ++f) {
      const bool x = s.direction(f) == Direction::x;
      const double at = line_position(s, f);
      out.push_back(tcl.row(x ? 0 : at, x ? at : 0, z, x ? 1 : 2));
    }
  }
  return out;
}

double difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

/// Compares mass, damping and stiffness in framewatch's coordinates.
void expect_same_matrices(const ExportedModel& model) {
  const OpenSeesInterpreter tcl = interpreted(model);
  const auto theirs = tcl.system();
  std::vector<std::string> not_linear;
  const ModelMatrices ours = model_matrices(model, not_linear);
  const Structure& s = model.structure;
  std::vector<Eigen::Index> rows = frame_rows(s, tcl);
  Eigen::MatrixXd motion = ours.frames;
  for (std::size_t r = 0; r < ours.rows.size(); ++r)
    if (ours.rows[r].name.starts_with("hidden mass")) {
      rows.push_back(tcl.last_row(ours.rows[r].along == "x" ? 1 : 2));
      motion.conservativeResize(motion.rows() + 1, Eigen::NoChange);
      motion.row(motion.rows() - 1) =
          Eigen::RowVectorXd::Unit(motion.cols(), static_cast<Eigen::Index>(r));
    }
  ASSERT_EQ(theirs.mass.rows(), ours.mass.rows());
  // Our coordinates of their unit motions.
  const Eigen::MatrixXd square = motion.transpose() * motion;
  const Eigen::MatrixXd there = motion.transpose() * theirs.motion(rows, Eigen::all);
  const Eigen::MatrixXd a = square.fullPivLu().solve(there);
  EXPECT_LT(difference(motion * a, theirs.motion(rows, Eigen::all)), kSame);
  EXPECT_LT(difference(a.transpose() * ours.mass * a, theirs.mass), kSame);
  EXPECT_LT(difference(a.transpose() * ours.damping * a, theirs.damping), kSame);
  EXPECT_LT(difference(a.transpose() * ours.stiffness * a, theirs.stiffness), kSame);
}

std::vector<Eigen::Vector2d> ground_motion() {
  estimator::Random random(4, 0);
  std::vector<Eigen::Vector2d> out;
  for (int i = 0; i <= kSteps; ++i)
    out.emplace_back(3 * (random.uniform() - 0.5), 3 * (random.uniform() - 0.5));
  return out;
}

/// Returns the largest difference of the displacements over the largest displacement.
double response_difference(const ExportedModel& model, estimator::DrivenBuilding& ours, int parts) {
  OpenSeesInterpreter tcl = interpreted(model);
  const auto ground = ground_motion();
  const auto theirs = tcl.integrate(ground, kStep_s, parts);
  const std::vector<Eigen::Index> rows = frame_rows(model.structure, tcl);
  double largest = 0, off = 0;
  for (int i = 0; i < kSteps; ++i) {
    ours.advance(ground[static_cast<std::size_t>(i)], ground[static_cast<std::size_t>(i) + 1]);
    const Eigen::VectorXd moved = ours.disp_rel();
    const Eigen::VectorXd there = theirs[static_cast<std::size_t>(i) + 1](rows);
    largest = std::max(largest, moved.cwiseAbs().maxCoeff());
    off = std::max(off, (moved - there).cwiseAbs().maxCoeff());
  }
  EXPECT_GT(largest, 1e-4);
  return off / largest;
}

TEST(OpenSeesModel, AssemblesTheSameMatrices) {
  for (const auto floor : {estimator::FloorModel::flexible, estimator::FloorModel::rigid})
    for (const auto& [n, m] : {std::pair(1, 0), std::pair(0, 1), std::pair(3, 0), std::pair(1, 1),
                               std::pair(2, 2), std::pair(3, 2), std::pair(2, 4)}) {
      SCOPED_TRACE(fmt::format("{} x {} frames", n, m));
      expect_same_matrices(building(3, n, m, floor));
    }
}

TEST(OpenSeesModel, MovesAlike) {
  for (const auto floor : {estimator::FloorModel::flexible, estimator::FloorModel::rigid}) {
    const ExportedModel model = building(2, 3, 2, floor);
    estimator::LinearBuilding ours(model.structure, estimator::ParameterTable(model.structure),
                                   model.theta, kStep_s);
    EXPECT_LT(response_difference(model, ours, 200), kSame);
  }
}

/// Effects that the matrices hold.
TEST(OpenSeesModel, HoldsLinearEffects) {
  for (const EffectKind kind :
       {EffectKind::extra_mass, EffectKind::tuned_mass_damper, EffectKind::base_rocking,
        EffectKind::frame_bending, EffectKind::added_spring, EffectKind::added_damper,
        EffectKind::modal_damping, EffectKind::p_delta}) {
    SCOPED_TRACE(std::string(name_of(kind)));
    const test::TableModel table = test::table_model();
    ExportedModel model{table.structure, table.theta, {}, {example_effect(kind, table)}};
    expect_same_matrices(model);
    if (kind == EffectKind::frame_bending) {
      model.structure.floor = estimator::FloorModel::rigid;
      model.theta = test::table_model(estimator::FloorModel::rigid).theta;
      expect_same_matrices(model);
      model.effects.push_back(example_effect(EffectKind::base_rocking, table));
      expect_same_matrices(model);
    }
  }
  ExportedModel tall = building(4, 2, 2);
  tall.bending_nmprad.base_nmprad = {3e7, 5e7};
  tall.bending_nmprad.shares = {std::vector<double>{1, 0.8, 0.5, 0.3}, {}};
  expect_same_matrices(tall);
}

/// Effects that become materials of OpenSees move like framewatch's laws, on frames and panels.
TEST(OpenSeesModel, MaterialsMoveLikeLaws) {
  const test::TableModel table = test::table_model();
  const auto moved = [&](const Effect& e) {
    const ExportedModel model{table.structure, table.theta, {}, {e}};
    estimator::NonlinearBuilding ours(table.structure, table.table(), table.theta, {e}, kStep_s, 8);
    estimator::LinearBuilding without(table.structure, table.table(), table.theta, kStep_s);
    EXPECT_GT(response_difference(model, without, 100), kVisible) << name_of(e.kind);
    return response_difference(model, ours, 100);
  };
  for (const EffectKind kind :
       {EffectKind::cubic_stiffness, EffectKind::quadratic_stiffness, EffectKind::quadratic_damping,
        EffectKind::p_delta, EffectKind::tuned_mass_damper, EffectKind::extra_mass})
    EXPECT_LT(moved(example_effect(kind, table)), kSame) << name_of(kind);
  for (const EffectKind kind : {EffectKind::bilinear_hysteresis, EffectKind::bouc_wen,
                                EffectKind::one_sided_gap, EffectKind::two_sided_gap}) {
    Effect e = example_effect(kind, table);
    if (kind == EffectKind::one_sided_gap || kind == EffectKind::two_sided_gap) e.set("cg_nspm", 0);
    EXPECT_LT(moved(e), kSameWithCorners) << name_of(kind);
  }
  Effect friction = example_effect(EffectKind::coulomb_friction, table);
  friction.set("stick_npm", 1e5);
  EXPECT_LT(moved(friction), kSameWithCorners);
  Effect yielding = example_effect(EffectKind::bilinear_hysteresis, table);
  yielding.set("spread", 0.5);
  EXPECT_LT(moved(yielding), kSameWithSprings);
  Effect loss = example_effect(EffectKind::bouc_wen, table);
  loss.set("strength_loss", 0.05);
  loss.set("stiffness_loss", 0.02);
  EXPECT_LT(moved(loss), kSameWithCorners);
  EffectPlace panel;
  panel.kind = estimator::PlaceKind::panel;
  panel.story = 1;
  panel.panel = 0;
  for (const EffectKind kind : {EffectKind::cubic_stiffness, EffectKind::quadratic_stiffness}) {
    Effect e = example_effect(kind, table);
    e.place = panel;
    EXPECT_LT(moved(e), kSame) << name_of(kind);
  }
  Effect e = loss;
  e.place = panel;
  EXPECT_LT(moved(e), kSameWithCorners);
}

TEST(OpenSeesModel, RefusesByNameWhatOpenSeesLacks) {
  const test::TableModel table = test::table_model();
  for (const EffectKind kind :
       {EffectKind::pinching, EffectKind::coulomb_friction, EffectKind::amplitude_dependence,
        EffectKind::stiffness_drop, EffectKind::stiffness_drift, EffectKind::unmeasured_force}) {
    const ExportedModel model{table.structure, table.theta, {}, {example_effect(kind, table)}};
    const auto problems = problems_of(model);
    ASSERT_EQ(problems.size(), 1u) << name_of(kind);
    EXPECT_EQ(problems[0].find(std::string(name_of(kind)) + " at "), 0u) << problems[0];
    EXPECT_NE(problems[0].find(fmt::format("--without {}", name_of(kind))), std::string::npos);
  }
  for (const EffectKind kind : {EffectKind::cubic_stiffness, EffectKind::quadratic_stiffness}) {
    Effect levels_off = example_effect(kind, table);
    EXPECT_TRUE(problems_of({table.structure, table.theta, {}, {levels_off}}).empty());
    levels_off.set("saturation_m", 2e-3);
    const auto problems = problems_of({table.structure, table.theta, {}, {levels_off}});
    ASSERT_EQ(problems.size(), 1u) << name_of(kind);
    EXPECT_NE(problems[0].find("saturation_m"), std::string::npos) << problems[0];
  }
  Effect round = example_effect(EffectKind::bilinear_hysteresis, table);
  round.set("sharpness", 1);
  EXPECT_EQ(problems_of({table.structure, table.theta, {}, {round}}).size(), 1u);
  Effect oriented = example_effect(EffectKind::bilinear_hysteresis, table);
  oriented.set("peak_oriented", 1);
  EXPECT_EQ(problems_of({table.structure, table.theta, {}, {oriented}}).size(), 1u);
  Effect unlike = example_effect(EffectKind::bilinear_hysteresis, table);
  unlike.set("asymmetry", 0.5);
  EXPECT_TRUE(problems_of({table.structure, table.theta, {}, {unlike}}).empty());
  const test::TableModel rigid = test::table_model(estimator::FloorModel::rigid);
  for (const EffectKind kind : {EffectKind::base_rocking, EffectKind::floor_flexibility})
    EXPECT_EQ(problems_of({rigid.structure, rigid.theta, {}, {example_effect(kind, rigid)}}).size(),
              1u)
        << name_of(kind);
  const Effect damping = example_effect(EffectKind::modal_damping, table);
  const Effect yielding = example_effect(EffectKind::bouc_wen, table);
  EXPECT_EQ(problems_of({table.structure, table.theta, {}, {damping, yielding}}).size(), 1u);
}

/// The scripts in both languages have the same commands.
TEST(OpenSeesModel, PythonSaysTheSame) {
  const test::TableModel table = test::table_model();
  std::vector<std::string> problems;
  const auto commands = opensees_model(
      {table.structure, table.theta, {}, {example_effect(EffectKind::bouc_wen, table)}}, problems);
  std::istringstream lines(python_text(commands, {}));
  std::vector<test::OpenSeesLine> python;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("ops.")) continue;
    const std::size_t open = line.find('('), close = line.rfind(')', line.find('#'));
    test::OpenSeesLine command{line.substr(4, open - 4)};
    std::istringstream words(line.substr(open + 1, close - open - 1));
    for (std::string word; std::getline(words, word, ',');) {
      std::erase_if(word, [](char c) { return c == '\'' || c == ' '; });
      command.push_back(word);
    }
    python.push_back(command);
  }
  EXPECT_EQ(python, test::tcl_lines(tcl_text(commands, {})));
}

}  // namespace opensees_model_test
}  // namespace framewatch::daemon
