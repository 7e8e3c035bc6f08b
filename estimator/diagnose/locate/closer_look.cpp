#include "estimator/diagnose/locate/closer_look.h"

#include "estimator/diagnose/locate/bin_curvature.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kIterations = 4;

/// Returns the curvature times x, one column per list, with the signals of its places free.
MatrixXd curvature_times(const Linearised& at, const std::vector<Index>& kept,
                         const std::vector<std::vector<CandidatePlace>>& lists, const MatrixXd& x) {
  const RowMatrix steps = x;
  RowMatrix sum = RowMatrix::Zero(x.rows(), x.cols());
  for (std::size_t r = 0; r < at.systems.size(); ++r) {
    BinCurvature curvature(at, r, kept, lists);
    for (Index b = 0; b < at.systems[r].bins(); ++b) curvature.add_times(b, steps, sum);
  }
  return sum;
}

}  // namespace

std::vector<CloserLook> closer_looks(const Linearised& at, const std::vector<Index>& kept,
                                     const std::vector<std::vector<CandidatePlace>>& lists,
                                     const std::vector<NormalEquations>& equations) {
  const auto count = static_cast<Index>(kept.size()), width = static_cast<Index>(lists.size());
  VectorXd prior(count), pull(count);
  for (Index i = 0; i < count; ++i) {
    prior[i] = at.prior[kept[static_cast<std::size_t>(i)]] / at.level;
    pull[i] = at.pull[kept[static_cast<std::size_t>(i)]] / at.level;
  }
  std::vector<Ldlt> direct;
  MatrixXd right(count, width);
  for (Index l = 0; l < width; ++l) {
    const NormalEquations& own = equations[static_cast<std::size_t>(l)];
    MatrixXd normal = own.normal;
    normal.diagonal() += prior;
    normal.diagonal().array() += 1e-12 + 1e-9 * normal.diagonal().array();
    direct.emplace_back(normal);
    right.col(l) = pull - own.gradient;
  }
  const auto directed = [&](const MatrixXd& rest) {
    MatrixXd out(count, width);
    for (Index l = 0; l < width; ++l)
      out.col(l) = direct[static_cast<std::size_t>(l)].solve(VectorXd(rest.col(l)));
    return out;
  };
  MatrixXd x = MatrixXd::Zero(count, width), rest = right, z = directed(rest), p = z;
  Eigen::RowVectorXd rho = rest.cwiseProduct(z).colwise().sum();
  for (int i = 0; i < kIterations; ++i) {
    MatrixXd product = curvature_times(at, kept, lists, p);
    product += prior.asDiagonal() * p;
    const Eigen::RowVectorXd bend = p.cwiseProduct(product).colwise().sum();
    for (Index l = 0; l < width; ++l) {
      const double share = bend[l] > 0 ? rho[l] / bend[l] : 0;
      x.col(l) += share * p.col(l);
      rest.col(l) -= share * product.col(l);
    }
    if (i + 1 == kIterations) break;
    z = directed(rest);
    const Eigen::RowVectorXd next = rest.cwiseProduct(z).colwise().sum();
    for (Index l = 0; l < width; ++l)
      p.col(l) = z.col(l) + (rho[l] > 0 ? next[l] / rho[l] : 0) * p.col(l);
    rho = next;
  }
  std::vector<CloserLook> out;
  for (Index l = 0; l < width; ++l) {
    const NormalEquations& own = equations[static_cast<std::size_t>(l)];
    const VectorXd step = x.col(l);
    const VectorXd bent = right.col(l) - rest.col(l) - prior.cwiseProduct(step);  // normal * step
    out.push_back({step, own.misfit + step.dot(bent) + 2 * step.dot(own.gradient)});
  }
  return out;
}

}  // namespace framewatch::estimator
