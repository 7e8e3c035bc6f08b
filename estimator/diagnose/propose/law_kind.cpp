// SPDX-License-Identifier: MIT
#include "estimator/diagnose/propose/law_kind.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "estimator/diagnose/propose/needed_signal.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr int kCells = 15;
constexpr int kMinCount = 3;     ///< samples of a cell that is shown
constexpr int kTimes = 8;        ///< supports of a stiffness that varies in time
constexpr int kClearances = 12;  ///< tried, up to the largest deformation

/// Column in time of one record.
using Columns = std::vector<VectorXd>;

struct Scales {
  double d = 1e-300, v = 1e-300;
};

Columns powers(const NeededSignal& n, const Scales& s) {
  const auto x = (n.d_t / s.d).array().eval();
  return {x * x.abs(), x.cube(), x.square(), x.cube() * x.square()};
}

/// Returns the forces of springs of unit stiffness with dashpots beyond a clearance: against
/// positive and against negative deformation. They only push.
Columns contact(const NeededSignal& n, const Scales& s, double clearance, double dashpot = 0) {
  const auto x = (n.d_t / s.d).array().eval();
  const auto damped = (dashpot * n.v_t / s.v).array().eval();
  const auto side = [&](double sign) -> VectorXd {
    const auto in = (sign * x - clearance).eval();
    return sign * (in > 0).select((in + sign * damped).cwiseMax(0), 0.0);
  };
  return {side(1), side(-1)};
}

/// Returns powers and a broken line.
Columns functions(const NeededSignal& n, const Scales& s) {
  Columns out = powers(n, s);
  for (const double at : {0.15, 0.3, 0.45, 0.6, 0.75, 0.9})
    for (VectorXd& column : contact(n, s, at)) out.push_back(std::move(column));
  return out;
}

Columns rates(const NeededSignal& n, const Scales& s) {
  const auto x = (n.v_t / s.v).array().eval();
  const auto d = (n.d_t / s.d).array().eval();
  Columns out{x * x.abs(), x.cube(), x * d.abs(), x * d.square()};
  for (const double width : {0.01, 0.05, 0.2}) out.push_back((x / width).tanh());
  return out;
}

/// Returns the force of a spring that yields at `limit`, over its stiffness.
VectorXd stopped(const VectorXd& d, double limit) {
  VectorXd out(d.size());
  double slider = 0;
  for (Index i = 0; i < d.size(); ++i) {
    out[i] = std::clamp(d[i] - slider, -limit, limit);
    slider = d[i] - out[i];
  }
  return out;
}

/// Returns the force, over its stiffness, of a spring that yields at `limit` and stays slack by its
/// plastic deformation.
VectorXd slackened(const VectorXd& d, double limit) {
  VectorXd out(d.size());
  double up = 0, down = 0;
  for (Index i = 0; i < d.size(); ++i) {
    out[i] = std::clamp(d[i] - up, 0.0, limit) - std::clamp(-d[i] - down, 0.0, limit);
    up = std::max(up, d[i] - limit);
    down = std::max(down, -d[i] - limit);
  }
  return out;
}

/// Returns the path length of the deformation up to each instant, as a share of the whole path.
VectorXd way(const VectorXd& d) {
  VectorXd out(d.size());
  double sum = 0;
  for (Index i = 0; i < d.size(); ++i) out[i] = sum += i > 0 ? std::abs(d[i] - d[i - 1]) : 0;
  return out / std::max(sum, 1e-300);
}

/// Returns stop operators, their products with the deformation (pinching) and with the path length
/// (degradation), and slack springs.
Columns memories(const NeededSignal& n, const Scales& s) {
  const VectorXd x = n.d_t / s.d;
  Columns out;
  for (const double limit : {0.005, 0.03, 0.1, 0.2, 0.4, 0.7}) out.push_back(stopped(x, limit));
  out.push_back(out[1].array() * x.array().abs());
  out.push_back(out[3].array() * x.array().abs());
  out.push_back(out[3].array() * x.array().square());
  const VectorXd gone = way(x);
  for (const std::size_t limit : {2, 3, 4, 5}) out.push_back(out[limit].cwiseProduct(gone));
  for (const double limit : {0.1, 0.3, 0.6}) out.push_back(slackened(x, limit));
  return out;
}

/// Returns the deformation weighted by hats in time. The first hat is left out because their sum is
/// the linear spring.
Columns times(const NeededSignal& n) {
  Columns out;
  const Index size = n.d_t.size();
  for (int k = 1; k < kTimes; ++k) {
    VectorXd hat(size);
    for (Index i = 0; i < size; ++i) {
      const double at = static_cast<double>(i) / static_cast<double>(size) * (kTimes - 1);
      hat[i] = std::max(0.0, 1 - std::abs(at - k));
    }
    out.push_back(hat.array() * n.d_t.array());
  }
  return out;
}

