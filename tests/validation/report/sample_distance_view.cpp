#include "tests/validation/report/sample_distance_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace weft::tests {
namespace {

using namespace validation;

constexpr int kNodes = 25;  // per side
constexpr int kFrames = 6;
constexpr double kRadius = 0.3;  // [m]

double x_of(int node) {
  return (node % kNodes - (kNodes - 1) / 2) / static_cast<double>(kNodes - 1);
}
double z_of(int node) {
  return (node / kNodes - (kNodes - 1) / 2) / static_cast<double>(kNodes - 1);
}

std::vector<double> positions(int frame) {
  std::vector<double> values;
  for (int node = 0; node < kNodes * kNodes; ++node) {
    const double r = std::min(std::hypot(x_of(node), z_of(node)), 0.75);
    const double ball = r < kRadius ? std::sqrt(kRadius * kRadius - r * r) : -(r - kRadius);
    values.insert(values.end(), {x_of(node), std::max(ball, 0.55 - 0.12 * frame), z_of(node)});
  }
  return values;
}

DistanceViewEngine engine(const char* name, double size) {
  DistanceViewEngine result{name, {}, {}};
  for (int frame = 0; frame < kFrames; ++frame) {
    std::vector<double> distances;
    for (int node = 0; node < kNodes * kNodes; ++node) {
      distances.push_back(size * frame * frame * std::abs(x_of(node) + 0.3 * z_of(node)));
    }
    result.largest.push_back(*std::max_element(distances.begin(), distances.end()));
    result.distances.push_back(quantize(distances, 0.0, result.largest.back()));
  }
  return result;
}

}  // namespace

DistanceView sample_distance_view() {
  DistanceView view;
  view.simulated_nodes = 2401;
  for (int frame = 0; frame < kFrames; ++frame) {
    view.times.push_back(0.2 * frame);
    view.positions.push_back(quantize(positions(frame)));
  }
  for (int v = 0; v + 1 < kNodes; ++v) {
    for (int u = 0; u + 1 < kNodes; ++u) {
      const int a = v * kNodes + u;
      const int b = a + kNodes;
      view.triangles.insert(view.triangles.end(), {a, b, a + 1, a + 1, b, b + 1});
    }
  }
  view.engines = {engine("bullet_soft float32", 2e-3), engine("bullet_forces float64", 3e-12)};
  view.engines[1].distances[4].bytes[0] = '\xFF';  // the word of a number that is not finite
  view.engines[1].distances[4].bytes[1] = '\xFF';
  view.engines[1].largest.back() = std::numeric_limits<double>::quiet_NaN();
  view.engines[1].distances.back() = {};
  const std::array<double, 7> still{0, 0, 0, 1, 0, 0, 0};
  view.bodies = {
      {"sphere", {kRadius - 0.01}, std::vector(kFrames, still)},
      {"plane", {}, std::vector(kFrames, std::array<double, 7>{0, -0.5, 0, 1, 0, 0, 0})}};
  return view;
}

}  // namespace weft::tests
