// The committed references, computed anew: minutes.
#include <cmath>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <weft/scenes/catalog.hpp>
#include <weft/validation/converged/converged_reference.hpp>

namespace weft::validation {
namespace {

class StoredReference : public testing::TestWithParam<std::string> {};

TEST_P(StoredReference, IsConvergedAndComesOutAgain) {
  std::ifstream file(std::string(WEFT_SOURCE_DIR "/validation/converged/data/") + GetParam() +
                     ".json");
  const nlohmann::json stored = nlohmann::json::parse(file);
  EXPECT_EQ(stored.at("scene"), GetParam());
  EXPECT_TRUE(stored.at("is_converged"));
  const auto levels = stored.at("studies").at(0).at("levels");
  const ConvergedReference found =
      converge(scenes::load_scene(GetParam()), {.time = stored.at("time_s"),
                                                .num_levels = static_cast<int>(levels.size()),
                                                .gate = stored.at("gate")});
  EXPECT_EQ(found.mesh_hash, stored.at("mesh_xxh128")) << "another mesh: run weft reference anew";
  EXPECT_TRUE(found.is_converged());
  // Another compiler or processor rounds in another way; what it may change is less than the error
  // that the reference states of itself.
  const double bound = found.studies[0].gci.value() * found.size;
  for (std::size_t c = 0; c < found.studies[0].positions.size(); ++c) {
    const nlohmann::json& nodes = stored.at("cloths").at(c);
    for (std::size_t i = 0; i < nodes.at("node").size(); ++i) {
      const Vector3<double> there(nodes.at("x_m").at(i), nodes.at("y_m").at(i),
                                  nodes.at("z_m").at(i));
      const int node = nodes.at("node").at(i);
      EXPECT_LT((found.studies[0].positions[c].col(node) - there).norm(), bound) << node;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, StoredReference, testing::Values("hang", "drape_sphere"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace weft::validation
