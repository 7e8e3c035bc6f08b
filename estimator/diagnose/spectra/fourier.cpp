#include "estimator/diagnose/spectra/fourier.h"

#include <algorithm>
#include <complex>
#include <vector>

#include <unsupported/Eigen/FFT>

namespace framewatch::estimator {

using Eigen::Index;
using Eigen::VectorXcd;
using Eigen::VectorXd;

namespace {

/// A transform that has the factors of the last few sizes: they take as long as a transform.
Eigen::FFT<double>& transform_of(Index size) {
  constexpr std::size_t kSizes = 8;
  thread_local Eigen::FFT<double> transform;
  thread_local std::vector<Index> sizes;
  if (std::find(sizes.begin(), sizes.end(), size) == sizes.end()) {
    if (sizes.empty() || sizes.size() == kSizes) {
      transform = Eigen::FFT<double>();
      transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
      sizes.clear();
    }
    sizes.push_back(size);
  }
  return transform;
}

}  // namespace

VectorXcd forward_fourier(const VectorXd& signal) {
  Eigen::FFT<double>& transform = transform_of(signal.size());
  const std::vector<double> in(signal.data(), signal.data() + signal.size());
  std::vector<std::complex<double>> out;
  transform.fwd(out, in);
  return Eigen::Map<const VectorXcd>(out.data(), static_cast<Index>(out.size()));
}

VectorXd inverse_fourier(const VectorXcd& half, Index size) {
  Eigen::FFT<double>& transform = transform_of(size);
  std::vector<std::complex<double>> in(static_cast<std::size_t>(size / 2 + 1));
  for (Index i = 0; i < std::min<Index>(half.size(), size / 2 + 1); ++i)
    in[static_cast<std::size_t>(i)] = half[i];
  std::vector<double> out(static_cast<std::size_t>(size));
  transform.inv(out, in, size);
  return Eigen::Map<const VectorXd>(out.data(), size);
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
