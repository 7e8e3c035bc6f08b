#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/bin_products.h"
#include "estimator/diagnose/locate/candidate_places.h"

namespace framewatch::estimator {

/// Products of the orthonormal directions of a list of places, whitened, with the columns and with
/// unit forces on the equations; directions x either.
struct PlaceProducts {
  Eigen::MatrixXcd columns, equations;
};

/// products: of the bin that they were computed for.
PlaceProducts place_products(const BinProducts& products,
                             const std::vector<CandidatePlace>& places);
/// Those with unit forces alone, which need no more than BinProducts::put_metric().
Eigen::MatrixXcd place_equations(const BinProducts& products,
                                 const std::vector<CandidatePlace>& places);

}  // namespace framewatch::estimator
