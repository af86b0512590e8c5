// Tested by tests/python/test_mesh.py.

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <weft/core/error.hpp>
#include <weft/mesh/cloth_grid.hpp>
#include <weft/mesh/icosphere.hpp>
#include <weft/mesh/rope.hpp>
#include <weft/mesh/surface_body.hpp>
#include <weft/python/bindings/core_module.hpp>
#include <weft/python/bindings/numpy_arrays.hpp>
#include <weft/scenes/format/scene_words.hpp>
#include <weft/scenes/import/import_mesh.hpp>

namespace weft::python {
namespace {

/// Where a word stands in a table of words.
template <class Words>
std::size_t index_of(const Words& words, std::string_view word, const std::string& where) {
  const auto found = std::find(words.begin(), words.end(), word);
  if (found == words.end()) {
    throw InvalidArgument(
        fmt::format("{} = '{}', expected one of {}", where, word, fmt::join(words, ", ")));
  }
  return static_cast<std::size_t>(found - words.begin());
}

MassLumping lumping_from(const std::string& word, const std::string& where) {
  return static_cast<MassLumping>(index_of(scenes::kLumpingWords, word, where + ": lumping"));
}

void set_pins(ClothMesh& mesh, const py::handle& pins, const std::string& where) {
  mesh.pinned = sorted_nodes_from(pins, mesh.num_nodes(), where + ": pins");
  mesh.pinned_velocities.resize(3, 0);
}

ClothMesh grid(std::array<int, 2> nodes, std::array<double, 2> size, double mass,
               const py::object& center, const py::object& u_axis, const py::object& v_axis,
               const std::string& stencil, const std::string& lumping, const py::object& pins) {
  ClothGrid grid;
  grid.nodes = nodes;
  grid.size = size;
  grid.total_mass = mass;
  grid.center = vector_from(center, "grid: center", "m");
  grid.u_axis = vector_from(u_axis, "grid: u_axis", "1");
  grid.v_axis = vector_from(v_axis, "grid: v_axis", "1");
  grid.stencil = static_cast<GridStencil>(
      index_of(scenes::kReadStencilWords, stencil, "grid: stencil") % scenes::kStencilWords.size());
  grid.lumping = lumping_from(lumping, "grid");
  ClothMesh mesh = make_cloth_grid(grid);
  set_pins(mesh, pins, "grid");
  return mesh;
}

ClothMesh sphere(double radius, double mass, const py::object& center, int frequency,
                 std::optional<double> center_mass_share, const std::string& lumping,
                 const py::object& pins) {
  ClothMesh mesh = make_icosphere({.radius = radius,
                                   .frequency = frequency,
                                   .center = vector_from(center, "sphere: center", "m"),
                                   .total_mass = mass,
                                   .lumping = lumping_from(lumping, "sphere"),
                                   .center_mass_share = center_mass_share});
  set_pins(mesh, pins, "sphere");
  return mesh;
}

ClothMesh rope(int nodes, const py::object& start, const py::object& end, double mass,
               const std::string& lumping, const py::object& pins) {
  ClothMesh mesh = make_rope({.nodes = nodes,
                              .start = vector_from(start, "rope: start", "m"),
                              .end = vector_from(end, "rope: end", "m"),
                              .total_mass = mass,
                              .lumping = lumping_from(lumping, "rope")});
  set_pins(mesh, pins, "rope");
  return mesh;
}

ClothMesh surface(const py::object& vertices, const py::object& triangles, double mass,
                  std::optional<double> center_mass_share, const std::string& lumping,
                  const py::object& pins) {
  Surface given;
  given.positions = points_from(vertices, "surface: vertices", "m");
  given.triangles = triangles_from(triangles, given.positions.cols(), "surface: triangles");
  ClothMesh mesh =
      make_surface_body(given, {mass, lumping_from(lumping, "surface"), center_mass_share});
  set_pins(mesh, pins, "surface");
  return mesh;
}

py::tuple read_mesh(const std::filesystem::path& file, double scale, const std::string& up,
                    const std::string& part) {
  constexpr std::array<std::string_view, 2> kUpWords = {"y", "z"};
  import::ImportOptions options;
  options.scale = scale;
  options.up = static_cast<import::UpAxis>(index_of(kUpWords, up, "read_mesh: up"));
  options.part = part;
  const Surface read = import::import_mesh(file, options).surface;
  return py::make_tuple(rows_of(read.positions), rows_of(read.triangles));
}

py::dict edge_sets_of(const ClothMesh& mesh) {
  py::dict sets;
  for (const EdgeSet& set : mesh.edge_sets) sets[py::str(set.name)] = rows_of(set.edges);
  return sets;
}

py::dict node_sets_of(const ClothMesh& mesh) {
  py::dict sets;
  for (const NodeSet& set : mesh.node_sets) sets[py::str(set.name)] = set.nodes;
  return sets;
}

void add_node_set(ClothMesh& mesh, const std::string& name, const py::object& nodes) {
  for (const NodeSet& set : mesh.node_sets) {
    if (set.name == name) {
      throw InvalidArgument("mesh: there is a node set '" + name +
                            "' already, expected another name");
    }
  }
  mesh.node_sets.push_back(
      {name, sorted_nodes_from(nodes, mesh.num_nodes(), "mesh: node set '" + name + "'")});
}

void bind_mesh_class(py::module_& module) {
  py::class_<ClothMesh>(module, "Mesh", "Geometry, masses and pins of a cloth; arrays are copies.")
      .def("__len__", &ClothMesh::num_nodes)
      .def("__repr__",
           [](const ClothMesh& mesh) {
             return fmt::format("<weft.Mesh: {} nodes, {} triangles, {} edges, {:.6g} kg>",
                                mesh.num_nodes(), mesh.triangles.cols(), mesh.num_edges(),
                                mesh.masses.sum());
           })
      .def_property_readonly(
          "vertices", [](const ClothMesh& mesh) { return rows_of(mesh.rest_positions); },
          "(n, 3) [m]: the rest shape.")
      .def_property_readonly(
          "triangles", [](const ClothMesh& mesh) { return rows_of(mesh.triangles); },
          "(t, 3): nodes, counter-clockwise seen from the front.")
      .def_property_readonly(
          "masses", [](const ClothMesh& mesh) { return array_of(mesh.masses); },
          "(n,) [kg], those of pinned nodes too.")
      .def_property(
          "pins", [](const ClothMesh& mesh) { return mesh.pinned; },
          [](ClothMesh& mesh, const py::object& pins) { set_pins(mesh, pins, "mesh"); },
          "Nodes that no force moves, in ascending order.")
      .def_property_readonly("edge_sets", &edge_sets_of,
                             "Name -> (m, 2): springs that laws may name.")
      .def_property_readonly("node_sets", &node_sets_of, "Name -> nodes that laws may name.")
      .def("add_node_set", &add_node_set, py::arg("name"), py::arg("nodes"),
           "Names nodes, for `drive` and for seams that tear.");
}

}  // namespace

void bind_meshes(py::module_& module) {
  using py::arg;
  const py::tuple origin = py::make_tuple(0.0, 0.0, 0.0);
  const py::tuple none{};
  bind_mesh_class(module);
  module.def("grid", &grid, arg("nodes"), arg("size"), arg("mass"), py::kw_only(),
             arg("center") = origin, arg("u_axis") = py::make_tuple(1.0, 0.0, 0.0),
             arg("v_axis") = py::make_tuple(0.0, 0.0, -1.0), arg("stencil") = "24-neighbor",
             arg("lumping") = "area", arg("pins") = none,
             "A rectangular cloth: numbers of nodes, sides [m], mass [kg], center [m]. Node (i, j) "
             "has the index "
             "j * nodes[0] + i; i runs along u_axis, j along v_axis.");
  module.def("sphere", &sphere, arg("radius"), arg("mass"), py::kw_only(), arg("center") = origin,
             arg("frequency") = 4, arg("center_mass_share") = py::none(), arg("lumping") = "area",
             arg("pins") = none,
             "A closed sphere of 20 frequency^2 triangles: radius [m], mass [kg].");
  module.def("rope", &rope, arg("nodes"), arg("start"), arg("end"), arg("mass"), py::kw_only(),
             arg("lumping") = "area", arg("pins") = none, "A straight rope from start to end [m].");
  module.def("surface", &surface, arg("vertices"), arg("triangles"), arg("mass"), py::kw_only(),
             arg("center_mass_share") = py::none(), arg("lumping") = "area", arg("pins") = none,
             "A cloth of arrays: vertices (n, 3) [m], triangles (t, 3), mass [kg].");
  module.def("read_mesh", &read_mesh, arg("file"), py::kw_only(), arg("scale") = 1.0,
             arg("up") = "y", arg("part") = "",
             "Vertices (n, 3) [m] and triangles (t, 3) of an OBJ, glTF, GLB, PLY, FBX or STL file; "
             "scale in meters per "
             "unit of the file.");
}

}  // namespace weft::python
