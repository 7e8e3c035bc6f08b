#include "estimator/diagnose/locate/few_products.h"

#include <numeric>

#include <gtest/gtest.h>

#include "estimator/diagnose/fit/fit.h"
#include "estimator/diagnose/locate/place_products.h"
#include "tests/estimator/diagnose/exact_record.h"
#include "tests/estimator/diagnose/other_buildings.h"

namespace framewatch::estimator {
namespace few_products_test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kStories = 11;  // a large building

/// What the orthonormal directions of a list take, with all products of the bin.
VectorXd expected_part(BinProducts& products, Index bin, const std::vector<CandidatePlace>& list,
                       Index columns) {
  products.compute(bin);
  const PlaceProducts places = place_products(products, list);
  VectorXd out = VectorXd::Zero(columns);
  for (Index i = 0; i < places.columns.rows(); ++i)
    out += (places.columns.row(i).conjugate() * places.columns(i, columns - 1)).real().transpose();
  return out;
}

TEST(FewProducts, AreThoseOfTheWholeBin) {
  constexpr double kTolerance = 1e-6;
  const test::Small small = test::tower(kStories);
  const Plant plant = small.plant();
  const MatrixXd record = small.record({}, 1);
  const std::vector<RecordSegment> segments{make_segment(
      record, test::kRate_hz, VectorXd::Constant(record.cols(), test::kNoise_mps2), {1, 4})};
  const Fitter fitter(plant, segments, {0.01, 0.005, 2.5e-4});
  Model model =
      test::with_effects(initial_model(plant),
                         {test::effect_of(LawForm::friction, test::frame_place(2), {20e3, 1e-3})});
  const Linearised at = fitter.linearise(model, fitter.systems(model, {}, Forcing::measured));
  std::vector<Index> kept(at.unknowns.size());
  std::iota(kept.begin(), kept.end(), Index{0});
  BinProducts products(at, 0, kept);
  FewProducts few(at, 0, kept);
  const auto columns = static_cast<Index>(kept.size()) + 1;
  const std::vector<CandidatePlace> all = candidate_places_of(plant, model);
  for (const Index bin : {Index{0}, at.systems[0].bins() / 2}) {
    few.set_bin(bin);
    for (std::size_t i = 0; i + 1 < all.size(); i += 7)
      for (const std::vector<CandidatePlace>& list :
           {std::vector{all[i]}, std::vector{all[i], all[i + 1]}}) {
        const VectorXd expected = expected_part(products, bin, list, columns);
        VectorXd found = VectorXd::Zero(columns);
        few.add(list, found);
        EXPECT_LT((found - expected).norm(), kTolerance * expected.norm()) << i;
      }
  }
}

}  // namespace few_products_test
}  // namespace framewatch::estimator
