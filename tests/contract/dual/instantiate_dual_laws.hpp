#pragma once

// Included before the sources of the laws where they are compiled for dual numbers (tests/contract/CMakeLists.txt).

#include "tests/contract/dual/dual.hpp"

#define WEFT_INSTANTIATE_LAW(Law) template class Law<weft::Dual>
