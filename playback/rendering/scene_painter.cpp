#include <weft/playback/rendering/scene_painter.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <weft/playback/rendering/meshes/collider_mesh.hpp>
#include <weft/playback/rendering/meshes/mark_mesh.hpp>

namespace weft::scenes {
namespace {

// As in surface.frag.
enum class SurfaceMode { kCloth, kScalar, kWireframe, kSolid, kTwoTone, kMark };

constexpr int kScaleSize = 256;
constexpr GLint kScaleUnit = 2;
constexpr GLint kTextureUnit = 3;

/// Obstacles are drawn 0.2 % smaller. Between its nodes a cloth is flat: over a ball of radius r,
/// an edge of length h dips by h^2 / (8 r) below the nodes, 0.1 % of r for h = r / 11. Without this
/// a ball would shine through a cloth that touches it as it should.
constexpr double kBodyScale = 0.998;

/// The ground fades into the backdrop at this many radii of the scene.
constexpr double kGroundExtent = 7.0;
/// Nodes farther than this many radii of the scene are not drawn: single precision has no room for
/// them.
constexpr double kLargestDistance = 1e6;
/// Thickness of a line of the wireframe in a picture of 540 pixel rows. [pixel]
constexpr double kLineWidth = 1.1;
/// Radius of a rope that is thinner, in radii of the scene: it must be seen.
constexpr double kThinnestRope = 0.004;
/// Radius of a point that a program has drawn, in radii of the scene.
constexpr double kPointRadius = 0.009;

Eigen::Matrix4f pose(const Vector3<double>& position, const Eigen::Quaterniond& orientation,
                     double scale) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.block<3, 3>(0, 0) = scale * orientation.normalized().toRotationMatrix();
  matrix.block<3, 1>(0, 3) = position;
  return matrix.cast<float>();
}

bool is_drawable(const RigidState& rigid, const Stage& stage) {
  return rigid.position.allFinite() && rigid.orientation.coeffs().allFinite() &&
         rigid.orientation.norm() > 0.0 &&
         (rigid.position - stage.center).norm() <= kLargestDistance * stage.radius;
}

/// Magnifies a tile of the picture to the whole clip space.
Eigen::Matrix4f tile_matrix(const Tile& tile, const RenderOptions& options) {
  const double x_scale = static_cast<double>(options.width) / tile.width;
  const double y_scale = static_cast<double>(options.height) / tile.height;
  const double x_center = (2.0 * tile.x + tile.width) / options.width - 1.0;
  const double y_center = (2.0 * tile.y + tile.height) / options.height - 1.0;
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix(0, 0) = x_scale;
  matrix(1, 1) = y_scale;
  matrix(0, 3) = -x_scale * x_center;
  matrix(1, 3) = -y_scale * y_center;
  return matrix.cast<float>();
}

}  // namespace

struct ScenePainter::Picture {
  const SceneState& state;
  const RenderOptions& options;
  Vector3<double> shift;  ///< [m] of the camera that follows a body
  View view;
  StudioLights lights;
  Eigen::Matrix4f clip_from_world;  ///< of the tile
};

ScenePainter::ScenePainter(const Scene& scene, std::unique_ptr<GlContext> context)
    : scene_(scene),
      stage_(make_stage(scene)),
      context_(std::move(context)),
      gl_((context_->make_current(), load_gl_functions(*context_))),
      backdrop_program_(gl_, {"screen.vert"}, {"backdrop.frag"}),
      ground_program_(gl_, {"scene.vert"}, {"key_light.glsl", "ground.frag"}),
      surface_program_(gl_, {"scene.vert"}, {"key_light.glsl", "surface.frag"}),
      light_maps_(gl_),
      target_(gl_),
      ground_(gl_) {
  ground_.upload(ground_surface(kGroundExtent * stage_.radius));
  for (std::size_t i = 0; i < scene_.cloths.size(); ++i) {
    const ClothMesh& mesh = meshes_.emplace_back(make_mesh(scene_.cloths[i]));
    layouts_.emplace_back(mesh);
    const auto& drawn = scene_.cloths[i].drawn_mesh;
    drawings_.push_back(drawn ? std::make_unique<ClothDrawing>(*drawn, mesh) : nullptr);
    const bool has_coordinates = drawn ? drawings_.back()->layout().has_coordinates
                                       : layouts_.back().whole().has_coordinates;
    cloth_paints_.push_back(cloth_paint(gl_, scene_, i, has_coordinates));
    cloths_.emplace_back(gl_);
  }
  for (const Collider& collider : scene_.colliders) {
    bodies_.emplace_back(gl_);
    bodies_.back().upload(collider_surface(collider.shape));
    body_paints_.push_back(collider_paint(gl_, scene_, collider));
  }
  gl_.GenVertexArrays(1, &screen_);
  gl_.GenTextures(1, &scale_);
}

