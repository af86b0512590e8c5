#pragma once

// Tested by tests/core/input_file_test.cpp, tests/contract/input_contract_test.cpp.

#include <stdexcept>
#include <string>

namespace weft {

/// Base of every error Weft throws. what() is one line that a user can act on.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A caller's mistake: a value out of its domain, an unknown name, arrays of the wrong size.
/// The message has the form "where: name = value [unit], expected ...".
class InvalidArgument : public Error {
 public:
  using Error::Error;
};

}  // namespace weft
