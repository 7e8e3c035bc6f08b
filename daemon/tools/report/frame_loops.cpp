// SPDX-License-Identifier: MIT
#include "daemon/tools/report/frame_loops.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include <fmt/core.h>

#include "estimator/diagnose/spectra/fourier.h"
#include "estimator/structure/matrices.h"

namespace framewatch::daemon {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Finds the sensor of every degree of freedom, and the mean of the base's along its direction.
struct Places {
  std::vector<int> axis;  ///< -1: no sensor
  std::vector<int> base[2];
};

Places places(const estimator::Structure& s, const SessionMotion& m) {
  Places out{std::vector<int>(static_cast<std::size_t>(s.degrees_of_freedom()), -1), {}};
  for (std::size_t a = 0; a < m.axes.size(); ++a) {
    const estimator::SensorAxis& axis = m.axes[a];
    if (!axis.horizontal()) continue;
    if (axis.story == 0)
      out.base[axis.direction == estimator::Direction::x ? 0 : 1].push_back(static_cast<int>(a));
    else if (axis.frame >= 0)
      out.axis[static_cast<std::size_t>(s.dof(axis.story, axis.frame))] = static_cast<int>(a);
  }
  return out;
}

/// Returns the first of `size` rows within first..end-1, all finite, whose middle has the largest
/// floor acceleration.
Index strongest(const SessionMotion& m, Index size, Index first, Index end) {
  VectorXd most = VectorXd::Zero(m.accel.rows());
  for (std::size_t a = 0; a < m.axes.size(); ++a) {
    if (m.axes[a].story == 0 || m.axes[a].is_force) continue;
    const VectorXd column = m.accel.col(static_cast<Index>(a));
    double sum = 0, count = 0;
    for (const double v : column) {
      if (!std::isfinite(v)) continue;
      sum += v;
      ++count;
    }
    const double mean = count > 0 ? sum / count : 0;
    for (Index i = 0; i < column.size(); ++i)
      if (std::isfinite(column[i])) most[i] = std::max(most[i], std::abs(column[i] - mean));
  }
  Index best = -1;
  double best_value = -1;
  const Index step = std::max<Index>(1, size / 20);
  for (Index from = first; from + size <= end; from += step) {
    const double value = most.segment(from + size / 6, size * 2 / 3).squaredNorm();
    if (value > best_value && m.accel.middleRows(from, size).allFinite()) {
      best_value = value;
      best = from;
    }
  }
  return best;
}

/// Acceleration, velocity and displacement of one channel behind one high-pass.
struct Motion {
  VectorXd accel, velocity, displacement;
};

Motion integrated(VectorXd accel, double rate_hz, double high_pass_hz) {
  const Index size = accel.size(), ramp = size / 6;
  accel.array() -= accel.mean();
  for (Index i = 0; i < ramp; ++i) {
    const double part =
        0.5 - 0.5 * std::cos(std::numbers::pi * static_cast<double>(i) / static_cast<double>(ramp));
    accel[i] *= part;
    accel[size - 1 - i] *= part;
  }
  Eigen::VectorXcd a = estimator::forward_fourier(accel), v = a, d = a;
  for (Index k = 0; k < a.size(); ++k) {
    const double f = static_cast<double>(k) * rate_hz / static_cast<double>(size);
    const double w = 2 * std::numbers::pi * f;
    const double gain = 1 / (1 + std::pow(high_pass_hz / std::max(f, 1e-9), 8));
    a[k] *= gain;
    v[k] = k == 0 ? 0 : a[k] / std::complex<double>(0, w);
    d[k] = k == 0 ? 0 : -a[k] / (w * w);
  }
  return {estimator::inverse_fourier(a, size), estimator::inverse_fourier(v, size),
          estimator::inverse_fourier(d, size)};
}

std::vector<double> shown(const VectorXd& all) {
  const Index ramp = all.size() / 6;
  return {all.data() + ramp, all.data() + all.size() - ramp};
}

}  // namespace

