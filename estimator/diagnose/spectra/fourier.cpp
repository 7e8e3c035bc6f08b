#include "estimator/diagnose/spectra/fourier.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include <unsupported/Eigen/FFT>

namespace framewatch::estimator {

using Eigen::Index;
using Eigen::VectorXcd;
using Eigen::VectorXd;

namespace {

constexpr std::size_t kMaxSizes = 16;

/// Transforms between a real signal and half of its spectrum. Caches the twiddle factors of recent
/// sizes because computing them takes longer than a transform.
class Transforms {
 public:
  Transforms() { transform_.SetFlag(Eigen::FFT<double>::HalfSpectrum); }

  Eigen::FFT<double>& of(Index size) {
    if (std::find(sizes_.begin(), sizes_.end(), size) != sizes_.end()) return transform_;
    if (sizes_.size() == kMaxSizes) {
      transform_.impl().clear();
      sizes_.clear();
    }
    sizes_.push_back(size);
    return transform_;
  }

 private:
  Eigen::FFT<double> transform_;
  std::vector<Index> sizes_;
};

Eigen::FFT<double>& transform_of(Index size) {
  static thread_local Transforms all;
  return all.of(size);
}

}  // namespace

VectorXcd forward_fourier(const VectorXd& signal) {
  VectorXcd out(signal.size() / 2 + 1);
  transform_of(signal.size()).fwd(out.data(), signal.data(), signal.size());
  return out;
}

VectorXd inverse_fourier(const VectorXcd& half, Index size) {
  VectorXcd in = VectorXcd::Zero(size / 2 + 1);
  const Index given = std::min(half.size(), in.size());
  in.head(given) = half.head(given);
  VectorXd out(size);
  transform_of(size).inv(out.data(), in.data(), size);
  return out;
}

Index smooth_size(Index size) {
  for (; size > 1; --size) {
    Index rest = size;
    for (const Index factor : {2, 3, 5})
      while (rest % factor == 0) rest /= factor;
    if (rest == 1) break;
  }
  return size;
}

}  // namespace framewatch::estimator