/// Returns the indices of the linear columns, then of some columns after them.
std::vector<Index> with_linear(Index linear, const std::vector<Index>& others) {
  std::vector<Index> out(static_cast<std::size_t>(linear));
  std::iota(out.begin(), out.end(), Index{0});
  for (const Index other : others) out.push_back(linear + other);
  return out;
}

class KindSearch {
 public:
  KindSearch(const Fitter& fitter, const std::vector<NeededSignal>& needed)
      : fitter_(fitter), needed_(needed) {
    for (const NeededSignal& n : needed) {
      scales_.d = std::max(scales_.d, n.d_t.cwiseAbs().maxCoeff());
      scales_.v = std::max(scales_.v, n.v_t.cwiseAbs().maxCoeff());
    }
  }

  KindOfLaw run() {
    const SearchSettings& settings = fitter_.settings();
    KindOfLaw out;
    double noise = 0;
    for (const RecordSegment& s : fitter_.segments()) noise += static_cast<double>(s.bins());
    const double linear = rest([](const NeededSignal&) { return Columns(); }, false);
    const double beyond = linear - noise;
    const auto share = [&](LawKind kind, double left) {
      out.share[static_cast<std::size_t>(kind)] =
          beyond > 0 ? std::clamp((linear - left) / beyond, 0.0, 1.0) : 0;
    };
    share(LawKind::elastic, rest([&](const NeededSignal& n) { return powers(n, scales_); }, false));
    const double smooth = out.share[static_cast<std::size_t>(LawKind::elastic)];
    share(LawKind::elastic,
          rest([&](const NeededSignal& n) { return functions(n, scales_); }, false));
    share(LawKind::impact, rest_of_clearance());
    share(LawKind::dissipative,
          rest([&](const NeededSignal& n) { return rates(n, scales_); }, false));
    share(LawKind::hysteretic,
          rest([&](const NeededSignal& n) { return memories(n, scales_); }, false));
    share(LawKind::time_varying, rest([](const NeededSignal& n) { return times(n); }, true));
    out.kind = linear < settings.beyond_linear * noise ? LawKind::linear : simplest(out.share);
    const double impact = out.share[static_cast<std::size_t>(LawKind::impact)];
    if (out.kind == LawKind::elastic && smooth < settings.explains &&
        1 - impact < settings.as_impact * (1 - smooth))
      out.kind = LawKind::impact;
    picture(out);
    return out;
  }

 private:
  /// Returns the misfit with a linear element. own: separate coefficients for every record.
  template <typename Make>
  double rest(const Make& make, bool own) const {
    return sums(make, own).fit().misfit;
  }

  template <typename Make>
  ScalarSums sums(const Make& make, bool own) const {
    ScalarSums out;
    for (std::size_t r = 0; r < needed_.size(); ++r) {
      const RecordSegment& s = fitter_.segments()[r];
      std::vector<VectorXcd> columns = linear_columns(needed_[r], s.w);
      const Columns more = make(needed_[r]);
      for (std::size_t other = 0; other < (own ? needed_.size() : 1); ++other)
        for (const VectorXd& column : more)
          columns.push_back(own && other != r ? VectorXcd(VectorXcd::Zero(s.bins()))
                                              : band_of(column, s, fitter_.ratio(r)));
      const ScalarSums one = scalar_sums(needed_[r], columns);
      if (r == 0)
        out = one;
      else
        out += one;
    }
    return out;
  }

  /// Returns the misfit with springs and dashpots that push beyond the best clearance, on one side
  /// or both.
  double rest_of_clearance() const {
    const Index linear = needed_.front().has_mass ? 3 : 2;
    const std::vector<Index> sides[] = {with_linear(linear, {0}), with_linear(linear, {1}),
                                        with_linear(linear, {0, 1})};
    double best = rest([](const NeededSignal&) { return Columns(); }, false);
    for (const double dashpot : {0.0, 0.1, 0.3, 1.0, 3.0})
      for (int i = 1; i <= kClearances; ++i) {
        const double clearance = static_cast<double>(i) / (kClearances + 1);
        const ScalarSums all = sums(
            [&](const NeededSignal& n) { return contact(n, scales_, clearance, dashpot); }, false);
        for (const std::vector<Index>& kept : sides) {
          const ScalarFit fit =
              ScalarSums{all.normal(kept, kept), all.right(kept), all.total}.fit();
          const auto springs = static_cast<Index>(kept.size()) - linear;
          if (fit.coefficients.tail(springs).minCoeff() > 0) best = std::min(best, fit.misfit);
        }
      }
    return best;
  }

