// SPDX-License-Identifier: MIT
#include "estimator/identify/groups/group_equations.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <utility>

#include "estimator/identify/elements/deformations.h"
#include "estimator/numeric/eigenvalues.h"
#include "estimator/numeric/kernels.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

/// Modes above this frequency are taken as rigid, because the derivative filters end here.
constexpr double kHighestMode_hz = 20;
/// Number of modes of an inner set for each pair of its ends. The rest is taken as rigid: with 4
/// modes this changes stiffnesses by 1e-5, with 3 by 2e-4. So the cost of an instant does not grow
/// with the stories of a group.
constexpr int kFewestModes = 3, kMaxModes = 4;

std::vector<double> by_columns(const Eigen::MatrixXd& m) {
  return {m.data(), m.data() + m.size()};
}

std::vector<double> by_rows(const Eigen::MatrixXd& m) {
  std::vector<double> out;
  for (Eigen::Index i = 0; i < m.rows(); ++i)
    for (Eigen::Index j = 0; j < m.cols(); ++j) out.push_back(m(i, j));
  return out;
}

std::vector<int> not_zero_rows(const Eigen::MatrixXd& m) {
  std::vector<int> out;
  for (Eigen::Index i = 0; i < m.rows(); ++i)
    if (!m.row(i).isZero(0)) out.push_back(static_cast<int>(i));
  return out;
}

/// Pairs exponents per step: conjugate ones together, real ones two by two.
std::vector<PolePair> pole_pairs(const std::vector<std::complex<double>>& exponents) {
  std::vector<PolePair> out;
  std::vector<double> real;
  for (const std::complex<double>& e : exponents) {
    if (e.imag() > 0)
      out.push_back({-2 * std::exp(e.real()) * std::cos(e.imag()), std::exp(2 * e.real())});
    else if (e.imag() == 0)
      real.push_back(std::exp(e.real()));
  }
  if (real.size() % 2 != 0) real.push_back(0);
  for (std::size_t i = 0; i + 1 < real.size(); i += 2)
    out.push_back({-(real[i] + real[i + 1]), real[i] * real[i + 1]});
  return out;
}

/// The modes of one inner set with its ends held.
struct SetModes {
  int first, size;        ///< its coordinates, after the measured ones
  Eigen::MatrixXd shape;  ///< size x modes, of unit modal mass
  Eigen::VectorXd w2;     ///< (rad/s)^2
};

class Builder {
 public:
  Builder(const ReducedBuilding& building, const Eigen::VectorXd& x, double rate_hz,
          InnerModes modes)
      : b_(building),
        x_(x),
        rate_hz_(rate_hz),
        modes_(modes),
        stiffness_(b_.constant_stiffness),
        damping_(b_.constant_damping) {
    for (std::size_t p = 0; p < b_.parts.size(); ++p)
      (b_.damping[p] != 0 ? damping_ : stiffness_) +=
          x_[static_cast<Eigen::Index>(p)] * b_.parts[p];
    condense();
    project();
  }

  GroupEquations equations() {
    GroupEquations out;
    out.rows = b_.rows();
    out.frequency_hz = frequency_hz_;
    for (std::size_t p = 0; p < b_.parts.size(); ++p) {
      const Eigen::MatrixXd whole =
          x_[static_cast<Eigen::Index>(p)] * rows(at_ends_.transpose() * b_.parts[p] * at_ends_);
      StaticPart part{static_cast<int>(p),
                      b_.damping[p] != 0,
                      not_zero_rows(whole),
                      not_zero_rows(whole.transpose()),
                      {}};
      if (part.rows.empty()) continue;
      part.matrix = by_columns(whole(part.rows, part.columns));
      out.parts.push_back(std::move(part));
    }
    out.by_value = rows(at_ends_.transpose() * b_.constant_stiffness * at_ends_);
    out.by_first = rows(at_ends_.transpose() * b_.constant_damping * at_ends_);
    out.by_second = rows(mass_);
    out.projection = projection_;
    out.frames = b_.frames * at_ends_;
    for (const SetModes& set : sets_) out.chains.push_back(chain(set));
    return out;
  }

 private:
  /// Returns the projected rows of a matrix that acts on all measured coordinates.
  Eigen::MatrixXd rows(const Eigen::MatrixXd& on_measured) const {
    return projection_ * on_measured.bottomRows(b_.rows());
  }

