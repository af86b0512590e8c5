#include <weft/playback/rendering/opengl/light_maps.hpp>

#include <cmath>

#include <weft/playback/rendering/view.hpp>

namespace weft::scenes {
namespace {

constexpr int kNumSkyLights = 24;            // as in prelude.glsl
constexpr int kNumSkyTaps = 6;               // as in prelude.glsl
constexpr GLsizei kKeySize = 2048;           // [texel]
constexpr GLsizei kSkySize = 512;            // [texel]
constexpr float kGoldenAngle = 2.39996323f;  // [rad] spreads points evenly without a pattern

/// Radius of the filter of the key shadow, part of the map: 12 texels are soft, but keep the
/// shape of a fold.
constexpr float kKeySpread = 12.0f / kKeySize;
// Linear comparison looks at one texel more.
static_assert(kKeySpread * kKeySize + 1 < ShadowBounds::kBlock);
/// Lift along the normal, in texels: the depth inside of one texel varies by the slope times half
/// its diagonal; the filter looks that much farther.
constexpr float kKeyLift = 8.0f;
constexpr float kSkyLift = 3.0f;
/// Each of the sky lights stands for a patch of the sky: blurred so far on the ground that their
/// shadows run together, less on the bodies, where a wide filter would look into the surface
/// itself.
constexpr float kGroundSkySpread = 40.0f / kSkySize;
constexpr float kBodySkySpread = 6.0f / kSkySize;

constexpr GLint kKeyUnit = 0;
constexpr GLint kSkyUnit = 1;
constexpr GLint kBoundsUnit = 4;  // after those of ScenePainter

/// Points evenly spread over the upper half of the unit sphere.
std::vector<Eigen::Vector3f> sky_directions() {
  std::vector<Eigen::Vector3f> directions;
  for (int i = 0; i < kNumSkyLights; ++i) {
    const float height = (static_cast<float>(i) + 0.5f) / kNumSkyLights;
    const float across = std::sqrt(1.0f - height * height);
    const float angle = kGoldenAngle * static_cast<float>(i);
    directions.emplace_back(across * std::cos(angle), height, across * std::sin(angle));
  }
  return directions;
}

std::vector<Eigen::Vector3f> disk_points(int count) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < count; ++i) {
    const float distance = std::sqrt((static_cast<float>(i) + 0.5f) / static_cast<float>(count));
    const float angle = kGoldenAngle * static_cast<float>(i);
    points.emplace_back(distance * std::cos(angle), distance * std::sin(angle), 0.0f);
  }
  return points;
}

void set_comparing(const GlFunctions& gl, GLenum target) {
  gl.TexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl.TexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(target, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  gl.TexParameteri(target, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
}

}  // namespace

LightMaps::LightMaps(const GlFunctions& gl)
    : gl_(gl),
      depth_program_(gl, {"depth.vert"}, {"depth.frag"}),
      key_bounds_(gl, kKeySize),
      sky_directions_(sky_directions()),
      sky_taps_(disk_points(kNumSkyTaps)) {
  gl.GenFramebuffers(1, &framebuffer_);
  gl.GenTextures(1, &key_map_);
  gl.BindTexture(GL_TEXTURE_2D, key_map_);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, kKeySize, kKeySize, 0, GL_DEPTH_COMPONENT,
                GL_FLOAT, nullptr);
  set_comparing(gl, GL_TEXTURE_2D);
  gl.GenTextures(1, &sky_maps_);
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, sky_maps_);
  gl.TexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_DEPTH_COMPONENT32F, kSkySize, kSkySize, kNumSkyLights, 0,
                GL_DEPTH_COMPONENT, GL_FLOAT, nullptr);
  set_comparing(gl, GL_TEXTURE_2D_ARRAY);
}

LightMaps::~LightMaps() {
  gl_.DeleteTextures(1, &key_map_);
  gl_.DeleteTextures(1, &sky_maps_);
  gl_.DeleteFramebuffers(1, &framebuffer_);
}

void LightMaps::update(const Eigen::Vector3f& key_direction, const Eigen::Vector3f& center,
                       double radius,
                       const std::function<void(const ShaderProgram&)>& draw_casters) {
  radius_ = radius;
  key_direction_ = key_direction;
  key_matrix_ = light_matrix(key_direction, center, radius);
  sky_matrices_.clear();
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.DrawBuffer(GL_NONE);
  gl_.ReadBuffer(GL_NONE);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthMask(GL_TRUE);
  depth_program_.use();
  gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, key_map_, 0);
  gl_.Viewport(0, 0, kKeySize, kKeySize);
  gl_.Clear(GL_DEPTH_BUFFER_BIT);
  depth_program_.set("u_clip_from_world", key_matrix_);
  draw_casters(depth_program_);
  gl_.Viewport(0, 0, kSkySize, kSkySize);
  for (int i = 0; i < kNumSkyLights; ++i) {
    sky_matrices_.push_back(
        light_matrix(sky_directions_[static_cast<std::size_t>(i)], center, radius));
    gl_.FramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, sky_maps_, 0, i);
    gl_.Clear(GL_DEPTH_BUFFER_BIT);
    depth_program_.set("u_clip_from_world", sky_matrices_.back());
    draw_casters(depth_program_);
  }
  key_bounds_.update(key_map_);
}

void LightMaps::bind(const ShaderProgram& program, Receiver receiver) const {
  const auto diameter = static_cast<float>(2.0 * radius_);
  gl_.ActiveTexture(GL_TEXTURE0 + kKeyUnit);
  gl_.BindTexture(GL_TEXTURE_2D, key_map_);
  gl_.ActiveTexture(GL_TEXTURE0 + kSkyUnit);
  gl_.BindTexture(GL_TEXTURE_2D_ARRAY, sky_maps_);
  gl_.ActiveTexture(GL_TEXTURE0 + kBoundsUnit);
  gl_.BindTexture(GL_TEXTURE_2D, key_bounds_.texture());
  program.set("u_key_bounds", kBoundsUnit);
  program.set("u_key_map", kKeyUnit);
  program.set("u_sky_maps", kSkyUnit);
  program.set("u_key_direction", key_direction_);
  program.set("u_key_clip_from_world", key_matrix_);
  program.set("u_key_offset", kKeyLift * diameter / kKeySize);
  program.set("u_key_spread", kKeySpread);
  program.set("u_sky_offset", kSkyLift * diameter / kSkySize);
  program.set("u_sky_spread", receiver == Receiver::kGround ? kGroundSkySpread : kBodySkySpread);
  program.set("u_sky_taps", sky_taps_);
  program.set("u_sky_directions", sky_directions_);
  program.set("u_sky_clip_from_world", sky_matrices_);
}

}  // namespace weft::scenes
