// Tested by tests/characters/gltf_faults_test.cpp, tests/characters/skinning_test.cpp.

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>

#include <weft/characters/gltf_document.hpp>

namespace weft::characters {
namespace {

using Json = nlohmann::json;

constexpr std::array<std::pair<const char*, std::size_t>, 7> kTypes = {
    {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}}};

/// Numbers of glTF's componentType.
constexpr int kInt8 = 5120;
constexpr int kUint8 = 5121;
constexpr int kInt16 = 5122;
constexpr int kUint16 = 5123;
constexpr int kUint32 = 5125;
constexpr int kFloat32 = 5126;

std::size_t size_of(int component) {
  switch (component) {
    case kInt8:
    case kUint8:
      return 1;
    case kInt16:
    case kUint16:
      return 2;
    case kUint32:
    case kFloat32:
      return 4;
    default:
      return 0;
  }
}

std::uint32_t little_endian(const std::byte* bytes, std::size_t size) {
  std::uint32_t value = 0;
  for (std::size_t i = size; i-- > 0;) {
    value = value << 8U | std::to_integer<std::uint32_t>(bytes[i]);
  }
  return value;
}

double component_value(const std::byte* bytes, int component, bool is_normalized) {
  const std::uint32_t bits = little_endian(bytes, size_of(component));
  switch (component) {
    case kInt8: {
      const auto value = static_cast<double>(static_cast<std::int8_t>(bits));
      return is_normalized ? std::max(value / 127.0, -1.0) : value;
    }
    case kUint8:
      return is_normalized ? bits / 255.0 : bits;
    case kInt16: {
      const auto value = static_cast<double>(static_cast<std::int16_t>(bits));
      return is_normalized ? std::max(value / 32767.0, -1.0) : value;
    }
    case kUint16:
      return is_normalized ? bits / 65535.0 : bits;
    case kFloat32:
      return static_cast<double>(std::bit_cast<float>(bits));
    default:
      return bits;
  }
}

/// An unsigned number of an object, or what stands for it; none if it is something else.
std::optional<std::size_t> size_at(const Json& object, const char* key, std::size_t otherwise) {
  const auto found = object.find(key);
  if (found == object.end()) return otherwise;
  if (!found->is_number_unsigned()) return std::nullopt;
  return found->get<std::size_t>();
}

}  // namespace

Eigen::MatrixXd GltfDocument::accessor(std::size_t index,
                                       const std::vector<std::string>& types) const {
  const Json& accessor = entry("accessors", index);
  const std::string where = "accessors[" + std::to_string(index) + "]";
  const std::string type = text(accessor, "type", "");
  if (std::find(types.begin(), types.end(), type) == types.end()) {
    fail(where + ".type = '" + type + "', expected '" + types.front() + "'");
  }
  const auto known = std::find_if(kTypes.begin(), kTypes.end(),
                                  [&](const auto& entry) { return type == entry.first; });
  const std::size_t num_rows = known->second;
  if (accessor.contains("sparse")) {
    fail(where + " is sparse, expected a plain one; export without sparse accessors");
  }
  const int component = static_cast<int>(size_at(accessor, "componentType", 0).value_or(0));
  const std::size_t component_size = size_of(component);
  if (component_size == 0) fail(where + ".componentType is unknown, expected 5120 to 5126");
  const std::size_t view_index = required_index(accessor, "bufferView", "bufferViews", where);
  const Json& view = entry("bufferViews", view_index);
  const std::string view_where = "bufferViews[" + std::to_string(view_index) + "]";
  const std::vector<std::byte>& buffer =
      buffers_[required_index(view, "buffer", "buffers", view_where)];

  const std::size_t element_size = num_rows * component_size;
  const auto count = size_at(accessor, "count", 0);
  const auto offset = size_at(accessor, "byteOffset", 0);
  const auto view_offset = size_at(view, "byteOffset", 0);
  const auto view_size = size_at(view, "byteLength", 0);
  const auto stride = size_at(view, "byteStride", element_size);
  if (!count || !offset || !view_offset || !view_size || !stride || *stride < element_size) {
    fail(where + " or its bufferView has a count, offset, length or stride that is out of range");
  }
  const bool view_fits =
      *view_offset <= buffer.size() && *view_size <= buffer.size() - *view_offset;
  // As a division: products of numbers from a file may overflow.
  const bool fits =
      view_fits && *offset <= *view_size &&
      (*count == 0 || (element_size <= *view_size - *offset &&
                       *count - 1 <= (*view_size - *offset - element_size) / *stride));
  if (!fits) {
    fail(where + " has " + std::to_string(*count) +
         " elements that reach beyond its bufferView or buffer");
  }
  claim(*count * num_rows, where);
  const auto normalized = accessor.find("normalized");
  const bool is_normalized =
      normalized != accessor.end() && normalized->is_boolean() && normalized->get<bool>();
  Eigen::MatrixXd values(static_cast<Eigen::Index>(num_rows), static_cast<Eigen::Index>(*count));
  for (std::size_t i = 0; i < *count; ++i) {
    const std::byte* element = buffer.data() + *view_offset + *offset + i * *stride;
    for (std::size_t r = 0; r < num_rows; ++r) {
      values(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(i)) =
          component_value(element + r * component_size, component, is_normalized);
    }
  }
  if (!values.allFinite()) fail(where + " has a number that is not finite");
  return values;
}

}  // namespace weft::characters
