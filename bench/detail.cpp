// What a step costs the main thread at each level of detail of a character's cape.
#include <chrono>

#include <weft/engines/engine_table.hpp>
#include <weft/scenes/catalog.hpp>
#include <weft/scenes/controllers/detail.hpp>

#include "bench/bench.hpp"
#include "bench/result_file.hpp"
#include "bench/stopwatch.hpp"

namespace weft::bench {
namespace {

using namespace weft::scenes;

constexpr int kSteps = 20;  // of a turn

/// The walking figure and its cape, without the skin, which costs the same in all levels.
Scene caped_figure() {
  Scene scene = load_scene("caped_figure");
  scene.cloths.resize(1);
  scene.characters[0].skins.clear();
  return scene;
}

struct Character {
  std::string name;
  DetailLevel level;
  std::shared_ptr<DetailController> controller = {};
  std::unique_ptr<Simulator> simulator = {};
  std::vector<double> step_ms = {};
};

void take_turn(Character& character, double time_step) {
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < kSteps; ++i) (void)character.simulator->step(time_step);
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
  character.step_ms.push_back(taken.count() / kSteps);
}

}  // namespace

void bench_detail(const Settings& settings) {
  const Scene scene = caped_figure();
  ResultFile file("main thread's time for a step of the caped figure's cape; medians of turns of " +
                      std::to_string(kSteps) + " steps",
                  {"engine", "level", "nodes", "step_ms", "over_full"});
  for (const char* engine : {"bullet_soft", "bullet_forces"}) {
    std::vector<Character> characters(3);
    characters[0] = {"full", DetailLevel::kFull};
    characters[1] = {"simplified", DetailLevel::kSimplified};
    characters[2] = {"skin", DetailLevel::kSkin};
    for (Character& character : characters) {
      character.controller =
          std::make_shared<DetailController>(Detail{.cloth = "cape"}, 0, scene.cloths[0]);
      character.controller->set_level(character.level);
      character.simulator = find_engine(engine, StoredPrecision::kFloat32)->make();
      character.simulator->set_controllers({character.controller});
      character.simulator->load(scene);
    }
    // Round by round, so that all see the same load of the machine.
    for (int round = 0; round < 4 * settings.num_rounds; ++round) {
      for (Character& character : characters) take_turn(character, scene.world.time_step);
    }
    const double full = median(characters[0].step_ms);
    for (Character& character : characters) {
      const double step = median(character.step_ms);
      const auto nodes = character.simulator->state().cloths[0].positions.cols();
      file.add({engine, character.name, std::to_string(nodes), three_digits(step),
                three_digits(step / full)});
    }
  }
  file.write(settings.folder / "detail.csv");
}

}  // namespace weft::bench