ScenePainter::~ScenePainter() {
  // Members delete their objects in the current context.
  context_->make_current();
  for (const std::vector<BodyPaint>* paints : {&body_paints_, &cloth_paints_}) {
    for (const BodyPaint& paint : *paints) gl_.DeleteTextures(1, &paint.texture);
  }
  gl_.DeleteTextures(1, &scale_);
  gl_.DeleteVertexArrays(1, &screen_);
}

Image ScenePainter::paint(const SceneState& state, const RenderOptions& options,
                          const ScalarField* scalar, const ColorMap* map) {
  Image image{options.width, options.height, {}};
  image.rgb.resize(std::size_t{3} * static_cast<std::size_t>(options.width) *
                   static_cast<std::size_t>(options.height));
  draw(state, options, scalar, map, image);
  return image;
}

void ScenePainter::paint_into(GLuint framebuffer, const SceneState& state,
                              const RenderOptions& options, const ScalarField* scalar,
                              const ColorMap* map) {
  draw(state, options, scalar, map, framebuffer);
}

template <class Output>
void ScenePainter::draw(const SceneState& state, const RenderOptions& options,
                        const ScalarField* scalar, const ColorMap* map, Output& output) {
  context_->make_current();
  // A window's panels leave these on.
  gl_.Disable(GL_BLEND);
  gl_.Disable(GL_SCISSOR_TEST);
  // Near and far planes must not cut the ground.
  gl_.Enable(GL_DEPTH_CLAMP);
  upload_cloths(state, options, scalar, map);
  upload_marks(options.marks);
  if (map != nullptr) upload_scale(*map);
  const Vector3<double> shift = camera_shift(scene_, meshes_, state);
  Camera camera = options.camera.value_or(scene_.camera);
  camera.position += shift;
  camera.target += shift;
  Picture picture{state, options, shift, {}, studio_lights(camera), Eigen::Matrix4f::Identity()};
  picture.view = make_view(
      camera, stage_, static_cast<double>(options.width) / static_cast<double>(options.height));
  light_maps_.update(picture.lights.key, shift.cast<float>(), state_radius(stage_, shift, state),
                     [&](const ShaderProgram& program) {
                       if (options.show_shadow) draw_casters(program, state);
                     });
  const int step = SampleTarget::kMaxSamples / options.samples;
  for (int y = 0; y < options.height; y += step) {
    for (int x = 0; x < options.width; x += step) {
      const Tile tile{x, y, std::min(step, options.width - x), std::min(step, options.height - y)};
      picture.clip_from_world = tile_matrix(tile, options) * picture.view.clip_from_world;
      target_.begin(tile, options.samples);
      draw_tile(picture, tile);
      target_.finish(tile, options.samples, output);
    }
  }
}

/// Values and edges are those of the simulated cloth: the other styles show it.
bool ScenePainter::is_drawn_fine(std::size_t cloth, const RenderOptions& options) const {
  return drawings_[cloth] && options.style == SurfaceStyle::kShaded;
}

void ScenePainter::upload_cloths(const SceneState& state, const RenderOptions& options,
                                 const ScalarField* scalar, const ColorMap* map) {
  const DrawLimits limits{stage_.center, kLargestDistance * stage_.radius};
  for (std::size_t i = 0; i < meshes_.size(); ++i) {
    if (is_drawn_fine(i, options)) {
      cloths_[i].upload(drawn_surface(*drawings_[i], state.cloths[i], limits));
      continue;
    }
    const double rope = std::max(scene_.cloths[i].collision_margin, kThinnestRope * stage_.radius);
    SurfaceMesh mesh = cloth_surface(layouts_[i].of(meshes_[i], state.cloths[i]),
                                     state.cloths[i].positions, rope, limits);
    if (scalar != nullptr) set_scalar(*scalar, i, *map, mesh);
    const bool is_wireframe = options.style == SurfaceStyle::kWireframe;
    cloths_[i].upload(is_wireframe ? with_barycentrics(mesh) : mesh);
  }
}

void ScenePainter::upload_marks(const std::vector<Mark>& marks) {
  const DrawLimits limits{stage_.center, kLargestDistance * stage_.radius};
  while (marks_.size() < marks.size()) marks_.emplace_back(gl_);
  for (std::size_t i = 0; i < marks.size(); ++i) {
    marks_[i].upload(mark_surface(marks[i], kPointRadius * stage_.radius, limits));
  }
}

