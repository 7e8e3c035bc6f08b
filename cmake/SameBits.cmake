# The numbers on arm64 are those on amd64, bit for bit (docs/gateway.md). There, a compiler fuses a product and a sum
# into one instruction that rounds once, Eigen does so too and then adds in another order, and char has no sign.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
  add_compile_options(-ffp-contract=off -fsigned-char)
  include_directories(BEFORE ${PROJECT_SOURCE_DIR}/cmake/arm64)
  # The blocks of a large product: as with the amd64 processors whose first cache has 48 KB.
  add_compile_definitions(EIGEN_FUNCTORS_PLUGIN="${PROJECT_SOURCE_DIR}/cmake/arm64/eigen_order.h"
    EIGEN_DEFAULT_L1_CACHE_SIZE=49152 EIGEN_DEFAULT_L2_CACHE_SIZE=2097152 EIGEN_DEFAULT_L3_CACHE_SIZE=2097152)
endif()
