// SPDX-License-Identifier: MIT
// What the estimator may do; tests/purity/symbols-check-fails expects no complaint.
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace purity {

double own(double x) {
  return std::sin(x) + std::sqrt(x);
}

double mathematics(const std::string& name, std::vector<double> values) {
  std::map<std::string, double> all;
  values.push_back(own(values.at(0)));
  all[name + std::to_string(values.size())] = values.back();
  return all.begin()->second;
}

}  // namespace purity
