#pragma once

#include <cstdint>
#include <string_view>

#include <weft/scenes/scene.hpp>

namespace weft::scenes::stress {

/// A scene that no reasonable person would write, made from a seed: the same one for the same seed
/// and engine, on every machine. Up to two bodies of all sources and some 200 nodes with up to seven
/// laws of the whole table, up to three colliders that may spin; stiffness 0 to 1e9, masses 1e-6 to
/// 1e6 kg, sizes 1e-6 to 1e3 m, steps 1e-5 to 0.1 s. Most numbers are ordinary ones, so that a scene
/// has one or two that are not. What an engine refuses by its documentation is left out for it.
[[nodiscard]] Scene random_scene(std::uint64_t seed, std::string_view engine);

}  // namespace weft::scenes::stress
