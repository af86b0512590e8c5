#pragma once

// Tested by tests/scenes/format/scene_file_test.cpp.

#include <array>
#include <string_view>

namespace weft::scenes {

/// The words of the scene format for enumerations and variants, in the order of their C++ values,
/// for the reader and the writer.

inline constexpr std::string_view kSchema = "weft-scene/1";

inline constexpr std::array<std::string_view, 3> kStencilWords = {"24-neighbour", "12-neighbour",
                                                                  "8-neighbour"};
/// Both spellings are read; that of kStencilWords, which older versions know, is written.
inline constexpr std::array<std::string_view, 6> kReadStencilWords = {
    "24-neighbor", "12-neighbor", "8-neighbor", "24-neighbour", "12-neighbour", "8-neighbour"};
inline constexpr std::array<std::string_view, 2> kLumpingWords = {"area", "uniform"};
inline constexpr std::array<std::string_view, 10> kShapeWords = {
    "sphere", "box",         "plane", "capsule",  "cylinder",
    "cone",   "convex_hull", "mesh",  "compound", "height_field"};
inline constexpr std::array<std::string_view, 7> kPatternWords = {
    "plain", "checks", "stripes", "dots", "tartan", "carpet", "eyeball"};
inline constexpr std::array<std::string_view, 10> kIntegratorWords = {
    "explicit_euler",    "modified_euler",   "velocity_verlet", "runge_kutta_4",
    "yoshida_4",         "dormand_prince_5", "implicit_euler",  "tr_bdf2",
    "implicit_midpoint", "generalized_alpha"};
inline constexpr std::array<std::string_view, 2> kContactWords = {"projection", "impulse"};
inline constexpr std::array<std::string_view, 2> kContactPointsWords = {"nodes", "nodes_and_faces"};
inline constexpr std::array<std::string_view, 3> kStepGuardWords = {"report", "refuse", "substep"};
inline constexpr std::array<std::string_view, 2> kConcaveWords = {"prisms", "triangles"};
inline constexpr std::array<std::string_view, 4> kCornerWords = {"-u-v", "+u-v", "-u+v", "+u+v"};
inline constexpr std::array<std::string_view, 4> kEdgeWords = {"-u", "+u", "-v", "+v"};
inline constexpr std::array<std::string_view, 3> kFollowWords = {"fixed", "heading", "banked"};
inline constexpr std::array<std::string_view, 4> kControllerWords = {"seek", "roll", "attach",
                                                                     "detail"};
inline constexpr std::array<std::string_view, 3> kDetailWords = {"full", "simplified", "skin"};

inline constexpr std::array<std::string_view, 4> kChannelWords = {"red", "green", "blue", "alpha"};

}  // namespace weft::scenes
