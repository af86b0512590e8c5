#pragma once

#include <memory>
#include <string>
#include <vector>

#include <weft/custom_forces/force_law.hpp>

namespace weft::bench {

/// The classic cloth (7 m x 7 m, 50 x 50 nodes, 28518 springs, 1 kg) with a connection from its
/// middle to every node of its rim.
[[nodiscard]] ClothMesh classic_cloth();

/// One law of the registry on a mesh that it can use, and what it is counted by.
struct LawCase {
  std::string id;
  std::string element;  ///< "spring", "line", "hinge", "face", "connection", "node"
  double num_elements;
  ClothMesh mesh;
  forces::LawSpecification specification;
};

/// A case for every law of the registry; laws that need a closed surface get an icosphere of about
/// as many nodes. size: factor on required parameters, 1 for typical values.
[[nodiscard]] std::vector<LawCase> law_cases(const ClothMesh& cloth, double size = 1.0);

}  // namespace weft::bench
