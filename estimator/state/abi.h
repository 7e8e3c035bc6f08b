// SPDX-License-Identifier: MIT
#pragma once

/// \file
/// Refuses to compile a program whose options give Eigen or the standard library another layout in
/// memory than in the library that it links. Vectors are allocated on one side and freed on the
/// other, so such a program would crash (docs/library.md). The installed copy has numbers in place
/// of the four right sides below: those that the library was built with (cmake/Library.cmake).

#if __cplusplus < 202002L
#error "framewatch needs C++20: compile with -std=c++20"
#endif
#ifdef _GLIBCXX_DEBUG
#error "framewatch: _GLIBCXX_DEBUG changes std::vector, and the library is built without it"
#endif
#ifdef EIGEN_DEFAULT_TO_ROW_MAJOR
#error \
    "framewatch: EIGEN_DEFAULT_TO_ROW_MAJOR changes matrices, and the library is built without it"
#endif

#include <cstddef>
#include <type_traits>

#include <Eigen/Core>

/// First number of the Eigen version that the library was built with.
#define FRAMEWATCH_EIGEN_WORLD EIGEN_WORLD_VERSION
/// Second number of that version.
#define FRAMEWATCH_EIGEN_MAJOR EIGEN_MAJOR_VERSION
/// Alignment of Eigen's vectors in the library, bytes.
#define FRAMEWATCH_EIGEN_ALIGN EIGEN_MAX_ALIGN_BYTES
/// 1 if the library gets Eigen's memory from malloc() alone.
#define FRAMEWATCH_EIGEN_MALLOC EIGEN_MALLOC_ALREADY_ALIGNED

static_assert(EIGEN_WORLD_VERSION == FRAMEWATCH_EIGEN_WORLD &&
                  EIGEN_MAJOR_VERSION == FRAMEWATCH_EIGEN_MAJOR,
              "framewatch: the library was built with another version of Eigen; see "
              "FRAMEWATCH_EIGEN_WORLD and FRAMEWATCH_EIGEN_MAJOR");
static_assert(EIGEN_MAX_ALIGN_BYTES == FRAMEWATCH_EIGEN_ALIGN &&
                  EIGEN_MALLOC_ALREADY_ALIGNED == FRAMEWATCH_EIGEN_MALLOC,
              "framewatch: these compiler options (-march, -mavx or -fsanitize=address) change how "
              "Eigen allocates. Compile with the options of find_package(framewatch) or "
              "`pkg-config --cflags framewatch`, which fix it");
static_assert(std::is_same_v<Eigen::Index, std::ptrdiff_t>,
              "framewatch: EIGEN_DEFAULT_DENSE_INDEX_TYPE differs from the library's");
