#include "estimator/watch/change_model.h"

namespace framewatch::estimator {
namespace {

/// Of elements one by one: masses off by 2 % move the others' values by about as much of a change.
constexpr double kOwn = 0.005, kLeak = 0.03;
/// Of groups of up to six stories, as predict_layout() foresees for usual layouts.
constexpr double kOwnOfGroup = 0.3, kLeakOfGroup = 0.35;

}  // namespace

ChangeModel usual_change_model(const ParameterTable& table) {
  const auto n = static_cast<std::size_t>(table.elements());
  const bool grouped = table.grouped();
  return {std::vector<double>(n, grouped ? kOwnOfGroup : kOwn),
          std::vector<double>(n * n, grouped ? kLeakOfGroup : kLeak)};
}

}  // namespace framewatch::estimator
