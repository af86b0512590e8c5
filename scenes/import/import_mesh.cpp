#include <weft/scenes/import/import_mesh.hpp>

#include <algorithm>
#include <cmath>
#include <map>

#include <weft/scenes/import/weld.hpp>

namespace weft::import {
namespace {

constexpr double kRelativeWeldTolerance = 1e-6;
constexpr std::size_t kMaxNames = 10;  // in a message

/// Name of a part in messages, and as a group.
const std::string& name_of(const FilePart& part) {
  return part.node.empty() ? part.mesh : part.node;
}

bool has_name(const FilePart& part, const std::string& name) {
  return part.node == name || part.mesh == name || part.material == name;
}

std::vector<FilePart> select(std::vector<FilePart> parts, const std::filesystem::path& file,
                             const std::string& name) {
  if (name.empty()) return parts;
  std::string known;
  for (std::size_t p = 0; p < parts.size() && p < kMaxNames; ++p) {
    known += (p == 0 ? "" : ", ") + name_of(parts[p]);
  }
  const auto is_other = [&](const FilePart& part) { return !has_name(part, name); };
  parts.erase(std::remove_if(parts.begin(), parts.end(), is_other), parts.end());
  if (parts.empty()) {
    throw ImportError(file, "has no part '" + name + "', expected one of " + known);
  }
  return parts;
}

void check(const ImportOptions& options) {
  if (!(options.scale > 0) || !std::isfinite(options.scale)) {
    throw InvalidArgument("import: scale = " + std::to_string(options.scale) +
                          ", expected > 0 and finite");
  }
  const double tolerance = options.weld_tolerance.value_or(0.0);
  if (!(tolerance >= 0) || !std::isfinite(tolerance)) {
    throw InvalidArgument("import: weld_tolerance = " + std::to_string(tolerance) +
                          " [m], expected >= 0 and finite");
  }
}

/// What is left of the file on its way to a surface.
struct Draft {
  std::vector<FilePart> parts;
  std::vector<int> first_vertex;  ///< of each part
  Matrix3X<double> vertices;      ///< of all parts [m]
  Soup soup;
  std::vector<Eigen::Vector3i> corners;  ///< of each triangle: vertices
  std::vector<int> node_of;              ///< node of each vertex, -1 for one that no face names
  std::vector<int> keep;                 ///< triangles that stay
  MeshReport report;
};

void place_vertices(const ImportOptions& options, const std::filesystem::path& file, Draft& draft) {
  int count = 0;
  for (const FilePart& part : draft.parts) {
    draft.first_vertex.push_back(count);
    count += part.num_vertices();
  }
  draft.vertices.resize(3, count);
  draft.report.num_vertices = count;
  for (std::size_t p = 0; p < draft.parts.size(); ++p) {
    const FilePart& part = draft.parts[p];
    for (int v = 0; v < part.num_vertices(); ++v) {
      const Vector3<double> given(&part.positions[3 * static_cast<std::size_t>(v)]);
      const Vector3<double> turned =
          options.up == UpAxis::kY ? given : Vector3<double>(given.x(), given.z(), -given.y());
      draft.vertices.col(draft.first_vertex[p] + v) = options.scale * turned;
      if (!(options.scale * given).allFinite()) {
        throw ImportError(file, "the position of vertex " + std::to_string(v) + " of '" +
                                    name_of(part) + "' is not finite");
      }
    }
  }
}

/// Corners of the triangles of a polygon.
std::vector<Eigen::Vector3i> cut(const std::vector<int>& polygon,
                                 const Matrix3X<double>& vertices) {
  std::vector<Eigen::Vector3i> triangles;
  if (polygon.size() == 4) {
    const auto distance = [&](std::size_t a, std::size_t b) {
      return (vertices.col(polygon[a]) - vertices.col(polygon[b])).norm();
    };
    if (distance(1, 3) < distance(0, 2)) {
      return {{polygon[0], polygon[1], polygon[3]}, {polygon[1], polygon[2], polygon[3]}};
    }
  }
  for (std::size_t c = 2; c < polygon.size(); ++c) {
    triangles.emplace_back(polygon[0], polygon[c - 1], polygon[c]);
  }
  return triangles;
}

void cut_faces(Draft& draft) {
  for (std::size_t p = 0; p < draft.parts.size(); ++p) {
    draft.report.parts.push_back(name_of(draft.parts[p]));
    int number = 0;
    for (std::vector<int> face : draft.parts[p].faces) {
      const FaceOfFile name{static_cast<int>(p), number++};
      if (face.size() < 3) {
        ++draft.report.other_elements;
        continue;
      }
      ++draft.report.num_faces;
      for (int& vertex : face) vertex += draft.first_vertex[p];
      for (const Eigen::Vector3i& corners : cut(face, draft.vertices)) {
        draft.corners.push_back(corners);
        draft.soup.faces.push_back(name);
      }
    }
  }
}

/// Only vertices of faces become nodes.
void weld_vertices(const ImportOptions& options, Draft& draft) {
  std::vector<bool> is_used(static_cast<std::size_t>(draft.vertices.cols()), false);
  for (const Eigen::Vector3i& corners : draft.corners) {
    for (const int vertex : corners) is_used[static_cast<std::size_t>(vertex)] = true;
  }
  std::vector<int> used;
  for (std::size_t v = 0; v < is_used.size(); ++v) {
    if (is_used[v]) used.push_back(static_cast<int>(v));
  }
  draft.report.unreferenced_vertices = static_cast<int>(is_used.size() - used.size());
  draft.node_of.assign(is_used.size(), -1);
  if (used.empty()) return;
  const Matrix3X<double> positions = draft.vertices(Eigen::all, used);
  const double diagonal = (positions.rowwise().maxCoeff() - positions.rowwise().minCoeff()).norm();
  const std::vector<int> nodes =
      weld(positions, options.weld_tolerance.value_or(kRelativeWeldTolerance * diagonal));
  const int num_nodes = *std::max_element(nodes.begin(), nodes.end()) + 1;
  draft.soup.positions.resize(3, num_nodes);
  for (std::size_t u = used.size(); u-- > 0;) {  // backwards: the first vertex of a node wins
    draft.node_of[static_cast<std::size_t>(used[u])] = nodes[u];
    draft.soup.positions.col(nodes[u]) = positions.col(static_cast<Eigen::Index>(u));
  }
  draft.report.num_nodes = num_nodes;
  draft.report.welded_vertices = static_cast<int>(used.size()) - num_nodes;
  for (const Eigen::Vector3i& corners : draft.corners) {
    draft.soup.triangles.emplace_back(draft.node_of[static_cast<std::size_t>(corners[0])],
                                      draft.node_of[static_cast<std::size_t>(corners[1])],
                                      draft.node_of[static_cast<std::size_t>(corners[2])]);
  }
}

Draft make_draft(const MeshInput& input, const ImportOptions& options) {
  check(options);
  const std::filesystem::path& file = input.name;
  Draft draft;
  draft.parts = select(read_mesh_file(input), file, options.part);
  place_vertices(options, file, draft);
  cut_faces(draft);
  weld_vertices(options, draft);
  inspect(draft.soup, draft.report, draft.keep);
  return draft;
}

Surface surface_of(const Draft& draft) {
  Surface surface;
  surface.positions = draft.soup.positions;
  const auto num_triangles = static_cast<Eigen::Index>(draft.keep.size());
  surface.triangles.resize(3, num_triangles);
  const bool has_texture =
      std::all_of(draft.parts.begin(), draft.parts.end(),
                  [](const FilePart& part) { return !part.texture_coordinates.empty(); });
  if (has_texture) surface.corner_texture_coordinates.resize(2, 3 * num_triangles);
  for (Eigen::Index t = 0; t < num_triangles; ++t) {
    const auto from = static_cast<std::size_t>(draft.keep[static_cast<std::size_t>(t)]);
    surface.triangles.col(t) = draft.soup.triangles[from];
    if (!has_texture) continue;
    const auto p = static_cast<std::size_t>(draft.soup.faces[from].part);
    for (int c = 0; c < 3; ++c) {
      const auto vertex = static_cast<std::size_t>(draft.corners[from][c] - draft.first_vertex[p]);
      surface.corner_texture_coordinates.col(3 * t + c) =
          Eigen::Vector2d(&draft.parts[p].texture_coordinates[2 * vertex]);
    }
  }
  return surface;
}

/// Weights of nodes by group; a node has the largest of its vertices.
std::vector<NodeGroup> groups_of(const Draft& draft) {
  std::map<std::pair<bool, std::string>, std::map<int, double>> weights;
  for (std::size_t p = 0; p < draft.parts.size(); ++p) {
    const FilePart& part = draft.parts[p];
    const auto add = [&](bool is_part, const std::string& name, int vertex, double weight) {
      const int node = draft.node_of[static_cast<std::size_t>(draft.first_vertex[p] + vertex)];
      if (node < 0) return;
      double& known = weights[{is_part, name}][node];
      known = std::max(known, weight);
    };
    for (int v = 0; v < part.num_vertices(); ++v) add(true, name_of(part), v, 1.0);
    for (const FileGroup& group : part.groups) {
      for (const auto& [vertex, weight] : group.weights) add(false, group.name, vertex, weight);
    }
  }
  std::vector<NodeGroup> groups;
  for (const auto& [key, nodes] : weights) {
    NodeGroup group{key.second, {}, {}, key.first};
    for (const auto& [node, weight] : nodes) {
      group.nodes.push_back(node);
      group.weights.push_back(weight);
    }
    groups.push_back(std::move(group));
  }
  return groups;
}

}  // namespace

ImportedMesh import_mesh(const MeshInput& input, const ImportOptions& options) {
  const Draft draft = make_draft(input, options);
  const std::optional<std::string> fault =
      options.is_body ? draft.report.fault() : draft.report.drawing_fault();
  if (fault) {
    throw ImportError(input.name, *fault);
  }
  ImportedMesh mesh;
  mesh.surface = surface_of(draft);
  if (!mesh.surface.corner_texture_coordinates.allFinite()) {
    throw ImportError(input.name, "a texture coordinate is not finite");
  }
  mesh.groups = groups_of(draft);
  mesh.report = draft.report;
  return mesh;
}

ImportedMesh import_mesh(const std::filesystem::path& file, const ImportOptions& options) {
  return import_mesh(mesh_input(file), options);
}

MeshReport check_mesh(const std::filesystem::path& file, const ImportOptions& options) {
  return make_draft(mesh_input(file), options).report;
}

}  // namespace weft::import
