#include <weft/scenes/import/mesh_file.hpp>

#include <algorithm>
#include <system_error>

#include <weft/scenes/import/assimp_file.hpp>
#include <weft/scenes/import/byte_stream.hpp>
#include <weft/scenes/import/isolated_run.hpp>

namespace weft::import {
namespace {

constexpr std::uintmax_t kMaxFileSize = 256'000'000;
constexpr std::size_t kMaxMessageLength = 300;

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

void check(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw ImportError(path, "no such file");
  if (!std::filesystem::is_regular_file(status)) throw ImportError(path, "is not a file");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw ImportError(path, error.message());
  if (size == 0) throw ImportError(path, "is empty, expected a mesh");
  if (size > kMaxFileSize) {
    throw ImportError(path, "has " + std::to_string(size) + " bytes, expected at most " +
                                std::to_string(kMaxFileSize));
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

std::vector<FilePart> read_mesh_file(const std::filesystem::path& path) {
  check(path);
  std::string bytes;
  try {
    bytes = run_isolated([&] {
      const std::vector<FilePart> parts = parts_of(*load_assimp(path));
      ByteWriter out;
      out.put(static_cast<std::uint64_t>(parts.size()));
      for (const FilePart& part : parts) put(out, part);
      return out.bytes();
    });
  } catch (const Error& error) {
    throw ImportError(path, "cannot be read: " + one_line(error.what()));
  }
  ByteReader in(bytes);
  std::vector<FilePart> parts(in.count());
  for (FilePart& part : parts) {
    part = get_part(in);
    if (part.node.empty() && part.mesh.empty()) part.mesh = path.stem().string();
  }
  return parts;
}

}  // namespace weft::import
