#include <weft/playback/exchange/vtp_export.hpp>

#include <limits>
#include <string>
#include <variant>

#include <fmt/format.h>

#include <weft/playback/exchange/exchange_body.hpp>
#include <weft/playback/exchange/vtp_file.hpp>
#include <weft/playback/rendering/renderer.hpp>
#include <weft/scenes/torn_cloth.hpp>

namespace weft::scenes {
namespace {

constexpr std::string_view kSeries = "series.pvd";
constexpr std::string_view kSeriesBeginning =
    "<?xml version=\"1.0\"?>\n<!-- Weft, times in s -->\n";

bool is_series(std::string_view beginning) {
  return beginning.substr(0, kSeriesBeginning.size()) == kSeriesBeginning;
}

/// 1 for a pinned node; a node that was split off a pinned one is pinned too.
Eigen::MatrixXd pinned_field(const ClothMesh& mesh, const ClothState& cloth) {
  Eigen::MatrixXd pinned = Eigen::MatrixXd::Zero(1, cloth.positions.cols());
  for (const int node : mesh.pinned) pinned(0, node) = 1.0;
  if (!cloth.topology) return pinned;
  for (std::size_t k = 0; k < cloth.topology->origins.size(); ++k) {
    pinned(0, mesh.num_nodes() + static_cast<Eigen::Index>(k)) =
        pinned(0, cloth.topology->origins[k]);
  }
  return pinned;
}

Eigen::MatrixXd mass_field(const Scene& scene, const ExchangeBody& body, const ClothState& cloth) {
  const Eigen::Index nodes = cloth.positions.cols();
  const auto* skin = std::get_if<SkinSource>(&scene.cloths[body.index].source);
  const bool is_skin = skin != nullptr && !skin->is_cloth;
  if (is_skin || cloth.topology) {
    return Eigen::MatrixXd::Constant(1, nodes, std::numeric_limits<double>::quiet_NaN());
  }
  return body.mesh.masses.transpose();
}

VtpSurface surface_of(const Scene& scene, const ExchangeBody& body, const SceneState& state) {
  VtpSurface surface{world_positions(body, state),
                     body.mesh.triangles,
                     line_segments(body.mesh),
                     {{"velocity_m_s", world_velocities(body, state)}}};
  if (body.is_rigid) return surface;
  const ClothState& cloth = state.cloths[body.index];
  const ClothMesh drawn = drawn_mesh(body.mesh, cloth.topology.get());
  surface.triangles = drawn.triangles;
  surface.lines = line_segments(drawn);
  surface.fields.push_back({"mass_kg", mass_field(scene, body, cloth)});
  surface.fields.push_back({"pinned", pinned_field(body.mesh, cloth)});
  surface.fields.push_back({"strain", node_strain(drawn, cloth.positions).transpose()});
  return surface;
}

}  // namespace

output::OutputFolder vtp_folder(const std::filesystem::path& path) {
  return {path, kSeries, {"a VTP series of Weft", is_series}};
}

int export_vtp_series(const RecordingReader& reader, const output::OutputFolder& folder,
                      const std::function<void(double)>& on_progress) {
  const std::vector<ExchangeBody> bodies = exchange_bodies(reader.scene());
  const bool is_double = reader.precision() == StoredPrecision::kFloat64;
  std::string series = std::string(kSeriesBeginning) +
                       "<VTKFile type=\"Collection\" version=\"1.0\" "
                       "byte_order=\"LittleEndian\">\n<Collection>\n";
  int num_files = 0;
  for (int frame = 0; frame < reader.num_frames(); ++frame) {
    const SceneState state = reader.frame(frame);
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const std::string file = fmt::format("{}_{:05}.vtp", bodies[b].file_name, frame);
      folder.write(file, vtp_text(surface_of(reader.scene(), bodies[b], state), is_double));
      series += fmt::format(R"(<DataSet timestep="{}" part="{}" name="{}" file="{}"/>)"
                            "\n",
                            state.time, b, bodies[b].file_name, file);
      ++num_files;
    }
    if (on_progress) on_progress((frame + 1.0) / reader.num_frames());
  }
  folder.write(kSeries, series + "</Collection>\n</VTKFile>\n");
  return num_files;
}

}  // namespace weft::scenes
