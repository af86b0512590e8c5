// Tested by tests/python/test_world.py, tests/python/test_tearing.py, tests/python/test_adoption.py.

#include <algorithm>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/core/error.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/python/bindings/law_list.hpp>
#include <weft/python/bindings/node_arrays.hpp>
#include <weft/python/bindings/numpy_arrays.hpp>
#include <weft/python/bindings/world/handles.hpp>

namespace weft::python {
namespace {

using bridge::from_bullet;

std::string in_message(const ClothRecord& cloth, const char* what) {
  return "cloth '" + cloth.name + "': " + what;
}

py::array_t<int> triangles_of(const ClothHandle& handle) {
  const btSoftBody& body = *handle.get().body;
  Triangles triangles(3, body.m_faces.size());
  for (int f = 0; f < body.m_faces.size(); ++f) {
    for (int corner = 0; corner < 3; ++corner) {
      triangles(corner, f) = static_cast<int>(body.m_faces[f].m_n[corner] - &body.m_nodes[0]);
    }
  }
  return rows_of(triangles);
}

py::array_t<double> masses_of(const ClothHandle& handle) {
  const ClothRecord& cloth = handle.get();
  if (cloth.mesh) return array_of(cloth.mesh->masses);
  VectorX<double> masses(cloth.body->m_nodes.size());
  for (int i = 0; i < cloth.body->m_nodes.size(); ++i) {
    const btScalar inverse = cloth.body->m_nodes[i].m_im;
    masses[i] = inverse > 0 ? 1 / static_cast<double>(inverse) : 0;
  }
  return array_of(masses);
}

std::vector<int> pins_of(const ClothHandle& handle) {
  std::vector<int> pins;
  const btSoftBody& body = *handle.get().body;
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    if (body.m_nodes[i].m_im == 0) pins.push_back(i);
  }
  return pins;
}

void refuse(const ClothRecord& cloth, const std::optional<std::string>& refusal) {
  if (refusal) throw Error("cloth '" + cloth.name + "': " + *refusal);
}

void set_law(const ClothHandle& handle, const LawTuple& law) {
  ClothRecord& cloth = handle.get();
  refuse(cloth, cloth.handle.set(laws_from({law}).front()));
  cloth.laws = cloth.handle.laws();
}

void remove_law(const ClothHandle& handle, const std::string& name) {
  ClothRecord& cloth = handle.get();
  const auto has_name = [&](const auto& law) { return law.law == name; };
  if (std::none_of(cloth.laws.begin(), cloth.laws.end(), has_name)) {
    throw InvalidArgument(in_message(cloth, "has no law '") + name + "', expected one that it has");
  }
  refuse(cloth, cloth.handle.remove(name));
  cloth.laws = cloth.handle.laws();
}

std::vector<LawTuple> laws_of(const ClothHandle& handle) {
  std::vector<LawTuple> laws;
  for (const forces::LawSpecification& law : handle.get().laws) laws.push_back(tuple_of(law));
  return laws;
}

py::object blow_up_of(const ClothHandle& handle) {
  const auto blow_up = handle.get().handle.state().blow_up;
  if (!blow_up) return py::none();
  return py::make_tuple(blow_up->node, blow_up->reason);
}

py::tuple step_error_of(const ClothHandle& handle) {
  const bridge::StepError error = handle.get().handle.state().step_error;
  return py::make_tuple(error.distance, error.newton_iterations, error.is_within_tolerance);
}

/// Columns of what touched the cloth in the last step: nodes, points, normals, impulses, whether they stick, names.
py::tuple contacts_of(const ClothHandle& handle) {
  const std::vector<bridge::ClothContactPoint> contacts = handle.get().handle.contacts();
  const auto n = static_cast<Eigen::Index>(contacts.size());
  VectorX<int> nodes(n);
  Matrix3X<double> points(3, n);
  Matrix3X<double> normals(3, n);
  Matrix3X<double> impulses(3, n);
  py::array_t<bool> is_sticking(n);
  py::list names;
  for (Eigen::Index i = 0; i < n; ++i) {
    const bridge::ClothContactPoint& contact = contacts[static_cast<std::size_t>(i)];
    nodes[i] = contact.node;
    points.col(i) = from_bullet(contact.point);
    normals.col(i) = from_bullet(contact.normal);
    impulses.col(i) = from_bullet(contact.impulse);
    is_sticking.mutable_at(i) = contact.is_sticking;
    names.append(handle.world->name_of(contact.object));
  }
  return py::make_tuple(py::array_t<int>(n, nodes.data()), rows_of(points), rows_of(normals),
                        rows_of(impulses), is_sticking, names);
}

void move_pins(const ClothHandle& handle, const py::object& nodes, const py::object& targets) {
  ClothRecord& cloth = handle.get();
  const btSoftBody& body = *cloth.body;
  std::vector<int> led = nodes_from(nodes, body.m_nodes.size(), in_message(cloth, "nodes"));
  for (const int node : led) {
    if (body.m_nodes[node].m_im == 0) continue;
    throw InvalidArgument(
        fmt::format("cloth '{}': node {} is not pinned, expected pins only", cloth.name, node));
  }
  cloth.led_targets = points_from(targets, static_cast<Eigen::Index>(led.size()),
                                  in_message(cloth, "targets"), "m");
  cloth.led_nodes = std::move(led);
}

void add_forces(const ClothHandle& handle, const py::object& nodes, const py::object& forces) {
  ClothRecord& cloth = handle.get();
  const int num_nodes = cloth.body->m_nodes.size();
  std::vector<int> given(static_cast<std::size_t>(num_nodes));
  if (nodes.is_none()) {
    std::iota(given.begin(), given.end(), 0);
  } else {
    given = nodes_from(nodes, num_nodes, in_message(cloth, "nodes"));
  }
  const auto count = static_cast<Eigen::Index>(given.size());
  const Matrix3X<double> acting = points_from(forces, count, in_message(cloth, "forces"), "N");
  const auto before = static_cast<Eigen::Index>(cloth.forced_nodes.size());
  cloth.forces.conservativeResize(3, before + count);
  cloth.forces.rightCols(count) = acting;
  cloth.forced_nodes.insert(cloth.forced_nodes.end(), given.begin(), given.end());
}

void anchor(const ClothHandle& handle, int node, const BodyHandle& body, bool collides) {
  ClothRecord& cloth = handle.get();
  BodyRecord& held_by = body.get();
  if (body.world != handle.world) {
    throw InvalidArgument(in_message(cloth, "body '") + held_by.name +
                          "' is in another world, expected one of the same");
  }
  const int num_nodes = cloth.body->m_nodes.size();
  if (node < 0 || node >= num_nodes) {
    throw InvalidArgument(
        fmt::format("cloth '{}': node = {}, expected 0 to {}", cloth.name, node, num_nodes - 1));
  }
  if (cloth.body->m_nodes[node].m_im == 0) {
    throw InvalidArgument(
        fmt::format("cloth '{}': node {} is pinned, expected a free one", cloth.name, node));
  }
  cloth.body->appendAnchor(node, held_by.body.get(), !collides);
  handle.world->solver().wake(*cloth.body);
}

/// Bullet's removeAnchor() would look at the node only and forgets that the body collides again.
int release(const ClothHandle& handle) {
  ClothRecord& cloth = handle.get();
  const int num_anchors = cloth.body->m_anchors.size();
  for (int a = num_anchors - 1; a >= 0; --a) {
    btSoftBody::Anchor& one = cloth.body->m_anchors[a];
    one.m_node->m_battach = 0;
    cloth.body->m_collisionDisabledObjects.remove(one.m_body);
  }
  cloth.body->m_anchors.clear();
  handle.world->solver().wake(*cloth.body);
  return num_anchors;
}

std::vector<std::tuple<std::string, std::string, std::string>> adoption_of(
    const ClothHandle& handle) {
  std::vector<std::tuple<std::string, std::string, std::string>> rows;
  for (const bridge::AdoptedProperty& property : handle.get().adopted) {
    rows.emplace_back(property.what, bridge::name_of(property.fate), property.how);
  }
  return rows;
}

int cut(const ClothHandle& handle, const py::object& from, const py::object& to,
        const py::object& depth) {
  ClothRecord& cloth = handle.get();
  return handle.world->cut(cloth, {vector_from(from, in_message(cloth, "start"), "m"),
                                   vector_from(to, in_message(cloth, "end"), "m"),
                                   vector_from(depth, in_message(cloth, "depth"), "m")});
}

}  // namespace

