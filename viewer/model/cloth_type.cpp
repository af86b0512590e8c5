#include <weft/viewer/model/cloth_type.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include <fmt/format.h>

#include <weft/custom_forces/registry.hpp>

namespace weft::viewer {
namespace {

constexpr std::array kTypes = {
    ClothType{"as written", 0.0, "the laws of the scene file"},
    ClothType{"handkerchief", 0.0, "does not resist bending"},
    ClothType{"cotton", 0.02, "soft folds; bends over 2 cm"},
    ClothType{"denim", 0.07, "broad folds; bends over 7 cm"},
    ClothType{"paper", 0.26, "hardly bends; over 26 cm"},
};

constexpr double kStandardGravity = 9.81;  // [m/s^2]

bool is_bending(const forces::LawSpecification& law) {
  return forces::role_of(law.law) == forces::LawRole::kBending;
}

bool can_bend(const scenes::Cloth& cloth) {
  const auto* skin = std::get_if<scenes::SkinSource>(&cloth.source);
  return !std::holds_alternative<Rope>(cloth.source) && (skin == nullptr || skin->is_cloth);
}

struct Sheet {
  double density = 0.0;  ///< [kg/m^2]
  double spacing = 0.0;  ///< [m] typical distance of neighbors
};

Sheet sheet_of(const scenes::Cloth& cloth) {
  const ClothMesh mesh = scenes::make_mesh(cloth);
  const double area = node_areas(mesh).sum();
  return {mesh.masses.sum() / area, std::sqrt(area / mesh.num_nodes())};
}

/// By Gershgorin the fastest bending mode of a grid has omega^2 <= 64 D / (rho d^4), and four times
/// that at a corner; an explicit step stays stable for omega dt < 2, and half of it is left to springs
/// and dampers.
double largest_rigidity(const Sheet& sheet, double time_step) {
  const double omega = 0.5 / time_step;
  return omega * omega * sheet.density * std::pow(sheet.spacing, 4) / 64.0;
}

}  // namespace

std::span<const ClothType> cloth_types() {
  return kTypes;
}

std::string apply_cloth_type(scenes::Scene& scene, const scenes::Scene& written, std::size_t type,
                             bool is_held) {
  const ClothType& chosen = kTypes.at(type);
  std::string note;
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    scenes::Cloth& cloth = scene.cloths[c];
    if (!can_bend(cloth)) continue;
    std::erase_if(cloth.laws, &is_bending);
    if (type == 0) {
      const auto& laws = written.cloths.at(c).laws;
      std::copy_if(laws.begin(), laws.end(), std::back_inserter(cloth.laws), &is_bending);
      continue;
    }
    if (chosen.bending_length == 0.0) continue;
    const Sheet sheet = sheet_of(cloth);
    double rigidity = sheet.density * kStandardGravity * std::pow(chosen.bending_length, 3);
    const double largest = largest_rigidity(sheet, scene.world.time_step);
    if (is_held && rigidity > largest) {
      rigidity = largest;
      note = fmt::format(
          "{}: rigidity held at {:.3g} N m, the most that an explicit step of {:.3g} s takes; "
          "bullet_weft takes all of it",
          chosen.name, largest, scene.world.time_step);
    }
    cloth.laws.push_back({"hinge_torsion", {}, {{"rigidity", {rigidity}}}});
  }
  return note;
}

}  // namespace weft::viewer
