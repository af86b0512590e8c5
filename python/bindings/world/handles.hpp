#pragma once

// Tested by tests/python/test_lifetimes.py.

#include <memory>
#include <string>

#include <pybind11/pybind11.h>

#include <weft/core/error.hpp>
#include <weft/python/bindings/world/world.hpp>

namespace weft::python {

namespace py = pybind11;

/// Throws Error while a step is in progress on another thread.
inline void require_idle(const World& world) {
  if (world.is_stepping()) {
    throw Error("world: is being stepped by another thread, expected calls between steps only");
  }
}

/// What Python holds of a body: it keeps the world alive, so that nothing is left to chance when Python frees both.
template <class Record>
struct Handle {
  std::shared_ptr<World> world;  ///< before record, which ends first
  std::shared_ptr<Record> record;

  /// The record. Throws Error if the body has left its world, and while the world is being stepped.
  [[nodiscard]] Record& get() const {
    require_idle(*world);
    if (record->is_removed) {
      throw Error("'" + record->name +
                  "' has been removed from its world, expected one that is in it");
    }
    return *record;
  }
};

using ClothHandle = Handle<ClothRecord>;
using BodyHandle = Handle<BodyRecord>;

/// The parts of a world module.
void bind_bodies(py::module_& module);
void bind_cloths(py::module_& module);
void bind_worlds(py::module_& module);

}  // namespace weft::python
