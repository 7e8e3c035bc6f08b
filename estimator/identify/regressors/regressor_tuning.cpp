// SPDX-License-Identifier: MIT
#include "estimator/identify/regressors/regressor_tuning.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "estimator/numeric/kernels.h"

namespace framewatch::estimator {
namespace {

/// Highest corner as a share of the sampling rate: the derivative triple is accurate up to there.
constexpr double kHighestCorner = 0.2;
/// Periods of the high-pass in which its impulse response decays.
constexpr double kDecay = 3;

}  // namespace

RegressorTuning::RegressorTuning(const Structure& structure, const FloorLayout& layout,
                                 const Deformations& deformations, const EstimatorOptions& options,
                                 const DerivativeTriple& triple, const HighPass& high_pass,
                                 const Eigen::VectorXd& theta0, std::vector<double> noise_density)
    : layout_(&layout),
      options_(&options),
      high_pass_poles_{high_pass.a1, high_pass.a2},
      noise_filter_(triple, high_pass,
                    static_cast<std::size_t>(kDecay * options.rate_hz / options.high_pass_hz)),
      theta0_(theta0),
      noise_density_(noise_density.empty() ? deformations.noise_density()
                                           : std::move(noise_density)),
      perturbed_(layout),
      eigen_(layout.frames()) {
  const int frames = layout.frames();
  for (int story = 1; story <= structure.stories; ++story)
    for (int f = 0; f < frames; ++f) mass_.push_back(structure.frame_mass(story, f));
  if (structure.floor == FloorModel::rigid) constraint_ = floor_constraint(structure);
  for (Eigen::MatrixXd* work : {&basis_, &modes_, &stiffness_}) work->setZero(frames, frames);
  for (Eigen::VectorXd* work : {&frequency_hz_, &inertia_}) work->setZero(frames);
  const int unknowns = layout.own() + 2 * frames;
  for (Eigen::VectorXd* work : {&force_, &common_}) work->setZero(unknowns);
  projected_.resize(static_cast<std::size_t>(frames * frames));
  for (int floor = 0; floor < layout.floors(); ++floor) {
    noise_.push_back(floor_noise(layout, deformations, noise_density_, options.rate_hz, floor));
  }
  rows_.resize(static_cast<std::size_t>(layout.floors()));
  for (int floor = 0; floor < layout.floors(); ++floor) tune(floor);
}

void RegressorTuning::set_theta0(const Eigen::VectorXd& theta0,
                                 const std::vector<double>& noise_density) {
  theta0_ = theta0;
  noise_density_ = noise_density;
}

void RegressorTuning::tune(int floor) {
  FloorNoise& noise = noise_[static_cast<std::size_t>(floor)];
  set_noise_density(noise, noise_density_, options_->rate_hz);
  take_all_equations();
  form(floor, rows_[static_cast<std::size_t>(floor)]);
}

void RegressorTuning::take_all_equations() {
  equations_.resize(static_cast<std::size_t>(layout_->frames()));
  std::iota(equations_.begin(), equations_.end(), 0);
}

void RegressorTuning::take_usable_equations(int floor, const std::vector<std::uint8_t>& known) {
  const int frames = layout_->frames();
  const auto is_known = [&](int level, int f) {
    return known[static_cast<std::size_t>(level * frames + f)] != 0;
  };
  equations_.clear();
  for (int f = 0; f < frames; ++f) {
    bool ok = is_known(floor + 1, f) && is_known(floor, f) &&
              (layout_->next(floor) == 0 || is_known(floor + 2, f));
    for (int p = 2 * frames; ok && p < 2 * frames + layout_->panels(); ++p) {
      if (layout_->coefficient(p, f) == 0) continue;
      for (int g = 0; g < frames; ++g)
        ok = ok && (layout_->coefficient(p, g) == 0 || is_known(floor + 1, g));
    }
    if (ok) equations_.push_back(f);
  }
}

void RegressorTuning::floor_stiffness(int floor, const Eigen::VectorXd& theta) {
  const int frames = layout_->frames();
  stiffness_.setZero();
  const auto add = [&](int position, double stiffness) {
    for (int f = 0; f < frames; ++f)
      for (int g = 0; g < frames; ++g)
        stiffness_(f, g) +=
            stiffness * layout_->coefficient(position, f) * layout_->coefficient(position, g);
  };
  for (int f = 0; f < frames; ++f) {
    add(f, theta[layout_->parameter(floor, f)]);
    if (layout_->next(floor) > 0) add(layout_->own() + f, theta[layout_->parameter(floor + 1, f)]);
  }
  for (int p = 2 * frames; p < 2 * frames + layout_->panels(); ++p)
    add(p, theta[layout_->parameter(floor, p)]);
}

/// Computes the modes of the present equations into the first columns of modes_ and frequency_hz_.
/// Returns their number.
int RegressorTuning::floor_modes(int floor, const Eigen::VectorXd& theta) {
  const int frames = layout_->frames();
  const auto count = static_cast<int>(equations_.size());
  int rows = 0;
  basis_.setZero();
  if (constraint_.size() > 0) {
    if (count < frames) return 0;
    for (Eigen::Index c = 0; c < constraint_.cols(); ++c) {
      const auto column = constraint_.block(floor * frames, c, frames, 1);
      if (!column.isZero(0)) basis_.col(rows++) = column;
    }
  } else {
    const bool paper = options_->variant == Variant::paper;
    for (const int f : equations_) basis_(f, rows++) = paper ? 1 : 1 / std::sqrt(mass(floor, f));
  }
  if (options_->variant == Variant::paper) {
    modes_ = basis_;
    frequency_hz_.setConstant(options_->high_pass_hz);
    return rows;
  }
  floor_stiffness(floor, theta);
  for (int r = 0; r < rows; ++r) {
    for (int s = 0; s < rows; ++s) {
      double sum = 0;
      for (int f = 0; f < frames; ++f)
        for (int g = 0; g < frames; ++g) sum += basis_(f, r) * stiffness_(f, g) * basis_(g, s);
      projected_[static_cast<std::size_t>(r * rows + s)] = sum;
    }
  }
  eigen_.compute(projected_.data(), rows);
  for (int r = 0; r < rows; ++r) {
    const double w = std::sqrt(std::max(eigen_.value(r), 0.0));
    frequency_hz_[r] = std::max(
        std::min(options_->corner_ratio * w / (2 * M_PI), kHighestCorner * options_->rate_hz),
        options_->high_pass_hz);
    for (int f = 0; f < frames; ++f) {
      modes_(f, r) = 0;
      for (int s = 0; s < rows; ++s) modes_(f, r) += basis_(f, s) * eigen_.vector(s, r);
    }
  }
  return rows;
}

void RegressorTuning::weigh(int floor, int r, const OscillatorSection& section, FloorRows& out) {
  const int frames = layout_->frames();
  const int unknowns = layout_->own() + layout_->next(floor);
  const auto row = static_cast<std::size_t>(r);
  const auto phi = modes_.col(r);
  const FloorNoise& noise = noise_[static_cast<std::size_t>(floor)];
  const NoiseMoments moments = noise_filter_.through(section);

  for (int p = 0; p < unknowns; ++p) {  // force of the element on the row per unit deformation
    double projected = 0;
    for (int f = 0; f < frames; ++f) projected += layout_->coefficient(p, f) * phi[f];
    force_[p] = projected * (p < layout_->own() ? theta0_at(floor, p)
                                                : theta0_at(floor + 1, p - layout_->own()));
  }
  for (int f = 0; f < frames; ++f) inertia_[f] = phi[f] * mass(floor, f);
  const Eigen::Index axes = noise.variance.size();
  // The noise of each axis enters the row through mass, stiffness and damping.
  double variance = 0, response = 0;
  common_.setZero();
  for (Eigen::Index a = 0; a < axes; ++a) {
    double m = 0, k = 0, c = 0;
    for (int f = 0; f < frames; ++f) m += inertia_[f] * noise.motion(f, a);
    for (int p = 0; p < unknowns; ++p)
      (noise.damping[static_cast<std::size_t>(p)] ? c : k) += force_[p] * noise.deformation(p, a);
    const double v = noise.variance[a];
    variance += v * (m * m * moments.g22 + c * c * moments.g11 + k * k * moments.g00 +
                     2 * m * k * moments.g20);
    response += v * m * m;
    for (int p = 0; p < unknowns; ++p) common_[p] += noise.deformation(p, a) * v * m;
  }
  const double root_weight =
      options_->variant == Variant::paper || variance <= 0 ? 1.0 : 1 / std::sqrt(variance);
  out.noise_residual += root_weight * root_weight * variance;

  const int stride = padded(layout_->front(floor));
  double* beta = &out.beta[row * static_cast<std::size_t>(stride)];
  for (int p = 0; p < unknowns; ++p) beta[p] = root_weight * force_[p];
  beta[unknowns] = root_weight;
  for (int f = 0; f < frames; ++f)
    out.response[row * static_cast<std::size_t>(frames) + static_cast<std::size_t>(f)] = -phi[f];
  out.noise_response += root_weight * root_weight * moments.g22 * response;
  for (int p = 0; p < unknowns; ++p) {
    // The response is -m p''. Noise in p'' is correlated with noise in p, but not with noise in p'.
    const bool damping = noise.damping[static_cast<std::size_t>(p)];
    if (!damping)
      out.noise_right[static_cast<std::size_t>(p)] -=
          root_weight * beta[p] * common_[p] * moments.g20;
    for (int q = p; q < unknowns; ++q) {
      if (damping != noise.damping[static_cast<std::size_t>(q)]) continue;
      out.noise_energy[static_cast<std::size_t>(p * unknowns + q)] +=
          beta[p] * beta[q] * noise.covariance(p, q) * (damping ? moments.g11 : moments.g00);
    }
  }
}

void RegressorTuning::form(int floor, FloorRows& out) {
  out.rows = equations_.empty() ? 0 : floor_modes(floor, theta0_);
  const auto rows = static_cast<std::size_t>(out.rows);
  const auto frames = static_cast<std::size_t>(layout_->frames());
  const auto unknowns = static_cast<std::size_t>(layout_->front(floor) - 1);
  out.beta.assign(rows * static_cast<std::size_t>(padded(layout_->front(floor))), 0.0);
  out.response.assign(rows * frames, 0.0);
  out.noise_energy.assign(unknowns * unknowns, 0.0);
  out.noise_right.assign(unknowns, 0.0);
  out.noise_response = out.noise_residual = 0;
  for (std::vector<double>* v : {&out.gain, &out.a1, &out.a2, &out.frequency_hz}) v->clear();
  const double zeta = damping();
  for (int r = 0; r < out.rows; ++r) {
    const OscillatorSection section(frequency_hz_[r], zeta, options_->rate_hz);
    out.a1.push_back(section.a1);
    out.a2.push_back(section.a2);
    out.gain.push_back(section.gain);
    out.frequency_hz.push_back(frequency_hz_[r]);
    weigh(floor, r, section, out);
  }
  pack_noise(floor, out);
}

void RegressorTuning::rows(int floor, const std::vector<std::uint8_t>& known, FloorRows& out) {
  take_usable_equations(floor, known);
  form(floor, out);
}

void RegressorTuning::pack_noise(int floor, FloorRows& out) const {
  const int unknowns = layout_->front(floor) - 1;
  const auto energy = [&](int p, int q) -> double& {
    return out.noise_energy[static_cast<std::size_t>(p * unknowns + q)];
  };
  for (int p = 0; p < unknowns; ++p)
    for (int q = 0; q < p; ++q) energy(p, q) = energy(q, p);
  out.noise_diagonal.clear();
  for (int p = 0; p < unknowns; ++p) out.noise_diagonal.push_back(energy(p, p));
  out.noise_bias.assign(static_cast<std::size_t>(unknowns * PerturbedDesigns::kCount), 0.0);
  kernels::in_use->multiply_add(out.noise_energy.data(), unknowns, unknowns, unknowns,
                                perturbed_.floor(floor), out.noise_bias.data(),
                                PerturbedDesigns::kCount);
  pack_compensation(*layout_, floor, out, kCompensatedShare, out.noise_compensation);
}

double RegressorTuning::damping() const {
  return options_->variant == Variant::paper ? std::sqrt(0.5) : options_->filter_damping;
}

int RegressorTuning::settle_rows(int least) const {
  double slowest_hz = kHighestCorner * options_->rate_hz;
  for (const FloorRows& floor : rows_)
    for (const double hz : floor.frequency_hz) slowest_hz = std::min(slowest_hz, hz);
  const double settle_s = 3 / (damping() * 2 * M_PI * slowest_hz);
  return std::max(least, static_cast<int>(std::ceil(settle_s * options_->rate_hz)));
}

int RegressorTuning::start_rows() const {
  return removes_past()
             ? 0
             : settle_rows(static_cast<int>(std::lround(options_->settle_s * options_->rate_hz)));
}

double RegressorTuning::detuning(int floor, const Eigen::VectorXd& theta) {
  const std::vector<double>& now = rows(floor).frequency_hz;
  take_all_equations();
  const int rows = floor_modes(floor, theta);
  double worst = 0;
  for (int r = 0; r < rows; ++r)
    worst = std::max(worst, std::abs(frequency_hz_[r] / now[static_cast<std::size_t>(r)] - 1));
  return worst;
}

namespace {

constexpr int kShapes = 4;  // shapes of a row: two of the high-pass, two of its oscillator section

}  // namespace

RegressorFilter::RegressorFilter(RegressorTuning& tuning, const FloorLayout& layout, int settle)
    : RowFilter(layout), tuning_(&tuning), layout_(&layout), settle_(settle) {
  floor_.reserve(static_cast<std::size_t>(layout.floors()));
  for (int floor = 0; floor < layout.floors(); ++floor) {
    const int stride = padded(layout.front(floor));
    const auto size = static_cast<std::size_t>(layout.frames() * stride);
    floor_.push_back({nullptr, tuning.rows(floor), std::vector<double>(size),
                      std::vector<double>(size), UnknownPast(stride, layout.frames(), kShapes)});
  }
  signal_.assign(static_cast<std::size_t>(padded(layout.own() + 2 * layout.frames() + 1)), 0.0);
  response_.assign(static_cast<std::size_t>(layout.frames()), 0.0);
  changed_.reserve(static_cast<std::size_t>(layout.floors()));
  known_.resize(static_cast<std::size_t>((layout.floors() + 1) * layout.frames()));
  reset(settle);
}

void RegressorFilter::reset(int settle) {
  settle_ = settle;
  std::fill(known_.begin(), known_.end(), std::uint8_t{1});
  for (int floor = 0; floor < layout_->floors(); ++floor) rebuild(floor);
}

void RegressorFilter::rebuild(int floor) {
  Floor& f = floor_[static_cast<std::size_t>(floor)];
  if (all_known_around(floor)) {
    f.rows = &tuning_->rows(floor);
  } else {
    tuning_->rows(floor, known_, f.some_known);
    f.rows = &f.some_known;
  }
  std::fill(f.s1.begin(), f.s1.end(), 0.0);
  std::fill(f.s2.begin(), f.s2.end(), 0.0);
  f.settling = settle_ + 1;
  f.past.end();
  // Settled filters carry no trace of the past.
  f.starting = tuning_->removes_past() && settle_ == 0;
  if (!f.starting) return;
  f.past.begin(f.rows->rows);
  for (int r = 0; r < f.rows->rows; ++r) {
    const auto row = static_cast<std::size_t>(r);
    f.past.add(r, tuning_->high_pass_poles());
    f.past.add(r, {f.rows->a1[row], f.rows->a2[row]});
  }
}

bool RegressorFilter::all_known_around(int floor) const {
  const auto first = known_.begin() + floor * layout_->frames();
  const int levels = layout_->next(floor) > 0 ? 3 : 2;
  return std::all_of(first, first + levels * layout_->frames(), [](auto k) { return k != 0; });
}

bool RegressorFilter::same_surroundings(int floor, const std::vector<std::uint8_t>& known) const {
  const auto first = known.begin() + floor * layout_->frames();
  const int levels = layout_->next(floor) > 0 ? 3 : 2;
  return std::equal(first, first + levels * layout_->frames(),
                    known_.begin() + floor * layout_->frames());
}

void RegressorFilter::push(const DeformationSet& set) {
  if (set.known != known_) {
    changed_.clear();
    for (int floor = 0; floor < layout_->floors(); ++floor)
      if (!same_surroundings(floor, set.known)) changed_.push_back(floor);
    known_ = set.known;
    for (const int floor : changed_) rebuild(floor);
  }
  const int own = layout_->own();
  const int frames = layout_->frames();
  const int motion_stride = own + frames;
  for (int floor = 0; floor < layout_->floors(); ++floor) {
    Floor& f = floor_[static_cast<std::size_t>(floor)];
    if (f.settling > 0) --f.settling;
    const int next = layout_->next(floor);
    const int stride = padded(layout_->front(floor));
    const double* here = &set.values[static_cast<std::size_t>(floor * motion_stride)];
    std::copy(here, here + own, signal_.begin());
    if (next > 0)
      std::copy(here + motion_stride, here + motion_stride + next, signal_.begin() + own);
    std::fill(signal_.begin() + own + next, signal_.begin() + stride, 0.0);
    for (int r = 0; r < f.rows->rows; ++r) {
      const double* weight = &f.rows->response[static_cast<std::size_t>(r * frames)];
      double response = 0;
      for (int g = 0; g < frames; ++g) response += weight[g] * here[own + g];
      response_[static_cast<std::size_t>(r)] = response;
    }
    kernels::in_use->filter_rows(signal_.data(), response_.data(), own + next, f.rows->gain.data(),
                                 f.rows->a1.data(), f.rows->a2.data(), f.s1.data(), f.s2.data(),
                                 f.rows->beta.data(), &rows_[offset(floor)], f.rows->rows, stride);
    f.starting = !f.past.remove(&rows_[offset(floor)]);
  }
}

/// Defined here, because the tuning must not depend on the filter, which depends on it.
std::unique_ptr<RowFilter> RegressorTuning::make_filter(int settle) {
  return std::make_unique<RegressorFilter>(*this, *layout_, settle);
}

}  // namespace framewatch::estimator
