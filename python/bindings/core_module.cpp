#include <weft/python/bindings/core_module.hpp>

#include <weft/python/bindings/errors.hpp>

PYBIND11_MODULE(_core, module) {
  module.doc() = "Meshes, laws, scenes and recordings; no Bullet.";
  module.attr("version") = WEFT_VERSION;
  weft::python::translate_errors();
  weft::python::bind_laws(module);
  weft::python::bind_meshes(module);
  weft::python::bind_scenes(module);
  weft::python::bind_recordings(module);
}
