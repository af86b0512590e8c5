#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <weft/mesh/cloth_mesh.hpp>
#include <weft/playback/rendering/image.hpp>
#include <weft/playback/rendering/opengl/gl_context.hpp>
#include <weft/scenes/appearance/mark.hpp>
#include <weft/scenes/scene.hpp>
#include <weft/scenes/simulator.hpp>

namespace weft::scenes {

enum class SurfaceStyle {
  kShaded,     ///< two-sided light, shadow, one colour per cloth
  kWireframe,  ///< the edges of the triangles
  kScalar,     ///< shaded, coloured by a value per node (strain, difference to another run...)
};

/// Values that colour a cloth: one number per node, mapped from [minimum, maximum] to the colour
/// scale.
struct ScalarField {
  std::vector<Eigen::VectorXd> values;  ///< one vector per cloth, n each
  double minimum = 0.0;
  double maximum = 1.0;
  std::string label;  ///< drawn beside the colour bar with its unit, e.g. "strain [%]"
};

/// The last bodies of a scene that are drawn translucent: those of other runs, to compare with.
struct Ghosts {
  std::size_t first_cloth = 0;
  std::size_t first_collider = 0;
  double opacity = 0.4;  ///< above 0, at most 1
};

struct RenderOptions {
  int width = 960;
  int height = 540;
  SurfaceStyle style = SurfaceStyle::kShaded;
  int samples = 2;  ///< supersampling per axis, 1 to 4: edges without stairs
  bool show_shadow = true;
  std::optional<Camera> camera = {};  ///< none: that of the scene
  std::optional<Ghosts> ghosts = {};
  std::vector<Mark> marks = {};  ///< drawn beside the bodies, without a shadow
};

/// Draws states of one scene, off-screen or in a window. One renderer, many frames.
class Renderer {
 public:
  /// Opens an off-screen OpenGL 3.3 core context (OSMesa). Throws Error if there is none.
  explicit Renderer(const Scene& scene);
  /// Draws in this context, which must be OpenGL 3.3 core or newer. Throws Error if it is not.
  Renderer(const Scene& scene, std::unique_ptr<GlContext> context);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// scalar must be given for SurfaceStyle::kScalar.
  [[nodiscard]] Image render(const SceneState& state, const RenderOptions& options,
                             const ScalarField* scalar = nullptr);
  /// The same picture into a framebuffer of the context, without a color bar. The picture's lower
  /// left corner is the framebuffer's.
  void render_into(unsigned framebuffer, const SceneState& state, const RenderOptions& options,
                   const ScalarField* scalar = nullptr);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Largest relative length change of the "stretch" springs at each node [-], signed; n. 0 where there are none.
[[nodiscard]] Eigen::VectorXd node_strain(const ClothMesh& mesh,
                                          ConstMatrix3XRef<double> positions);

}  // namespace weft::scenes
