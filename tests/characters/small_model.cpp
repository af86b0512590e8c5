#include "tests/characters/small_model.hpp"

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <vector>

#include <weft/characters/base64.hpp>

namespace weft::tests {
namespace {

/// Bytes with a buffer view for each piece.
class Pieces {
 public:
  template <class Number>
  void add(const std::vector<Number>& numbers) {
    const std::size_t size = numbers.size() * sizeof(Number);
    views_ += (views_.empty() ? "" : ",\n") +
              std::string("{\"buffer\": 0, \"byteOffset\": " + std::to_string(bytes_.size()) +
                          ", \"byteLength\": " + std::to_string(size) + "}");
    const std::size_t offset = bytes_.size();
    bytes_.resize(offset + (size + 3) / 4 * 4);
    std::memcpy(bytes_.data() + offset, numbers.data(), size);
  }
  [[nodiscard]] const std::string& views() const { return views_; }
  [[nodiscard]] std::string buffer() const {
    return "{\"byteLength\": " + std::to_string(bytes_.size()) +
           ", \"uri\": \"data:application/octet-stream;base64," + characters::to_base64(bytes_) +
           "\"}";
  }

 private:
  std::vector<std::byte> bytes_;
  std::string views_;
};

Pieces pieces(float bind_width) {
  constexpr float kHalf = 0.70710678F;
  Pieces result;
  result.add<float>({0, 0, 0, 1, 0, 0, 0, 2, 0, 1, 2, 0});                        // 0 places
  result.add<std::uint8_t>({0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0});     // 1 joints
  result.add<float>({1, 0, 0, 0, 1, 0, 0, 0, .5, .5, 0, 0, .5, .5, 0, 0});        // 2 weights
  result.add<std::uint16_t>({0, 1, 3, 0, 3, 2});                                  // 3 corners
  result.add<float>({1,          0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1,    //
                     bind_width, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -2, 0, 1});  // 4 binds
  result.add<float>({0, 1, 2});                                                   // 5 times
  result.add<float>({0, 1, 0, 2, 1, 0, 0, 1, 0});                                 // 6 ways
  result.add<float>({0, 0, 0, 1, 0, 0, kHalf, kHalf, 0, 0, 0, 1});                // 7 turns
  result.add<float>({0, 0, 0, 1, 1, 1, 0, 0, 0, 0, 0, 0, 2, 2, 2,                 //
                     0, 0, 0, 0, 0, 0, 1, 1, 1, 0, 0, 0});                        // 8 sizes
  result.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1});            // 9 colours
  return result;
}

}  // namespace

std::string small_model(float bind_width) {
  const Pieces bytes = pieces(bind_width);
  return R"({
"asset": {"version": "2.0"},
"scene": 0,
"scenes": [{"nodes": [0, 2]}],
"nodes": [
{"name": "Root", "translation": [0, 1, 0], "children": [1]},
{"name": "Tip", "translation": [0, 1, 0], "children": [3]},
{"name": "Strip", "mesh": 0, "skin": 0},
{"name": "Flag", "mesh": 1}],
"meshes": [
{"name": "Ribbon", "primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2,
 "COLOR_0": 9}, "indices": 3, "material": 0}]},
{"name": "Plate", "primitives": [{"attributes": {"POSITION": 0}, "indices": 3}]}],
"materials": [{"name": "Silk"}],
"skins": [{"joints": [0, 1], "inverseBindMatrices": 4}],
"animations": [{"name": "Move", "channels": [
{"sampler": 0, "target": {"node": 0, "path": "translation"}},
{"sampler": 1, "target": {"node": 1, "path": "rotation"}},
{"sampler": 2, "target": {"node": 1, "path": "scale"}}],
"samplers": [
{"input": 5, "output": 6},
{"input": 5, "output": 7, "interpolation": "STEP"},
{"input": 5, "output": 8, "interpolation": "CUBICSPLINE"}]}],
"accessors": [
{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 4},
{"bufferView": 1, "componentType": 5121, "type": "VEC4", "count": 4},
{"bufferView": 2, "componentType": 5126, "type": "VEC4", "count": 4},
{"bufferView": 3, "componentType": 5123, "type": "SCALAR", "count": 6},
{"bufferView": 4, "componentType": 5126, "type": "MAT4", "count": 2},
{"bufferView": 5, "componentType": 5126, "type": "SCALAR", "count": 3},
{"bufferView": 6, "componentType": 5126, "type": "VEC3", "count": 3},
{"bufferView": 7, "componentType": 5126, "type": "VEC4", "count": 3},
{"bufferView": 8, "componentType": 5126, "type": "VEC3", "count": 9},
{"bufferView": 9, "componentType": 5126, "type": "VEC4", "count": 4}],
"bufferViews": [)" +
         bytes.views() + "],\n\"buffers\": [" + bytes.buffer() + "]\n}\n";
}

std::string changed(std::string text, const std::string& from, const std::string& to) {
  const std::size_t place = text.find(from);
  if (place == std::string::npos) throw std::logic_error("not in the text: " + from);
  return text.replace(place, from.size(), to);
}

}  // namespace weft::tests
