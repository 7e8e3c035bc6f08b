#include "estimator/identify/groups/group_chain.h"

#include <algorithm>
#include <cstddef>

#include "estimator/identify/groups/axis_motion.h"
#include "estimator/numeric/kernels.h"

namespace framewatch::estimator {
namespace {

constexpr int kSignals = AxisMotion::kSignals;

/// out += matrix x; by columns.
void add_product(const std::vector<double>& matrix, int rows, const double* x, int columns,
                 double* out) {
  const double* at = matrix.data();
  for (int c = 0; c < columns; ++c, at += rows)
    for (int r = 0; r < rows; ++r) out[r] += at[r] * x[c];
}

std::size_t size(int count) {
  return static_cast<std::size_t>(count);
}

}  // namespace

void GroupChain::start(const GroupEquations& equations, int unknowns) {
  equations_ = &equations;
  unknowns_ = unknowns;
  stride_ = padded(unknowns + 1);
  inner_.clear();
  for (const InnerChain& chain : equations.chains) {
    Inner inner;
    const std::size_t modes = size(chain.modes);
    inner.columns = padded(static_cast<int>(chain.forces.size()));
    inner.state.assign(2 * modes, 0.0);
    inner.next = inner.state;
    inner.forces_before.assign(modes, 0.0);
    inner.forces_now = inner.column = inner.forces_before;
    inner.derivatives.assign(4 * modes * size(inner.columns), 0.0);
    inner.derivatives_next.assign(2 * modes * size(inner.columns), 0.0);
    inner.on_rows.assign(chain.rows.size() * size(inner.columns), 0.0);
    inner.with_value.assign(modes + chain.ends.size(), 0.0);
    inner.with_first = inner.with_value;
    inner.column.resize(std::max(modes, chain.rows.size()));
    inner_.push_back(std::move(inner));
  }
  const std::size_t rows = size(equations.rows);
  signal_.assign(rows * size(stride_), 0.0);
  response_.assign(rows, 0.0);
  s1_.assign(rows * size(stride_), 0.0);
  s2_ = s1_;
}

void GroupChain::add_static(const double* motion) {
  std::fill(signal_.begin(), signal_.end(), 0.0);
  std::fill(response_.begin(), response_.end(), 0.0);
  for (const StaticPart& part : equations_->parts) {
    const double* at = part.matrix.data();
    for (const int column : part.columns) {
      const double x =
          motion[column * kSignals + (part.damping ? AxisMotion::first : AxisMotion::value)];
      for (const int row : part.rows) signal_[size(row * stride_ + part.parameter)] += *at++ * x;
    }
  }
  // by_* are by columns: rows vary fastest.
  const auto add = [&](const Eigen::MatrixXd& matrix, int signal) {
    const double* at = matrix.data();
    for (Eigen::Index c = 0; c < matrix.cols(); ++c)
      for (double& z : response_) z -= *at++ * motion[c * kSignals + signal];
  };
  add(equations_->by_second, AxisMotion::second);
  add(equations_->by_first, AxisMotion::first);
  add(equations_->by_value, AxisMotion::value);
}

void GroupChain::advance(const InnerChain& chain, Inner& inner, const double* motion) {
  const int modes = chain.modes;
  const auto ends = static_cast<int>(chain.ends.size());
  const auto signal = [&](int e, int which) {
    return motion[chain.ends[size(e)] * kSignals + which];
  };
  std::fill(inner.forces_now.begin(), inner.forces_now.end(), 0.0);
  std::fill(inner.column.begin(), inner.column.end(), 0.0);
  for (int e = 0; e < ends; ++e) {
    const double* second = &chain.from_second[size(e * modes)];
    const double* first = &chain.from_first[size(e * modes)];
    for (int m = 0; m < modes; ++m) {
      inner.forces_now[size(m)] += second[m] * signal(e, AxisMotion::held_second) +
                                   first[m] * signal(e, AxisMotion::held_first);
      // A hold takes nothing off what acts at once.
      inner.column[size(m)] +=
          second[m] * signal(e, AxisMotion::second) + first[m] * signal(e, AxisMotion::first);
    }
  }
  std::fill(inner.next.begin(), inner.next.end(), 0.0);
  const std::vector<double>& by = chain.transition_columns;
  const auto add = [&](const std::vector<double>& x, int first_column) {
    const double* at = &by[size(first_column * 2 * modes)];
    for (const double value : x)
      for (int r = 0; r < 2 * modes; ++r) inner.next[size(r)] += *at++ * value;
  };
  add(inner.state, 0);
  add(inner.forces_before, 2 * modes);
  add(inner.forces_now, 3 * modes);
  inner.state.swap(inner.next);
  inner.forces_before = inner.forces_now;

  // Accelerations of the modes from the forces and what the springs hold.
  double* accel = inner.column.data();
  const double* rate = &inner.state[size(modes)];
  for (int m = 0; m < modes; ++m) {
    inner.with_value[size(m)] = inner.state[size(m)] / InnerChain::kScale_radps;
    inner.with_first[size(m)] = rate[m];
    accel[m] -= chain.stiffness[size(m)] * inner.with_value[size(m)];
  }
  const double* damping = chain.damping.data();
  for (int c = 0; c < modes; ++c, damping += modes)
    for (int m = 0; m < modes; ++m) accel[m] -= damping[m] * rate[c];
  for (int e = 0; e < ends; ++e) {
    inner.with_value[size(modes + e)] = signal(e, AxisMotion::value);
    inner.with_first[size(modes + e)] = signal(e, AxisMotion::first);
  }
  const std::size_t rows = chain.rows.size();
  for (int m = 0; m < modes; ++m)
    for (std::size_t r = 0; r < rows; ++r)
      response_[size(chain.rows[r])] -= chain.inertia[size(m) * rows + r] * accel[m] +
                                        chain.friction[size(m) * rows + r] * rate[m];
}

void GroupChain::derive(const InnerChain& chain, Inner& inner) {
  if (chain.forces.empty()) return;  // nothing that is identified moves it
  const int modes = chain.modes, columns = inner.columns;
  const auto rows = static_cast<int>(chain.rows.size());
  const auto ends = static_cast<int>(chain.ends.size());
  double* now = &inner.derivatives[size(3 * modes * columns)];
  for (std::size_t p = 0; p < chain.forces.size(); ++p) {
    const InnerForce& force = chain.forces[p];
    const double* by = (force.damping ? inner.with_first : inner.with_value).data();
    std::fill(inner.column.begin(), inner.column.end(), 0.0);
    add_product(force.on_modes, modes, by, modes + ends, inner.column.data());
    for (int m = 0; m < modes; ++m) now[size(m * columns) + p] = inner.column[size(m)];
    std::fill(inner.column.begin(), inner.column.end(), 0.0);
    add_product(force.on_rows, rows, by, modes, inner.column.data());
    for (int r = 0; r < rows; ++r) inner.on_rows[size(r * columns) + p] = inner.column[size(r)];
  }
  std::fill(inner.derivatives_next.begin(), inner.derivatives_next.end(), 0.0);
  kernels::in_use->multiply_add(chain.transition.data(), 4 * modes, 2 * modes, 4 * modes,
                                inner.derivatives.data(), inner.derivatives_next.data(), columns);
  std::copy(inner.derivatives_next.begin(), inner.derivatives_next.end(),
            inner.derivatives.begin());
  std::copy(now, now + size(modes * columns), now - size(modes * columns));
  kernels::in_use->multiply_add(chain.read_out.data(), 3 * modes, rows, 3 * modes,
                                inner.derivatives.data(), inner.on_rows.data(), columns);
  for (int r = 0; r < rows; ++r) {
    const int row = chain.rows[size(r)];
    for (std::size_t p = 0; p < chain.forces.size(); ++p) {
      const double derivative = inner.on_rows[size(r * columns) + p];
      signal_[size(row * stride_ + chain.forces[p].parameter)] += derivative;
      response_[size(row)] += derivative;  // h x = z: what is linear in x about the tuning
    }
  }
}

void GroupChain::step(const double* motion, const FloorRows& sections, double* out) {
  add_static(motion);
  for (std::size_t i = 0; i < inner_.size(); ++i) {
    advance(equations_->chains[i], inner_[i], motion);
    derive(equations_->chains[i], inner_[i]);
  }
  for (std::size_t r = 0; r < response_.size(); ++r) {
    const double* h = &signal_[r * size(stride_)];
    const double* beta = &sections.beta[r * size(stride_)];
    kernels::in_use->filter_rows(h, &response_[r], unknowns_, &sections.gain[r], &sections.a1[r],
                                 &sections.a2[r], &s1_[r * size(stride_)], &s2_[r * size(stride_)],
                                 beta, out + r * size(stride_), 1, stride_);
  }
}

}  // namespace framewatch::estimator
