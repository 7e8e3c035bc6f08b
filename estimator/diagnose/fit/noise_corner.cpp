// SPDX-License-Identifier: MIT
#include "estimator/diagnose/fit/noise_corner.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace framewatch::estimator {
namespace {

using Eigen::Index;

constexpr double kLowestCorner = 0.05;  ///< of the band's lowest frequency
constexpr double kRatio = 1.12;         ///< between successive corner frequencies to try
constexpr int kCorners = 80;
constexpr int kTimes = 3;  ///< that the model is fitted to a color

std::vector<NoiseCell> cells_of(const Whitened& system, const RecordSegment& segment) {
  const Index n = system.operation.equations();
  std::vector<NoiseCell> out;
  for (Index from = 0; from + kBinsOfCell <= system.bins(); from += kBinsOfCell)
    for (Index i = 0; i < n; ++i) {
      double power = 0;
      for (Index b = from; b < from + kBinsOfCell; ++b)
        power += system.rest.segment(2 * n * b, 2 * n)(Eigen::seq(i, 2 * n - 1, n)).squaredNorm();
      const double hz = segment.w[from + kBinsOfCell / 2] / (2 * M_PI);
      out.push_back({hz, segment.corner_hz, power / kBinsOfCell, kBinsOfCell});
    }
  return out;
}

std::vector<NoiseCell> cells_of(const Fitter& fitter, const FitResult& now) {
  const std::vector<Whitened> systems =
      fitter.systems(now.model, now.motion, forcing_of(now.model));
  std::vector<NoiseCell> out;
  for (std::size_t r = 0; r < systems.size(); ++r) {
    const std::vector<NoiseCell> more = cells_of(systems[r], fitter.segments()[r]);
    out.insert(out.end(), more.begin(), more.end());
  }
  return out;
}

/// Returns half the negative log-likelihood of noise with this corner frequency.
double cost_of(const std::vector<NoiseCell>& cells, double corner_hz) {
  double out = 0;
  for (const NoiseCell& c : cells) {
    const double expected = c.expected(corner_hz);
    out += c.numbers * (c.level / expected + std::log(expected));
  }
  return out;
}

}  // namespace

double likeliest_corner_hz(const std::vector<NoiseCell>& cells) {
  double lowest = cells.front().hz;
  for (const NoiseCell& c : cells) lowest = std::min(lowest, c.hz);
  double best = 0, corner = kLowestCorner * lowest;
  for (int i = 0; i < kCorners; ++i, corner *= kRatio)
    if (cost_of(cells, corner) < cost_of(cells, best)) best = corner;
  return best;
}

double spread_of(const std::vector<NoiseCell>& cells, double corner_hz) {
  double out = 0;
  for (const NoiseCell& c : cells)
    out += 2 * c.numbers * std::pow(std::max(c.level / c.expected(corner_hz) - 1, 0.0), 2);
  return out / static_cast<double>(cells.size());
}

void set_corner(double corner_hz, std::vector<RecordSegment>& segments) {
  for (RecordSegment& s : segments) s.corner_hz = corner_hz;
}

bool fit_noise_corner(const Fitter& fitter, std::vector<RecordSegment>& segments, FitResult& now) {
  const Plant& plant = fitter.plant();
  const SearchSettings& settings = fitter.settings();
  const double misfit = now.total_misfit() / fitter.expected(now.model);
  // Motions that no axis reads, or a single equation, give too little evidence.
  if (plant.unread.cols() > 0 || plant.equations() < 2) return false;
  if (misfit < settings.to_explain || misfit > settings.most_of_noise) return false;
  const double earlier_hz = segments.front().corner_hz;
  FitResult corrected = now;
  double spread = settings.perhaps_noise_spread;
  for (int i = 0; i <= kTimes; ++i) {
    const std::vector<NoiseCell> cells = cells_of(fitter, corrected);
    if (cells.empty()) break;
    const double corner_hz = likeliest_corner_hz(cells);
    spread = spread_of(cells, corner_hz);
    if (corner_hz == 0 || spread > settings.perhaps_noise_spread || i == kTimes) break;
    if (std::abs(corner_hz - segments.front().corner_hz) < settings.same_corner * corner_hz) break;
    set_corner(corner_hz, segments);
    FitResult again =
        fitter.fit(corrected.model, corrected.motion, thorough(now.model, settings.steps));
    if (!again.good) {
      spread = settings.perhaps_noise_spread;
      break;
    }
    corrected = std::move(again);
  }
  if (segments.front().corner_hz == earlier_hz) return false;
  if (spread > settings.noise_spread) {
    set_corner(earlier_hz, segments);
    return false;
  }
  now = std::move(corrected);
  return true;
}

}  // namespace framewatch::estimator
