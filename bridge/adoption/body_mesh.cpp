#include <weft/bridge/adoption/body_mesh.hpp>

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/mesh/topology/winding.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

int node_index(const btSoftBody& body, const btSoftBody::Node* node) {
  return static_cast<int>(node - &body.m_nodes[0]);
}

void read_nodes(const btSoftBody& body, ClothMesh& mesh) {
  const int n = body.m_nodes.size();
  mesh.rest_positions.resize(3, n);
  mesh.masses.resize(n);
  double sum = 0;
  int num_free = 0;
  for (int i = 0; i < n; ++i) {
    const btSoftBody::Node& node = body.m_nodes[i];
    mesh.rest_positions.col(i) = from_bullet<double>(node.m_x);
    if (node.m_im > 0) {
      mesh.masses[i] = 1 / static_cast<double>(node.m_im);
      sum += mesh.masses[i];
      ++num_free;
    } else {
      mesh.pinned.push_back(i);
    }
  }
  const double mean = num_free > 0 ? sum / num_free : 1.0;
  for (const int i : mesh.pinned) mesh.masses[i] = mean;
}

void read_faces(const btSoftBody& body, ClothMesh& mesh) {
  mesh.triangles.resize(3, body.m_faces.size());
  for (int f = 0; f < body.m_faces.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      mesh.triangles(k, f) = node_index(body, body.m_faces[f].m_n[k]);
    }
  }
  mesh.triangles = wound_alike(mesh.triangles);
}

using NodePair = std::pair<int, int>;

/// The two nodes of a link, the lower one first, if it has a length.
std::optional<NodePair> ends_of(const btSoftBody& body, const btSoftBody::Link& link) {
  const NodePair nodes =
      std::minmax({node_index(body, link.m_n[0]), node_index(body, link.m_n[1])});
  const bool has_length = nodes.first != nodes.second && link.m_rl > 0 &&
                          (link.m_n[0]->m_x - link.m_n[1]->m_x).length2() > 0;
  return has_length ? std::optional(nodes) : std::nullopt;
}

/// Which of some pairs come for the first time.
std::vector<char> are_first(const std::vector<NodePair>& pairs) {
  std::vector<std::size_t> order(pairs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t one, std::size_t two) {
    return std::pair(pairs[one], one) < std::pair(pairs[two], two);
  });
  std::vector<char> are(pairs.size(), 1);
  for (std::size_t k = 1; k < order.size(); ++k) {
    if (pairs[order[k]] == pairs[order[k - 1]]) are[order[k]] = 0;
  }
  return are;
}

/// Appends the links of a material to the mesh as an edge set, if there are any.
void read_links(const btSoftBody& body, int material, bool is_bending, BodyMesh& result) {
  LinkedEdges group;
  group.material = body.m_materials[material];
  group.is_bending = is_bending;
  group.name = "material " + std::to_string(material) + (is_bending ? " (bending)" : "");
  std::vector<const btSoftBody::Link*> links;
  std::vector<NodePair> ends;
  for (int l = 0; l < body.m_links.size(); ++l) {
    const btSoftBody::Link& link = body.m_links[l];
    if (link.m_material != group.material || (link.m_bbending != 0) != is_bending) continue;
    if (const std::optional<NodePair> nodes = ends_of(body, link)) {
      links.push_back(&link);
      ends.push_back(*nodes);
    } else {
      ++group.num_left_out;
    }
  }
  const std::vector<char> are_new = are_first(ends);
  std::vector<NodePair> pairs;
  double sum = 0;
  int num_movable = 0;
  for (std::size_t k = 0; k < ends.size(); ++k) {
    if (are_new[k] == 0) {
      ++group.num_left_out;
      continue;
    }
    pairs.push_back(ends[k]);
    const double mobility =
        static_cast<double>(links[k]->m_n[0]->m_im) + static_cast<double>(links[k]->m_n[1]->m_im);
    if (!(mobility > 0)) continue;
    sum += 1 / mobility;
    ++num_movable;
  }
  if (pairs.empty() && group.num_left_out == 0) return;
  group.num_links = static_cast<int>(pairs.size());
  group.mean_reduced_mass = num_movable > 0 ? sum / num_movable : 0.0;
  Edges edges(2, static_cast<Eigen::Index>(pairs.size()));
  for (Eigen::Index e = 0; e < edges.cols(); ++e) {
    const auto& nodes = pairs[static_cast<std::size_t>(e)];
    edges.col(e) << nodes.first, nodes.second;
  }
  result.mesh.edge_sets.push_back({group.name, std::move(edges)});
  result.links.push_back(std::move(group));
}

}  // namespace

BodyMesh mesh_of(const btSoftBody& body) {
  BodyMesh result;
  read_nodes(body, result.mesh);
  read_faces(body, result.mesh);
  for (int m = 0; m < body.m_materials.size(); ++m) {
    for (const bool is_bending : {false, true}) read_links(body, m, is_bending, result);
  }
  return result;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