  /// Computes the static shapes under motion of the ends and the modes of every set.
  void condense() {
    at_ends_ = Eigen::MatrixXd::Zero(b_.size(), b_.measured);
    at_ends_.topRows(b_.measured).setIdentity();
    for (std::size_t i = 0; i + 1 < b_.sets.size(); ++i) {
      const int first = b_.sets[i], size = b_.sets[i + 1] - first;
      const Eigen::MatrixXd k = stiffness_.block(first, first, size, size);
      at_ends_.middleRows(first, size) =
          -Cholesky(k).solve(Eigen::MatrixXd(stiffness_.block(first, 0, size, b_.measured)));
      const RealEigen eigen = generalized_eigen(b_.mass.block(first, first, size, size), k);
      const int ends = static_cast<int>(
          not_zero_rows(stiffness_.block(first, 0, size, b_.measured).transpose()).size());
      const int pairs = std::max(1, (ends + 1) / 2);
      SetModes set{first, size, Eigen::MatrixXd(size, size), Eigen::VectorXd(size)};
      Eigen::Index modes = 0;
      for (Eigen::Index m = size - 1; m >= 0; --m) {  // ascending 1 / w^2
        const double over_w2 = eigen.values[m];
        const bool low = over_w2 * std::pow(2 * M_PI * kHighestMode_hz, 2) > 1;
        if (!(over_w2 > 1e-12 * eigen.values[size - 1]) ||
            (modes_ == InnerModes::few && modes >= kMaxModes * pairs) ||
            (!low && modes >= kFewestModes * pairs))
          break;
        set.w2[modes] = 1 / over_w2;
        set.shape.col(modes++) = eigen.vectors.col(m) / std::sqrt(over_w2);
      }
      set.shape.conservativeResize(Eigen::NoChange, modes);
      set.w2.conservativeResize(modes);
      if (modes > 0) sets_.push_back(std::move(set));
    }
    mass_ = at_ends_.transpose() * b_.mass * at_ends_;
  }

  /// Computes the modes of each floor with its neighbors held, as rows.
  void project() {
    const Eigen::MatrixXd k = at_ends_.transpose() * stiffness_ * at_ends_;
    projection_ = Eigen::MatrixXd::Zero(b_.rows(), b_.rows());
    for (std::size_t f = 0; f + 1 < b_.floors.size(); ++f) {
      const int first = b_.floors[f], size = b_.floors[f + 1] - first;
      const RealEigen modes = generalized_eigen(k.block(first, first, size, size),
                                                mass_.block(first, first, size, size));
      const int row = first - b_.inputs;
      projection_.block(row, row, size, size) = modes.vectors.transpose();
      for (int i = 0; i < size; ++i)
        frequency_hz_.push_back(std::sqrt(std::max(modes.values[i], 0.0)) / (2 * M_PI));
    }
  }

  InnerChain chain(const SetModes& set) const {
    InnerChain out;
    const Eigen::Index modes = set.shape.cols();
    out.modes = static_cast<int>(modes);
    Eigen::MatrixXd shapes = Eigen::MatrixXd::Zero(b_.size(), modes);
    shapes.middleRows(set.first, set.size) = set.shape;
    out.stiffness = by_columns(set.w2);
    out.frames = b_.frames * shapes;
    const Eigen::MatrixXd inertia = at_ends_.transpose() * b_.mass * shapes;
    const Eigen::MatrixXd friction = at_ends_.transpose() * damping_ * shapes;
    const Eigen::MatrixXd damping = shapes.transpose() * damping_ * shapes;
    const auto coupled = stiffness_.block(set.first, 0, set.size, b_.measured).cwiseAbs() +
                         b_.mass.block(set.first, 0, set.size, b_.measured).cwiseAbs();
    out.ends = not_zero_rows(Eigen::MatrixXd(coupled).transpose());
    out.rows = rows_at(out.ends);
    out.from_second = by_columns(-inertia(out.ends, Eigen::all).transpose());
    out.from_first = by_columns(-friction(out.ends, Eigen::all).transpose());
    out.damping = by_columns(damping);
    const Eigen::MatrixXd row_inertia = rows(inertia)(out.rows, Eigen::all);
    const Eigen::MatrixXd row_friction = rows(friction)(out.rows, Eigen::all);
    out.inertia = by_columns(row_inertia);
    out.friction = by_columns(row_friction);
    Eigen::MatrixXd read(row_inertia.rows(), 3 * modes);
    read << row_inertia * set.w2.asDiagonal() / InnerChain::kScale_radps,
        row_inertia * damping - row_friction, -row_inertia;
    out.read_out = by_rows(read);
    discretise(set.w2, damping, out);
    for (std::size_t p = 0; p < b_.parts.size(); ++p) {
      const Eigen::MatrixXd force = x_[static_cast<Eigen::Index>(p)] * b_.parts[p] * shapes;
      if (force.isZero(0)) continue;
      Eigen::MatrixXd on_modes(modes, modes + static_cast<Eigen::Index>(out.ends.size()));
      on_modes << shapes.transpose() * force,
          Eigen::MatrixXd(at_ends_.transpose() * force)(out.ends, Eigen::all).transpose();
      out.forces.push_back({static_cast<int>(p), b_.damping[p] != 0, by_columns(on_modes),
                            by_columns(rows(at_ends_.transpose() * force)(out.rows, Eigen::all))});
    }
    return out;
  }

