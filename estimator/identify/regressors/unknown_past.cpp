// SPDX-License-Identifier: MIT
#include "estimator/identify/regressors/unknown_past.h"

#include <algorithm>
#include <cmath>

namespace framewatch::estimator {
namespace {

/// A shape is over when it has decayed to this share of its start. What it then carries of a motion
/// is a thousandth, ten times below the noise of good sensors.
constexpr double kOver = 1e-3;
/// Value below which a shape is set to zero, before numbers become denormal and slow.
constexpr double kGone = 1e-30;

}  // namespace

UnknownPast::UnknownPast(int stride, int most_rows, int most_shapes)
    : stride_(static_cast<std::size_t>(stride)), equation_(static_cast<std::size_t>(most_rows)) {
  const auto shapes = static_cast<std::size_t>(most_shapes);
  for (Equation& e : equation_) {
    e.poles.reserve(shapes / 2);
    for (std::vector<double>* v : {&e.now, &e.before, &e.shape}) v->reserve(shapes);
    e.factor.reserve(shapes * shapes);
    e.fitted.reserve(shapes * stride_);
  }
}

void UnknownPast::begin(int rows) {
  equations_ = rows;
  instants_ = 0;
  const auto count = static_cast<std::size_t>(equations_);
  if (equation_.size() < count) equation_.resize(count);
  for (std::size_t i = 0; i < count; ++i) equation_[i].poles.clear();
}

void UnknownPast::add(int row, const PolePair& poles) {
  Equation& e = equation_[static_cast<std::size_t>(row)];
  e.poles.push_back(poles);
  resize(e);
  for (std::size_t i = 0; i < e.now.size(); ++i) {
    // In each pair, one shape was 1 an instant ago, the other two instants ago.
    (i % 2 == 0 ? e.now : e.before)[i] = 1;
  }
}

void UnknownPast::resize(Equation& e) const {
  const std::size_t shapes = 2 * e.poles.size();
  for (std::vector<double>* v : {&e.now, &e.before, &e.shape}) v->assign(shapes, 0.0);
  e.factor.assign(shapes * shapes, 0.0);
  e.fitted.assign(shapes * stride_, 0.0);
}

/// Advances the shapes by one instant. Returns false when all are over.
bool UnknownPast::step(Equation& e) {
  bool any = false;
  for (std::size_t i = 0; i < e.now.size(); ++i) {
    const PolePair& poles = e.poles[i / 2];
    double next = -poles.a1 * e.now[i] - poles.a2 * e.before[i];
    if (std::abs(next) < kGone) next = 0;
    e.before[i] = e.now[i];
    e.now[i] = next;
    any = any || std::abs(next) > kOver || std::abs(e.before[i]) > kOver;
  }
  return any;
}

void UnknownPast::rotate(Equation& e, double* row) const {
  const std::size_t shapes = e.now.size();
  e.shape = e.now;
  for (std::size_t i = 0; i < shapes; ++i) {
    const double x = e.shape[i];
    if (x == 0) continue;
    double* factor = &e.factor[i * shapes];
    const double length = std::sqrt(factor[i] * factor[i] + x * x);
    const double c = factor[i] / length, s = x / length;
    factor[i] = length;
    for (std::size_t k = i + 1; k < shapes; ++k) {
      const double above = factor[k];
      factor[k] = c * above + s * e.shape[k];
      e.shape[k] = c * e.shape[k] - s * above;
    }
    double* fitted = &e.fitted[i * stride_];
    for (std::size_t k = 0; k < stride_; ++k) {
      const double above = fitted[k];
      fitted[k] = c * above + s * row[k];
      row[k] = c * row[k] - s * above;
    }
  }
}

bool UnknownPast::remove(double* rows) {
  if (equations_ == 0) return true;
  bool any = false, whole = true;
  ++instants_;
  for (std::size_t r = 0; r < static_cast<std::size_t>(equations_); ++r) {
    Equation& e = equation_[r];
    any = step(e) || any;
    rotate(e, rows + r * stride_);
    whole = whole && instants_ > static_cast<int>(e.now.size());
  }
  if (!any) end();
  return whole;
}

}  // namespace framewatch::estimator
