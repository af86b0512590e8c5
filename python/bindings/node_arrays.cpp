#include <weft/python/bindings/node_arrays.hpp>

namespace weft::python {
namespace {

using Member = btVector3 btSoftBody::Node::*;

py::array show(const ClothHandle& cloth, Member member) {
  btSoftBody& body = *cloth.get().body;
  // What the array is based on: it ends with the last array that shows these nodes.
  const py::capsule owner(new ClothHandle(cloth),
                          [](void* handle) { delete static_cast<ClothHandle*>(handle); });
  return py::array(py::dtype::of<btScalar>(),
                   {static_cast<py::ssize_t>(body.m_nodes.size()), py::ssize_t{3}},
                   {static_cast<py::ssize_t>(sizeof(btSoftBody::Node)),
                    static_cast<py::ssize_t>(sizeof(btScalar))},
                   (body.m_nodes[0].*member).m_floats, owner);
}

}  // namespace

py::array node_positions(const ClothHandle& cloth) {
  return show(cloth, &btSoftBody::Node::m_x);
}

py::array node_velocities(const ClothHandle& cloth) {
  return show(cloth, &btSoftBody::Node::m_v);
}

}  // namespace weft::python
