# cmake -DFILES=<json;json> -DOUT=<cpp file> -P embed_peers.cmake
# Writes the results of peers as raw literals, in the order given.
set(items "")
foreach(file IN LISTS FILES)
  file(READ "${file}" text)
  string(APPEND items "    R\"peer(${text})peer\",\n")
endforeach()
file(WRITE "${OUT}" "// Made from validation/peers/results by embed_peers.cmake.
#include <weft/validation/peers/peer_result.hpp>

namespace weft::validation {

std::span<const std::string_view> peer_texts() {
  static constexpr std::string_view kTexts[] = {
${items}  };
  return kTexts;
}

}  // namespace weft::validation
")
