// Pictures of every scene of the catalog beside stored ones, which OSMesa of Debian 12 drew. Built twice: for OSMesa, and
// for EGL without a surface. To draw the stored ones again: WEFT_WRITE_GOLDEN=FOLDER, and look at each.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <ostream>
#include <string>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/playback/rendering/image.hpp>
#include <weft/playback/rendering/renderer.hpp>
#include <weft/playback/rendering/start_of_scene.hpp>
#include <weft/scenes/catalog.hpp>
#ifdef WEFT_TEST_EGL
#include <weft/playback/rendering/opengl/egl_context.hpp>
#endif

namespace weft::scenes {
namespace {

// What nobody sees: other rounding of colors, and pixels on edges that belong to one side or the other.
constexpr double kLargestMean = 0.3;       // of 255, over all pixels and channels
constexpr int kSeen = 24;                  // of 255, in one channel
constexpr double kLargestSeenPart = 2e-3;  // of the pixels

constexpr double kWaves = 0.02;  // of the size of a cloth
constexpr int kWidth = 240;
constexpr int kHeight = 150;

struct Difference {
  double mean = 0.0;       ///< of 255
  double seen_part = 0.0;  ///< of the pixels
};

Difference difference(const Image& a, const Image& b) {
  Difference result;
  int num_seen = 0;
  for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
    int largest = 0;
    for (std::size_t k = i; k < i + 3; ++k) {
      const int step = std::abs(static_cast<int>(a.rgb[k]) - static_cast<int>(b.rgb[k]));
      result.mean += step;
      largest = std::max(largest, step);
    }
    num_seen += largest > kSeen ? 1 : 0;
  }
  result.mean /= static_cast<double>(a.rgb.size());
  result.seen_part = 3.0 * num_seen / static_cast<double>(a.rgb.size());
  return result;
}

bool is_alike(const Difference& difference) {
  return difference.mean <= kLargestMean && difference.seen_part <= kLargestSeenPart;
}

std::string read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Waves on every cloth, so that there are folds, fronts, backs and shadows.
SceneState waved(const Scene& scene, double height) {
  SceneState state = start_of_scene(scene);
  for (ClothState& cloth : state.cloths) {
    const Matrix3X<double> rest = cloth.positions;
    const double size = (rest.rowwise().maxCoeff() - rest.rowwise().minCoeff()).norm();
    for (Eigen::Index i = 0; i < rest.cols(); ++i) {
      const Vector3<double> place = rest.col(i) / size;
      cloth.positions.col(i) += height * size *
                                Vector3<double>(std::sin(17 * place.y() + 5 * place.z()),
                                                std::sin(13 * place.x() + 11 * place.z()),
                                                std::sin(7 * place.x() + 19 * place.y()));
    }
  }
  return state;
}

std::unique_ptr<Renderer> renderer_of(const Scene& scene) {
#ifdef WEFT_TEST_EGL
  return std::make_unique<Renderer>(scene, open_egl_context());
#else
  return std::make_unique<Renderer>(scene);
#endif
}

std::filesystem::path golden_of(const std::string& name) {
  return std::filesystem::path(WEFT_TEST_SOURCE_DIR) / "golden" / (name + ".png");
}

class Golden : public testing::TestWithParam<std::string> {};

TEST_P(Golden, SceneLooksAsStored) {
#ifdef WEFT_TEST_EGL
  try {
    (void)open_egl_context();
  } catch (const Error& error) {
    GTEST_SKIP() << error.what();
  }
#endif
  const Scene scene = load_scene(GetParam());
  const std::unique_ptr<Renderer> renderer = renderer_of(scene);
  RenderOptions options;
  options.width = kWidth;
  options.height = kHeight;
  const Image drawn = renderer->render(waved(scene, kWaves), options);
  if (const char* folder = std::getenv("WEFT_WRITE_GOLDEN")) {
    std::ofstream(std::filesystem::path(folder) / (scene.name + ".png"), std::ios::binary)
        << encode_png(drawn);
    return;
  }
  const std::string stored = read(golden_of(scene.name));
  ASSERT_FALSE(stored.empty()) << golden_of(scene.name) << ": expected a picture";
  const Image golden = decode_image(stored);
  ASSERT_EQ(golden.rgb.size(), drawn.rgb.size());
  const Difference found = difference(golden, drawn);
  fmt::print("mean {:.4f} of 255, {:.4f} % of the pixels are seen to differ\n", found.mean,
             100 * found.seen_part);
  EXPECT_TRUE(is_alike(found));
#ifndef WEFT_TEST_EGL
  // Negative control: the same scene with waves of half the height.
  EXPECT_FALSE(is_alike(difference(golden, renderer->render(waved(scene, 0.5 * kWaves), options))))
      << "the comparison would not notice another state";
#endif
}

std::vector<std::string> names() {
  std::vector<std::string> names;
  for (const CatalogEntry& entry : scene_catalog()) names.emplace_back(entry.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Scenes, Golden, testing::ValuesIn(names()),
                         [](const auto& run) { return run.param; });

}  // namespace
}  // namespace weft::scenes
