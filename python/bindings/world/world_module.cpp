// Tested by tests/python/test_world.py.

#include <weft/bridge/bullet/precision.hpp>
#include <weft/python/bindings/errors.hpp>
#include <weft/python/bindings/world/handles.hpp>

PYBIND11_MODULE(WEFT_PYTHON_MODULE, module) {
  module.doc() = "Worlds and engines with Bullet in one precision.";
  module.attr("precision") = weft::bridge::precision_name();
  weft::python::translate_errors();
  // Meshes and scenes are types of this module.
  weft::python::py::module_::import("weft._core");
  weft::python::bind_bodies(module);
  weft::python::bind_cloths(module);
  weft::python::bind_worlds(module);
}
