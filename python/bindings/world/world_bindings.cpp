// Tested by tests/python/test_world.py, tests/python/test_threads.py, tests/python/test_interrupt.py.

#include <optional>
#include <utility>

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <weft/core/error.hpp>
#include <weft/engines/engine_table.hpp>
#include <weft/python/bindings/law_list.hpp>
#include <weft/python/bindings/numpy_arrays.hpp>
#include <weft/python/bindings/scene_run.hpp>
#include <weft/python/bindings/signals.hpp>
#include <weft/python/bindings/world/handles.hpp>

namespace weft::python {
namespace {

/// While a step runs without the lock of the interpreter, other Python threads are refused.
class Stepping {
 public:
  explicit Stepping(World& world) : world_(world) {
    require_idle(world);
    world.set_stepping(true);
  }
  ~Stepping() { world_.set_stepping(false); }
  Stepping(const Stepping&) = delete;
  Stepping& operator=(const Stepping&) = delete;

 private:
  World& world_;
};

py::tuple step(const std::shared_ptr<World>& world, double time_step, int steps) {
  if (steps < 1) {
    throw InvalidArgument("world: steps = " + std::to_string(steps) + ", expected >= 1");
  }
  StepSummary summary;
  {
    const Stepping stepping(*world);
    const py::gil_scoped_release unlocked;
    Signals signals;
    for (int i = 0; i < steps; ++i) {
      if (i > 0) signals.check();
      world->step(time_step, summary);
    }
  }
  return py::make_tuple(summary.largest_error, summary.unfinished_steps, summary.num_tears);
}

bridge::FastSettings fast_settings(double tolerance, int newton_iterations, int linear_iterations,
                                   bool may_sleep, double sleep_speed, double sleep_time) {
  bridge::FastSettings fast;
  fast.solver = {newton_iterations, linear_iterations, tolerance};
  fast.may_sleep = may_sleep;
  fast.sleep_speed = sleep_speed;
  fast.sleep_time = sleep_time;
  return fast;
}

using TearTuple =
    std::tuple<std::string, double, double, int, std::vector<std::pair<std::string, double>>>;

std::optional<TearRule> rule_from(const std::optional<TearTuple>& given) {
  if (!given) return std::nullopt;
  const auto& [edge_set, strain, variation, max_splits, weak] = *given;
  TearRule rule{edge_set, strain, variation, max_splits};
  for (const auto& [node_set, limit] : weak) rule.weak.push_back({node_set, limit});
  return rule;
}

ClothHandle add_cloth(const std::shared_ptr<World>& world, const std::string& name,
                      const ClothMesh& mesh, const std::vector<LawTuple>& laws, double margin,
                      double friction, bool implicit, const bridge::FastSettings& fast,
                      bool meets_itself, bool meets_cloths, std::optional<double> thickness,
                      const std::optional<TearTuple>& tear, bool can_be_cut,
                      const py::object& velocity) {
  require_idle(*world);
  const Vector3<double> v = vector_from(velocity, "cloth '" + name + "': velocity", "m/s");
  ClothHandle handle{world, world->add_cloth(name, mesh,
                                             {.laws = laws_from(laws),
                                              .margin = margin,
                                              .friction = friction,
                                              .is_implicit = implicit,
                                              .fast = fast,
                                              .meets_itself = meets_itself,
                                              .meets_cloths = meets_cloths,
                                              .thickness = thickness,
                                              .tear = rule_from(tear),
                                              .can_be_cut = can_be_cut})};
  btSoftBody& body = *handle.record->body;
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    btSoftBody::Node& node = body.m_nodes[i];
    if (node.m_im > 0)
      node.m_v.setValue(static_cast<btScalar>(v[0]), static_cast<btScalar>(v[1]),
                        static_cast<btScalar>(v[2]));
  }
  return handle;
}

ClothHandle adopt(const std::shared_ptr<World>& world, const std::string& name,
                  const py::object& vertices, const py::object& triangles,
                  const std::vector<LawTuple>& laws, std::optional<double> stiffness,
                  double time_step, const bridge::FastSettings& fast, double mass,
                  double link_factor, std::optional<double> bending_factor, int iterations,
                  double margin, double friction, double damping, bool meets_cloths,
                  const py::object& pins) {
  require_idle(*world);
  const Matrix3X<double> points = points_from(vertices, "adopt: vertices", "m");
  const Triangles faces = triangles_from(triangles, points.cols(), "adopt: triangles");
  const BulletBodyOptions options = {
      .mass = mass,
      .link_factor = link_factor,
      .bending_factor = bending_factor,
      .iterations = iterations,
      .margin = margin,
      .friction = friction,
      .damping = damping,
      .meets_cloths = meets_cloths,
      .pins = sorted_nodes_from(pins, static_cast<int>(points.cols()), "adopt: pins")};
  return {
      world,
      world->adopt(
          name, points, faces, options,
          {.time_step = time_step, .stiffness = stiffness, .laws = laws_from(laws), .fast = fast})};
}

template <class Record>
std::vector<Handle<Record>> handles_of(const std::shared_ptr<World>& world,
                                       const std::vector<std::shared_ptr<Record>>& records) {
  require_idle(*world);
  std::vector<Handle<Record>> handles;
  for (const auto& record : records) handles.push_back({world, record});
  return handles;
}

template <class Record>
void remove(const std::shared_ptr<World>& world, const Handle<Record>& handle) {
  require_idle(*world);
  if (handle.world != world) {
    throw InvalidArgument("world: '" + handle.record->name +
                          "' is in another world, expected one of this world");
  }
  world->remove(*handle.record);
}

py::dict run_engine(const scenes::Scene& scene, const std::string& engine,
                    const std::filesystem::path& output, bool may_replace,
                    std::optional<double> duration, std::optional<double> time_step) {
  for (const scenes::EngineInfo& info : scenes::engine_table()) {
    if (info.name != engine || info.precision != (sizeof(btScalar) == sizeof(double)
                                                      ? scenes::StoredPrecision::kFloat64
                                                      : scenes::StoredPrecision::kFloat32)) {
      continue;
    }
    return run_scene(scene, {.engine = engine,
                             .precision = info.precision,
                             .make = info.make,
                             .output = output,
                             .may_replace = may_replace,
                             .duration = duration,
                             .time_step = time_step});
  }
  throw InvalidArgument("scene: engine '" + engine + "' is not in this module");
}

}  // namespace

