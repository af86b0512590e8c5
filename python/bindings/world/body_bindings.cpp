// Tested by tests/python/test_bodies.py.

#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/core/error.hpp>
#include <weft/python/bindings/numpy_arrays.hpp>
#include <weft/python/bindings/world/handles.hpp>
#include <weft/python/bindings/world/rigid_bodies.hpp>

namespace weft::python {
namespace {

using bridge::from_bullet;
using bridge::to_bullet;

Eigen::Quaterniond quaternion_from(const py::handle& object, const std::string& where) {
  const std::vector<double> q = numbers_from(object, where, "1");
  if (q.size() != 4) {
    throw InvalidArgument(
        fmt::format("{} has {} numbers, expected a quaternion (x, y, z, w)", where, q.size()));
  }
  const Eigen::Quaterniond result(q[3], q[0], q[1], q[2]);
  if (!(std::abs(result.norm() - 1) < 1e-3)) {
    throw InvalidArgument(
        fmt::format("{} has the length {} [1], expected 1", where, result.norm()));
  }
  return result.normalized();
}

/// What only a body with a mass has.
btRigidBody& dynamic_body(const BodyHandle& handle, const char* what) {
  BodyRecord& record = handle.get();
  if (record.body->isStaticOrKinematicObject()) {
    throw InvalidArgument(
        fmt::format("body '{}': {}, expected a body with a mass", record.name, what));
  }
  return *record.body;
}

void set_position(const BodyHandle& handle, const py::object& position) {
  BodyRecord& body = handle.get();
  place(body, vector_from(position, "body '" + body.name + "': position", "m"),
        orientation_of(body));
  if (!body.body->isKinematicObject()) {
    body.body->setInterpolationWorldTransform(body.body->getWorldTransform());
  }
}

void set_orientation(const BodyHandle& handle, const py::object& orientation) {
  BodyRecord& body = handle.get();
  const Vector3<double> position = position_of(body);
  place(body, position, quaternion_from(orientation, "body '" + body.name + "': orientation"));
  if (!body.body->isKinematicObject()) {
    body.body->setInterpolationWorldTransform(body.body->getWorldTransform());
  }
}

BodyHandle add_body(const std::shared_ptr<World>& world, const scenes::Shape& shape,
                    const BodyOptions& options, const py::object& velocity,
                    const py::object& angular_velocity) {
  require_idle(*world);
  world->check_name(options.name);
  const std::string who = "body '" + options.name + "': ";
  const Vector3<double> v = vector_from(velocity, who + "velocity", "m/s");
  const Vector3<double> w = vector_from(angular_velocity, who + "angular_velocity", "rad/s");
  if (options.mass == 0 && !(v.isZero(0) && w.isZero(0))) {
    throw InvalidArgument(
        who +
        "a velocity of a body without a mass, expected none: move kinematic bodies by position");
  }
  std::shared_ptr<BodyRecord> body = make_body(shape, options);
  body->body->setLinearVelocity(to_bullet(v));
  body->body->setAngularVelocity(to_bullet(w));
  world->add(body);
  return {world, std::move(body)};
}

/// Adds a method of the world for a shape; make takes the shape's own arguments.
template <class... Arguments, class... Names>
void def_add(py::module_& module, const char* name, scenes::Shape (*make)(Arguments...),
             const Names&... names) {
  module.def(
      name,
      [make](const std::shared_ptr<World>& world, const std::string& body_name,
             const py::object& position, const py::object& orientation, double mass, bool kinematic,
             double friction, double restitution, const py::object& velocity,
             const py::object& angular_velocity, Arguments... arguments) {
        const std::string who = "body '" + body_name + "': ";
        const BodyOptions options = {
            .name = body_name,
            .position = vector_from(position, who + "position", "m"),
            .orientation = quaternion_from(orientation, who + "orientation"),
            .mass = mass,
            .is_kinematic = kinematic,
            .friction = friction,
            .restitution = restitution};
        return add_body(world, make(std::forward<Arguments>(arguments)...), options, velocity,
                        angular_velocity);
      },
      py::arg("world"), py::arg("name"), py::arg("position"), py::arg("orientation"),
      py::arg("mass"), py::arg("kinematic"), py::arg("friction"), py::arg("restitution"),
      py::arg("velocity"), py::arg("angular_velocity"), names...);
}

scenes::Shape sphere_shape(double radius) {
  return scenes::SphereShape{radius};
}
scenes::Shape box_shape(const py::object& half_extents) {
  return scenes::BoxShape{vector_from(half_extents, "box: half_extents", "m")};
}
scenes::Shape plane_shape() {
  return scenes::PlaneShape{};
}
scenes::Shape capsule_shape(double radius, double height) {
  return scenes::CapsuleShape{radius, height};
}
scenes::Shape cylinder_shape(double radius, double height) {
  return scenes::CylinderShape{radius, height};
}
scenes::Shape hull_shape(const py::object& points) {
  return scenes::ConvexHullShape{points_from(points, "hull: points", "m")};
}
scenes::Shape mesh_shape(const py::object& vertices, const py::object& triangles) {
  scenes::MeshShape mesh;
  mesh.points = points_from(vertices, "mesh: vertices", "m");
  mesh.triangles = triangles_from(triangles, mesh.points.cols(), "mesh: triangles");
  return mesh;
}

py::tuple quaternion_of(const BodyHandle& handle) {
  const Eigen::Quaterniond q = orientation_of(handle.get());
  return py::make_tuple(q.x(), q.y(), q.z(), q.w());
}

}  // namespace

void bind_bodies(py::module_& module) {
  py::class_<BodyHandle>(module, "RigidBody", py::module_local())
      .def_property_readonly("name", [](const BodyHandle& h) { return h.record->name; })
      .def_property_readonly("is_removed", [](const BodyHandle& h) { return h.record->is_removed; })
      .def_property_readonly("mass",
                             [](const BodyHandle& h) {
                               const btScalar inverse = h.get().body->getInvMass();
                               return inverse > 0 ? 1 / static_cast<double>(inverse) : 0.0;
                             })
      .def_property_readonly("is_kinematic",
                             [](const BodyHandle& h) { return h.get().body->isKinematicObject(); })
      .def_property(
          "position", [](const BodyHandle& h) { return tuple_of(position_of(h.get())); },
          &set_position)
      .def_property("orientation", &quaternion_of, &set_orientation)
      .def_property(
          "velocity",
          [](const BodyHandle& h) {
            return tuple_of(from_bullet(h.get().body->getLinearVelocity()));
          },
          [](const BodyHandle& h, const py::object& v) {
            dynamic_body(h, "its velocity is given")
                .setLinearVelocity(to_bullet(vector_from(v, "body: velocity", "m/s")));
          })
      .def_property(
          "angular_velocity",
          [](const BodyHandle& h) {
            return tuple_of(from_bullet(h.get().body->getAngularVelocity()));
          },
          [](const BodyHandle& h, const py::object& w) {
            dynamic_body(h, "its angular velocity is given")
                .setAngularVelocity(to_bullet(vector_from(w, "body: angular_velocity", "rad/s")));
          })
      .def_property(
          "friction",
          [](const BodyHandle& h) { return static_cast<double>(h.get().body->getFriction()); },
          [](const BodyHandle& h, double friction) {
            if (!(friction >= 0 && std::isfinite(friction))) {
              throw InvalidArgument(
                  fmt::format("body '{}': friction = {} [1], expected >= 0 and finite",
                              h.record->name, friction));
            }
            h.get().body->setFriction(static_cast<btScalar>(friction));
          })
      .def(
          "add_force",
          [](const BodyHandle& h, const py::object& force) {
            dynamic_body(h, "a force acts on it")
                .applyCentralForce(to_bullet(vector_from(force, "body: force", "N")));
          },
          py::arg("force"))
      .def(
          "add_torque",
          [](const BodyHandle& h, const py::object& torque) {
            dynamic_body(h, "a torque acts on it")
                .applyTorque(to_bullet(vector_from(torque, "body: torque", "N m")));
          },
          py::arg("torque"));
  using py::arg;
  def_add(module, "add_sphere", &sphere_shape, arg("radius"));
  def_add(module, "add_box", &box_shape, arg("half_extents"));
  def_add(module, "add_plane", &plane_shape);
  def_add(module, "add_capsule", &capsule_shape, arg("radius"), arg("height"));
  def_add(module, "add_cylinder", &cylinder_shape, arg("radius"), arg("height"));
  def_add(module, "add_hull", &hull_shape, arg("points"));
  def_add(module, "add_mesh", &mesh_shape, arg("vertices"), arg("triangles"));
}

}  // namespace weft::python
