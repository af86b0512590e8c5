#include <weft/playback/exchange/vtp_file.hpp>

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>

#include <fmt/format.h>

#include <weft/characters/base64.hpp>

namespace weft::scenes {
namespace {

static_assert(std::endian::native == std::endian::little, "the files say LittleEndian");

/// VTK's inline form: the number of bytes, then the bytes, as one base64 text.
template <class Scalar>
std::string data_array(const char* type, const std::string& name, Eigen::Index components,
                       const Scalar* values, Eigen::Index count) {
  const std::uint64_t bytes = static_cast<std::uint64_t>(count) * sizeof(Scalar);
  std::vector<std::byte> block(sizeof bytes + bytes);
  std::memcpy(block.data(), &bytes, sizeof bytes);
  if (bytes > 0) std::memcpy(block.data() + sizeof bytes, values, bytes);
  return fmt::format(
      R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="binary">{}</DataArray>)"
      "\n",
      type, name, components, characters::to_base64(block));
}

std::string real_array(const std::string& name, const Eigen::MatrixXd& values, bool is_double) {
  if (is_double) return data_array("Float64", name, values.rows(), values.data(), values.size());
  const Eigen::MatrixXf rounded = values.cast<float>();
  return data_array("Float32", name, rounded.rows(), rounded.data(), rounded.size());
}

/// size: number of points of each cell.
std::string cells(const char* tag, const int* nodes, Eigen::Index size, Eigen::Index count) {
  std::vector<std::int32_t> ends;
  for (Eigen::Index i = 1; i <= count; ++i) ends.push_back(static_cast<std::int32_t>(size * i));
  return fmt::format("<{0}>\n{1}{2}</{0}>\n", tag,
                     data_array("Int32", "connectivity", 1, nodes, size * count),
                     data_array("Int32", "offsets", 1, ends.data(), count));
}

}  // namespace

std::string vtp_text(const VtpSurface& surface, bool is_double) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<!-- Weft, SI units, y is up -->\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<PolyData>\n";
  text += fmt::format(
      R"(<Piece NumberOfPoints="{}" NumberOfVerts="0" NumberOfLines="{}" NumberOfStrips="0" NumberOfPolys="{}">)"
      "\n<PointData>\n",
      surface.points.cols(), surface.lines.cols(), surface.triangles.cols());
  for (const VtpField& field : surface.fields) {
    text += real_array(field.name, field.values, is_double);
  }
  text += "</PointData>\n<Points>\n" + real_array("Points", surface.points, is_double);
  text += "</Points>\n";
  text += cells("Lines", surface.lines.data(), 2, surface.lines.cols());
  text += cells("Polys", surface.triangles.data(), 3, surface.triangles.cols());
  return text + "</Piece>\n</PolyData>\n</VTKFile>\n";
}

}  // namespace weft::scenes
