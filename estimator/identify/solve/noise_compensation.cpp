// SPDX-License-Identifier: MIT
#include "estimator/identify/solve/noise_compensation.h"

#include <algorithm>
#include <cmath>

#include "estimator/numeric/kernels.h"
#include "estimator/numeric/nan.h"

namespace framewatch::estimator {

NoiseCompensation::NoiseCompensation(const FloorLayout& layout, double share)
    : layout_(layout),
      share_(share),
      floor_(static_cast<std::size_t>(layout.floors())),
      energy_(static_cast<std::size_t>(layout.unknowns()), 0.0) {
  if (share == kCompensatedShare) return;
  const GramShape shape(layout);
  for (std::size_t f = 0; f < floor_.size(); ++f) {
    const std::size_t end = f + 1 < floor_.size() ? shape.floor[f + 1].offset : shape.size;
    floor_[f].packed.assign(end - shape.floor[f].offset, 0.0);
  }
}

void NoiseCompensation::update(const RowFilter& rows, const WindowParts& sums, double level) {
  std::fill(energy_.begin(), energy_.end(), 0.0);
  residual_ = 0;
  level_ = level;
  for (int f = 0; f < layout_.floors(); ++f) {
    Floor& floor = floor_[static_cast<std::size_t>(f)];
    floor.rows = &rows.floor_rows(f);
    floor.instants = (*sums.instants)[static_cast<std::size_t>(f)];
    if (share_ != kCompensatedShare)
      pack_compensation(layout_, f, *floor.rows, share_, floor.packed);
    residual_ += floor.instants * floor.rows->noise_residual;
    const std::vector<double>& diagonal = floor.rows->noise_diagonal;
    double* energy = &energy_[static_cast<std::size_t>(f * layout_.own())];
    for (std::size_t p = 0; p < diagonal.size(); ++p) energy[p] += floor.instants * diagonal[p];
  }
}

namespace {

/// Ratio of the model's error that the solution absorbs to the error that it leaves. Chosen so that
/// intervals hold for buildings that the model does not describe (docs/accuracy.md). The equations
/// of groups are taken together, which overstates the ratio.
constexpr double kAbsorbed = 1.5, kAbsorbedOfGroups = 1;

bool is_stiffness(ParameterKind kind) {
  return kind != ParameterKind::frame_damping && kind != ParameterKind::panel_damping;
}

}  // namespace

ModelMisfit::ModelMisfit(const FloorLayout& layout)
    : layout_(layout),
      excess_(static_cast<std::size_t>(layout.floors()), 0),
      force_(static_cast<std::size_t>(layout.floors()), 0),
      usual_(excess_.size(), 0),
      least_(excess_.size(), 0),
      learned_(excess_.size(), 0),
      x_(static_cast<std::size_t>(layout.most_front()), 0),
      stiff_(static_cast<std::size_t>(layout.most_front()), 0) {}

void ModelMisfit::update(const WindowParts& sums, const std::vector<double>& solution,
                         const NoiseCompensation& noise, bool noise_known) {
  const int own = layout_.own();
  for (int floor = 0; floor < layout_.floors(); ++floor) {
    const GramShape::Floor& shape = sums.shape->floor[static_cast<std::size_t>(floor)];
    for (int i = 0; i + 1 < shape.front; ++i) {
      const double x = solution[static_cast<std::size_t>(floor * own + i)];
      x_[static_cast<std::size_t>(i)] = x;
      stiff_[static_cast<std::size_t>(i)] = is_stiffness(layout_.kind(i % own)) ? x : 0;
    }
    x_[static_cast<std::size_t>(shape.front - 1)] = -1;
    stiff_[static_cast<std::size_t>(shape.front - 1)] = 0;
    double left = 0, force = 0;
    std::size_t at = shape.offset;
    for (int i = 0; i < shape.front; ++i) {
      const int first = packed_row_begin(i);
      const auto row = static_cast<std::size_t>(i);
      for (int j = i; j < shape.front; ++j) {
        const std::size_t entry = at + static_cast<std::size_t>(j - first);
        const double sum = sums.newest[entry] + sums.middle[entry] + sums.oldest[entry];
        const auto column = static_cast<std::size_t>(j);
        const double times = i == j ? sum : 2 * sum;
        left += times * x_[row] * x_[column];
        force += times * stiff_[row] * stiff_[column];
      }
      at += static_cast<std::size_t>(shape.stride - first);
    }
    const double expected = noise_known ? noise.residual(floor) : 0;
    const auto f = static_cast<std::size_t>(floor);
    excess_[f] = std::isfinite(left) ? std::max(left - expected, 0.0) : 0;
    force_[f] = std::isfinite(force) ? std::max(force, 0.0) : 0;
    learn(f, noise_known ? expected : left);
  }
}

/// Learns from windows that are not far beyond what is usual. `expected`: energy that noise leaves.
void ModelMisfit::learn(std::size_t floor, double expected) {
  if (!(force_[floor] > 0)) return;
  least_[floor] = std::max(expected, 0.0) / force_[floor];
  const double ratio = excess_[floor] / force_[floor];
  if (learned_[floor] == kLearned && ratio > limit(floor, usual_[floor])) return;
  learned_[floor] = std::min(learned_[floor] + 1, kLearned);
  usual_[floor] += (ratio - usual_[floor]) / learned_[floor];
}

/// Returns the lowest floor whose equations hold the unknown. The first unknowns of a story are
/// also in the equations of the floor below.
int ModelMisfit::lowest_floor(int unknown) const {
  const int floor = unknown / layout_.own();
  return unknown % layout_.own() < layout_.shared() ? std::max(floor - 1, 0) : floor;
}

double ModelMisfit::misfit(int unknown) const {
  double largest = kNaN;
  for (int f = lowest_floor(unknown); f <= unknown / layout_.own(); ++f) {
    const auto floor = static_cast<std::size_t>(f);
    if (!(force_[floor] > 0)) continue;
    const double is = std::sqrt(excess_[floor] / force_[floor]);
    if (!(is <= largest)) largest = is;
  }
  return largest;
}

double ModelMisfit::error(int unknown, double variance) const {
  double excess = 0;
  for (int f = lowest_floor(unknown); f <= unknown / layout_.own(); ++f)
    excess += excess_[static_cast<std::size_t>(f)];
  return error_of(excess, variance);
}

double ModelMisfit::new_error(int unknown, double variance, const ModelMisfit& usual) const {
  double excess = 0;
  for (int f = lowest_floor(unknown); f <= unknown / layout_.own(); ++f) {
    const auto floor = static_cast<std::size_t>(f);
    if (usual.learned_[floor] == kLearned &&
        excess_[floor] > limit(floor, usual.usual_[floor]) * force_[floor])
      excess += excess_[floor];
  }
  return error_of(excess, variance);
}

double ModelMisfit::error_of(double excess, double variance) const {
  return (layout_.grouped() ? kAbsorbedOfGroups : kAbsorbed) *
         std::sqrt(excess * std::max(variance, 0.0));
}

}  // namespace framewatch::estimator
