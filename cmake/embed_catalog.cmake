# cmake -D OUTPUT=<file.cpp> -D SCENES=<a.toml,b.toml,...> -P embed_catalog.cmake
# Writes the scene texts as C++ so that the library needs no data files at run time.
string(REPLACE "," ";" scenes "${SCENES}")
set(code "// Generated from scenes/catalog/*.toml.\n#include <array>\n\n#include <weft/scenes/catalog.hpp>\n\n")
list(LENGTH scenes count)
string(APPEND code "namespace weft::scenes {\n\nstd::span<const CatalogEntry> scene_catalog() {\n")
string(APPEND code "  static constexpr std::array<CatalogEntry, ${count}> kEntries = {{\n")
foreach(scene IN LISTS scenes)
  get_filename_component(name "${scene}" NAME_WE)
  file(READ "${scene}" text)
  string(APPEND code "      {\"${name}\", R\"weft_toml(${text})weft_toml\"},\n")
endforeach()
string(APPEND code "  }};\n  return kEntries;\n}\n\n}  // namespace weft::scenes\n")
file(WRITE "${OUTPUT}" "${code}")
