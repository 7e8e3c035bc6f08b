// SPDX-License-Identifier: MIT
#include "tests/support/paper_buildings.h"

#include "daemon/tools/lab/data_files.h"
#include "tests/support/data.h"

namespace framewatch::test {

std::optional<estimator::GroundMotion> el_centro_ns() {
  const auto data = data_path("");
  return data ? daemon::el_centro_ns(*data) : std::nullopt;
}

std::optional<estimator::GroundMotion> hachinohe_ns() {
  const auto data = data_path("");
  return data ? daemon::hachinohe_ns(*data) : std::nullopt;
}

}  // namespace framewatch::test
