// A result of another program: a PC2 point cache, told by its first bytes, or an OBJ file.
#include <weft/core/error.hpp>
#include <weft/playback/exchange/import/obj_shape.hpp>
#include <weft/playback/exchange/point_cache.hpp>
#include "fuzz/fuzz_target.hpp"

namespace {

using namespace weft;

void read_point_cache(std::string_view bytes) {
  const scenes::PointCache cache = scenes::decode_point_cache(bytes, "input.pc2");
  for (const Eigen::Matrix3Xf& sample : cache.samples) {
    fuzz::require(sample.cols() == cache.samples.front().cols(), "samples have the same points");
  }
}

void read_obj(std::string_view text) {
  const scenes::ObjShape shape = scenes::read_obj_shape(text, "input.obj");
  fuzz::require(shape.points.allFinite(), "points are finite");
  for (const std::vector<int>& face : shape.faces) {
    for (const int node : face) {
      fuzz::require(node >= 0 && node < shape.points.cols(), "faces name points that are there");
    }
  }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes = fuzz::text_of(data, size);
  try {
    if (bytes.starts_with("POINTCACHE2")) {
      read_point_cache(bytes);
    } else {
      read_obj(bytes);
    }
  } catch (const Error& error) {
    fuzz::require_clear(error.what());
  }
  return 0;
}
