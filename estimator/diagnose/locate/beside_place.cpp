#include "estimator/diagnose/locate/beside_place.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

#include "estimator/diagnose/fit/noise_colour.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::VectorXcd;

constexpr int kTimesBeside = 3, kStepsBeside = 6, kTimesCells = 10;
constexpr double kSameCorner = 0.15;  ///< relative difference
constexpr double kNoiseBeside = 2;    ///< spread_of() of noise
constexpr double kOutlier = 3;        ///< standard deviations of a cell of noise
constexpr double kMaxCells = 0.6;     ///< smallest share of cells that are noise

/// Returns the residual with arbitrary signals at a place, in cells.
std::vector<NoiseCell> cells_beside(const Fitter& fitter, const Localisation& place) {
  std::vector<NoiseCell> out;
  const std::vector<Whitened> systems =
      fitter.systems(place.model, place.motion, Forcing::measured);
  for (std::size_t r = 0; r < systems.size(); ++r) {
    const Whitened& system = systems[r];
    const RecordSegment& segment = fitter.segments()[r];
    const Index n = system.operation.equations();
    for (Index from = 0; from + kBinsOfCell <= system.bins(); from += kBinsOfCell) {
      double power = 0, numbers = 0;
      for (Index b = from; b < from + kBinsOfCell; ++b) {
        VectorXcd rest(n);
        rest.real() = system.rest.segment(2 * n * b, n);
        rest.imag() = system.rest.segment(2 * n * b + n, n);
        const MatrixXcd basis = candidate_basis(system, b, place.candidate_places);
        power += rest.squaredNorm() - (basis.adjoint() * rest).squaredNorm();
        numbers += static_cast<double>(n - basis.cols());
      }
      const double hz = segment.w[from + kBinsOfCell / 2] / (2 * M_PI);
      out.push_back({hz, segment.corner_hz, power / numbers, numbers});
    }
  }
  return out;
}

/// Returns the corner frequency of most of the cells. Removes the other cells from `cells`.
double corner_of_most(std::vector<NoiseCell>& cells) {
  const std::vector<NoiseCell> all = cells;
  double corner_hz = likeliest_corner_hz(cells);
  for (int i = 0; i < kTimesCells; ++i) {
    const auto excess = [&](const NoiseCell& c) {
      return (c.level / c.expected(corner_hz) - 1) * std::sqrt(c.numbers);
    };
    std::vector<double> sorted;
    for (const NoiseCell& c : all) sorted.push_back(excess(c));
    std::sort(sorted.begin(), sorted.end());
    const auto most = static_cast<std::size_t>(kMaxCells * static_cast<double>(sorted.size()));
    const double limit = std::max(kOutlier, sorted[most]);
    cells.clear();
    std::copy_if(all.begin(), all.end(), std::back_inserter(cells),
                 [&](const NoiseCell& c) { return excess(c) <= limit; });
    const double next_hz = likeliest_corner_hz(cells);
    if (next_hz == corner_hz) break;
    corner_hz = next_hz;
  }
  return corner_hz;
}

}  // namespace

bool colour_beside(const Fitter& fitter, std::vector<RecordSegment>& segments,
                   const Localisation& place) {
  const double before_hz = segments.front().corner_hz;
  Localisation now = place;
  double spread = 0;
  for (int i = 0; i <= kTimesBeside; ++i) {
    std::vector<NoiseCell> cells = cells_beside(fitter, now);
    if (cells.empty() || (i == 0 && spread_of(cells, 0) < kNoiseBeside)) break;
    const double corner_hz = corner_of_most(cells);
    spread = spread_of(cells, corner_hz);
    if (i == kTimesBeside || corner_hz == 0) break;
    if (std::abs(corner_hz - segments.front().corner_hz) < kSameCorner * corner_hz) break;
    set_corner(corner_hz, segments);
    now = localise(fitter, now.model, now.motion, now.candidate_places, kStepsBeside);
  }
  if (spread > kNoiseBeside) set_corner(before_hz, segments);
  return segments.front().corner_hz != before_hz;
}

}  // namespace framewatch::estimator
