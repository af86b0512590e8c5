#pragma once

#include <algorithm>
#include <cstdlib>

namespace weft::test {

/// How many a test takes of what it can take any number of: WEFT_TEST_COUNT, which the tests with the label slow set, or the usual number.
inline int count(int usual) {
  const char* const number = std::getenv("WEFT_TEST_COUNT");
  return number != nullptr ? std::max(1, std::atoi(number)) : usual;
}

}  // namespace weft::test
