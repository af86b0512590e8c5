# The program of README.md as a file, and a variant of it that explodes.
#
# weft_readme_sample(<out> [EXPLODES]): out is set to the path. README.md is read again when it changes.
function(weft_readme_sample out)
  set(readme "${PROJECT_SOURCE_DIR}/README.md")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${readme}")
  file(READ "${readme}" text)
  set(begin_mark "\n```cpp\n")
  string(FIND "${text}" "${begin_mark}" begin)
  string(LENGTH "${begin_mark}" mark_length)
  math(EXPR begin "${begin} + ${mark_length}")
  string(SUBSTRING "${text}" ${begin} -1 text)
  string(FIND "${text}" "\n```\n" end)
  math(EXPR end "${end} + 1")
  string(SUBSTRING "${text}" 0 ${end} text)
  set(name readme_sample)
  if("EXPLODES" IN_LIST ARGN)
    set(name readme_sample_explodes)
    # A node is pushed to a speed that means nothing.
    string(REPLACE "  for (int step" "  cloth->m_nodes[7].m_v = btVector3(0, btScalar(1e12), 0);\n  for (int step" explosive
           "${text}")
    if(explosive STREQUAL text)
      message(FATAL_ERROR "README.md's program has no loop over steps any more")
    endif()
    set(text "${explosive}")
  endif()
  file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/tests/docs/${name}.cpp" CONTENT "${text}" @ONLY)
  set(${out} "${PROJECT_BINARY_DIR}/tests/docs/${name}.cpp" PARENT_SCOPE)
endfunction()
