#include "estimator/diagnose/spectra/fourier.h"

#include <algorithm>
#include <complex>
#include <vector>

#include <unsupported/Eigen/FFT>

namespace framewatch::estimator {

using Eigen::Index;
using Eigen::VectorXcd;
using Eigen::VectorXd;

VectorXcd forward_fourier(const VectorXd& signal) {
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  const std::vector<double> in(signal.data(), signal.data() + signal.size());
  std::vector<std::complex<double>> out;
  transform.fwd(out, in);
  return Eigen::Map<const VectorXcd>(out.data(), static_cast<Index>(out.size()));
}

VectorXd inverse_fourier(const VectorXcd& half, Index size) {
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
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
