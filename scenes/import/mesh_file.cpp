#include <weft/scenes/import/mesh_file.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <string_view>

#include <weft/scenes/import/assimp_file.hpp>
#include <weft/scenes/import/byte_stream.hpp>
#include <weft/scenes/import/isolated_run.hpp>
#include <weft/scenes/import/ply_header.hpp>

namespace weft::import {
namespace {

constexpr std::size_t kMaxMessageLength = 300;

/// What reading may cost, from a few times what assimp takes for the largest files of each format.
IsolationBudget budget_of(std::size_t size) {
  constexpr std::uint64_t kMebibyte = std::uint64_t{1} << 20U;
  return {std::min<std::uint64_t>(60, 5 + size / (2 * kMebibyte)),
          std::min<std::uint64_t>(4096 * kMebibyte, 256 * kMebibyte + 64 * size)};
}

void put(ByteWriter& out, const FilePart& part) {
  for (const std::string* text : {&part.node, &part.mesh, &part.material}) out.put(*text);
  out.put(part.positions);
  out.put(part.texture_coordinates);
  out.put(static_cast<std::uint64_t>(part.faces.size()));
  for (const std::vector<int>& face : part.faces) out.put(face);
  out.put(static_cast<std::uint64_t>(part.groups.size()));
  for (const FileGroup& group : part.groups) {
    out.put(group.name);
    out.put(group.weights);
  }
}

FilePart get_part(ByteReader& in) {
  FilePart part;
  for (std::string* text : {&part.node, &part.mesh, &part.material}) *text = in.text();
  part.positions = in.values<double>();
  part.texture_coordinates = in.values<double>();
  part.faces.resize(in.count());
  for (std::vector<int>& face : part.faces) face = in.values<int>();
  part.groups.resize(in.count());
  for (FileGroup& group : part.groups) {
    group.name = in.text();
    group.weights = in.values<std::pair<int, double>>();
  }
  return part;
}

constexpr std::array<std::string_view, 6> kExtensions = {".obj", ".gltf", ".glb",
                                                         ".ply", ".fbx",  ".stl"};

/// The extension in lower case.
std::string extension_of(const std::filesystem::path& name) {
  std::string extension = name.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

void check(const MeshInput& input) {
  if (input.bytes.empty()) throw ImportError(input.name, "is empty, expected a mesh");
  const std::string extension = extension_of(input.name);
  if (std::find(kExtensions.begin(), kExtensions.end(), extension) == kExtensions.end()) {
    throw ImportError(input.name,
                      "cannot be read: expected a name that ends with .obj, .gltf, .glb, .ply, "
                      ".fbx or .stl");
  }
  if (extension != ".ply") return;
  if (const std::optional<std::string> fault = ply_header_fault(input.bytes)) {
    throw ImportError(input.name, "cannot be read: " + *fault);
  }
}

/// A library's message as a part of one line.
std::string one_line(std::string message) {
  std::replace_if(
      message.begin(), message.end(),
      [](char c) { return static_cast<unsigned char>(c) < 0x20U || c == 0x7F; }, ' ');
  if (message.size() > kMaxMessageLength) message = message.substr(0, kMaxMessageLength) + "...";
  while (!message.empty() && message.back() == ' ') message.pop_back();
  if (message.find("bad_alloc") != std::string::npos) return "needs too much memory";
  return message;
}

}  // namespace

MeshInput mesh_input(const std::filesystem::path& path) {
  try {
    return {path, read_input_file(path), files_below(path.parent_path())};
  } catch (const InvalidArgument& error) {
    throw ImportError(path, error.what());
  }
}

std::vector<FilePart> read_mesh_file(const MeshInput& input) {
  check(input);
  std::string bytes;
  try {
    const auto work = [&] {
      const std::vector<FilePart> parts = parts_of(*load_assimp(input));
      ByteWriter out;
      out.put(static_cast<std::uint64_t>(parts.size()));
      for (const FilePart& part : parts) put(out, part);
      return out.bytes();
    };
    bytes = run_isolated(work, budget_of(input.bytes.size()));
  } catch (const Error& error) {
    throw ImportError(input.name, "cannot be read: " + one_line(error.what()));
  }
  ByteReader in(bytes);
  std::vector<FilePart> parts(in.count());
  for (FilePart& part : parts) {
    part = get_part(in);
    if (part.node.empty() && part.mesh.empty()) part.mesh = input.name.stem().string();
  }
  return parts;
}

}  // namespace weft::import
