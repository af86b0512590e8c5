#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <weft/core/error.hpp>
#include <weft/engines/engine_table.hpp>
#include <weft/playback/rendering/image.hpp>
#include <weft/playback/rendering/montage.hpp>
#include <weft/playback/rendering/renderer.hpp>
#include <weft/scenes/catalog.hpp>
#include <weft/scenes/engine_kind.hpp>
#include <weft/scenes/recording/recording.hpp>

#include "apps/app.hpp"
#include "apps/progress/partial_note.hpp"
#include "apps/progress/progress_bar.hpp"
#include "apps/terminal.hpp"

namespace weft::app {
namespace {

/// The engine for scenes that are made for all.
constexpr std::string_view kUsualEngine = scenes::kBulletForces.name;

struct SheetOptions {
  std::vector<std::string> names;
  std::vector<std::string> engines;  // none: the first of each scene
  std::string output;
  std::string page;
  int columns = 4;
  int width = 384;  // of one picture [pixel]
};

/// A scene at its most telling time.
struct Exhibit {
  scenes::Scene scene;
  std::string engine;
  scenes::SceneState state;
  scenes::Image picture;
};

const scenes::EngineInfo& find_any_precision(const std::string& name) {
  for (const auto precision :
       {scenes::StoredPrecision::kFloat32, scenes::StoredPrecision::kFloat64}) {
    if (const scenes::EngineInfo* engine = scenes::find_engine(name, precision)) return *engine;
  }
  throw Error("contact-sheet: engine '" + name + "' is not in this program");
}

double poster_time(const scenes::Scene& scene) {
  return scene.camera.poster_time.value_or(scene.world.duration);
}

std::string first_engine(const scenes::Scene& scene) {
  return scene.engines.empty() ? std::string(kUsualEngine) : scene.engines.front();
}

Exhibit simulate(const scenes::Scene& for_all, const std::string& name) {
  const scenes::Scene scene = scenes::with_step_of(for_all, name);
  const std::unique_ptr<scenes::Simulator> simulator = find_any_precision(name).make();
  simulator->load(scene);
  const double end = poster_time(scene);
  ProgressBar progress(scene.name);
  // Half a step early: whether rounding adds a step must not decide about the picture.
  while (simulator->state().time < end - 0.5 * scene.world.time_step) {
    const scenes::StepReport report = simulator->step(scene.world.time_step);
    progress.update(report.time / end);
    if (report.blow_up) {
      throw Error(fmt::format("contact-sheet: {} blew up at t = {:.4g} s: {}", scene.name,
                              report.blow_up->time, report.blow_up->reason));
    }
  }
  return {scene, name, simulator->state(), {}};
}

Exhibit from_recording(const std::string& path) {
  const scenes::RecordingReader reader(path);
  note_if_partial(reader, path);
  if (reader.num_frames() == 0) throw Error(path + ": has no frame to render");
  const double time = poster_time(reader.scene());
  int frame = 0;
  while (frame + 1 < reader.num_frames() && reader.frame_time(frame) < time) ++frame;
  const auto engine = reader.provenance().find("engine");
  return {reader.scene(),
          engine == reader.provenance().end() ? "" : engine->second,
          reader.frame(frame),
          {}};
}

bool is_recording(const std::string& name) {
  return name.ends_with(".weftrec");
}

Exhibit drawn(Exhibit exhibit, int width) {
  scenes::RenderOptions options;
  options.width = width;
  options.height = width * 9 / 16;
  options.samples = 4;
  exhibit.picture = scenes::Renderer(exhibit.scene).render(exhibit.state, options);
  return exhibit;
}

Exhibit make_exhibit(const std::string& name, int width) {
  if (is_recording(name)) return drawn(from_recording(name), width);
  const scenes::Scene scene = scenes::load_scene(name);
  return drawn(simulate(scene, first_engine(scene)), width);
}

/// "Shows a cloth" is "a cloth" where a column says so.
std::string what_it_shows(const std::string& summary) {
  constexpr std::string_view kShows = "Shows ";
  return summary.starts_with(kShows) ? summary.substr(kShows.size()) : summary;
}

std::string engines_of(const scenes::Scene& scene) {
  if (scene.engines.empty()) return "all";
  std::string names;
  for (const std::string& name : scene.engines) names += (names.empty() ? "`" : ", `") + name + "`";
  return names;
}

std::string scene_page(const std::vector<Exhibit>& exhibits, const std::string& command) {
  std::string page = fmt::format(
      "# What scenes are there, and what do they look like?\n\n"
      "Made by `{}`: change a scene, then run it again.\n"
      "`weft run NAME` simulates a scene, `weft render` draws it; each is a TOML file to copy.\n\n"
      "![All scenes](img/contact_sheet.png)\n\n"
      "| | Scene | Shows | Engines | Picture |\n|---|---|---|---|---|\n",
      command);
  for (const Exhibit& exhibit : exhibits) {
    const std::string& name = exhibit.scene.name;
    page += fmt::format(
        "| ![{0}](img/scenes/{0}.png) | [`{0}`](../scenes/catalog/{0}.toml) | {1} | {2} "
        "| {3}, t = {4:.3g} s |\n",
        name, what_it_shows(exhibit.scene.summary), engines_of(exhibit.scene), exhibit.engine,
        exhibit.state.time);
  }
  return page;
}

/// What makes the same page again.
std::string command_text(const SheetOptions& options) {
  const SheetOptions usual;
  std::string text =
      fmt::format("weft contact-sheet -o {} --page {}", options.output, options.page);
  if (options.width != usual.width) text += fmt::format(" --width {}", options.width);
  if (options.columns != usual.columns) text += fmt::format(" --columns {}", options.columns);
  return text;
}

bool begins_as_page(std::string_view beginning) {
  return beginning.starts_with(
      "# What scenes are there, and what do they look like?\n\nMade by `weft");
}

/// What the command writes, all looked at before the first scene is simulated.
class SheetOutputs {
 public:
  explicit SheetOutputs(const SheetOptions& options)
      : sheet_(options.output, scenes::kPictureKind) {
    if (options.page.empty()) return;
    const std::filesystem::path folder = std::filesystem::path(options.page).parent_path();
    if (!folder.empty()) std::filesystem::create_directories(folder);
    page_.emplace(options.page, output::FileKind{"a page of scenes", begins_as_page});
    pictures_ = folder / "img" / "scenes";
  }

