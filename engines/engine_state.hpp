#pragma once

// Tested by tests/engines/snapshot_test.cpp.

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <weft/core/state_archive.hpp>
#include <weft/custom_forces/law_info.hpp>
#include <weft/scenes/scene.hpp>
#include <weft/scenes/simulator.hpp>
#include <weft/scenes/snapshot/snapshot.hpp>

namespace weft::scenes {

/// What snapshots of all engines have in common.
void serialize(StateArchive& archive, StepReport& report);
void serialize(StateArchive& archive, std::vector<forces::LawSpecification>& laws);

[[nodiscard]] bool are_same(const std::vector<forces::LawSpecification>& a,
                            const std::vector<forces::LawSpecification>& b);

/// The scene of a run, and its text, which is made when the first snapshot needs it.
class LoadedScene {
 public:
  LoadedScene() = default;
  explicit LoadedScene(const Scene& scene) : scene_(std::make_shared<const Scene>(scene)) {}

  /// Throws Error before a scene is loaded.
  [[nodiscard]] const Scene& scene() const;
  /// Without its duration and its frames, which change no step.
  [[nodiscard]] const std::shared_ptr<const std::string>& text();
  /// Throws Error for a snapshot of another engine, precision or scene.
  void check(const Snapshot& snapshot, std::string_view engine, std::string_view precision);

 private:
  std::shared_ptr<const Scene> scene_;
  std::shared_ptr<const std::string> text_;
};

}  // namespace weft::scenes
