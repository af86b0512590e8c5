#pragma once

// Tested by tests/python/test_mesh.py, tests/python/test_laws.py, tests/python/test_scene.py.

#include <pybind11/pybind11.h>

namespace weft::python {

namespace py = pybind11;

/// The parts of the module weft._core.
void bind_laws(py::module_& module);
void bind_meshes(py::module_& module);
void bind_scenes(py::module_& module);
void bind_recordings(py::module_& module);

}  // namespace weft::python
