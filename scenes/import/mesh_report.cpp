#include <weft/scenes/import/mesh_report.hpp>

#include <numbers>
#include <sstream>

namespace weft::import {
namespace {

constexpr std::size_t kMaxListed = 10;  // of faces in a line, of places in a list

std::string name_of(const FaceOfFile& face, const std::vector<std::string>& parts) {
  return "face " + std::to_string(face.face) + " of '" +
         parts.at(static_cast<std::size_t>(face.part)) + "'";
}

template <class Faces>
std::string list_of(const Faces& faces, const std::vector<std::string>& parts) {
  std::string text;
  for (std::size_t i = 0; i < faces.size() && i < kMaxListed; ++i) {
    text += (i == 0 ? "" : ", ") + name_of(faces[i], parts);
  }
  return faces.size() > kMaxListed ? text + ", ..." : text;
}

std::string place_of(const Vector3<double>& place) {
  std::ostringstream text;
  text << "(" << place.x() << ", " << place.y() << ", " << place.z() << ") m";
  return text.str();
}

void add_faces(std::ostringstream& out, const char* what, const std::vector<FaceOfFile>& faces,
               const std::vector<std::string>& parts) {
  out << what << ": " << faces.size();
  if (!faces.empty()) out << ": " << list_of(faces, parts);
  out << "\n";
}

void add_defects(std::ostringstream& out, const char* what, const std::vector<Defect>& defects,
                 const std::vector<std::string>& parts) {
  out << what << ": " << defects.size() << "\n";
  for (std::size_t i = 0; i < defects.size() && i < kMaxListed; ++i) {
    out << "  at " << place_of(defects[i].place) << ": " << list_of(defects[i].faces, parts)
        << "\n";
  }
}

double degrees(double angle) {
  return angle * 180 / std::numbers::pi;
}

}  // namespace

std::optional<std::string> MeshReport::drawing_fault() const {
  if (num_triangles == 0) return "has no triangle, expected a surface";
  return std::nullopt;
}

std::optional<std::string> MeshReport::fault() const {
  if (!collapsed_faces.empty()) {
    return name_of(collapsed_faces[0], parts) +
           " has two corners at one place, expected three different ones";
  }
  if (const std::optional<std::string> empty = drawing_fault()) return empty;
  if (!flat_faces.empty()) {
    return name_of(flat_faces[0], parts) + " has no area, expected a triangle with one";
  }
  const auto at = [&](const Defect& defect) {
    return place_of(defect.place) + ": " + list_of(defect.faces, parts);
  };
  if (!branching_edges.empty()) {
    return "more than two triangles meet at the edge at " + at(branching_edges[0]) +
           ", expected at most two";
  }
  if (!flipped_edges.empty()) {
    return "neighbors turn opposite ways at the edge at " + at(flipped_edges[0]) +
           ", expected all fronts on one side";
  }
  if (!bow_ties.empty()) {
    return "two surfaces meet in the single point " + at(bow_ties[0]) +
           ", expected edges between them";
  }
  return std::nullopt;
}

std::string MeshReport::text() const {
  std::ostringstream out;
  out << "parts:";
  for (const std::string& part : parts) out << " '" << part << "'";
  out << "\nin the file: " << num_vertices << " vertices, " << num_faces << " faces\n"
      << "surface: " << num_nodes << " nodes, " << num_triangles << " triangles, " << area
      << " m^2, " << (is_closed() ? "closed" : "open") << "\n"
      << "welded vertices: " << welded_vertices << "\n"
      << "unreferenced vertices: " << unreferenced_vertices << "\n"
      << "points and lines: " << other_elements << "\n";
  add_faces(out, "duplicate triangles", duplicate_faces, parts);
  out << "boundary: " << boundary_loops << " loops, " << boundary_edges << " edges\n";
  if (num_triangles > 0) {
    out << "smallest angle: " << degrees(smallest_angle) << " deg, "
        << name_of(smallest_angle_face, parts) << "\n";
  }
  add_faces(out, "slivers (an angle below 2 deg)", slivers, parts);
  add_faces(out, "collapsed triangles", collapsed_faces, parts);
  add_faces(out, "triangles without area", flat_faces, parts);
  add_defects(out, "edges of more than two triangles", branching_edges, parts);
  add_defects(out, "edges between opposite fronts", flipped_edges, parts);
  add_defects(out, "points that join two surfaces", bow_ties, parts);
  return out.str();
}

}  // namespace weft::import
