#pragma once

// Tested by tests/playback/rendering/renderer_test.cpp, tests/playback/rendering/appearance_render_test.cpp.

#include <memory>
#include <vector>

#include <weft/playback/rendering/meshes/cloth_drawing.hpp>
#include <weft/playback/rendering/meshes/torn_layout.hpp>
#include <weft/playback/rendering/opengl/gpu_mesh.hpp>
#include <weft/playback/rendering/opengl/light_maps.hpp>
#include <weft/playback/rendering/opengl/sample_target.hpp>
#include <weft/playback/rendering/paint/body_paint.hpp>
#include <weft/playback/rendering/paint/color_map.hpp>
#include <weft/playback/rendering/renderer.hpp>
#include <weft/playback/rendering/view.hpp>

namespace weft::scenes {

/// Draws checked states of a scene: what goes into a picture, and in which order.
class ScenePainter {
 public:
  ScenePainter(const Scene& scene, std::unique_ptr<GlContext> context);
  ~ScenePainter();
  ScenePainter(const ScenePainter&) = delete;
  ScenePainter& operator=(const ScenePainter&) = delete;

  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const std::vector<ClothMesh>& meshes() const { return meshes_; }

  /// scalar and map are given for SurfaceStyle::kScalar only.
  [[nodiscard]] Image paint(const SceneState& state, const RenderOptions& options,
                            const ScalarField* scalar, const ColorMap* map);
  void paint_into(GLuint framebuffer, const SceneState& state, const RenderOptions& options,
                  const ScalarField* scalar, const ColorMap* map);

 private:
  /// What is the same for all tiles of a picture.
  struct Picture;

  /// Draws the picture in tiles; Output is an image or a framebuffer.
  template <class Output>
  void draw(const SceneState& state, const RenderOptions& options, const ScalarField* scalar,
            const ColorMap* map, Output& output);
  void upload_cloths(const SceneState& state, const RenderOptions& options,
                     const ScalarField* scalar, const ColorMap* map);
  [[nodiscard]] bool is_drawn_fine(std::size_t cloth, const RenderOptions& options) const;
  void upload_marks(const std::vector<Mark>& marks);
  void upload_scale(const ColorMap& map);
  void set_scalar(const ScalarField& scalar, std::size_t cloth, const ColorMap& map,
                  SurfaceMesh& mesh) const;
  void draw_casters(const ShaderProgram& program, const SceneState& state) const;
  void draw_tile(const Picture& picture, const Tile& tile);
  void draw_backdrop(const Picture& picture, const Tile& tile);
  void draw_ground(const Picture& picture, const Tile& tile);
  void draw_colliders(const Picture& picture) const;
  void draw_cloths(const Picture& picture) const;
  void draw_marks(const Picture& picture) const;
  void set_opacity(const Picture& picture, bool is_ghost) const;
  [[nodiscard]] bool is_drawn(std::size_t collider, const SceneState& state) const;
  void set_common(const ShaderProgram& program, const Picture& picture, const Tile& tile) const;

  Scene scene_;
  std::vector<ClothMesh> meshes_;
  Stage stage_;
  std::unique_ptr<GlContext> context_;
  GlFunctions gl_;
  ShaderProgram backdrop_program_;
  ShaderProgram ground_program_;
  ShaderProgram surface_program_;
  LightMaps light_maps_;
  SampleTarget target_;
  GpuMesh ground_;
  std::vector<GpuMesh> bodies_;
  std::vector<GpuMesh> cloths_;
  std::vector<GpuMesh> marks_;  ///< of the picture, and unused ones
  std::vector<BodyPaint> body_paints_;
  std::vector<TornLayout> layouts_;
  std::vector<std::unique_ptr<ClothDrawing>>
      drawings_;  ///< null: the cloth's own triangles are drawn
  std::vector<BodyPaint> cloth_paints_;
  GLuint screen_ = 0;
  GLuint scale_ = 0;
};

}  // namespace weft::scenes
