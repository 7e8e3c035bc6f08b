// SPDX-License-Identifier: MIT
// Eigen includes this before its matrix products (EIGEN_FUNCTORS_PLUGIN, cmake/SameBits.cmake).
// Without this macro, products add their terms in the same order as on amd64.
#undef EIGEN_HAS_SINGLE_INSTRUCTION_MADD
