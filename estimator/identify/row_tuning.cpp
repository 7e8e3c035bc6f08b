#include "estimator/identify/row_tuning.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Eigenvalues>

namespace framewatch {
namespace {

/// Matched filters above this share of the sampling rate leave the triple's accurate band.
constexpr double kHighestCorner = 0.2;
/// Periods of the high-pass after which its impulse response is forgotten.
constexpr double kDecay = 3;

}  // namespace

RowTuning::RowTuning(const Structure& structure, const FloorLayout& layout,
                     const Deformations& deformations, const EstimatorOptions& options,
                     const DerivativeTriple& triple, const HighPass& high_pass,
                     const Eigen::VectorXd& theta0, std::vector<double> noise_density)
    : layout_(&layout),
      deformations_(&deformations),
      options_(&options),
      noise_filter_(triple, high_pass,
                    static_cast<std::size_t>(kDecay * options.rate_hz / options.high_pass_hz)),
      theta0_(theta0),
      noise_density_(noise_density.empty() ? deformations.noise_density()
                                           : std::move(noise_density)) {
  for (int story = 1; story <= structure.stories; ++story)
    for (int f = 0; f < structure.frames(); ++f) mass_.push_back(structure.frame_mass(story, f));
  if (structure.floor == FloorModel::rigid) constraint_ = floor_constraint(structure);
}

std::vector<int> RowTuning::usable_equations(int floor,
                                             const std::vector<std::uint8_t>& known) const {
  const int frames = layout_->frames();
  const auto is_known = [&](int level, int f) {
    return known[static_cast<std::size_t>(level * frames + f)] != 0;
  };
  std::vector<int> usable;
  for (int f = 0; f < frames; ++f) {
    bool ok = is_known(floor + 1, f) && is_known(floor, f) &&
              (layout_->next(floor) == 0 || is_known(floor + 2, f));
    for (int p = 2 * frames; ok && p < 2 * frames + layout_->panels(); ++p) {
      if (layout_->coefficient(p, f) == 0) continue;
      for (int g = 0; g < frames; ++g)
        ok = ok && (layout_->coefficient(p, g) == 0 || is_known(floor + 1, g));
    }
    if (ok) usable.push_back(f);
  }
  return usable;
}

Eigen::MatrixXd RowTuning::floor_stiffness(int floor, const Eigen::VectorXd& theta) const {
  const int frames = layout_->frames();
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(frames, frames);
  const auto add = [&](int position, double stiffness) {
    Eigen::VectorXd b(frames);
    for (int f = 0; f < frames; ++f) b[f] = layout_->coefficient(position, f);
    k += stiffness * b * b.transpose();
  };
  for (int f = 0; f < frames; ++f) {
    add(f, theta[layout_->parameter(floor, f)]);
    if (layout_->next(floor) > 0) add(layout_->own() + f, theta[layout_->parameter(floor + 1, f)]);
  }
  for (int p = 2 * frames; p < 2 * frames + layout_->panels(); ++p)
    add(p, theta[layout_->parameter(floor, p)]);
  return k;
}

Eigen::MatrixXd RowTuning::floor_modes(int floor, const std::vector<int>& equations,
                                       const Eigen::VectorXd& theta,
                                       Eigen::VectorXd& frequency_hz) const {
  const int frames = layout_->frames();
  const int first = floor * frames;
  const auto count = static_cast<Eigen::Index>(equations.size());
  Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(frames, count);
  if (constraint_.size() > 0) {
    if (count < frames) return Eigen::MatrixXd(frames, 0);
    std::vector<Eigen::Index> columns;
    for (Eigen::Index c = 0; c < constraint_.cols(); ++c)
      if (!constraint_.block(first, c, frames, 1).isZero(0)) columns.push_back(c);
    basis.resize(frames, static_cast<Eigen::Index>(columns.size()));
    for (std::size_t c = 0; c < columns.size(); ++c)
      basis.col(static_cast<Eigen::Index>(c)) = constraint_.block(first, columns[c], frames, 1);
  } else {
    for (Eigen::Index c = 0; c < count; ++c) {
      const int f = equations[static_cast<std::size_t>(c)];
      basis(f, c) = 1 / std::sqrt(mass(floor, f));
    }
  }
  const Eigen::MatrixXd k = basis.transpose() * floor_stiffness(floor, theta) * basis;
  if (options_->variant == Variant::paper) {
    frequency_hz = Eigen::VectorXd::Constant(basis.cols(), options_->high_pass_hz);
    for (Eigen::Index c = 0; c < basis.cols() && constraint_.size() == 0; ++c)
      basis.col(c) *= std::sqrt(mass(floor, equations[static_cast<std::size_t>(c)]));
    return basis;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(k);
  frequency_hz =
      (options_->corner_ratio * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt() / (2 * M_PI))
          .cwiseMin(kHighestCorner * options_->rate_hz)
          .cwiseMax(options_->high_pass_hz);
  return basis * solver.eigenvectors();
}

void RowTuning::weigh(int floor, int r, const Eigen::VectorXd& phi, const FloorNoise& floor_noise,
                      FloorRows& out) const {
  const int frames = layout_->frames();
  const int unknowns = layout_->own() + layout_->next(floor);
  const auto row = static_cast<std::size_t>(r);
  const NoiseMoments noise = noise_filter_.through(out.gain[row], out.a1[row], out.a2[row]);

  Eigen::VectorXd force(unknowns);  // of the element, projected on the row, per unit deformation
  for (int p = 0; p < unknowns; ++p) {
    double projected = 0;
    for (int f = 0; f < frames; ++f) projected += layout_->coefficient(p, f) * phi[f];
    force[p] = projected * (p < layout_->own() ? design_at(floor, p)
                                               : design_at(floor + 1, p - layout_->own()));
  }
  Eigen::VectorXd inertia(frames);
  for (int f = 0; f < frames; ++f) inertia[f] = phi[f] * mass(floor, f);
  const auto axes = floor_noise.variance.size();
  const Eigen::RowVectorXd m = inertia.transpose() * floor_noise.motion;
  Eigen::RowVectorXd k = Eigen::RowVectorXd::Zero(axes);
  Eigen::RowVectorXd c = Eigen::RowVectorXd::Zero(axes);
  for (int p = 0; p < unknowns; ++p)
    (floor_noise.damping[static_cast<std::size_t>(p)] ? c : k) +=
        force[p] * floor_noise.deformation.row(p);
  double variance = 0;
  for (Eigen::Index a = 0; a < axes; ++a)
    variance += floor_noise.variance[a] * (m[a] * m[a] * noise.g22 + c[a] * c[a] * noise.g11 +
                                           k[a] * k[a] * noise.g00 + 2 * m[a] * k[a] * noise.g20);
  const double root_weight =
      options_->variant == Variant::paper || variance <= 0 ? 1.0 : 1 / std::sqrt(variance);
  out.noise_residual += root_weight * root_weight * variance;

  const int stride = padded(layout_->front(floor));
  double* beta = &out.beta[row * static_cast<std::size_t>(stride)];
  for (int p = 0; p < unknowns; ++p) beta[p] = root_weight * force[p];
  beta[unknowns] = root_weight;
  for (int f = 0; f < frames; ++f)
    out.response[row * static_cast<std::size_t>(frames) + static_cast<std::size_t>(f)] = -phi[f];
  out.noise_response +=
      root_weight * root_weight * noise.g22 * m.cwiseAbs2().dot(floor_noise.variance.transpose());
  const Eigen::VectorXd common =
      floor_noise.deformation * floor_noise.variance.cwiseProduct(m.transpose());
  for (int p = 0; p < unknowns; ++p) {
    // The response is -m p'': noise in p'' and p moves together, in p'' and p' it does not.
    if (!floor_noise.damping[static_cast<std::size_t>(p)])
      out.noise_right[static_cast<std::size_t>(p)] -= root_weight * beta[p] * common[p] * noise.g20;
    for (int q = p; q < unknowns; ++q) {
      const bool damping = floor_noise.damping[static_cast<std::size_t>(p)];
      if (damping != floor_noise.damping[static_cast<std::size_t>(q)]) continue;
      out.noise_energy[static_cast<std::size_t>(p * unknowns + q)] +=
          beta[p] * beta[q] * floor_noise.covariance(p, q) * (damping ? noise.g11 : noise.g00);
    }
  }
}

void RowTuning::pack_noise(int floor, FloorRows& out) const {
  const int front = layout_->front(floor);
  const int stride = padded(front);
  const int unknowns = front - 1;
  Eigen::MatrixXd part = Eigen::MatrixXd::Zero(front, stride);
  double whole = 0;
  for (int p = 0; p < unknowns; ++p)
    part(p, unknowns) = out.noise_right[static_cast<std::size_t>(p)];
  for (int p = 0; p < unknowns; ++p) {
    for (int q = p; q < unknowns; ++q) {
      const double w = out.noise_energy[static_cast<std::size_t>(p * unknowns + q)];
      out.noise_energy[static_cast<std::size_t>(q * unknowns + p)] = w;
      part(p, q) = kTakenOff * w;
      part(p, unknowns) -= (1 - kTakenOff) * w;
      if (q != p) part(q, unknowns) -= (1 - kTakenOff) * w;
      whole += q == p ? w : 2 * w;
    }
  }
  part(unknowns, unknowns) = out.noise_response - (1 - kTakenOff) * whole;
  for (int i = 0; i < front; ++i)
    for (int j = packed_row_begin(i); j < stride; ++j)
      out.noise_taken_off.push_back(j >= i ? part(i, j) : part(j, i));
}

double RowTuning::damping() const {
  return options_->variant == Variant::paper ? std::sqrt(0.5) : options_->filter_damping;
}

std::vector<int> RowTuning::all_frames() const {
  std::vector<int> all(static_cast<std::size_t>(layout_->frames()));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

int RowTuning::settle_rows(int least) const {
  const std::vector<int> all = all_frames();
  double slowest_hz = kHighestCorner * options_->rate_hz;
  for (int floor = 0; floor < layout_->floors(); ++floor) {
    Eigen::VectorXd frequency;
    floor_modes(floor, all, theta0_, frequency);
    slowest_hz = std::min(slowest_hz, frequency.minCoeff());
  }
  const double settle_s = 3 / (damping() * 2 * M_PI * slowest_hz);
  return std::max(least, static_cast<int>(std::ceil(settle_s * options_->rate_hz)));
}

double RowTuning::detuning(const Eigen::VectorXd& theta) const {
  const std::vector<int> all = all_frames();
  double worst = 0;
  for (int floor = 0; floor < layout_->floors(); ++floor) {
    Eigen::VectorXd now, then;
    floor_modes(floor, all, theta0_, now);
    floor_modes(floor, all, theta, then);
    for (Eigen::Index r = 0; r < now.size(); ++r)
      worst = std::max(worst, std::abs(then[r] / now[r] - 1));
  }
  return worst;
}

FloorRows RowTuning::rows(int floor, const std::vector<std::uint8_t>& known) const {
  const std::vector<int> equations = usable_equations(floor, known);
  FloorRows out;
  Eigen::VectorXd frequency;
  const Eigen::MatrixXd modes =
      equations.empty() ? Eigen::MatrixXd() : floor_modes(floor, equations, theta0_, frequency);
  out.rows = static_cast<int>(modes.cols());
  const auto rows = static_cast<std::size_t>(out.rows);
  const auto frames = static_cast<std::size_t>(layout_->frames());
  out.beta.assign(rows * static_cast<std::size_t>(padded(layout_->front(floor))), 0.0);
  out.response.assign(rows * frames, 0.0);
  const auto unknowns = static_cast<std::size_t>(layout_->front(floor) - 1);
  out.noise_energy.assign(unknowns * unknowns, 0.0);
  out.noise_right.assign(unknowns, 0.0);
  const FloorNoise noise =
      floor_noise(*layout_, *deformations_, noise_density_, options_->rate_hz, floor);
  const double zeta = damping();
  for (int r = 0; r < out.rows; ++r) {
    const double w = std::tan(M_PI * frequency[r] / options_->rate_hz);
    const double norm = 1 / (1 + 2 * zeta * w + w * w);
    out.a1.push_back(2 * (w * w - 1) * norm);
    out.a2.push_back((1 - 2 * zeta * w + w * w) * norm);
    out.gain.push_back(4 * w * w * norm);
    out.frequency_hz.push_back(frequency[r]);
    weigh(floor, r, modes.col(r), noise, out);
  }
  pack_noise(floor, out);
  return out;
}

}  // namespace framewatch
