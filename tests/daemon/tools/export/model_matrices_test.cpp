// SPDX-License-Identifier: MIT
#include "daemon/tools/export/model_matrices.h"

#include <matio.h>

#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "estimator/structure/matrices.h"
#include "tests/support/example_effects.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace model_matrices_test {

// Limits.
constexpr double kSameDesign = 1e-9;  // relative, of a design that went out and came back

TEST(ModelMatrices, FlexibleFloorsHaveTheMatricesOfTheMethod) {
  const test::TableModel table = test::table_model();
  std::vector<std::string> problems;
  const ModelMatrices m = model_matrices({table.structure, table.theta, {}, {}}, problems);
  const estimator::Matrices known = assemble(table.structure, table.table(), table.theta);
  EXPECT_TRUE(problems.empty());
  EXPECT_TRUE(m.mass.isApprox(Eigen::MatrixXd(known.mass.asDiagonal()), 1e-14));
  EXPECT_TRUE(m.damping.isApprox(known.damping, 1e-14));
  EXPECT_TRUE(m.stiffness.isApprox(known.stiffness, 1e-14));
  EXPECT_TRUE(m.influence.isApprox(ground_influence(table.structure)));
}

/// Two frames each way, 1 m apart, of 40 kg each: 80 kg move; about the middle each turns 0.5 m.
TEST(ModelMatrices, RowsOfARigidFloorAreItsMiddleAndItsRotation) {
  const test::TableModel table = test::table_model(estimator::FloorModel::rigid);
  std::vector<std::string> problems;
  const ModelMatrices m = model_matrices({table.structure, table.theta, {}, {}}, problems);
  ASSERT_EQ(m.rows.size(), 6u);
  EXPECT_EQ(m.rows[0].name, "floor 1, middle along x");
  EXPECT_EQ(m.rows[5].name, "floor 2, rotation");
  EXPECT_EQ(m.rows[5].unit, "rad");
  EXPECT_DOUBLE_EQ(m.mass(0, 0), 80);
  EXPECT_DOUBLE_EQ(m.mass(2, 2), 4 * 40 * 0.25);
  EXPECT_DOUBLE_EQ(m.influence(0, 0), 1);
  EXPECT_DOUBLE_EQ(m.influence.row(2).norm(), 0);
  // A turn by 1 rad, counter-clockwise: y1 at y = 0 moves to +x, y2 to -x.
  EXPECT_DOUBLE_EQ(m.frames(0, 2), 0.5);
  EXPECT_DOUBLE_EQ(m.frames(1, 2), -0.5);
}

TEST(ModelMatrices, ADesignGoesOutAndComesBack) {
  for (const auto floor : {estimator::FloorModel::flexible, estimator::FloorModel::rigid}) {
    const test::TableModel table = test::table_model(floor);
    const test::TemporaryDirectory directory;
    std::vector<std::string> problems;
    const ModelMatrices m = model_matrices({table.structure, table.theta, {}, {}}, problems);
    ASSERT_EQ(write_matrices(m, directory.path(".")), "");
    const auto back = read_matrix_design(table.structure, directory.path("."), problems);
    EXPECT_TRUE(problems.empty()) << problems.front();
    ASSERT_TRUE(back);
    EXPECT_LT(back->stiffness_rest, kSameDesign);
    EXPECT_TRUE(back->theta.isApprox(table.theta, kSameDesign));
  }
}

TEST(ModelMatrices, MatlabFileHasTheSameNumbers) {
  const test::TableModel table = test::table_model();
  const test::TemporaryDirectory directory;
  std::vector<std::string> problems;
  const ModelMatrices m = model_matrices({table.structure, table.theta, {}, {}}, problems);
  ASSERT_EQ(write_matrices(m, directory.path(".")), "");
  mat_t* const file = Mat_Open(directory.path("matrices.mat").c_str(), MAT_ACC_RDONLY);
  ASSERT_NE(file, nullptr);
  for (const auto& [name, matrix] :
       {std::pair("M", &m.mass), std::pair("C", &m.damping), std::pair("K", &m.stiffness)}) {
    matvar_t* const variable = Mat_VarRead(file, name);
    ASSERT_NE(variable, nullptr) << name;
    const auto* numbers = static_cast<const double*>(variable->data);
    for (Eigen::Index i = 0; i < matrix->size(); ++i) EXPECT_EQ(numbers[i], matrix->data()[i]);
    Mat_VarFree(variable);
  }
  Mat_Close(file);
}

TEST(ModelMatrices, RefusesLawsByName) {
  const test::TableModel table = test::table_model();
  for (const auto kind : {estimator::EffectKind::cubic_stiffness, estimator::EffectKind::bouc_wen,
                          estimator::EffectKind::stiffness_drift}) {
    std::vector<std::string> problems;
    model_matrices({table.structure, table.theta, {}, {example_effect(kind, table)}}, problems);
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].find(std::string(name_of(kind)) + " at story "), 0u) << problems[0];
  }
}

TEST(ModelMatrices, ReadsBothFormsOfMatrixMarket) {
  const auto parsed = [](const std::string& text) {
    std::vector<std::string> problems;
    const auto m = parse_matrix_market("K.mtx", text, 2, problems);
    EXPECT_EQ(m.has_value(), problems.empty());
    return m;
  };
  Eigen::MatrixXd known(2, 2);
  known << 4, -1, -1, 3;
  const auto listed = parsed(
      "%%MatrixMarket matrix coordinate real symmetric\n% a comment\n2 2 3\n1 1 4\n2 1 -1\n2 2 "
      "3\n");
  const auto array = parsed("%%MatrixMarket matrix array real general\n2 2\n4\n-1\n-1\n3\n");
  const auto half = parsed("%%MatrixMarket matrix array real symmetric\n2 2\n4\n-1\n3\n");
  for (const auto& m : {listed, array, half}) {
    ASSERT_TRUE(m);
    EXPECT_EQ(*m, known);
  }
  for (const char* bad : {"", "4 -1\n", "%%MatrixMarket matrix coordinate complex general\n2 2 0\n",
                          "%%MatrixMarket matrix array real general\n2 2\n4\n-1\n-1\n",
                          "%%MatrixMarket matrix array real general\n2 2\n4\n-1\n-1\n3\n3\n",
                          "%%MatrixMarket matrix coordinate real general\n2 2 5\n",
                          "%%MatrixMarket matrix coordinate real general\n2 2 1\n0 1 4\n",
                          "%%MatrixMarket matrix coordinate real general\n2 2 1\n1 1 inf\n"})
    EXPECT_FALSE(parsed(bad)) << bad;
}

}  // namespace model_matrices_test
}  // namespace framewatch::daemon
