#pragma once

// Tested by tests/python/test_interrupt.py.

#include <chrono>

#include <pybind11/pybind11.h>

namespace weft::python {

/// Lets Python's signals be heard in a loop that runs without the lock of the interpreter. It asks for the lock every 50 ms only, for
/// another Python thread may keep it for 5 ms each time.
class Signals {
 public:
  /// Throws error_already_set if a handler of a signal has raised something, as Ctrl-C does.
  void check() {
    const auto now = Clock::now();
    if (now - last_ < std::chrono::milliseconds(50)) return;
    last_ = now;
    const pybind11::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

}  // namespace weft::python
