#include <weft/scenes/format/mesh_text.hpp>

#include <array>
#include <bit>
#include <cstdint>

#include <weft/core/error.hpp>

namespace weft::scenes {
namespace {

constexpr std::string_view kMagic = "WEFTMESH";
constexpr std::string_view kDigits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

[[noreturn]] void fail() {
  throw InvalidArgument("is no stored mesh, expected one as in the resolved scene of a recording");
}

std::string encode(const std::string& bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = i + k;
      bits = bits << 8U | (at < bytes.size() ? static_cast<unsigned char>(bytes[at]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? kDigits[bits >> (18 - 6 * k) & 63U] : '=';
    }
  }
  return text;
}

std::string decode(std::string_view text) {
  std::array<int, 256> values{};
  values.fill(-1);
  for (std::size_t d = 0; d < kDigits.size(); ++d) {
    values[static_cast<unsigned char>(kDigits[d])] = static_cast<int>(d);
  }
  if (text.size() % 4 != 0) fail();
  std::size_t num_padding = 0;
  while (num_padding < 2 && num_padding < text.size() &&
         text[text.size() - 1 - num_padding] == '=') {
    ++num_padding;
  }
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_padding = i >= text.size() - num_padding;
    const int value = is_padding ? 0 : values[static_cast<unsigned char>(text[i])];
    if (value < 0) fail();
    bits = bits << 6U | static_cast<std::uint32_t>(value);
    if (i % 4 != 3) continue;
    for (const unsigned shift : {16U, 8U, 0U}) bytes += static_cast<char>(bits >> shift & 255U);
    bits = 0;
  }
  bytes.resize(bytes.size() - num_padding);
  return bytes;
}

template <class Bits>
void put(std::string& bytes, Bits bits) {
  for (std::size_t i = 0; i < sizeof bits; ++i) bytes += static_cast<char>(bits >> (8 * i) & 255U);
}

template <class Bits>
Bits get(std::string_view bytes, std::size_t& position) {
  Bits bits = 0;
  for (std::size_t i = 0; i < sizeof bits; ++i) {
    bits |= static_cast<Bits>(static_cast<unsigned char>(bytes[position++])) << (8 * i);
  }
  return bits;
}

}  // namespace

std::string mesh_text(const Surface& surface) {
  std::string bytes(kMagic);
  for (const Eigen::Index count : {surface.positions.cols(), surface.triangles.cols(),
                                   surface.corner_texture_coordinates.cols()}) {
    put(bytes, static_cast<std::uint32_t>(count));
  }
  for (const double x : surface.positions.reshaped()) put(bytes, std::bit_cast<std::uint64_t>(x));
  for (const int node : surface.triangles.reshaped()) put(bytes, static_cast<std::uint32_t>(node));
  for (const double x : surface.corner_texture_coordinates.reshaped()) {
    put(bytes, std::bit_cast<std::uint64_t>(x));
  }
  return encode(bytes);
}

Surface parse_mesh_text(std::string_view text) {
  const std::string bytes = decode(text);
  constexpr std::size_t kHeader = kMagic.size() + 3 * sizeof(std::uint32_t);
  if (bytes.size() < kHeader || !bytes.starts_with(kMagic)) fail();
  std::size_t position = kMagic.size();
  const std::size_t num_nodes = get<std::uint32_t>(bytes, position);
  const std::size_t num_triangles = get<std::uint32_t>(bytes, position);
  const std::size_t num_places = get<std::uint32_t>(bytes, position);
  // 64-bit sums of 32-bit counts: they cannot overflow.
  const std::size_t expected = kHeader + 24 * num_nodes + 12 * num_triangles + 16 * num_places;
  if (bytes.size() != expected) fail();
  Surface surface;
  surface.positions.resize(3, static_cast<Eigen::Index>(num_nodes));
  surface.triangles.resize(3, static_cast<Eigen::Index>(num_triangles));
  surface.corner_texture_coordinates.resize(2, static_cast<Eigen::Index>(num_places));
  const auto number = [&] { return std::bit_cast<double>(get<std::uint64_t>(bytes, position)); };
  for (double& x : surface.positions.reshaped()) x = number();
  for (int& node : surface.triangles.reshaped()) {
    node = static_cast<int>(get<std::uint32_t>(bytes, position));
  }
  for (double& x : surface.corner_texture_coordinates.reshaped()) x = number();
  return surface;
}

}  // namespace weft::scenes
