# cmake -DPAGE=<html file> -DOUT=<cpp file> -DHEADER=<header> -DFUNCTION=<namespace::name> -P embed_page.cmake
# Writes the page as an array of bytes: no limit on the length of a literal, no escaping. The header declares the
# function, which gives the bytes as a std::string_view.
file(READ "${PAGE}" hex HEX)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
string(REPEAT "....." 20 line)  # 20 bytes of five characters each
string(REGEX REPLACE "(${line})" "\\1\n" bytes "${bytes}")
file(WRITE "${OUT}" "// Made by embed_page.cmake.
#include <${HEADER}>

namespace {
constexpr unsigned char kPage[] = {
${bytes}};
}  // namespace

std::string_view ${FUNCTION}() {
  return {reinterpret_cast<const char*>(kPage), sizeof(kPage)};
}
")
