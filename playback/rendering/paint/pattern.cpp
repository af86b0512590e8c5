#include <weft/playback/rendering/paint/pattern.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include <weft/playback/rendering/paint/color_map.hpp>

namespace weft::scenes {
namespace {

using Light = Eigen::Vector3f;  // linear light
using Place = Eigen::Vector2d;  // u, v from 0 to 1

/// Samples per pixel and axis: edges without stairs.
constexpr int kSamples = 3;

struct Inks {
  Light ground;
  Light figure;
  Light dark;
  Light pale;
};

double fraction(double x) {
  return x - std::floor(x);
}

/// Distance to the nearest whole number, 0 to 0.5.
double fold(double x) {
  return std::abs(x - std::round(x));
}

Light checks(const Place& p, const Inks& inks) {
  constexpr int kCells = 8;
  const int cell = static_cast<int>(kCells * p.x()) + static_cast<int>(kCells * p.y());
  return cell % 2 == 0 ? inks.ground : inks.figure;
}

Light stripes(const Place& p, const Inks& inks) {
  constexpr int kPairs = 8;
  return fraction(kPairs * p.x()) < 0.5 ? inks.ground : inks.figure;
}

Light dots(const Place& p, const Inks& inks) {
  constexpr double kRows = 8;
  constexpr double kRadius = 0.27;
  const double row = std::floor(kRows * p.y());
  const double shift = std::fmod(row, 2.0) * 0.5;
  const Place cell(fold(kRows * p.x() + shift + 0.5), fraction(kRows * p.y()) - 0.5);
  return cell.norm() < kRadius ? inks.figure : inks.ground;
}

/// The colour of a thread of a tartan at a place of its sett.
Light thread(double place, const Inks& inks) {
  constexpr int kSetts = 3;
  const double x = 2.0 * fold(kSetts * place);  // the sett is mirrored: 0 at its middle, 1 at ends
  if (x < 0.045) return inks.pale;
  if (x < 0.30) return inks.ground;
  if (x < 0.36) return inks.dark;
  if (x < 0.42) return inks.ground;
  if (x < 0.74) return inks.dark;
  if (x < 0.80) return inks.figure;
  if (x < 0.86) return inks.dark;
  return inks.figure;
}

Light tartan(const Place& p, const Inks& inks) {
  // Twill: the thread on top changes along diagonals.
  constexpr double kThreads = 192;
  const bool is_warp =
      fraction(0.25 * (std::floor(kThreads * p.x()) + std::floor(kThreads * p.y()))) < 0.5;
  return is_warp ? thread(p.x(), inks) : thread(p.y(), inks);
}

/// A rosette: petals around a middle. [-] signed, < 0 inside.
double rosette(const Place& p, double radius, int petals) {
  const double angle = std::atan2(p.y(), p.x());
  return p.norm() - radius * (0.78 + 0.22 * std::cos(petals * angle));
}

/// Small flowers in a lattice, for the field and the border.
Light flowers(const Place& p, double cell, const Light& field, const Inks& inks) {
  const Place q(p.x() / cell, p.y() / cell);
  const double odd = std::fmod(std::abs(std::floor(q.y())), 2.0) * 0.5;
  const Place place(fraction(q.x() + odd) - 0.5, fraction(q.y()) - 0.5);
  if (place.norm() < 0.09) return inks.dark;
  if (rosette(place, 0.28, 4) < 0.0) return inks.figure;
  const double vine =
      std::abs(place.y() + 0.18 * std::sin(2.0 * std::numbers::pi * (place.x() + 0.25)));
  if (vine < 0.035) return 0.55f * inks.figure + 0.45f * field;
  return field;
}

Light medallion(const Place& p, double size, const Light& field, const Inks& inks) {
  const double middle = rosette(p, size, 8);
  if (middle > 0.0) return field;
  if (middle > -0.06 * size) return inks.figure;
  if (rosette(p, 0.80 * size, 8) > 0.0) return inks.dark;
  if (rosette(p, 0.74 * size, 8) > 0.0) return inks.pale;
  if (rosette(p, 0.50 * size, 16) > 0.0) return flowers(p, 0.16 * size, inks.ground, inks);
  if (rosette(p, 0.44 * size, 16) > 0.0) return inks.figure;
  if (rosette(p, 0.22 * size, 8) > 0.0) return inks.dark;
  return inks.pale;
}

Light carpet(const Place& p, const Inks& inks) {
  const double rim = std::min(std::min(p.x(), 1.0 - p.x()), std::min(p.y(), 1.0 - p.y()));
  if (rim < 0.018) return inks.dark;
  if (rim < 0.030) return inks.figure;
  if (rim < 0.130) {
    // The border's flowers stand in its middle line.
    const bool is_side = std::min(p.x(), 1.0 - p.x()) == rim;
    const double along = is_side ? p.y() : p.x();
    const Place q(fold(10.0 * along) / 10.0, rim - 0.080);
    if (q.norm() < 0.009) return inks.ground;
    if (rosette(q, 0.034, 6) < 0.0) return inks.figure;
    const double wave = 0.026 * std::cos(20.0 * std::numbers::pi * along);
    if (std::abs(q.y() + wave) < 0.004) return inks.pale;
    return inks.dark;
  }
  if (rim < 0.142) return inks.figure;
  if (rim < 0.152) return inks.dark;
  const Place corner(0.5 - std::abs(p.x() - 0.5) - 0.152, 0.5 - std::abs(p.y() - 0.5) - 0.152);
  const Light quarter = medallion(corner, 0.21, Light(-1, -1, -1), inks);
  if (quarter.x() >= 0.0f) return quarter;
  const Place middle = p - Place(0.5, 0.5);
  const Light center =
      medallion(Place(middle.x(), 0.82 * middle.y()), 0.27, Light(-1, -1, -1), inks);
  if (center.x() >= 0.0f) return center;
  // Pendants above and below the medallion.
  const double pendant = rosette(Place(1.5 * middle.x(), std::abs(middle.y()) - 0.325), 0.035, 4);
  if (pendant < 0.0) return pendant < -0.010 ? inks.dark : inks.figure;
  return flowers(middle, 0.058, inks.ground, inks);
}

Light eyeball(const Place& p, const Inks& inks) {
  const Place q = 2.0 * (p - Place(0.5, 0.5));
  const double angle = 180.0 * q.norm();  // [deg] from the axis
  const double around = std::atan2(q.y(), q.x());
  constexpr double kPupil = 14.0;
  constexpr double kIris = 34.0;
  if (angle < kPupil) return Light::Constant(0.004f);
  if (angle < kIris) {
    const double part = (angle - kPupil) / (kIris - kPupil);
    const double fibres = 0.5 + 0.25 * std::sin(47.0 * around + 3.0 * std::sin(5.0 * around)) +
                          0.25 * std::sin(83.0 * around - 6.0 * part);
    const double shade = (0.55 + 0.75 * fibres * (1.0 - 0.4 * part)) *
                         (1.0 - 0.85 * std::clamp((part - 0.80) / 0.20, 0.0, 1.0)) *
                         (0.45 + 0.55 * std::clamp(part / 0.12, 0.0, 1.0));
    return static_cast<float>(shade) * inks.ground;
  }
  // Fine veins that come from behind and end before the iris.
  const double wander =
      around + 0.05 * std::sin(angle / 5.0) + 0.03 * std::sin(angle / 2.3 + 4.0 * around);
  const double vein = fold(wander * 9.0 / (2.0 * std::numbers::pi)) / 9.0 * 360.0 *
                      std::sin(angle * std::numbers::pi / 180.0);
  const double strength = std::clamp((angle - 52.0) / 70.0, 0.0, 1.0);
  const auto red = static_cast<float>(vein < 0.4 + 1.6 * strength ? 0.55 * strength : 0.0);
  const auto edge = static_cast<float>(std::clamp((angle - kIris) / 4.0, 0.0, 1.0));
  const Light white = (0.55f + 0.45f * edge) * inks.figure;
  return (1.0f - red) * white + red * Light(0.45f, 0.05f, 0.04f);
}

Light color_at(Pattern pattern, const Place& p, const Inks& inks) {
  switch (pattern) {
    case Pattern::kPlain:
      return inks.ground;
    case Pattern::kChecks:
      return checks(p, inks);
    case Pattern::kStripes:
      return stripes(p, inks);
    case Pattern::kDots:
      return dots(p, inks);
    case Pattern::kTartan:
      return tartan(p, inks);
    case Pattern::kCarpet:
      return carpet(p, inks);
    case Pattern::kEyeball:
      return eyeball(p, inks);
  }
  std::abort();  // every enumerator has its case
}

}  // namespace

PatternColors default_colors(Pattern pattern, const Rgb& body_color) {
  switch (pattern) {
    case Pattern::kTartan:
      return {body_color, {40, 92, 70}};
    case Pattern::kCarpet:
      return {body_color, {226, 178, 92}};
    case Pattern::kEyeball:
      return {body_color, {240, 238, 232}};
    default:
      return {body_color, {242, 236, 222}};
  }
}

Image pattern_image(Pattern pattern, const PatternColors& colors, int size) {
  const Inks inks{linear_light(colors.ground), linear_light(colors.figure),
                  linear_light({26, 34, 62}), linear_light({240, 230, 206})};
  Image image{size, size, {}};
  image.rgb.reserve(std::size_t{3} * static_cast<std::size_t>(size) *
                    static_cast<std::size_t>(size));
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) {
      Light sum = Light::Zero();
      for (int k = 0; k < kSamples * kSamples; ++k) {
        const double x = column + (k % kSamples + 0.5) / kSamples;
        const double y = size - row - (k / kSamples + 0.5) / kSamples;
        sum += color_at(pattern, Place(x, y) / size, inks);
      }
      const Rgb rgb = encode_srgb(sum / static_cast<float>(kSamples * kSamples));
      image.rgb.insert(image.rgb.end(), rgb.begin(), rgb.end());
    }
  }
  return image;
}

}  // namespace weft::scenes
