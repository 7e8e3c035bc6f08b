// SPDX-License-Identifier: MIT
// A Matrix Market file for `framewatch diagnose --design`.
#include "daemon/tools/export/model_matrices.h"
#include "tests/fuzz/targets.h"

namespace framewatch::test {
namespace {

void read_matrix_market(Bytes input) {
  std::vector<std::string> problems;
  const auto matrix = daemon::parse_matrix_market("K.mtx", text_of(input), 3, problems);
  require(matrix.has_value() == problems.empty(), "all of it or a problem");
  require(!matrix || matrix->allFinite(), "finite numbers");
}

std::vector<std::string> matrix_market_seeds() {
  return {"%%MatrixMarket matrix coordinate real general\n% rows\n3 3 2\n1 1 4.5\n3 2 -1e3\n",
          "%%MatrixMarket matrix coordinate real symmetric\n3 3 1\n2 1 -1\n",
          "%%MatrixMarket matrix array real symmetric\n3 3\n1\n2\n3\n4\n5\n6\n"};
}

}  // namespace

const FuzzTarget kMatrixMarketTarget{"matrix_market", &read_matrix_market, &matrix_market_seeds};

}  // namespace framewatch::test
