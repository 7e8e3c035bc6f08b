// SPDX-License-Identifier: MIT
#include "estimator/identify/groups/floor_motion.h"

#include <algorithm>
#include <cmath>

#include "estimator/identify/elements/story_design.h"
#include "estimator/numeric/nan.h"

namespace framewatch::estimator {
namespace {

constexpr double kForgottenStart = 4.6;  // decay to a hundredth

using Matrix = Eigen::Map<const Eigen::MatrixXd>;

}  // namespace

FloorMotion::FloorMotion(const PipelineConfig& config)
    : config_(config),
      table_(config.parameters()),
      design_(story_design(config)),
      designed_(group_parameters(config.structure, table_, design_)) {
  tune(designed_, identifying(config.axes));
}

void FloorMotion::tune(const Eigen::VectorXd& theta, const std::vector<std::uint8_t>& present) {
  theta_ = theta;
  present_ = present;
  form();
}

void FloorMotion::form() {
  building_ = reduced_building(config_.structure, config_.axes, table_, design_, present_, true);
  equations_ = group_equations(building_, theta_.cwiseQuotient(designed_), config_.options.rate_hz,
                               InnerModes::all_below_20_hz);
  double settle_s = 0;
  for (const InnerChain& chain : equations_.chains)
    settle_s = std::max(settle_s, kForgottenStart / chain.slowest_radps);
  settle_rows_ = static_cast<int>(std::ceil(settle_s * config_.options.rate_hz));
  frames_ = Eigen::VectorXd::Constant(building_.frames.rows(), kNaN);
  expected_index_ = -1;
  restart();
}

void FloorMotion::restart() {
  inner_.clear();
  for (const InnerChain& chain : equations_.chains)
    inner_.push_back({Eigen::VectorXd::Zero(2 * chain.modes), Eigen::VectorXd::Zero(chain.modes),
                      Eigen::VectorXd::Zero(2 * chain.modes)});
}

const Eigen::VectorXd& FloorMotion::push(const SampleSet& set) {
  if (set.index != expected_index_) restart();
  expected_index_ = set.index + 1;
  if (building_.rows() == 0) {  // the base is not known
    restart();
    frames_.setConstant((config_.structure.stories + 1) * config_.structure.frames(), kNaN);
    return frames_;
  }
  measured_.setZero(building_.measured);
  for (std::size_t a = 0; a < present_.size(); ++a)
    if (present_[a] != 0)
      measured_ += building_.from_axes.col(static_cast<Eigen::Index>(a)) * set.accel[a];
  if (!measured_.allFinite()) {
    restart();
    frames_.setConstant(equations_.frames.rows(), kNaN);
    return frames_;
  }
  frames_ = equations_.frames * measured_;
  for (std::size_t i = 0; i < inner_.size(); ++i) {
    const InnerChain& chain = equations_.chains[i];
    Inner& inner = inner_[i];
    const Eigen::Index m = chain.modes;
    Eigen::VectorXd force = Eigen::VectorXd::Zero(m);  // column: acceleration of one end
    for (std::size_t e = 0; e < chain.ends.size(); ++e)
      force += Eigen::Map<const Eigen::VectorXd>(
                   &chain.from_second[e * static_cast<std::size_t>(m)], m) *
               measured_[chain.ends[e]];
    const Matrix transition(chain.transition_columns.data(), 2 * m, 4 * m);
    inner.next = transition.leftCols(2 * m) * inner.state +
                 transition.middleCols(2 * m, m) * inner.input_before +
                 transition.rightCols(m) * force;
    inner.state.swap(inner.next);
    inner.input_before = force;
    const Eigen::VectorXd accel =
        force -
        Eigen::Map<const Eigen::VectorXd>(chain.stiffness.data(), m)
            .cwiseProduct(inner.state.head(m) / InnerChain::kScale_radps) -
        Matrix(chain.damping.data(), m, m) * inner.state.tail(m);
    frames_ += chain.frames * accel;
  }
  return frames_;
}

}  // namespace framewatch::estimator
