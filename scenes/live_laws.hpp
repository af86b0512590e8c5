#pragma once

// Tested by tests/engines/live_laws_test.cpp.

#include <cstddef>
#include <vector>

#include <weft/custom_forces/law_info.hpp>

namespace weft::scenes {

/// The interface of engines whose laws can change between two steps, beside Simulator.
class LiveLaws {
 public:
  virtual ~LiveLaws() = default;

  /// Other laws for a cloth, counted as Scene::cloths, from the next step on. Positions, velocities
  /// and time go on as they are. Throws InvalidArgument for laws that the engine refuses, for one
  /// that it can set only at load(), and for a cloth that may tear; nothing has changed then.
  virtual void replace_laws(std::size_t cloth,
                            const std::vector<forces::LawSpecification>& laws) = 0;
};

}  // namespace weft::scenes