void bind_cloths(py::module_& module) {
  using py::arg;
  py::class_<ClothHandle>(module, "Cloth", py::module_local())
      .def_property_readonly("name", [](const ClothHandle& h) { return h.record->name; })
      .def_property_readonly("is_removed",
                             [](const ClothHandle& h) { return h.record->is_removed; })
      .def_property_readonly("generation",
                             [](const ClothHandle& h) { return h.record->generation; })
      .def("is_same",
           [](const ClothHandle& a, const ClothHandle& b) { return a.record == b.record; })
      .def("__len__", [](const ClothHandle& h) { return h.get().body->m_nodes.size(); })
      .def("positions", &node_positions)
      .def("velocities", &node_velocities)
      .def("triangles", &triangles_of)
      .def("masses", &masses_of)
      .def("pins", &pins_of)
      .def("laws", &laws_of)
      .def("set_law", &set_law, arg("law"))
      .def("remove_law", &remove_law, arg("name"))
      .def("state",
           [](const ClothHandle& h) {
             return std::string(bridge::name_of(h.get().handle.state().status));
           })
      .def("blow_up", &blow_up_of)
      .def("step_error", &step_error_of)
      .def("contacts", &contacts_of)
      .def("num_contacts",
           [](const ClothHandle& h) { return h.world->solver().num_contacts(*h.get().body); })
      .def("move_pins", &move_pins, arg("nodes"), arg("targets"))
      .def("add_forces", &add_forces, arg("nodes"), arg("forces"))
      .def("anchor", &anchor, arg("node"), arg("body"), arg("collides"))
      .def("release", &release)
      .def("wake", [](const ClothHandle& h) { h.world->solver().wake(*h.get().body); })
      .def("adoption", &adoption_of)
      .def("cut", &cut, arg("start"), arg("end"), arg("depth"));
}

}  // namespace weft::python
