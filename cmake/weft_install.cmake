# Installs the library modules, their headers and the CMake package (find_package(weft)).
