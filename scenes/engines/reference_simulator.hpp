#pragma once

#include <memory>

#include <weft/scenes/simulator.hpp>

namespace weft::scenes {

/// Weft's own spring solver behind the port, set up as Scene::reference says.
[[nodiscard]] std::unique_ptr<Simulator> make_reference();

}  // namespace weft::scenes
