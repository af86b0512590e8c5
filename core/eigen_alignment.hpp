#pragma once

// Tested by tests/install/CMakeLists.txt.

// Eigen chooses the alignment of its matrices, and with it how it takes and gives back memory, from the
// compiler's flags: -mavx, -march=native or -fsanitize=address change both. Matrices that a program made would
// then be freed by the library, or the other way round, in another way than they were taken. Here the choice
// is fixed, to what Eigen takes on x86-64 without such flags. Weft's CMake targets define the same for all
// files of a program; without CMake this header has to come before any of Eigen's.
#ifndef EIGEN_CORE_H
#ifndef EIGEN_MAX_ALIGN_BYTES
#define EIGEN_MAX_ALIGN_BYTES 16
#endif
#ifndef EIGEN_MAX_STATIC_ALIGN_BYTES
#define EIGEN_MAX_STATIC_ALIGN_BYTES 16
#endif
#ifndef EIGEN_MALLOC_ALREADY_ALIGNED
#define EIGEN_MALLOC_ALREADY_ALIGNED 1
#endif
#endif

#include <Eigen/Core>

#if EIGEN_MAX_ALIGN_BYTES != 16 || EIGEN_MAX_STATIC_ALIGN_BYTES != 16 || \
    EIGEN_MALLOC_ALREADY_ALIGNED != 1
#error \
    "Eigen was included before Weft, with another alignment than Weft's libraries have. Link the CMake target weft::..., include Weft's headers before Eigen's, or compile all files with -DEIGEN_MAX_ALIGN_BYTES=16 -DEIGEN_MAX_STATIC_ALIGN_BYTES=16 -DEIGEN_MALLOC_ALREADY_ALIGNED=1"
#endif
