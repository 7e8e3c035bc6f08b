// SPDX-License-Identifier: MIT
#include "estimator/identify/window/element_drift.h"

#include <algorithm>
#include <cmath>

#include "estimator/identify/elements/deformations.h"
#include "estimator/identify/elements/story_design.h"
#include "estimator/identify/groups/reduced_building.h"
#include "estimator/motion/derivative_triple.h"
#include "estimator/numeric/nan.h"
#include "estimator/structure/natural_frequencies.h"

namespace framewatch::estimator {
namespace {

constexpr double kHighestCorner = 0.2;  // share of the sampling rate
constexpr double kSmallestShare = 1e-9;
constexpr int kShapes = 4;  // of an element: two of the high-pass, two of its section

std::size_t place_of(int count) {
  return static_cast<std::size_t>(count);
}

double corner_hz(const PipelineConfig& config) {
  const double lowest_hz = lowest_frequency_hz(config.structure, ParameterTable(config.structure),
                                               story_design(config).theta);
  return std::max(
      std::min(ElementDrift::kCorner * lowest_hz, kHighestCorner * config.options.rate_hz),
      config.options.high_pass_hz);
}

}  // namespace

ElementDrift::ElementDrift(const PipelineConfig& config, const ParameterTable& table,
                           const FloorLayout& layout, int block_rows, int most_blocks)
    : block_rows_(block_rows),
      blocks_(most_blocks + 1),
      elements_(place_of(table.elements())),
      s1_(elements_.size(), 0.0),
      s2_(elements_.size(), 0.0),
      was_known_(elements_.size(), 0),
      sums_(place_of(blocks_) * elements_.size(), 0.0),
      counts_(sums_.size(), 0) {
  past_.reserve(elements_.size());  // a copy would not keep reserved memory
  for (std::size_t e = 0; e < elements_.size(); ++e) past_.emplace_back(1, 1, kShapes);
  const double hz = corner_hz(config);
  const OscillatorSection section(hz, config.options.filter_damping, config.options.rate_hz);
  gain_ = section.gain, section_ = {section.a1, section.a2};
  const HighPass high_pass(config.options.high_pass_hz, config.options.rate_hz);
  high_pass_poles_ = {high_pass.a1, high_pass.a2};
  over_w2_ = 1 / (4 * M_PI * M_PI * hz * hz);
  if (table.grouped())
    find_groups(config, table);
  else
    find_stories(table, layout);
}

void ElementDrift::find_stories(const ParameterTable& table, const FloorLayout& layout) {
  const int frames = layout.frames(), stride = layout.own() + frames;
  for (int floor = 0; floor < layout.floors(); ++floor)
    for (int position = 0; position < layout.own(); ++position) {
      const int parameter = layout.parameter(floor, position);
      if (parameter >= table.elements()) continue;
      Element& element = elements_[place_of(parameter)];
      element.terms = {{place_of(floor * stride + position), 1.0}};
      for (int f = 0; f < frames; ++f) {
        if (layout.coefficient(position, f) == 0) continue;
        element.flags.push_back(place_of((floor + 1) * frames + f));
        if (layout.kind(position) == ParameterKind::frame_stiffness)
          element.flags.push_back(place_of(floor * frames + f));
      }
    }
}

/// Sets up the mean over a group's frames of the motion of its upper floor relative to its lower
/// one.
void ElementDrift::find_groups(const PipelineConfig& config, const ParameterTable& table) {
  const Structure& s = config.structure;
  const ReducedBuilding building =
      reduced_building(s, config.axes, table, {story_design(config).theta, config.bending_nmprad},
                       identifying(config.axes), true);
  const Eigen::MatrixXd frames = building.frames.leftCols(building.measured) * building.from_axes;
  for (int p = 0; p < table.elements(); ++p) {
    const Parameter& group = table[p];
    if (group.kind != ParameterKind::frame_stiffness || group.frames.empty()) continue;
    Eigen::RowVectorXd weights = Eigen::RowVectorXd::Zero(frames.cols());
    for (const int f : group.frames)
      weights += (frames.row(group.last_story * s.frames() + f) -
                  frames.row((group.story - 1) * s.frames() + f)) /
                 static_cast<double>(group.frames.size());
    Element& element = elements_[place_of(p)];
    const double largest = weights.cwiseAbs().maxCoeff();
    for (Eigen::Index a = 0; a < weights.size(); ++a) {
      if (std::abs(weights[a]) <= kSmallestShare * largest) continue;
      const auto axis = static_cast<std::size_t>(a);
      element.terms.push_back({axis * AxisMotion::kSignals + AxisMotion::value, weights[a]});
      element.flags.push_back(axis);
    }
  }
}

void ElementDrift::restart() {
  std::fill(s1_.begin(), s1_.end(), 0.0);
  std::fill(s2_.begin(), s2_.end(), 0.0);
  std::fill(was_known_.begin(), was_known_.end(), 0);
  std::fill(sums_.begin(), sums_.end(), 0.0);
  std::fill(counts_.begin(), counts_.end(), 0);
  rows_ = at_ = 0;
}

bool ElementDrift::known(const Element& element, const DeformationSet& set) const {
  return !element.terms.empty() &&
         std::all_of(element.flags.begin(), element.flags.end(),
                     [&](std::size_t flag) { return set.known[flag] != 0; });
}

void ElementDrift::push(const DeformationSet& set) {
  const std::size_t count = elements_.size();
  if (rows_ == block_rows_) {
    rows_ = 0;
    at_ = (at_ + 1) % blocks_;
    const auto first = static_cast<std::ptrdiff_t>(place_of(at_) * count);
    const auto size = static_cast<std::ptrdiff_t>(count);
    std::fill_n(sums_.begin() + first, size, 0.0);
    std::fill_n(counts_.begin() + first, size, 0);
  }
  ++rows_;
  double* sums = &sums_[place_of(at_) * count];
  std::int32_t* counts = &counts_[place_of(at_) * count];
  for (std::size_t e = 0; e < count; ++e) {
    const Element& element = elements_[e];
    const bool is_known = known(element, set);
    if (is_known && was_known_[e] == 0) {
      past_[e].begin(1);
      past_[e].add(0, high_pass_poles_);
      past_[e].add(0, section_);
    }
    was_known_[e] = is_known ? 1 : 0;
    double x = 0;
    if (is_known)
      for (const Term& term : element.terms) x += term.weight * set.values[term.value];
    const double s = gain_ * x - section_.a1 * s1_[e] - section_.a2 * s2_[e];
    s2_[e] = s1_[e];
    s1_[e] = s;
    if (!is_known) continue;
    double own = s;
    if (!past_[e].remove(&own)) continue;
    sums[e] += own * own;
    ++counts[e];
  }
}

double ElementDrift::rms(int parameter, int blocks) const {
  if (place_of(parameter) >= elements_.size()) return kNaN;
  double sum = 0;
  std::int64_t instants = 0;
  const int newest = std::min(blocks, blocks_ - 1);
  for (int back = 0; back <= newest; ++back) {
    const std::size_t i =
        place_of((at_ + blocks_ - back) % blocks_) * elements_.size() + place_of(parameter);
    sum += sums_[i];
    instants += counts_[i];
  }
  const std::int64_t wanted = std::int64_t{blocks} * block_rows_;
  return instants > 0 && 2 * instants >= wanted
             ? over_w2_ * std::sqrt(sum / static_cast<double>(instants))
             : kNaN;
}

}  // namespace framewatch::estimator
