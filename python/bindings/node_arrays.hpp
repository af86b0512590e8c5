#pragma once

// Tested by tests/python/test_shared_memory.py.

#include <pybind11/numpy.h>

#include <weft/python/bindings/world/handles.hpp>

namespace weft::python {

/// NumPy arrays (n, 3) that show the nodes where Bullet has them, in Bullet's precision: nothing is copied, and what Python writes is
/// there in the next step. An array keeps cloth and world alive.
[[nodiscard]] py::array node_positions(const ClothHandle& cloth);   ///< m_x [m]
[[nodiscard]] py::array node_velocities(const ClothHandle& cloth);  ///< m_v [m/s]

}  // namespace weft::python
