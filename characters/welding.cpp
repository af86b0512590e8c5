#include <weft/characters/welding.hpp>

#include <map>
#include <vector>

namespace weft::characters {
namespace {

/// What vertices must share to be one: the place and, if asked for, joints and weights.
using Identity = std::vector<double>;

Identity identity_of(const Part& part, std::size_t vertex, Weld weld) {
  const Vector3<double> place = part.positions.col(static_cast<Eigen::Index>(vertex));
  // + 0.0: -0 and 0 are one place.
  Identity identity = {place.x() + 0.0, place.y() + 0.0, place.z() + 0.0};
  if (weld == Weld::kSamePlace) return identity;
  for (int k = part.first_influence[vertex]; k < part.first_influence[vertex + 1]; ++k) {
    identity.push_back(part.influence_joint[static_cast<std::size_t>(k)]);
    identity.push_back(part.influence_weight[static_cast<std::size_t>(k)]);
  }
  return identity;
}

/// For each vertex the first one of its identity.
std::vector<int> first_of_each(const Part& part, Weld weld, ImportReport& report) {
  std::map<Identity, int> first;
  std::vector<int> result;
  for (std::size_t v = 0; v < static_cast<std::size_t>(part.positions.cols()); ++v) {
    const auto [entry, is_new] = first.try_emplace(identity_of(part, v, weld), static_cast<int>(v));
    if (!is_new) ++report.num_merged_vertices;
    result.push_back(entry->second);
  }
  return result;
}

void join_triangles(const Part& part, const std::vector<int>& first, Part& result,
                    ImportReport& report) {
  const bool has_places = part.corner_texture_coordinates.cols() > 0;
  result.triangles.resize(3, part.triangles.cols());
  result.corner_texture_coordinates.resize(2, has_places ? part.triangles.size() : 0);
  Eigen::Index count = 0;
  for (Eigen::Index t = 0; t < part.triangles.cols(); ++t) {
    Eigen::Vector3i corners;
    for (int c = 0; c < 3; ++c) corners[c] = first[static_cast<std::size_t>(part.triangles(c, t))];
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) {
      ++report.num_dropped_triangles;
      continue;
    }
    if (has_places) {
      result.corner_texture_coordinates.middleCols(3 * count, 3) =
          part.corner_texture_coordinates.middleCols(3 * t, 3);
    }
    result.triangles.col(count++) = corners;
  }
  result.triangles.conservativeResize(3, count);
  if (has_places) result.corner_texture_coordinates.conservativeResize(2, 3 * count);
}

void copy_vertex(const Part& from, int vertex, Part& to, Eigen::Index place) {
  to.positions.col(place) = from.positions.col(vertex);
  if (from.colors.cols() > 0) to.colors.col(place) = from.colors.col(vertex);
  const auto v = static_cast<std::size_t>(vertex);
  for (int k = from.first_influence[v]; k < from.first_influence[v + 1]; ++k) {
    to.influence_joint.push_back(from.influence_joint[static_cast<std::size_t>(k)]);
    to.influence_weight.push_back(from.influence_weight[static_cast<std::size_t>(k)]);
  }
  to.first_influence.push_back(static_cast<int>(to.influence_joint.size()));
}

}  // namespace

Part welded(const Part& part, Weld weld, ImportReport& report) {
  const std::vector<int> first = first_of_each(part, weld, report);
  Part result;
  result.node = part.node;
  result.mesh = part.mesh;
  result.material = part.material;
  result.joints = part.joints;
  result.inverse_bind = part.inverse_bind;
  join_triangles(part, first, result, report);

  std::vector<int> kept(first.size(), 0);
  for (const int corner : result.triangles.reshaped()) kept[static_cast<std::size_t>(corner)] = 1;
  Eigen::Index count = 0;
  for (const int keep : kept) count += keep;
  result.positions.resize(3, count);
  result.colors.resize(4, part.colors.cols() > 0 ? count : 0);
  result.first_influence.push_back(0);
  std::vector<int> place(first.size(), 0);
  count = 0;
  for (std::size_t v = 0; v < first.size(); ++v) {
    if (kept[v] == 0) continue;
    place[v] = static_cast<int>(count);
    copy_vertex(part, static_cast<int>(v), result, count++);
  }
  for (int& corner : result.triangles.reshaped()) corner = place[static_cast<std::size_t>(corner)];
  return result;
}

}  // namespace weft::characters
