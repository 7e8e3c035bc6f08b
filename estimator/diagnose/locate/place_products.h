#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/bin_products.h"
#include "estimator/diagnose/locate/candidate_places.h"

namespace framewatch::estimator {

/// Products of the orthonormal whitened directions of a list of places with the columns, and with
/// unit forces on the equations: directions x columns or equations.
struct PlaceProducts {
  Eigen::MatrixXcd columns, equations;
};

/// Computes both. products: of the bin of its last compute().
PlaceProducts place_products(const BinProducts& products,
                             const std::vector<CandidatePlace>& places);
/// Computes the products with unit forces only, which need only BinProducts::put_metric().
Eigen::MatrixXcd place_equations(const BinProducts& products,
                                 const std::vector<CandidatePlace>& places);

}  // namespace framewatch::estimator
