// The kernels, included by one source per instruction set, which compiles them for it. Nothing here
// may leave a symbol another source could share: no function of the standard library.
// FRAMEWATCH_VECTOR_BYTES: width of its registers.

#include "estimator/numeric/kernels.h"
#include "estimator/numeric/kernels_bins.h"
#include "estimator/numeric/kernels_cholesky.h"
#include "estimator/numeric/kernels_columns.h"
#include "estimator/numeric/kernels_gram.h"
#include "estimator/numeric/kernels_sorted.h"

namespace framewatch::estimator::kernels {
namespace {

constexpr Table kTable = {filter_rows,      add_rows,         add,
                          sum_into_front,   partial_cholesky, substitute_back,
                          forward_columns,  backward_columns, multiply_add,
                          add_two,          subtract_product, replace_sorted,
                          noise_covariance, inverse_cholesky};

}  // namespace
}  // namespace framewatch::estimator::kernels
