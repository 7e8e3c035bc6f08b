#include "daemon/tools/lab/random_building.h"

#include <string>

#include "estimator/simulate/random.h"
#include "estimator/structure/matrices.h"
#include "estimator/structure/natural_frequencies.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {
namespace {

double between(estimator::Random& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

int count(estimator::Random& random, int low, int high) {
  return low + static_cast<int>(random.uniform() * (high - low + 1));
}

std::vector<double> spans(estimator::Random& random, int frames) {
  std::vector<double> out;
  for (int i = 1; i < frames; ++i) out.push_back(between(random, 3, 9));
  return out;
}

std::vector<std::string> names(const char* axis, int frames) {
  std::vector<std::string> out;
  for (int i = 1; i <= frames; ++i) out.push_back(axis + std::to_string(i));
  return out;
}

}  // namespace

RandomBuilding random_building(std::uint64_t seed) {
  constexpr double kFirstMode_hz[] = {0.8, 3};
  estimator::Random random(seed, 77);
  RandomBuilding out;
  estimator::Structure& s = out.structure;
  s.name = "random building " + std::to_string(seed);
  s.stories = count(random, 1, 6);
  s.frames_x = names("y", count(random, 1, 4));
  s.frames_y = names("x", count(random, 1, 4));
  s.span_x = spans(random, s.m());
  s.span_y = spans(random, s.n());
  s.story_height.assign(static_cast<std::size_t>(s.stories), 3.5);
  for (int i = 0; i < s.nodes(); ++i) s.node_mass.push_back(between(random, 5e3, 2e4));
  const estimator::ParameterTable table(s);
  out.truth.resize(table.size());
  for (int p = 0; p < table.elements(); ++p)
    out.truth[p] = between(random, 0.6, 1.6) *
                   (table[p].kind == estimator::ParameterKind::frame_stiffness ? 1.0 : 0.4);
  const double wanted_hz = between(random, kFirstMode_hz[0], kFirstMode_hz[1]);
  const double unit_hz = natural_frequencies_hz(s, table, out.truth).front();
  out.truth.head(table.elements()) *= (wanted_hz / unit_hz) * (wanted_hz / unit_hz);
  out.truth = with_proportional_damping(s, table, out.truth, between(random, 0.01, 0.04));
  for (int p = table.elements(); p < table.size(); ++p) out.truth[p] *= between(random, 0.5, 1.5);
  return out;
}

}  // namespace framewatch::daemon
