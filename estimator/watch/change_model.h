#pragma once

#include <cstddef>
#include <vector>

#include "estimator/structure/parameter_table.h"

namespace framewatch::estimator {

/// What the model's error makes of a change. A group of stories is described by the design's shares
/// of its stories; when one of them loses stiffness these are others, so that the group's value
/// changes by more or less than its stiffness, and the values of other groups change, too.
struct ChangeModel {
  std::vector<double> own;   ///< by element: standard error of the size of its change, over that
  std::vector<double> leak;  ///< element by element, by the one that changes first: change of the
                             ///< other one's value over the size, at most

  bool is_of(std::size_t elements) const {
    return own.size() == elements && leak.size() == elements * elements;
  }
};

/// Where nothing is foreseen: of elements that are identified one by one, or of groups.
ChangeModel usual_change_model(const ParameterTable& table);

}  // namespace framewatch::estimator
