// SPDX-License-Identifier: MIT
#include "estimator/structure/parameter_table.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "estimator/structure/matrices.h"
#include "estimator/structure/natural_frequencies.h"
#include "tests/support/paper_buildings.h"

namespace framewatch::estimator {
namespace parameter_table_test {

/// 2 stories, n = 2, m = 3.
Structure oblong() {
  Structure s;
  s.stories = 2;
  s.frames_x = {"y1", "y2"};
  s.frames_y = {"x1", "x2", "x3"};
  s.span_x = {3, 5};
  s.span_y = {4};
  s.story_height = {3, 3};
  s.node_mass.assign(12, 1000);
  return s;
}

std::vector<std::string> names(const ParameterTable& table) {
  std::vector<std::string> out;
  for (int i = 0; i < table.size(); ++i) out.push_back(table[i].name);
  return out;
}

TEST(ParameterTable, FollowsThePapersThetaWhenNIsNotM) {
  const std::vector<std::string> expected = {
      "kx_1_y1",   "kx_1_y2",   "kx_2_y1",   "kx_2_y2",                          //
      "ky_1_x1",   "ky_1_x2",   "ky_1_x3",   "ky_2_x1",   "ky_2_x2", "ky_2_x3",  //
      "Gk_1_x1y1", "Gk_1_x2y1", "Gk_2_x1y1", "Gk_2_x2y1",                        //
      "cx_1_y1",   "cx_1_y2",   "cx_2_y1",   "cx_2_y2",                          //
      "cy_1_x1",   "cy_1_x2",   "cy_1_x3",   "cy_2_x1",   "cy_2_x2", "cy_2_x3",  //
      "Gc_1_x1y1", "Gc_1_x2y1", "Gc_2_x1y1", "Gc_2_x2y1"};
  EXPECT_EQ(names(ParameterTable(oblong())), expected);
}

TEST(ParameterTable, PanelsRunAlongXFirst) {
  const ParameterTable table(test::table2());
  EXPECT_EQ(table[table.panel_stiffness(1, 0)].name, "Gk_1_x1y1");
  EXPECT_EQ(table[table.panel_stiffness(1, 1)].name, "Gk_1_x2y1");
  EXPECT_EQ(table[table.panel_stiffness(2, 5)].name, "Gk_2_x3y2");
  EXPECT_EQ(table.size(), 68);
}

TEST(ParameterTable, IndicesNamesAndPartnersAgree) {
  for (const Structure& s : {oblong(), test::table1(), test::table2()}) {
    const ParameterTable table(s);
    std::set<std::string> seen;
    for (int i = 0; i < table.size(); ++i) {
      const Parameter& p = table[i];
      EXPECT_TRUE(seen.insert(p.name).second);
      EXPECT_EQ(table.find(p.name), i);
      int index = 0;
      switch (p.kind) {
        case ParameterKind::frame_stiffness:
          index = table.frame_stiffness(p.story, p.frame);
          break;
        case ParameterKind::frame_damping:
          index = table.frame_damping(p.story, p.frame);
          break;
        case ParameterKind::panel_stiffness:
          index = table.panel_stiffness(p.story, p.panel);
          break;
        case ParameterKind::panel_damping:
          index = table.panel_damping(p.story, p.panel);
          break;
        case ParameterKind::bending_stiffness:
          FAIL() << "belongs only to groups";
      }
      EXPECT_EQ(index, i) << p.name;
    }
    EXPECT_EQ(table[table.elements()].kind, ParameterKind::frame_damping);
    EXPECT_FALSE(table.find("kx_9_y1"));
  }
}

TEST(ParameterTable, UnitsNameThePaperEquationTwelve) {
  const ParameterTable table(oblong());
  EXPECT_EQ(table[0].unit, "N/m");
  EXPECT_EQ(table[*table.find("Gk_2_x2y1")].unit, "N/(rad*m)");
  EXPECT_EQ(table[*table.find("cy_1_x3")].unit, "N*s/m");
  EXPECT_EQ(table[*table.find("Gc_1_x1y1")].unit, "N*s/(rad*m)");
}

TEST(ParameterTable, PlaneAndRigidBuildingsHaveNoPanels) {
  Structure plane = oblong();
  plane.frames_y.clear();
  plane.span_x.clear();
  EXPECT_EQ(names(ParameterTable(plane)),
            (std::vector<std::string>{"kx_1_y1", "kx_1_y2", "kx_2_y1", "kx_2_y2", "cx_1_y1",
                                      "cx_1_y2", "cx_2_y1", "cx_2_y2"}));
  Structure across = oblong();
  across.frames_x.clear();
  across.span_y.clear();
  EXPECT_EQ(ParameterTable(across).size(), 12);
  EXPECT_EQ(ParameterTable(across)[0].name, "ky_1_x1");
  Structure rigid = oblong();
  rigid.floor = FloorModel::rigid;
  EXPECT_EQ(ParameterTable(rigid).size(), 20);
}

TEST(ParameterTable, ProportionalDampingGivesTheFirstModeItsRatio) {
  const Structure s = test::table1();
  const ParameterTable table(s);
  const Eigen::VectorXd theta = with_proportional_damping(s, table, test::table1_theta(), 0.05);
  const double w1 = 2 * M_PI * natural_frequencies_hz(s, table, theta).front();
  const Eigen::VectorXd ratio =
      theta.tail(table.elements()).cwiseQuotient(theta.head(table.elements()));
  EXPECT_NEAR(ratio.minCoeff(), 2 * 0.05 / w1, 1e-12);
  EXPECT_NEAR(ratio.maxCoeff(), 2 * 0.05 / w1, 1e-12);
}

}  // namespace parameter_table_test
}  // namespace framewatch::estimator