void ScenePainter::set_scalar(const ScalarField& scalar, std::size_t cloth, const ColorMap& map,
                              SurfaceMesh& mesh) const {
  const double span = map.maximum() - map.minimum();
  for (std::size_t vertex = 0; vertex < mesh.vertices.size(); ++vertex) {
    const double value = scalar.values[cloth][mesh.nodes[vertex]];
    const double place = span > 0.0 ? (value - map.minimum()) / span : 0.0;
    mesh.vertices[vertex].value = {0.0f, 0.0f};
    if (!std::isfinite(value)) continue;
    mesh.vertices[vertex].value = {static_cast<float>(std::clamp(place, 0.0, 1.0)), 1.0f};
  }
}

void ScenePainter::upload_scale(const ColorMap& map) {
  std::array<float, std::size_t{3} * kScaleSize> texels{};
  for (int i = 0; i < kScaleSize; ++i) {
    const double part = static_cast<double>(i) / (kScaleSize - 1);
    const double value = (1.0 - part) * map.minimum() + part * map.maximum();
    const Eigen::Vector3f light = linear_light(map.color(value));
    std::copy(light.begin(), light.end(), texels.begin() + 3 * static_cast<std::ptrdiff_t>(i));
  }
  gl_.ActiveTexture(GL_TEXTURE0 + kScaleUnit);
  gl_.BindTexture(GL_TEXTURE_2D, scale_);
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGB32F, kScaleSize, 1, 0, GL_RGB, GL_FLOAT, texels.data());
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void ScenePainter::draw_casters(const ShaderProgram& program, const SceneState& state) const {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!is_drawn(i, state)) continue;
    const RigidState& rigid = state.rigids[i];
    program.set("u_world_from_body",
                pose(rigid.position - stage_.center, rigid.orientation, kBodyScale));
    bodies_[i].draw();
  }
  program.set("u_world_from_body", Eigen::Matrix4f(Eigen::Matrix4f::Identity()));
  for (std::size_t i = 0; i < cloths_.size(); ++i) {
    if (cloth_paints_[i].is_visible) cloths_[i].draw();
  }
}

bool ScenePainter::is_drawn(std::size_t collider, const SceneState& state) const {
  return body_paints_[collider].is_visible && is_drawable(state.rigids[collider], stage_);
}

void ScenePainter::draw_tile(const Picture& picture, const Tile& tile) {
  draw_backdrop(picture, tile);
  draw_ground(picture, tile);
  surface_program_.use();
  set_common(surface_program_, picture, tile);
  light_maps_.bind(surface_program_, LightMaps::Receiver::kBody);
  // Samplers of another kind than those of the lights: they must never name the same unit.
  surface_program_.set("u_scale", kScaleUnit);
  surface_program_.set("u_texture", kTextureUnit);
  draw_colliders(picture);
  draw_cloths(picture);
  draw_marks(picture);
}

void ScenePainter::set_common(const ShaderProgram& program, const Picture& picture,
                              const Tile& tile) const {
  const auto samples = static_cast<float>(picture.options.samples);
  program.set("u_clip_from_world", picture.clip_from_world);
  program.set("u_eye", picture.view.eye);
  program.set("u_fill_direction", picture.lights.fill);
  program.set("u_rim_direction", picture.lights.rim);
  program.set("u_show_shadow", picture.options.show_shadow ? 1 : 0);
  program.set("u_tile_origin", Eigen::Vector2f(samples * static_cast<float>(tile.x),
                                               samples * static_cast<float>(tile.y)));
  program.set("u_picture_size",
              Eigen::Vector2f(samples * static_cast<float>(picture.options.width),
                              samples * static_cast<float>(picture.options.height)));
}

void ScenePainter::draw_backdrop(const Picture& picture, const Tile& tile) {
  gl_.Disable(GL_DEPTH_TEST);
  gl_.DepthMask(GL_FALSE);
  backdrop_program_.use();
  set_common(backdrop_program_, picture, tile);
  gl_.BindVertexArray(screen_);
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
}