  /// Returns all rows of the floors that these measured coordinates belong to.
  std::vector<int> rows_at(const std::vector<int>& ends) const {
    std::vector<int> out;
    for (std::size_t f = 0; f + 1 < b_.floors.size(); ++f)
      if (std::any_of(ends.begin(), ends.end(),
                      [&](int e) { return e >= b_.floors[f] && e < b_.floors[f + 1]; }))
        for (int i = b_.floors[f]; i < b_.floors[f + 1]; ++i) out.push_back(i - b_.inputs);
    return out;
  }

  void discretise(const Eigen::VectorXd& w2, const Eigen::MatrixXd& damping,
                  InnerChain& out) const {
    const Eigen::Index m = w2.size();
    const double step = 1 / rate_hz_, scale = InnerChain::kScale_radps;
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(4 * m, 4 * m);
    a.block(0, m, m, m).diagonal().setConstant(scale * step);
    a.block(m, 0, m, m).diagonal() = -w2 * step / scale;
    a.block(m, m, m, m) = -damping * step;
    const auto values = general_eigenvalues(a.topLeftCorner(2 * m, 2 * m));
    out.slowest_radps = std::numeric_limits<double>::infinity();
    for (const auto& value : values)
      out.slowest_radps = std::min(out.slowest_radps, -value.real() / step);
    out.poles = pole_pairs({values.begin(), values.end()});
    a.block(m, 2 * m, m, m).diagonal().setConstant(step);
    a.block(2 * m, 3 * m, m, m).setIdentity();
    const Eigen::MatrixXd e = matrix_exponential(a);
    Eigen::MatrixXd transition(2 * m, 4 * m);
    transition << e.topLeftCorner(2 * m, 2 * m),
        e.block(0, 2 * m, 2 * m, m) - e.block(0, 3 * m, 2 * m, m), e.block(0, 3 * m, 2 * m, m);
    out.transition = by_rows(transition);
    out.transition_columns = by_columns(transition);
  }

  const ReducedBuilding& b_;
  const Eigen::VectorXd& x_;
  double rate_hz_;
  InnerModes modes_;
  Eigen::MatrixXd stiffness_, damping_;
  Eigen::MatrixXd at_ends_;     ///< static motion of all coordinates by the measured ones
  Eigen::MatrixXd mass_;        ///< mass of the measured coordinates and the floors they carry
  Eigen::MatrixXd projection_;  ///< rows by equations of the measured floors
  std::vector<double> frequency_hz_;
  std::vector<SetModes> sets_;
};

}  // namespace

GroupEquations group_equations(const ReducedBuilding& building, const Eigen::VectorXd& x,
                               double rate_hz, InnerModes modes) {
  if (building.rows() == 0) return {};
  return Builder(building, x, rate_hz, modes).equations();
}

namespace {

constexpr int kSignals = AxisMotion::kSignals;

/// out += matrix x. The matrix is stored by columns.
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
  // by_* are stored by columns, so rows vary fastest.
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
      // A hold does not attenuate what acts at once.
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

  // The accelerations of the modes follow from the forces and the spring forces.
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
  if (chain.forces.empty()) return;  // no identified parameter moves it
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
      response_[size(row)] += derivative;  // h x = z: the part linear in x about the tuning
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
