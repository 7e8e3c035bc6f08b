#include "daemon/replay/bending_trial.h"

#include <cmath>

#include "estimator/identify/elements/guessed_design.h"
#include "estimator/numeric/nan.h"
#include "estimator/structure/group_design.h"

namespace framewatch::daemon {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kAtFirst = 0.05;  ///< of the work of the stories that hinges do in the beginning
constexpr double kBetter = 0.8;    ///< misfit with bending over that without, at most
constexpr double kErrors = 3;      ///< of the flexibility, from none

/// Rotational stiffness of every hinge that does this share of the stories' work under the floors'
/// inertia.
double first_guess(const estimator::Structure& s, const VectorXd& design,
                   estimator::Direction along) {
  const estimator::ParameterTable table(s);
  double shear = 0, work = 0, squares = 0, moment = 0;
  for (int story = s.stories; story >= 1; --story) {
    double stiffness = 0;
    for (int f = 0; f < s.frames(); ++f) {
      if (s.direction(f) != along) continue;
      shear += s.frame_mass(story, f);
      stiffness += design[table.frame_stiffness(story, f)];
    }
    work += shear * shear / stiffness;
    moment += shear * s.story_height[static_cast<std::size_t>(story - 1)];
    squares += moment * moment;
  }
  const int frames = along == estimator::Direction::x ? s.n() : s.m();
  return squares / (kAtFirst * work * frames);
}

}  // namespace

std::optional<BendingTrial> try_bending(const estimator::PipelineConfig& config,
                                        const Eigen::MatrixXd& accel,
                                        const estimator::Refinement& rigid,
                                        estimator::RefineOptions options) {
  const estimator::Structure& s = config.structure;
  const bool panels = s.floor == estimator::FloorModel::flexible && s.panels() > 0;
  const bool grouped = config.parameters().grouped();
  if (config.bending_nmprad.any() || (panels && !grouped) || !rigid.has_values())
    return std::nullopt;
  estimator::PipelineConfig bends = config;
  if (bends.design.size() == 0)
    bends.design = guessed_design(s, estimator::ParameterTable(s));
  for (const estimator::Direction along : {estimator::Direction::x, estimator::Direction::y})
    if ((along == estimator::Direction::x ? s.n() : s.m()) > 0)
      bends.bending_nmprad.base_nmprad[along == estimator::Direction::x ? 0 : 1] =
          first_guess(s, bends.design, along);
  const estimator::ParameterTable before = config.parameters(), table = bends.parameters();
  const VectorXd design =
      group_parameters(s, table, {bends.design, bends.bending_nmprad});
  VectorXd start = design;
  for (int p = 0; p < table.size(); ++p)
    if (const auto same = before.find(table[p].name)) start[p] = rigid.theta[*same];
  options.prior = false;  // nothing is known of the bending
  const estimator::Refinement r = refine_max_likelihood(bends, accel, design, start, options);
  if (!r.has_values()) return std::nullopt;
  BendingTrial out;
  out.misfit_ratio = r.misfit_ratio;
  const double better = r.misfit_ratio / rigid.misfit_ratio;
  for (const std::size_t along : {0, 1}) {
    const auto p = table.find(along == 0 ? "krx" : "kry");
    out.stiffness_nmprad[along] = p ? r.theta[*p] : estimator::kNaN;
    out.std_error_nmprad[along] = p ? r.std_error[*p] : estimator::kNaN;
    out.needed = out.needed || (p && better < kBetter && r.theta[*p] > kErrors * r.std_error[*p]);
  }
  return out;
}

}  // namespace framewatch::daemon