FrameLoops frame_loops(const estimator::Structure& s, const SessionMotion& m, const VectorXd& theta,
                       double high_pass_hz, double seconds, Index first, Index end) {
  FrameLoops out;
  const Places at = places(s, m);
  const Index size = estimator::smooth_size(
      std::min<Index>(static_cast<Index>(1.5 * seconds * m.rate_hz), end - first));
  const Index from = size > 6 * static_cast<Index>(m.rate_hz) ? strongest(m, size, first, end) : -1;
  if (std::count(at.axis.begin(), at.axis.end(), -1) > 0) out.reason = "a frame has no sensor";
  if (from < 0) out.reason = "no stretch of 6 s has all its samples";
  const estimator::ParameterTable table(s);
  const bool shared = s.floor == estimator::FloorModel::rigid && s.frames() > 1;
  for (int story = 1; story <= s.stories && !shared; ++story)
    for (int p = 0; p < s.panels(); ++p)
      if (!std::isfinite(theta[table.panel_stiffness(story, p)]))
        out.reason = "a floor panel's stiffness is not known, so its force is unknown";
  if (!out.reason.empty()) return out;

  const Index dofs = s.degrees_of_freedom();
  MatrixXd force(size, dofs), u(size, dofs), v(size, dofs);
  for (int story = 1; story <= s.stories; ++story)
    for (int f = 0; f < s.frames(); ++f) {
      const int dof = s.dof(story, f);
      const VectorXd accel =
          m.accel.col(at.axis[static_cast<std::size_t>(dof)]).segment(from, size);
      VectorXd base = VectorXd::Zero(size);
      const auto& columns = at.base[s.direction(f) == estimator::Direction::x ? 0 : 1];
      for (const int c : columns)
        base += m.accel.col(c).segment(from, size) / static_cast<double>(columns.size());
      const Motion absolute = integrated(accel, m.rate_hz, high_pass_hz);
      const Motion relative = integrated(accel - base, m.rate_hz, high_pass_hz);
      force.col(dof) = -s.frame_mass(story, f) * absolute.accel;
      u.col(dof) = relative.displacement;
      v.col(dof) = relative.velocity;
    }
  for (const estimator::Element& e : elements(s, table)) {
    if (e.panel < 0 || shared) continue;
    VectorXd shear = VectorXd::Zero(size), rate = VectorXd::Zero(size);
    for (const auto& [dof, b] : e.b) {
      shear += b * u.col(dof);
      rate += b * v.col(dof);
    }
    const double c = theta[e.stiffness + table.elements()];
    const VectorXd panel = theta[e.stiffness] * shear + (std::isfinite(c) ? c : 0) * rate;
    for (const auto& [dof, b] : e.b) force.col(dof) -= b * panel;
  }
  const auto add = [&](const std::string& name, int story, int parameter,
                       const std::vector<int>& frames) {
    VectorXd drift = VectorXd::Zero(size), shear = VectorXd::Zero(size);
    for (const int f : frames) {
      drift += u.col(s.dof(story, f)) / static_cast<double>(frames.size());
      if (story > 1) drift -= u.col(s.dof(story - 1, f)) / static_cast<double>(frames.size());
      for (int above = story; above <= s.stories; ++above) shear += force.col(s.dof(above, f));
    }
    FrameLoop loop{name, story, parameter, shown(drift), shown(shear), 0};
    for (const double d : loop.drift_m)
      loop.largest_drift_m = std::max(loop.largest_drift_m, std::abs(d));
    out.loops.push_back(std::move(loop));
  };
  for (int story = 1; story <= s.stories; ++story) {
    std::vector<int> along[2];
    for (int f = 0; f < s.frames(); ++f) {
      along[s.direction(f) == estimator::Direction::x ? 0 : 1].push_back(f);
      const int k = table.frame_stiffness(story, f);
      if (!shared) add(table[k].name, story, k, {f});
    }
    for (int d = 0; d < 2 && shared; ++d)
      if (!along[d].empty())
        add(fmt::format("story {}, {}", story, d == 0 ? "x" : "y"), story, -1, along[d]);
  }
  out.from_us = m.time_us(from + size / 6);
  out.to_us = m.time_us(from + size - 1 - size / 6);
  return out;
}

}  // namespace framewatch::daemon
