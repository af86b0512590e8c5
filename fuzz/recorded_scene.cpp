// The text of a resolved scene as it stands in a recording: it may name no file.
#include "fuzz/fuzz_target.hpp"
#include "fuzz/scene_check.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  weft::fuzz::check_scene_text(weft::fuzz::text_of(data, size), {});
  return 0;
}
