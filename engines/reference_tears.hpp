#pragma once

// Tested by tests/scenes/catalog/tear_test.cpp.

#include <functional>
#include <vector>

#include <weft/reference/solver.hpp>
#include <weft/scenes/scene.hpp>
#include <weft/scenes/torn_cloth.hpp>

namespace weft::scenes {

/// The cloths of a scene that tear, in the reference solver.
class ReferenceTears {
 public:
  /// Makes the laws of a cloth for its mesh as it is now.
  using MakeLaws = std::function<forces::LawSet<double>(const Cloth&, const ClothMesh&)>;

  ReferenceTears() = default;
  ReferenceTears(const Scene& scene, const reference::SpringSolver& solver, MakeLaws make_laws);

  void make_first_cuts(reference::SpringSolver& solver);
  /// Tears what is beyond its limit now.
  void tear(reference::SpringSolver& solver);
  /// Between the laws and the state of the solver: nodes that have come by tears.
  void serialize(StateArchive& archive, reference::SpringSolver& solver);
  /// The topology of each cloth of the scene; null for one that is whole.
  [[nodiscard]] std::shared_ptr<const ClothTopology> topology(std::size_t cloth) const;

 private:
  struct Entry {
    std::size_t cloth;
    Cloth description;
    TornCloth torn;
  };
  void apply(const Tear& tear, Entry& entry, reference::SpringSolver& solver) const;

  std::vector<Entry> entries_;
  MakeLaws make_laws_;
};

}  // namespace weft::scenes
