// Tested by tests/python/test_scene.py.

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <weft/engines/reference_simulator.hpp>
#include <weft/python/bindings/core_module.hpp>
#include <weft/python/bindings/numpy_arrays.hpp>
#include <weft/python/bindings/scene_run.hpp>
#include <weft/scenes/catalog.hpp>
#include <weft/scenes/engine_kind.hpp>
#include <weft/scenes/format/scene_file.hpp>

namespace weft::python {
namespace {

template <class Bodies>
std::vector<std::string> names_of(const Bodies& bodies) {
  std::vector<std::string> names;
  for (const auto& body : bodies) names.push_back(body.name);
  return names;
}

std::vector<std::string> catalog_names() {
  std::vector<std::string> names;
  for (const scenes::CatalogEntry& entry : scenes::scene_catalog()) names.emplace_back(entry.name);
  return names;
}

}  // namespace

void bind_scenes(py::module_& module) {
  py::class_<scenes::Scene>(module, "Scene")
      .def_readonly("name", &scenes::Scene::name)
      .def_readonly("summary", &scenes::Scene::summary)
      .def_readonly("engines", &scenes::Scene::engines)
      .def_property_readonly("text", &scenes::write_scene)
      .def_property_readonly("duration", [](const scenes::Scene& s) { return s.world.duration; })
      .def_property_readonly("time_step", [](const scenes::Scene& s) { return s.world.time_step; })
      .def_property_readonly("frame_interval",
                             [](const scenes::Scene& s) { return s.world.frame_interval; })
      .def_property_readonly("gravity",
                             [](const scenes::Scene& s) { return tuple_of(s.world.gravity); })
      .def_property_readonly("cloths", [](const scenes::Scene& s) { return names_of(s.cloths); })
      .def_property_readonly("colliders",
                             [](const scenes::Scene& s) { return names_of(s.colliders); })
      .def("is_for_engine", &scenes::is_for_engine, py::arg("engine"));
  module.attr("engines") = scenes::engine_names();
  module.def("scene_names", &catalog_names);
  module.def("load_scene", &scenes::load_scene, py::arg("name_or_path"));
  module.def(
      "read_scene_text",
      [](const std::string& text, const std::string& name) {
        return scenes::read_scene_text(text, name);
      },
      py::arg("text"), py::arg("name"));
  module.def(
      "run_reference",
      [](const scenes::Scene& scene, const std::filesystem::path& output, bool may_replace,
         std::optional<double> duration, std::optional<double> time_step) {
        return run_scene(scene, {.engine = std::string(scenes::kReferenceEngine.name),
                                 .precision = scenes::StoredPrecision::kFloat64,
                                 .make = [] { return scenes::make_reference(); },
                                 .output = output,
                                 .may_replace = may_replace,
                                 .duration = duration,
                                 .time_step = time_step});
      },
      py::arg("scene"), py::arg("output"), py::arg("may_replace"), py::arg("duration"),
      py::arg("time_step"));
}

}  // namespace weft::python
