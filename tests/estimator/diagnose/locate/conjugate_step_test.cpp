// SPDX-License-Identifier: MIT
#include "estimator/diagnose/locate/conjugate_step.h"

#include <numeric>

#include <gtest/gtest.h>

#include "estimator/diagnose/fit/fit.h"
#include "estimator/diagnose/fit/law_tracks.h"
#include "estimator/simulate/random.h"
#include "tests/estimator/diagnose/exact_record.h"

namespace framewatch::estimator {
namespace conjugate_step_test {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using test::Small;

constexpr double kRounding = 1e-9;
constexpr Index kBin = 17;

/// Has unknowns of stiffnesses, masses, readings, and of an effect.
struct Case {
  Small small;
  Plant plant = small.plant();
  std::vector<RecordSegment> segments = small.segments({small.record({}, 1)});
  Fitter fitter{plant, segments, {}};
  Model model =
      test::with_effects(test::true_model(small, plant), {test::cubic_spring(1, 1e11).modelled});
  Linearised at = fitter.linearise(model, fitter.systems(model, {}, Forcing::measured));
  std::vector<Index> kept;

  Case() : kept(at.unknowns.size()) { std::iota(kept.begin(), kept.end(), Index{0}); }
  Case(const Case&) = delete;
  Case& operator=(const Case&) = delete;

  VectorXcd of_bin(const Eigen::VectorXd& rows) const {
    const Index n = plant.equations();
    VectorXcd out(n);
    out.real() = rows.segment(2 * n * kBin, n);
    out.imag() = rows.segment(2 * n * kBin + n, n);
    return out;
  }

  /// Returns the whitened columns of the bin, one after the other.
  MatrixXcd columns() const {
    MatrixXcd out(plant.equations(), static_cast<Index>(kept.size()));
    for (const Index u : kept)
      out.col(u) = of_bin(whole_column(plant, at.systems[0], at.columns[0], u));
    return out;
  }

  /// Returns one place of each kind alone, and two together.
  std::vector<std::vector<CandidatePlace>> lists() const {
    std::vector<std::vector<CandidatePlace>> out;
    for (const CandidatePlace& place : candidate_places_of(plant, model))
      if (out.empty() || out.back().front().kind != place.kind) out.push_back({place});
    out.push_back({out.front().front(), out.back().front()});
    return out;
  }
};

TEST(BinCurvature, MatchesTheColumnsWithoutThePlaces) {
  const Case c;
  const std::vector<std::vector<CandidatePlace>> lists = c.lists();
  ASSERT_GT(lists.size(), 3U);
  const auto width = static_cast<Index>(lists.size());
  Random random(5);
  RowMatrix steps(static_cast<Index>(c.kept.size()), width);
  for (Index i = 0; i < steps.size(); ++i) steps.data()[i] = random.normal();
  RowMatrix sum = RowMatrix::Constant(steps.rows(), width, 2);
  BinCurvature(c.at, 0, c.kept, lists).add_times(kBin, steps, sum);
  const MatrixXcd columns = c.columns();
  for (Index l = 0; l < width; ++l) {
    const MatrixXcd basis =
        candidate_basis(c.at.systems[0], kBin, lists[static_cast<std::size_t>(l)]);
    const MatrixXcd rest = columns - basis * (basis.adjoint() * columns);
    const MatrixXd curvature = (rest.adjoint() * rest).real();
    const Eigen::VectorXd expected = curvature * steps.col(l);
    // Units differ, so each unknown is compared in units of its column.
    const Eigen::VectorXd size =
        columns.colwise().norm().transpose() * (columns.colwise().norm() * steps.col(l).cwiseAbs());
    for (Index u = 0; u < expected.size(); ++u)
      EXPECT_NEAR(sum(u, l) - 2, expected[u], kRounding * size[u]) << l << ' ' << u;
  }
}

TEST(BinProducts, EqualRowsTimesColumns) {
  const Case c;
  const MatrixXcd columns = c.columns();
  VectorXcd rows(c.plant.equations());
  Random random(6);
  for (Index i = 0; i < rows.size(); ++i)
    rows[i] = std::complex<double>(random.normal(), random.normal());
  BinProducts products(c.at, 0, c.kept);
  const Eigen::RowVectorXcd found = products.with_rows(kBin, rows);
  ASSERT_EQ(found.size(), columns.cols() + 1);
  for (Index u = 0; u < columns.cols(); ++u)
    EXPECT_LT(std::abs(found[u] - rows.dot(columns.col(u))),
              kRounding * rows.norm() * columns.col(u).norm());
  const VectorXcd residual = c.of_bin(c.at.systems[0].residual);
  EXPECT_LT(std::abs(found[columns.cols()] - rows.dot(residual)),
            kRounding * rows.norm() * residual.norm());
}

}  // namespace conjugate_step_test
}  // namespace framewatch::estimator