void ScenePainter::draw_ground(const Picture& picture, const Tile& tile) {
  const Vector3<double> normal = stage_.ground_orientation * Vector3<double>::UnitY();
  const Camera& camera = picture.options.camera ? *picture.options.camera : scene_.camera;
  const double height = normal.dot(camera.position + picture.shift - stage_.ground_position);
  if (!stage_.ground_is_visible || (!stage_.ground_is_collider && height <= 0.0)) return;
  // A ground that is only decoration writes no depth: what falls through it stays visible.
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthMask(stage_.ground_is_collider ? GL_TRUE : GL_FALSE);
  ground_program_.use();
  set_common(ground_program_, picture, tile);
  light_maps_.bind(ground_program_, LightMaps::Receiver::kGround);
  const Vector3<double> along = picture.shift - normal.dot(picture.shift) * normal;
  const Vector3<double> on_ground = stage_.ground_orientation.conjugate() * along;
  ground_program_.set("u_world_from_body", pose(stage_.ground_position + along - stage_.center,
                                                stage_.ground_orientation, 1.0));
  ground_program_.set("u_shift", Eigen::Vector2f(static_cast<float>(on_ground.x()),
                                                 static_cast<float>(on_ground.z())));
  ground_program_.set("u_tint", stage_.ground_color
                                    ? Eigen::Vector3f(1.25f * linear_light(*stage_.ground_color))
                                    : Eigen::Vector3f(Eigen::Vector3f::Ones()));
  ground_program_.set("u_cell", static_cast<float>(grid_cell(stage_.radius)));
  ground_program_.set("u_extent", static_cast<float>(kGroundExtent * stage_.radius));
  ground_.draw();
}

void ScenePainter::draw_colliders(const Picture& picture) const {
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthMask(GL_TRUE);
  surface_program_.set("u_is_thin", 0);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!is_drawn(i, picture.state)) continue;
    const RigidState& rigid = picture.state.rigids[i];
    const BodyPaint& paint = body_paints_[i];
    const SurfaceMode mode = paint.is_two_tone ? SurfaceMode::kTwoTone : SurfaceMode::kSolid;
    surface_program_.set("u_mode", static_cast<int>(mode));
    paint.set(gl_, surface_program_, kTextureUnit);
    const auto& ghosts = picture.options.ghosts;
    set_opacity(picture, ghosts && i >= ghosts->first_collider);
    surface_program_.set("u_world_from_body",
                         pose(rigid.position - stage_.center, rigid.orientation, kBodyScale));
    bodies_[i].draw();
  }
}

void ScenePainter::set_opacity(const Picture& picture, bool is_ghost) const {
  const double opacity = is_ghost ? picture.options.ghosts->opacity : 1.0;
  surface_program_.set("u_opacity", static_cast<float>(opacity));
}

void ScenePainter::draw_cloths(const Picture& picture) const {
  const RenderOptions& options = picture.options;
  const SurfaceMode mode = options.style == SurfaceStyle::kWireframe ? SurfaceMode::kWireframe
                           : options.style == SurfaceStyle::kScalar  ? SurfaceMode::kScalar
                                                                     : SurfaceMode::kCloth;
  const double line = std::max(1.0, kLineWidth * options.height / 540.0) * options.samples;
  gl_.ActiveTexture(GL_TEXTURE0 + kScaleUnit);
  gl_.BindTexture(GL_TEXTURE_2D, scale_);
  surface_program_.set("u_mode", static_cast<int>(mode));
  surface_program_.set("u_line_width", static_cast<float>(line));
  surface_program_.set("u_no_value_color", linear_light(kNoValueColor));
  surface_program_.set("u_world_from_body", Eigen::Matrix4f(Eigen::Matrix4f::Identity()));
  for (std::size_t i = 0; i < cloths_.size(); ++i) {
    if (!cloth_paints_[i].is_visible) continue;
    BodyPaint paint = cloth_paints_[i];
    if (mode == SurfaceMode::kWireframe) {
      // Thin light lines on white paper would hardly be seen.
      paint.back *= 0.6f;
    }
    const bool has_inside = is_drawn_fine(i, options) ? drawings_[i]->layout().is_closed
                                                      : layouts_[i].whole().is_closed ||
                                                            layouts_[i].whole().rope.cols() > 0;
    surface_program_.set("u_is_thin", has_inside || mode == SurfaceMode::kWireframe ? 0 : 1);
    paint.set(gl_, surface_program_, kTextureUnit);
    set_opacity(picture, options.ghosts && i >= options.ghosts->first_cloth);
    cloths_[i].draw();
  }
}

void ScenePainter::draw_marks(const Picture& picture) const {
  const std::vector<Mark>& marks = picture.options.marks;
  if (marks.empty()) return;
  surface_program_.set("u_mode", static_cast<int>(SurfaceMode::kMark));
  surface_program_.set("u_is_thin", 0);
  set_opacity(picture, false);
  surface_program_.set("u_world_from_body", Eigen::Matrix4f(Eigen::Matrix4f::Identity()));
  for (std::size_t i = 0; i < marks.size(); ++i) {
    BodyPaint paint;
    paint.front = paint.back = linear_light(marks[i].color);
    paint.set(gl_, surface_program_, kTextureUnit);
    marks_[i].draw();
  }
}

}  // namespace weft::scenes
