#include <weft/playback/exchange/gltf/gltf_cloth.hpp>

#include <algorithm>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <weft/playback/exchange/gltf/morph_targets.hpp>
#include <weft/playback/exchange/gltf/tracked_nodes.hpp>
#include <weft/playback/exchange/unfit_recording.hpp>
#include <weft/playback/rendering/meshes/cloth_drawing.hpp>
#include <weft/playback/rendering/meshes/cloth_layout.hpp>

namespace weft::scenes {
namespace {

using Use = GlbWriter::Use;

// Ways to put vertices together, of the glTF 2.0 specification, section 5.24.
constexpr int kLines = 1;
constexpr int kTriangles = 4;

/// The vertices of a cloth. Those of a seam of the picture are several of one node.
struct ClothVertices {
  std::vector<int> nodes;     ///< of the mesh that have a vertex, ascending
  std::vector<int> vertices;  ///< place in nodes of each vertex
  Eigen::MatrixXi elements;   ///< vertices of triangles, 3 x t, or of a rope's lines, 2 x m
  Eigen::Matrix2Xf places;    ///< of the vertices in a picture, 2 x v; empty: none
  [[nodiscard]] bool is_rope() const { return elements.rows() == 2; }
};

ClothVertices vertices_of(const ClothLayout& layout) {
  ClothVertices result;
  if (layout.rope.cols() > 0) {
    result.nodes.assign(layout.rope.data(), layout.rope.data() + layout.rope.size());
  } else {
    result.nodes = layout.nodes;
  }
  std::sort(result.nodes.begin(), result.nodes.end());
  result.nodes.erase(std::unique(result.nodes.begin(), result.nodes.end()), result.nodes.end());
  const auto place_of = [&](int node) {
    return static_cast<int>(std::lower_bound(result.nodes.begin(), result.nodes.end(), node) -
                            result.nodes.begin());
  };
  if (layout.rope.cols() > 0) {
    for (int i = 0; i < static_cast<int>(result.nodes.size()); ++i) result.vertices.push_back(i);
    result.elements = layout.rope.unaryExpr(place_of);
    return result;
  }
  for (const int node : layout.nodes) result.vertices.push_back(place_of(node));
  const std::vector<int> corners(layout.corners.begin(), layout.corners.end());
  result.elements = Eigen::Map<const Eigen::MatrixXi>(corners.data(), 3, std::ssize(corners) / 3);
  if (!layout.has_coordinates) return result;
  result.places.resize(2, std::ssize(layout.coordinates));
  for (Eigen::Index v = 0; v < result.places.cols(); ++v) {
    result.places.col(v) = layout.coordinates[static_cast<std::size_t>(v)];
  }
  return result;
}

/// Positions and normals of the nodes over time, each 3n x frames.
struct ClothMotion {
  Eigen::MatrixXd positions;  ///< [m]
  Eigen::MatrixXf normals;    ///< empty for what has none
};

ClothMotion read_motion(const RecordingReader& reader, std::size_t index,
                        const std::vector<int>& nodes, bool has_normals, TrackedNodes& tracked,
                        const std::function<void()>& on_frame) {
  const Eigen::Index rows = 3 * std::ssize(nodes);
  ClothMotion motion;
  motion.positions.resize(rows, reader.num_frames());
  if (has_normals) motion.normals.resize(rows, reader.num_frames());
  for (int frame = 0; frame < reader.num_frames(); ++frame) {
    const SceneState state = reader.frame(frame);
    const ClothState& cloth = state.cloths[index];
    const std::vector<int>& now = tracked.nodes(cloth);
    // Single precision is enough near one of the nodes. All nodes are finite.
    const DrawLimits limits{cloth.positions.col(0), std::numeric_limits<float>::max()};
    const SurfaceMesh surface =
        has_normals ? cloth_surface(tracked.triangles(cloth), cloth.positions, limits)
                    : SurfaceMesh();
    for (Eigen::Index i = 0; i < std::ssize(nodes); ++i) {
      const int node = now[static_cast<std::size_t>(nodes[static_cast<std::size_t>(i)])];
      motion.positions.block<3, 1>(3 * i, frame) = cloth.positions.col(node);
      if (!has_normals) continue;
      motion.normals.block<3, 1>(3 * i, frame) =
          surface.vertices[static_cast<std::size_t>(node)].normal;
    }
    on_frame();
  }
  return motion;
}

/// A cloth as a document has it, before its motion becomes morph targets.
struct MovingCloth {
  ClothVertices vertices;
  ClothMotion motion;
  bool has_node_numbers = true;  ///< vertices are nodes of the recording
};

bool is_painted_from_middle(const BodyLook& look) {
  return look.mapping == TextureMapping::kByDirection || look.mapping == TextureMapping::kFromFront;
}

/// The nodes of the cloth as it is in the last frame.
MovingCloth read_simulated_cloth(const RecordingReader& reader, std::size_t index, ClothMesh whole,
                                 const BodyLook& look, const std::function<void()>& on_frame) {
  if (is_painted_from_middle(look))
    whole.corner_texture_coordinates = corner_places(look.mapping, whole);
  const SceneState last = reader.frame(reader.num_frames() - 1);
  TrackedNodes tracked(std::move(whole), last.cloths[index].topology);
  MovingCloth cloth;
  cloth.vertices = vertices_of(make_layout(tracked.mesh()));
  const bool has_normals =
      !cloth.vertices.is_rope() && reader.scene().cloths[index].appearance.smooth;
  cloth.motion = read_motion(reader, index, cloth.vertices.nodes, has_normals, tracked, on_frame);
  return cloth;
}

/// The drawn mesh with the places in the picture that its look gives it.
DrawnCloth painted(DrawnCloth drawn, const BodyLook& look) {
  if (!is_painted_from_middle(look)) return drawn;
  Surface surface = *drawn.surface;
  ClothMesh mesh;
  mesh.rest_positions = surface.positions;
  mesh.triangles = surface.triangles;
  surface.corner_texture_coordinates = corner_places(look.mapping, mesh);
  drawn.surface = std::make_shared<const Surface>(std::move(surface));
  return drawn;
}

/// The drawn mesh of a cloth: each of its vertices is a place of its own, with the normal of its side of a crease.
MovingCloth read_drawn_cloth(const RecordingReader& reader, std::size_t index, const BodyLook& look,
                             const std::function<void()>& on_frame) {
  const Cloth& body = reader.scene().cloths[index];
  const bool has_normals = body.appearance.smooth;
  ClothDrawing drawing(painted(body.drawn_mesh.value(), look), make_mesh(body));
  const DrawnLayout& layout = drawing.layout();
  MovingCloth cloth;
  cloth.has_node_numbers = false;
  const int num_vertices = drawing.embedding().num_vertices();
  cloth.vertices.nodes.resize(static_cast<std::size_t>(num_vertices));
  std::iota(cloth.vertices.nodes.begin(), cloth.vertices.nodes.end(), 0);
  cloth.vertices.vertices = cloth.vertices.nodes;
  cloth.vertices.elements = layout.mesh.triangles;
  if (layout.has_coordinates) {
    cloth.vertices.places.resize(2, num_vertices);
    for (int v = 0; v < num_vertices; ++v) {
      cloth.vertices.places.col(v) = layout.coordinates[static_cast<std::size_t>(v)];
    }
  }
  cloth.motion.positions.resize(3 * num_vertices, reader.num_frames());
  if (has_normals) cloth.motion.normals.resize(3 * num_vertices, reader.num_frames());
  for (int frame = 0; frame < reader.num_frames(); ++frame) {
    const SceneState state = reader.frame(frame);
    if (state.cloths[index].topology) {
      throw UnfitRecording(
          fmt::format("cloth '{}' has a drawn mesh and is torn at t = {:.6g} s, expected the same "
                      "vertices in every frame",
                      body.name, state.time));
    }
    drawing.set_state(state.cloths[index]);
    for (int v = 0; v < num_vertices; ++v) {
      const DrawnVertex vertex = drawing.vertex(v);
      cloth.motion.positions.block<3, 1>(3 * v, frame) = vertex.position;
      if (has_normals) {
        cloth.motion.normals.block<3, 1>(3 * v, frame) = vertex.normal.cast<float>();
      }
    }
    on_frame();
  }
  return cloth;
}

/// The same for each vertex.
Eigen::Matrix3Xf spread(const Eigen::Matrix3Xf& by_node, const ClothVertices& vertices) {
  return by_node(Eigen::all, vertices.vertices);
}

/// Numbers of the recording's nodes, so that a program finds them again. glTF wants floats here, which hold integers exactly up to 2^24.
Eigen::RowVectorXf node_numbers(const ClothVertices& vertices) {
  Eigen::RowVectorXf numbers(std::ssize(vertices.vertices));
  for (Eigen::Index v = 0; v < numbers.size(); ++v) {
    const int place = vertices.vertices[static_cast<std::size_t>(v)];
    numbers[v] = static_cast<float>(vertices.nodes[static_cast<std::size_t>(place)]);
  }
  return numbers;
}

GltfJson mesh_of(GlbWriter& writer, const Cloth& cloth, const ClothVertices& vertices,
                 const MorphTargets& morph, const MorphNormals& normals, int material,
                 bool has_node_numbers) {
  GltfJson attributes = {
      {"POSITION", writer.add_numbers(spread(morph.base, vertices), Use::kVertices)}};
  const bool has_normals = normals.base.cols() > 0;
  if (has_normals) {
    attributes["NORMAL"] = writer.add_numbers(spread(normals.base, vertices), Use::kVertices);
  }
  if (vertices.places.cols() > 0) {
    attributes["TEXCOORD_0"] =
        writer.add_numbers(gltf_coordinates(vertices.places, cloth.appearance), Use::kVertices);
  }
  if (has_node_numbers)
    attributes["_NODE"] = writer.add_numbers(node_numbers(vertices), Use::kVertices);
  GltfJson primitive = {{"attributes", std::move(attributes)},
                        {"indices", writer.add_indices(vertices.elements)},
                        {"mode", vertices.is_rope() ? kLines : kTriangles},
                        {"material", material}};
  GltfJson mesh = {{"name", cloth.name}};
  for (std::size_t k = 0; k < morph.targets.size(); ++k) {
    GltfJson target = {
        {"POSITION", writer.add_numbers(spread(morph.targets[k], vertices), Use::kVertices)}};
    if (has_normals) {
      target["NORMAL"] = writer.add_numbers(spread(normals.targets[k], vertices), Use::kVertices);
    }
    primitive["targets"].push_back(std::move(target));
    mesh["weights"].push_back(morph.weights(static_cast<Eigen::Index>(k), 0));
    mesh["extras"]["targetNames"].push_back("mode " + std::to_string(k + 1));
  }
  mesh["primitives"].push_back(std::move(primitive));
  return mesh;
}

}  // namespace

GltfClothNode add_cloth(GltfParts parts, const RecordingReader& reader, std::size_t cloth,
                        const GltfOptions& options, const std::function<void()>& on_frame) {
  const Cloth& body = reader.scene().cloths[cloth];
  ClothMesh whole = make_mesh(body);
  const bool has_places = body.drawn_mesh
                              ? body.drawn_mesh->surface->corner_texture_coordinates.cols() > 0
                              : corner_coordinates(whole).cols() > 0;
  const BodyLook look = cloth_look(reader.scene(), cloth, has_places);
  MovingCloth moving = body.drawn_mesh
                           ? read_drawn_cloth(reader, cloth, look, on_frame)
                           : read_simulated_cloth(reader, cloth, std::move(whole), look, on_frame);
  const ClothVertices& vertices = moving.vertices;
  const bool has_normals = moving.motion.normals.cols() > 0;
  const MorphTargets morph =
      fit_morph_targets(std::move(moving.motion.positions), options.error, options.most_targets);
  MorphNormals normals;
  if (has_normals) normals = fit_morph_normals(moving.motion.normals, morph.weights);

  const int material = parts.materials.add(look, body.appearance);
  const int mesh = parts.writer.add("meshes", mesh_of(parts.writer, body, vertices, morph, normals,
                                                      material, moving.has_node_numbers));
  GltfClothNode result;
  result.node = parts.writer.add("nodes", {{"name", body.name}, {"mesh", mesh}});
  if (morph.num_targets() > 0) parts.animation.add(result.node, "weights", morph.weights);
  result.report = {body.name,
                   static_cast<int>(vertices.nodes.size()),
                   static_cast<int>(morph.num_targets()),
                   morph.largest_error,
                   morph.rms_error,
                   normals.rms_error,
                   morph.is_within_error};
  return result;
}

}  // namespace weft::scenes