  LawKind simplest(const std::array<double, 7>& share) const {
    const SearchSettings& settings = fitter_.settings();
    const double best = *std::max_element(share.begin(), share.end());
    if (best < settings.kind_follows) return LawKind::external;
    for (const LawKind kind : {LawKind::elastic, LawKind::dissipative, LawKind::impact,
                               LawKind::time_varying, LawKind::hysteretic})
      if (share[static_cast<std::size_t>(kind)] >= settings.simpler_kind * best) return kind;
    return LawKind::hysteretic;
  }

  void picture(KindOfLaw& out) const {
    RestoringSurface& to = out.surface;
    to.d_m = VectorXd::LinSpaced(kCells, -scales_.d, scales_.d);
    to.v_mps = VectorXd::LinSpaced(kCells, -scales_.v, scales_.v);
    to.force_n = Eigen::MatrixXd::Zero(kCells, kCells);
    to.count = Eigen::MatrixXi::Zero(kCells, kCells);
    const auto cell = [](double x, double peak) {
      const double at = (x / peak + 1) / 2 * (kCells - 1);
      return std::clamp<Index>(static_cast<Index>(std::lround(at)), 0, kCells - 1);
    };
    double strongest = 0;
    for (std::size_t r = 0; r < needed_.size(); ++r) {
      const RecordSegment& s = fitter_.segments()[r];
      const int ratio = fitter_.ratio(r);
      const VectorXd force = signal_of(beyond_linear(s, needed_[r]), s, ratio);
      const VectorXd &d = needed_[r].d_t, &v = needed_[r].v_t;
      for (Index i = 0; i < force.size(); ++i) {
        const Index a = cell(d[i], scales_.d), b = cell(v[i], scales_.v);
        to.force_n(a, b) += force[i];
        ++to.count(a, b);
      }
      const double peak = d.cwiseAbs().maxCoeff();
      if (peak <= strongest) continue;
      strongest = peak;
      out.d_m.resize(force.size() / ratio);
      out.force_n.resize(out.d_m.size());
      for (Index i = 0; i < out.d_m.size(); ++i) {
        out.d_m[i] = d[i * ratio];
        out.force_n[i] = force[i * ratio];
      }
    }
    for (Index i = 0; i < to.force_n.size(); ++i) {
      const int count = to.count.data()[i];
      to.force_n.data()[i] = count < kMinCount ? std::numeric_limits<double>::quiet_NaN()
                                               : to.force_n.data()[i] / count;
    }
  }

  const Fitter& fitter_;
  const std::vector<NeededSignal>& needed_;
  Scales scales_;
};

}  // namespace

const char* law_kind_word(LawKind kind) {
  switch (kind) {
    case LawKind::linear:
      return "linear";
    case LawKind::elastic:
      return "elastic";
    case LawKind::impact:
      return "impact";
    case LawKind::dissipative:
      return "dissipative";
    case LawKind::hysteretic:
      return "hysteretic";
    case LawKind::time_varying:
      return "time_varying";
    case LawKind::external:
      break;
  }
  return "external";
}

bool is_of_kind(EffectKind law, LawKind kind) {
  switch (law) {
    case EffectKind::cubic_stiffness:
    case EffectKind::quadratic_stiffness:
      return kind == LawKind::elastic;
    case EffectKind::amplitude_dependence:
      return kind == LawKind::elastic || kind == LawKind::hysteretic;
    case EffectKind::one_sided_gap:
    case EffectKind::two_sided_gap:
      return kind == LawKind::impact;
    case EffectKind::quadratic_damping:
      return kind == LawKind::dissipative;
    case EffectKind::coulomb_friction:
      return kind == LawKind::dissipative || kind == LawKind::hysteretic;
    case EffectKind::bilinear_hysteresis:
    case EffectKind::bouc_wen:
    case EffectKind::pinching:
      return kind == LawKind::hysteretic;
    case EffectKind::stiffness_drop:
    case EffectKind::stiffness_drift:
      return kind == LawKind::time_varying;
    default:
      return false;
  }
}

bool is_of_deformation(EffectKind law) {
  return is_of_kind(law, LawKind::elastic) || is_of_kind(law, LawKind::impact);
}

bool follows_motion(LawKind kind) {
  return kind == LawKind::elastic || kind == LawKind::impact || kind == LawKind::dissipative ||
         kind == LawKind::hysteretic;
}

KindOfLaw kind_of_law(const Fitter& fitter, const std::vector<NeededSignal>& needed) {
  return KindSearch(fitter, needed).run();
}

}  // namespace framewatch::estimator
