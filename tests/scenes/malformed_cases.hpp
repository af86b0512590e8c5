#pragma once

#include <array>
#include <string_view>

namespace weft::scenes {

/// A file under tests/scenes/malformed and the error it must give.
struct MalformedCase {
  std::string_view name;
  int line;
  int column;
  std::string_view fragment;  ///< of the message
};

// clang-format off
inline constexpr std::array<MalformedCase, 83> kMalformedCases = {{
    {"axis_of_a_rope", 11, 1, "cloth.u_axis: unknown key"},
    {"center_has_it_all", 9, 88, "expected a number > 0 and < 1"},
    {"column_of_a_sphere", 11, 39, "expected a whole number from 0 to 41"},
    {"corner_of_a_sphere", 11, 19, "an icosphere has no corners and edges, expected one of box, sphere, nodes"},
    {"edge_of_a_rope", 11, 45, "a rope has no corners and edges, expected one of box, sphere, nodes"},
    {"empty_sphere", 11, 8, "holds no node, expected a sphere with at least one node"},
    {"gas_in_a_rope", 12, 7, "needs a closed surface"},
    {"huge_sphere", 9, 45, "expected a whole number from 1 to 316"},
    {"lines_of_a_sphere", 11, 1, "line_sets is empty"},
    {"no_source", 7, 1, "missing key 'grid', expected exactly one of grid, icosphere, rope, mesh"},
    {"no_such_source", 9, 1, "cloth.gird: unknown key, did you mean 'grid'?"},
    {"node_not_there", 11, 22, "expected a range within 0 to 41"},
    {"nodes_backwards", 11, 19, "the smaller number first"},
    {"share_without_center", 9, 68, "there is no centre node"},
    {"short_rope", 9, 59, "makes a rope without length"},
    {"taken_connection", 11, 15, "has the name of another connection"},
    {"two_sources", 10, 13, "grid is given too, expected exactly one of grid, icosphere, rope, mesh"},
    {"wind_on_a_rope", 12, 7, "acts on triangles, expected another law for a rope"},
    {"ambiguous_unit", 16, 13, "ambiguous unit 'N/m*rad'"},
    {"bad_name", 2, 8, "expected a name"},
    {"bare_number", 20, 10, "missing unit, expected a length such as \"2 m\""},
    {"binary", 1, 1, "control character 0x7f"},
    {"camera_on_target", 17, 1, "position = target"},
    {"crossed_brackets", 9, 22, "'}' does not match, expected ']'"},
    {"deep_brackets", 2, 21, "nested too deep"},
    {"deep_key", 2, 32, "too many parts"},
    {"duplicate_body", 18, 8, "another body has this name"},
    {"duplicate_key", 6, 12, "redefine"},
    {"dynamic_plane", 20, 8, "a plane cannot move"},
    {"edge_set_twice", 16, 22, "expected each set once"},
    {"empty", 1, 1, "is empty"},
    {"empty_pin", 13, 8, "holds no node"},
    {"fixed_velocity", 21, 12, "a fixed body cannot move"},
    {"gas_in_a_grid", 12, 7, "needs a closed surface"},
    {"tie_outside", 11, 40, "expected a whole number from -3 to 2"},
    {"ties_missing", 11, 1, "connection_sets is empty"},
    {"fractional_nodes", 9, 19, "expected a whole number from 2"},
    {"huge_nodes", 9, 18, "expected at most 1000000"},
    {"infinite", 12, 12, "expected a finite number"},
    {"missing_key", 17, 1, "collider: missing key 'radius'"},
    {"missing_parameter", 14, 1, "missing key 'stiffness', expected a stiffness"},
    {"missing_schema", 1, 1, "missing key 'schema'"},
    {"missing_unit", 20, 10, "missing unit, expected a length such as \"2 m\""},
    {"missing_world", 1, 1, "missing key 'world'"},
    {"nameless_table", 2, 1, "table header without a name"},
    {"negative_friction", 12, 12, "expected a number >= 0"},
    {"negative_margin", 12, 20, "expected a length >= 0"},
    {"negative_mass", 11, 8, "expected a mass > 0"},
    {"negative_stiffness", 16, 13, "expected >= 0 [N/m]"},
    {"no_cloth", 1, 1, "no cloth, expected at least one"},
    {"no_mass", 7, 1, "missing key 'mass' or 'areal_density'"},
    {"no_space", 20, 10, "expected a space between number and unit"},
    {"not_a_number", 12, 12, "expected a finite number"},
    {"not_a_quantity", 20, 10, "expected a length such as \"2 m\""},
    {"not_utf8", 2, 9, "is not UTF-8"},
    {"one_node", 9, 22, "expected a whole number from 2"},
    {"only_comment", 1, 1, "is empty"},
    {"overflow", 20, 10, "out of the range of double"},
    {"short_vector", 21, 12, "has 2 entries, expected an array of 3"},
    {"single_cloth", 7, 1, "expected a cloth written [[cloth]]"},
    {"skew_axes", 11, 10, "not perpendicular"},
    {"too_many_steps", 5, 12, "expected at most 10000000"},
    {"too_short", 5, 12, "expected at least one time step"},
    {"two_masses", 12, 17, "exactly one of the two"},
    {"two_pins_in_one", 13, 8, "expected exactly one of corner, edge, box, sphere, nodes, part, vertex_group"},
    {"unclosed_string", 2, 14, "string"},
    {"uneven_frames", 6, 18, "expected a whole number of them"},
    {"unknown_corner", 13, 19, "unknown corner, expected one of -u-v"},
    {"unknown_edge_set", 16, 25, "unknown edge set of this cloth, expected one of stretch, shear, bend"},
    {"unknown_integrator", 18, 14, "did you mean 'modified_euler'?"},
    {"unknown_key", 21, 1, "collider.raduis: unknown key, did you mean 'radius'?"},
    {"unknown_law", 15, 7, "unknown law, did you mean 'tension'?"},
    {"unknown_parameter", 17, 1, "did you mean 'stiffness'?"},
    {"unknown_shape", 19, 9, "unknown shape, expected one of sphere, box, plane"},
    {"unknown_unit", 20, 10, "unknown unit 'mm/foo', expected a length"},
    {"unknown_world_key", 6, 1, "did you mean 'gravity'?"},
    {"wrong_schema", 1, 10, "expected \"weft-scene/1\""},
    {"wrong_type", 12, 12, "expected a number without unit"},
    {"wrong_unit", 16, 13, "cloth.law.stiffness = \"5 N\": wrong unit, is force [kg m/s^2], expected stiffness [N/m]"},
    {"zero_axis", 10, 10, "no direction"},
    {"zero_denominator", 4, 13, "divides by zero"},
    {"zero_nodes", 9, 19, "expected a whole number from 2"},
    {"zero_radius", 20, 10, "expected a length > 0"},
}};
// clang-format on

}  // namespace weft::scenes
