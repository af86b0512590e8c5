#pragma once

// Tested by tests/python/test_errors.py.

namespace weft::python {

/// Weft's errors become those of weft/errors.py in the module that is being made: InvalidArgument, which is a ValueError, and
/// Error.
void translate_errors();

}  // namespace weft::python
