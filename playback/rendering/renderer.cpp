#include <weft/playback/rendering/renderer.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/playback/rendering/paint/color_bar.hpp>
#include <weft/playback/rendering/paint/color_map.hpp>
#include <weft/playback/rendering/scene_painter.hpp>

namespace weft::scenes {
namespace {

constexpr int kMaxSize = 8192;  // [pixel]
constexpr int kMaxSamples = 4;

void check_between(const char* name, int value, int low, int high, const char* unit) {
  if (value < low || value > high) {
    throw InvalidArgument(fmt::format("Renderer::render: {} = {} [{}], expected {} to {}", name,
                                      value, unit, low, high));
  }
}

void check_count(const std::string& what, Eigen::Index value, Eigen::Index expected) {
  if (value != expected) {
    throw InvalidArgument(fmt::format("Renderer::render: {} = {}, expected {} as in the scene",
                                      what, value, expected));
  }
}

/// A torn cloth has the nodes of the scene's mesh and those that were split off.
Eigen::Index num_nodes(const ClothMesh& mesh, const ClothState& cloth) {
  if (!cloth.topology) return mesh.num_nodes();
  const Eigen::Index count = mesh.num_nodes() + std::ssize(cloth.topology->origins);
  const Triangles& triangles = cloth.topology->triangles;
  if (triangles.size() > 0 && (triangles.minCoeff() < 0 || triangles.maxCoeff() >= count)) {
    throw InvalidArgument(
        fmt::format("Renderer::render: a triangle of cloth '{}' names a node that is not there, "
                    "expected 0 to {}",
                    cloth.name, count - 1));
  }
  return count;
}

void check_state(const Scene& scene, const std::vector<ClothMesh>& meshes,
                 const SceneState& state) {
  check_count("number of cloths", std::ssize(state.cloths), std::ssize(scene.cloths));
  check_count("number of colliders", std::ssize(state.rigids), std::ssize(scene.colliders));
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    check_count(fmt::format("number of nodes of cloth '{}'", scene.cloths[i].name),
                state.cloths[i].positions.cols(), num_nodes(meshes[i], state.cloths[i]));
  }
}

void check_scalar(const std::vector<ClothMesh>& meshes, const SceneState& state,
                  const ScalarField* scalar) {
  if (scalar == nullptr) {
    throw InvalidArgument("Renderer::render: scalar = none, expected a field for the scalar style");
  }
  check_count("number of cloths with scalar values", std::ssize(scalar->values),
              std::ssize(meshes));
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    check_count(fmt::format("number of scalar values of cloth {}", i), scalar->values[i].size(),
                num_nodes(meshes[i], state.cloths[i]));
  }
}

}  // namespace

struct Renderer::Impl {
  Impl(const Scene& scene, std::unique_ptr<GlContext> context)
      : painter(scene, std::move(context)) {}

  void check(const SceneState& state, const RenderOptions& options, const ScalarField* scalar) {
    check_between("width", options.width, 1, kMaxSize, "pixel");
    check_between("height", options.height, 1, kMaxSize, "pixel");
    check_between("samples", options.samples, 1, kMaxSamples, "-");
    check_state(painter.scene(), painter.meshes(), state);
    if (options.style == SurfaceStyle::kScalar) check_scalar(painter.meshes(), state, scalar);
  }

  ScenePainter painter;
};

Renderer::Renderer(const Scene& scene, std::unique_ptr<GlContext> context)
    : impl_(std::make_unique<Impl>(scene, std::move(context))) {}

Renderer::~Renderer() = default;

Image Renderer::render(const SceneState& state, const RenderOptions& options,
                       const ScalarField* scalar) {
  ScenePainter& painter = impl_->painter;
  impl_->check(state, options, scalar);
  if (options.style != SurfaceStyle::kScalar)
    return painter.paint(state, options, nullptr, nullptr);
  const ColorMap map(scalar->minimum, scalar->maximum);
  Image image = painter.paint(state, options, scalar, &map);
  draw_color_bar(image, map, scalar->label);
  return image;
}

void Renderer::render_into(unsigned framebuffer, const SceneState& state,
                           const RenderOptions& options, const ScalarField* scalar) {
  impl_->check(state, options, scalar);
  if (options.style != SurfaceStyle::kScalar) {
    impl_->painter.paint_into(framebuffer, state, options, nullptr, nullptr);
    return;
  }
  const ColorMap map(scalar->minimum, scalar->maximum);
  impl_->painter.paint_into(framebuffer, state, options, scalar, &map);
}

}  // namespace weft::scenes