  void write_sheet(const scenes::Image& sheet) const { sheet_.write(scenes::encode_png(sheet)); }

  void write_page(const std::vector<Exhibit>& exhibits, const std::string& command) const {
    if (!page_) return;
    std::filesystem::create_directories(pictures_);
    for (const Exhibit& exhibit : exhibits) {
      scenes::write_png(pictures_ / (exhibit.scene.name + ".png"), exhibit.picture);
    }
    page_->write(scene_page(exhibits, command));
  }

 private:
  output::OutputFile sheet_;
  std::optional<output::OutputFile> page_;
  std::filesystem::path pictures_;
};

/// The same scene on several engines, as neighbors; white where it is not made for one.
std::vector<scenes::SheetEntry> compare_engines(const SheetOptions& options) {
  std::vector<scenes::SheetEntry> entries;
  for (const std::string& name : options.names) {
    if (is_recording(name))
      throw Error(name + ": a recording has its engine, expected a scene with --engines");
    const scenes::Scene scene = scenes::load_scene(name);
    for (const std::string& engine : options.engines) {
      if (scenes::is_for_engine(scene, engine)) {
        const Exhibit exhibit = drawn(simulate(scene, engine), options.width);
        entries.push_back({exhibit.picture, scene.name, engine});
      } else {
        scenes::Image empty = entries.empty() ? scenes::Image{} : entries.front().picture;
        std::fill(empty.rgb.begin(), empty.rgb.end(), std::uint8_t{255});
        entries.push_back({std::move(empty), scene.name, "not made for " + engine});
      }
    }
  }
  return entries;
}

int make_sheet(SheetOptions options) {
  if (options.names.empty()) {
    for (const scenes::CatalogEntry& entry : scenes::scene_catalog()) {
      options.names.emplace_back(entry.name);
    }
  }
  const SheetOutputs outputs(options);
  if (!options.engines.empty()) {
    const std::vector<scenes::SheetEntry> entries = compare_engines(options);
    outputs.write_sheet(scenes::contact_sheet(entries, options.columns));
    print("{}: {} scenes on {} engines\n", options.output, options.names.size(),
          options.engines.size());
    return kOk;
  }
  std::vector<Exhibit> exhibits;
  std::vector<scenes::SheetEntry> entries;
  for (const std::string& name : options.names) {
    const Exhibit& exhibit = exhibits.emplace_back(make_exhibit(name, options.width));
    entries.push_back({exhibit.picture, exhibit.scene.name, what_it_shows(exhibit.scene.summary)});
  }
  outputs.write_sheet(scenes::contact_sheet(entries, options.columns));
  outputs.write_page(exhibits, command_text(options));
  print("{}: {} scenes\n", options.output, exhibits.size());
  return kOk;
}

}  // namespace

Action add_contact_sheet_command(CLI::App& parser) {
  CLI::App* command = parser.add_subcommand(
      "contact-sheet", "One picture of many scenes, each at the time its camera names");
  auto options = std::make_shared<SheetOptions>();
  command->add_option("SCENE", options->names,
                      "Catalog names, scene files, recordings (default: the whole catalog)");
  command->add_option("-o,--output", options->output, "PNG to write")->required();
  CLI::Option* page =
      command->add_option("--page", options->page,
                          "Markdown table of the scenes to write, with its pictures in img/scenes "
                          "beside it");
  command
      ->add_option("--engines", options->engines,
                   "Each scene on each of these, side by side, e.g. bullet_weft,reference")
      ->delimiter(',')
      ->check(CLI::IsMember(
          scenes::engine_names([](const scenes::EngineKind& kind) { return !kind.is_deformable; })))
      ->excludes(page);
  command->add_option("--columns", options->columns, "Pictures in a row")
      ->check(CLI::Range(1, 20))
      ->capture_default_str();
  command->add_option("--width", options->width, "Of one picture [pixels]")
      ->check(CLI::Range(64, 1920))
      ->capture_default_str();
  return [options] { return make_sheet(*options); };
}

}  // namespace weft::app