void bind_worlds(py::module_& module) {
  using py::arg;
  py::class_<bridge::FastSettings>(module, "FastSettings", py::module_local())
      .def(py::init(&fast_settings), arg("tolerance"), arg("newton_iterations"),
           arg("linear_iterations"), arg("may_sleep"), arg("sleep_speed"), arg("sleep_time"));
  py::class_<World, std::shared_ptr<World>>(module, "World", py::module_local())
      .def(py::init([](const py::object& gravity, double voxel) {
             return std::make_shared<World>(vector_from(gravity, "world: gravity", "m/s^2"), voxel);
           }),
           arg("gravity"), arg("distance_field_voxel"))
      .def_property_readonly("gravity", [](const World& w) { return tuple_of(w.gravity()); })
      .def_property_readonly("time", &World::time)
      .def("step", &step, arg("time_step"), arg("steps"));
  module.def("cloths", [](const std::shared_ptr<World>& w) { return handles_of(w, w->cloths()); });
  module.def("bodies", [](const std::shared_ptr<World>& w) { return handles_of(w, w->bodies()); });
  module.def("remove", &remove<ClothRecord>);
  module.def("remove", &remove<BodyRecord>);
  module.def("add_cloth", &add_cloth, arg("world"), arg("name"), arg("mesh"), arg("laws"),
             arg("margin"), arg("friction"), arg("implicit"), arg("fast"), arg("meets_itself"),
             arg("meets_cloths"), arg("thickness"), arg("tear"), arg("can_be_cut"),
             arg("velocity"));
  module.def("adopt", &adopt, arg("world"), arg("name"), arg("vertices"), arg("triangles"),
             arg("laws"), arg("stiffness"), arg("time_step"), arg("fast"), arg("mass"),
             arg("link_factor"), arg("bending_factor"), arg("iterations"), arg("margin"),
             arg("friction"), arg("damping"), arg("meets_cloths"), arg("pins"));
  module.def("run_engine", &run_engine, arg("scene"), arg("engine"), arg("output"),
             arg("may_replace"), arg("duration"), arg("time_step"));
}

}  // namespace weft::python
