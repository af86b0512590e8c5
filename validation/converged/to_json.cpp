// Tested by tests/validation/converged/converged_reference_test.cpp.

#include <algorithm>
#include <cmath>
#include <string_view>

#include <nlohmann/json.hpp>

#include <weft/scenes/format/scene_words.hpp>
#include <weft/validation/converged/converged_reference.hpp>
#include <weft/validation/report/formats/json_text.hpp>

namespace weft::validation {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kSchema = "weft-converged-reference/1";

bool begins_as_reference(std::string_view beginning) {
  // "schema" is the first key, whatever the white space.
  constexpr std::size_t kFirstKeys = 100;
  return beginning.starts_with('{') &&
         beginning.substr(0, kFirstKeys).find(kSchema) != std::string_view::npos;
}

Json optional(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

/// Rounded to 12 decimal places: a picometre, far below every error here.
double rounded(double metres) {
  return std::round(metres * 1e12) / 1e12;
}

Json study_json(const ConvergenceStudy& study) {
  Json levels = Json::array();
  for (const ConvergenceLevel& level : study.levels) {
    Json one = {{"time_step_s", level.time_step},
                {"num_steps", level.num_steps},
                {"difference", optional(level.difference)},
                {"positions_xxh128", level.hash}};
    if (level.blow_up) one["blow_up"] = *level.blow_up;
    levels.push_back(std::move(one));
  }
  const auto word = static_cast<std::size_t>(study.integrator);
  return {{"integrator", scenes::kIntegratorWords[word]},
          {"formal_order", study.formal_order},
          {"observed_order", optional(study.order)},
          {"gci", optional(study.gci)},
          {"levels", std::move(levels)}};
}

Json nodes_json(const Matrix3X<double>& positions, int max_nodes) {
  Json nodes = Json::array(), x = Json::array(), y = Json::array(), z = Json::array();
  const auto count = std::min<Eigen::Index>(positions.cols(), max_nodes);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index node = i * positions.cols() / count;
    nodes.push_back(node);
    x.push_back(rounded(positions(0, node)));
    y.push_back(rounded(positions(1, node)));
    z.push_back(rounded(positions(2, node)));
  }
  return {{"node", nodes}, {"x_m", x}, {"y_m", y}, {"z_m", z}};
}

}  // namespace

const output::FileKind kReferenceKind{"a converged reference", begins_as_reference};

std::string to_json(const ConvergedReference& reference, int max_nodes) {
  Json studies = Json::array(), cloths = Json::array();
  for (const ConvergenceStudy& study : reference.studies) studies.push_back(study_json(study));
  if (!reference.studies.empty()) {
    for (const Matrix3X<double>& positions : reference.studies.front().positions) {
      cloths.push_back(nodes_json(positions, max_nodes));
    }
  }
  const Json root = {{"schema", kSchema},
                     {"scene", reference.scene},
                     {"program", reference.program},
                     {"scene_xxh128", reference.scene_hash},
                     {"mesh_xxh128", reference.mesh_hash},
                     {"time_s", reference.time},
                     {"size_m", reference.size},
                     {"gate", reference.gate},
                     {"agreement_of_integrators", optional(reference.agreement)},
                     {"is_converged", reference.is_converged()},
                     {"studies", std::move(studies)},
                     {"cloths", std::move(cloths)}};
  return json_text(root) + "\n";
}

}  // namespace weft::validation
