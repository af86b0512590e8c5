#pragma once

// Tested by tests/engines/blow_up_engines_test.cpp, tests/engines/body_engines_test.cpp.

#include <functional>
#include <memory>

#include <weft/custom_forces/force_law.hpp>
#include <weft/scenes/simulator.hpp>

namespace weft::scenes {

/// Weft's own spring solver behind the port, set up as Scene::reference says.
[[nodiscard]] std::unique_ptr<Simulator> make_reference();

/// The same with every law passed through a filter that may wrap it: the door through which
/// validation puts deliberate mistakes into a run.
using LawFilter = std::function<std::unique_ptr<forces::ForceLaw<double>>(
    std::unique_ptr<forces::ForceLaw<double>>)>;
[[nodiscard]] std::unique_ptr<Simulator> make_reference(LawFilter filter);

}  // namespace weft::scenes
