#include <weft/engines/reference_tears.hpp>

#include <utility>

namespace weft::scenes {

ReferenceTears::ReferenceTears(const Scene& scene, const reference::SpringSolver& solver,
                               MakeLaws make_laws)
    : make_laws_(std::move(make_laws)) {
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    const Cloth& cloth = scene.cloths[c];
    if (!cloth.tear) continue;
    entries_.push_back({c, cloth, TornCloth(solver.system().bodies[c].mesh, *cloth.tear)});
  }
}

void ReferenceTears::apply(const Tear& tear, Entry& entry, reference::SpringSolver& solver) const {
  const reference::Body& old = solver.system().bodies[entry.cloth];
  const Eigen::Index num_old = old.positions.cols();
  reference::Body body;
  body.name = old.name;
  body.mesh = tear.mesh;
  body.laws = make_laws_(entry.description, tear.mesh);
  body.positions = old.positions;
  body.velocities = old.velocities;
  body.positions.conservativeResize(3, tear.mesh.num_nodes());
  body.velocities.conservativeResize(3, tear.mesh.num_nodes());
  for (std::size_t k = 0; k < tear.origins.size(); ++k) {
    const Eigen::Index node = num_old + static_cast<Eigen::Index>(k);
    body.positions.col(node) = old.positions.col(tear.origins[k]);
    body.velocities.col(node) = old.velocities.col(tear.origins[k]);
  }
  body.collision_margin = old.collision_margin;
  body.friction = old.friction;
  body.face_contact = old.face_contact;
  body.self_contact = old.self_contact;
  body.mutual_contact = old.mutual_contact;
  body.self_thickness = old.self_thickness;
  solver.replace_body(entry.cloth, std::move(body));
  entry.torn.adopt(tear);
}

void ReferenceTears::make_first_cuts(reference::SpringSolver& solver) {
  for (Entry& entry : entries_) {
    if (const auto tear = entry.torn.first_cuts()) apply(*tear, entry, solver);
  }
}

void ReferenceTears::tear(reference::SpringSolver& solver) {
  for (Entry& entry : entries_) {
    const auto tear = entry.torn.tear_at(solver.system().bodies[entry.cloth].positions);
    if (tear) apply(*tear, entry, solver);
  }
}

void ReferenceTears::serialize(StateArchive& archive, reference::SpringSolver& solver) {
  archive.part("tears");
  for (Entry& entry : entries_) {
    const TornCloth loaded = entry.torn;
    entry.torn.serialize(archive);
    if (!archive.is_reading() || entry.torn.topology() == loaded.topology()) continue;
    const TornCloth torn = std::exchange(entry.torn, loaded);
    apply(torn.tear_since(loaded), entry, solver);
    entry.torn = torn;
  }
}

std::shared_ptr<const ClothTopology> ReferenceTears::topology(std::size_t cloth) const {
  for (const Entry& entry : entries_) {
    if (entry.cloth == cloth) return entry.torn.topology();
  }
  return nullptr;
}

}  // namespace weft::scenes
