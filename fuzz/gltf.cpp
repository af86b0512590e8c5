// A model of a character, .glb or .gltf.
#include <span>

#include <weft/characters/gltf_reader.hpp>
#include <weft/core/error.hpp>
#include "fuzz/fuzz_target.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace weft;
  try {
    const characters::Character character =
        characters::read_gltf(std::as_bytes(std::span(data, size)), "input.glb");
    for (const characters::Part& part : character.parts) {
      fuzz::require(part.positions.allFinite(), "positions are finite");
      fuzz::require(
          part.triangles.size() == 0 ||
              (part.triangles.minCoeff() >= 0 && part.triangles.maxCoeff() < part.positions.cols()),
          "triangles name vertices that are there");
    }
  } catch (const InvalidArgument& error) {
    // Names from the file are quoted as they are; what prints the message makes them harmless.
    fuzz::require(std::string_view(error.what()).size() <= 2000, "an error is short");
  }
  return 0;
}
