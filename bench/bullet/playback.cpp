#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <tbb/task_arena.h>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/core/error.hpp>
#include <weft/mesh/cloth_grid.hpp>
#include <weft/playback/export/cloth_energy.hpp>
#include <weft/playback/export/player_page.hpp>
#include <weft/playback/rendering/renderer.hpp>
#include <weft/recorder/recorder.hpp>
#include <weft/scenes/recording/playback_copy.hpp>
#include <weft/scenes/recording/recording.hpp>

#include <btBulletDynamicsCommon.h>

#include "bench/bench.hpp"
#include "bench/result_file.hpp"
#include "bench/stopwatch.hpp"

namespace weft::bench {
namespace {

constexpr double kTimeStep = 1.0 / 60;  // [s]
constexpr int kFrames = 300;

struct TemporaryFolder {
  TemporaryFolder() : path(std::filesystem::temp_directory_path() / "weft-bench-playback") {
    std::filesystem::remove_all(path);
    std::filesystem::create_directories(path);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  std::filesystem::path path;
};

double wall_milliseconds(const std::function<void()>& call) {
  const auto start = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

std::string nodes_text(int n) {
  return std::to_string(n * n);
}

/// A sheet of n x n nodes that falls over a ball, a frame of each step.
void record(int n, const std::filesystem::path& path, ResultFile& file) {
  ClothGrid grid{.nodes = {n, n}, .size = {2.0, 2.0}, .total_mass = 1.0};
  grid.center = {0, 1.2, 0};
  const ClothMesh mesh = make_cloth_grid(grid);
  bridge::SoftWorld world({{0, -9.81, 0}, 0.05});
  btSoftBody& cloth = world.add(bridge::make_cloth_body(
      world.info(), mesh, {.collision_margin = 0.01, .friction = 0.5, .time_step = kTimeStep}));
  const auto refusal =
      world.solver().attach_fast(cloth, mesh,
                                 {{"gravity", {}, {{"acceleration", {0.0, -9.81, 0.0}}}},
                                  {"tension", {}, {{"stiffness", {1000.0}}}},
                                  {"velocity_damping", {}, {{"rate", {0.5}}}}},
                                 {.may_sleep = false});
  if (refusal) throw Error("bench playback: " + *refusal);
  const auto shape = std::make_shared<btSphereShape>(btScalar(0.5));
  auto body = std::make_unique<btRigidBody>(btScalar(0), nullptr, shape.get());
  btTransform place = btTransform::getIdentity();
  place.setOrigin(btVector3(0, btScalar(0.5), 0));
  body->setWorldTransform(place);
  const btRigidBody& ball = world.add(std::move(body), shape);
  recorder::Recorder recorder(path, {.name = "sheet", .frame_interval = kTimeStep});
  recorder.add(cloth, "sheet");
  recorder.add(ball, "ball");
  double stepping = 0;   // [ms]
  double recording = 0;  // [ms]
  for (int step = 1; step <= kFrames; ++step) {
    const double start = processor_time();
    world.step(kTimeStep);
    const double stepped = processor_time();
    (void)recorder.record(step * kTimeStep);
    stepping += stepped - start;
    recording += processor_time() - stepped;
  }
  (void)recorder.finish();
  file.add({"a step of the fast solver", nodes_text(n), three_digits(stepping / kFrames), "ms"});
  file.add({"a frame of the recorder, in the mean", nodes_text(n),
            three_digits(recording / kFrames), "ms"});
  file.add({"the recorder beside the steps", nodes_text(n),
            three_digits(100 * recording / stepping), "%"});
}

void measure_sizes(int n, const std::filesystem::path& path, ResultFile& file) {
  constexpr double kMegabyte = 1e6;
  const scenes::RecordingReader reader(path);
  const std::string frames = std::to_string(reader.num_frames()) + " frames, ";
  file.add({frames + "recording", nodes_text(n),
            three_digits(static_cast<double>(std::filesystem::file_size(path)) / kMegabyte), "MB"});
  scenes::PlaybackCopyOptions options;
  options.metrics = scenes::cloth_energies(reader);
  const std::string page =
      scenes::player_page({{"sheet.weftrec", scenes::playback_copy(reader, options), "", ""}});
  file.add({frames + "page, rounded by 0.01 mm", nodes_text(n),
            three_digits(static_cast<double>(page.size()) / kMegabyte), "MB"});
}

/// Pictures in a second, of the last frame.
void draw(int n, const std::filesystem::path& path, int num_rounds, ResultFile& file) {
  const scenes::RecordingReader reader(path);
  const scenes::SceneState state = reader.frame(reader.num_frames() - 1);
  scenes::Renderer renderer(reader.scene());
  const struct {
    const char* name;
    scenes::SurfaceStyle style;
    int samples;
  } looks[] = {{"shaded", scenes::SurfaceStyle::kShaded, 2},
               {"shaded, one sample", scenes::SurfaceStyle::kShaded, 1},
               {"wireframe", scenes::SurfaceStyle::kWireframe, 2}};
  for (const auto& look : looks) {
    scenes::RenderOptions options;
    options.width = 1280;
    options.height = 720;
    options.style = look.style;
    options.samples = look.samples;
    (void)renderer.render(state, options);
    std::vector<double> times;  // [ms]
    for (int round = 0; round < num_rounds; ++round) {
      times.push_back(wall_milliseconds([&] { (void)renderer.render(state, options); }));
    }
    file.add({std::string("pictures of 1280 x 720, ") + look.name, nodes_text(n),
              three_digits(1e3 / median(times)), "1/s"});
  }
}

}  // namespace

void bench_playback(const Settings& settings) {
  ResultFile file(
      "a sheet that falls over a ball: the recorder's processor time on one thread with a frame of "
      "each step of 1/60 s, sizes of files, and pictures in a second without a display or a "
      "graphics card, medians",
      {"what", "nodes", "value", "unit"});
  const TemporaryFolder folder;
  for (const int n : {50, 100}) {
    const std::filesystem::path path = folder.path / (nodes_text(n) + ".weftrec");
    tbb::task_arena arena(1);
    arena.execute([&] { record(n, path, file); });
    measure_sizes(n, path, file);
    draw(n, path, settings.num_rounds, file);
  }
  file.write(settings.folder / "playback.csv");
}

}  // namespace weft::bench
