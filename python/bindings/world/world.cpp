#include <weft/python/bindings/world/world.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/bridge/classic/nodes/pinned_nodes.hpp>
#include <weft/bridge/tearing.hpp>
#include <weft/core/error.hpp>

namespace weft::python {
namespace {

/// Steps [s] whose square single precision still has; longer than the longest one nothing is told from anything.
constexpr double kShortestStep = 1e-9;
constexpr double kLongestStep = 1e3;

double checked_voxel(double voxel) {
  if (voxel >= 1e-6 && voxel <= 1e3) return voxel;
  throw InvalidArgument(
      fmt::format("world: distance_field_voxel = {} [m], expected 1e-06 to 1000", voxel));
}

template <class Record>
void erase(std::vector<std::shared_ptr<Record>>& records, const Record& record) {
  std::erase_if(records, [&](const auto& other) { return other.get() == &record; });
}

}  // namespace

World::World(const Vector3<double>& gravity, double voxel)
    : gravity_(gravity), world_({gravity, checked_voxel(voxel)}) {}

World::~World() {
  for (const auto& cloth : cloths_) {
    world_.world().removeSoftBody(cloth->body.get());
    cloth->is_removed = true;
    ++cloth->generation;
  }
  for (const auto& body : bodies_) {
    world_.world().removeRigidBody(body->body.get());
    body->is_removed = true;
  }
}

void World::check_name(const std::string& name) const {
  if (name.empty()) throw InvalidArgument("world: name is empty, expected some letters");
  const auto has_name = [&](const auto& record) { return record->name == name; };
  if (std::any_of(cloths_.begin(), cloths_.end(), has_name) ||
      std::any_of(bodies_.begin(), bodies_.end(), has_name)) {
    throw InvalidArgument("world: name '" + name + "' is taken, expected another one");
  }
}

std::shared_ptr<ClothRecord> World::add_cloth(const std::string& name, const ClothMesh& mesh,
                                              const ClothOptions& options) {
  check_name(name);
  std::shared_ptr<ClothRecord> cloth = make_cloth(world_.info(), name, mesh, options);
  world_.world().addSoftBody(cloth->body.get());
  try {
    attach_laws(solver(), *cloth, options);
  } catch (...) {
    world_.world().removeSoftBody(cloth->body.get());
    throw;
  }
  cloths_.push_back(cloth);
  return cloth;
}

std::shared_ptr<ClothRecord> World::adopt(const std::string& name, const Matrix3X<double>& vertices,
                                          const Triangles& triangles,
                                          const BulletBodyOptions& options,
                                          const bridge::AdoptionSettings& settings) {
  check_name(name);
  std::shared_ptr<ClothRecord> cloth =
      make_adopted(solver(), world_.info(), name, vertices, triangles, options, settings);
  world_.world().addSoftBody(cloth->body.get());
  cloths_.push_back(cloth);
  return cloth;
}

void World::add(std::shared_ptr<BodyRecord> body) {
  check_name(body->name);
  world_.world().addRigidBody(body->body.get());
  bodies_.push_back(std::move(body));
}

void World::remove(ClothRecord& cloth) {
  if (cloth.is_removed) return;
  solver().detach(*cloth.body);
  world_.world().removeSoftBody(cloth.body.get());
  cloth.is_removed = true;
  ++cloth.generation;
  erase(cloths_, cloth);
}

void World::remove(BodyRecord& body) {
  if (body.is_removed) return;
  for (const auto& cloth : cloths_) {
    const auto& anchors = cloth->body->m_anchors;
    for (int a = 0; a < anchors.size(); ++a) {
      if (anchors[a].m_body != body.body.get()) continue;
      throw InvalidArgument("world: body '" + body.name + "' holds anchors of cloth '" +
                            cloth->name +
                            "', expected none: release them, or remove the cloth first");
    }
  }
  world_.world().removeRigidBody(body.body.get());
  body.is_removed = true;
  const auto found = std::find_if(bodies_.begin(), bodies_.end(),
                                  [&](const auto& other) { return other.get() == &body; });
  removed_shapes_.push_back(body.shape);
  removed_.push_back(*found);
  bodies_.erase(found);
  for (const auto& cloth : cloths_) solver().wake(*cloth->body);
}

void World::lead_pins(double time_step) {
  for (const auto& cloth : cloths_) {
    btSoftBody& body = *cloth->body;
    if (!cloth->led_nodes.empty()) {
      bridge::move_kinematic_nodes(cloth->led_nodes, cloth->led_targets, time_step, body);
    }
    for (std::size_t i = 0; i < cloth->forced_nodes.size(); ++i) {
      body.m_nodes[cloth->forced_nodes[i]].m_f +=
          bridge::to_bullet(cloth->forces.col(static_cast<Eigen::Index>(i)));
    }
    cloth->forced_nodes.clear();
  }
}

void World::place_pins(double time_step) {
  for (const auto& cloth : cloths_) {
    if (cloth->led_nodes.empty()) continue;
    bridge::place_nodes(cloth->led_nodes, cloth->led_targets, time_step, *cloth->body);
    // Bullet would go on moving them with the velocity of this step.
    for (const int node : cloth->led_nodes) cloth->body->m_nodes[node].m_v.setZero();
    cloth->led_nodes.clear();
  }
}

void World::tear_cloths(StepSummary& summary) {
  for (const auto& cloth : cloths_) {
    if (!cloth->tear_rule) continue;
    const Tear tear = bridge::tear(solver(), *cloth->body, *cloth->mesh, cloth->settings,
                                   cloth->laws, *cloth->tear_rule);
    if (!tear.any()) continue;
    ++cloth->generation;
    summary.num_tears += static_cast<int>(tear.origins.size());
  }
}

void World::summarize(StepSummary& summary) {
  bool is_finished = true;
  for (const auto& cloth : cloths_) {
    const bridge::ClothState state = cloth->handle.state();
    summary.largest_error = std::max(summary.largest_error, state.step_error.distance);
    is_finished = is_finished && state.step_error.is_within_tolerance;
  }
  if (!is_finished) ++summary.unfinished_steps;
}

void World::step(double time_step, StepSummary& summary) {
  if (!(time_step >= kShortestStep && time_step <= kLongestStep)) {
    throw InvalidArgument(fmt::format("world: time_step = {} [s], expected {} to {}", time_step,
                                      kShortestStep, kLongestStep));
  }
  // The step that Bullet takes, which it rounds to single precision in both builds.
  const auto taken = static_cast<double>(static_cast<float>(time_step));
  lead_pins(taken);
  world_.step(time_step);
  place_pins(taken);
  removed_.clear();
  time_ += taken;
  summarize(summary);
  tear_cloths(summary);
}

int World::cut(ClothRecord& cloth, const Blade& blade) {
  if (!cloth.can_be_cut) {
    throw InvalidArgument(
        "cloth '" + cloth.name +
        "': was made without room for cuts, expected can_be_cut=True or a tear rule");
  }
  const Tear tear =
      bridge::cut(solver(), *cloth.body, *cloth.mesh, cloth.settings, cloth.laws, blade);
  if (tear.any()) ++cloth.generation;
  return static_cast<int>(tear.origins.size());
}

std::string World::name_of(const btCollisionObject* object) const {
  for (const auto* list : {&bodies_, &removed_}) {
    for (const auto& body : *list) {
      if (body->body.get() == object) return body->name;
    }
  }
  return "";
}

}  // namespace weft::python
