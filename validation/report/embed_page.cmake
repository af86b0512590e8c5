# cmake -DPAGE=<html file> -DOUT=<cpp file> -P embed_page.cmake
# Writes the page as an array of bytes: no limit on the length of a literal, no escaping.
file(READ "${PAGE}" hex HEX)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
string(REPEAT "....." 20 line)  # 20 bytes of five characters each
string(REGEX REPLACE "(${line})" "\\1\n" bytes "${bytes}")
file(WRITE "${OUT}" "// Made from web/dist/report.html by embed_page.cmake.
#include <weft/validation/report/page.hpp>

namespace weft::validation {
namespace {
constexpr unsigned char kPage[] = {
${bytes}};
}  // namespace

std::string_view page_template() {
  return {reinterpret_cast<const char*>(kPage), sizeof(kPage)};
}

}  // namespace weft::validation
")
