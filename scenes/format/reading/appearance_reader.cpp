#include <weft/scenes/format/reading/appearance_reader.hpp>

#include <algorithm>
#include <filesystem>
#include <string>

#include <fmt/format.h>

#include <weft/scenes/appearance/image_file.hpp>
#include <weft/scenes/format/scene_words.hpp>
#include <weft/scenes/format/spelling.hpp>
#include <weft/scenes/format/toml_text.hpp>

namespace weft::scenes {
namespace {

/// More than that is a mistake in the file, and would alias to noise.
constexpr double kMaxRepeat = 1000;

Rgb read_color(const TomlValue& value) {
  const std::string text = value.text();
  if (const std::optional<Rgb> color = parse_color(text)) return *color;
  const std::vector<std::string_view> names = color_names();
  value.fail("is neither \"#rrggbb\" nor a known colour" + suggestion(text, names));
}

void read_texture(const TomlValue& value, Appearance& appearance) {
  const std::string text = value.text();
  if (!has_image_extension(text)) {
    const auto found = std::find(kPatternWords.begin(), kPatternWords.end(), text);
    if (found == kPatternWords.end()) {
      value.fail("is neither a .png or .jpg file nor a pattern" + suggestion(text, kPatternWords));
    }
    appearance.pattern = static_cast<Pattern>(found - kPatternWords.begin());
    return;
  }
  if (std::filesystem::path(text).is_absolute()) {
    value.fail("is an absolute path, expected one relative to the scene file");
  }
  appearance.image = text;
}

void read_repeat(const TomlValue& value, Appearance& appearance) {
  const std::vector<TomlValue> items = value.items("two numbers such as [4, 1]", 2);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    appearance.texture_repeat[axis] = items[axis].positive("1");
    if (appearance.texture_repeat[axis] > kMaxRepeat) {
      items[axis].fail(fmt::format("expected at most {}", kMaxRepeat));
    }
  }
}

void load_file(const TomlTable& body, const Appearance& appearance, Scene& scene) {
  if (appearance.image.empty()) return;
  const auto same = [&](const SceneFile& file) { return file.name == appearance.image; };
  if (std::any_of(scene.files.begin(), scene.files.end(), same)) return;
  const TomlValue value = body.require("texture", "");
  std::string bytes = value.named_file("a picture");
  try {
    (void)decode_image(bytes);
  } catch (const Error& error) {
    value.fail(fmt::format("{}, expected a PNG or JPEG", error.what()));
  }
  scene.files.push_back({appearance.image, std::move(bytes)});
}

}  // namespace

Appearance read_appearance(const TomlTable& table) {
  Appearance appearance;
  if (const auto value = table.find("color")) appearance.color = read_color(*value);
  if (const auto value = table.find("back_color")) appearance.back_color = read_color(*value);
  if (const auto value = table.find("pattern_color")) {
    appearance.pattern_color = read_color(*value);
  }
  if (const auto value = table.find("texture")) read_texture(*value, appearance);
  if (const auto value = table.find("texture_repeat")) read_repeat(*value, appearance);
  if (const auto value = table.find("smooth")) appearance.smooth = value->boolean();
  if (const auto value = table.find("visible")) appearance.visible = value->boolean();
  return appearance;
}

void load_appearance_files(const TomlTable& root, Scene& scene) {
  const std::vector<TomlTable> cloths = root.tables("cloth");
  for (std::size_t i = 0; i < cloths.size(); ++i) {
    load_file(cloths[i], scene.cloths[i].appearance, scene);
  }
  const std::vector<TomlTable> colliders = root.tables("collider");
  for (std::size_t i = 0; i < colliders.size(); ++i) {
    load_file(colliders[i], scene.colliders[i].appearance, scene);
  }
}

std::string write_appearance(const Appearance& appearance) {
  std::string out;
  const auto write_color = [&](std::string_view key, const std::optional<Rgb>& color) {
    if (color) out += fmt::format("{} = \"{}\"\n", key, format_color(*color));
  };
  write_color("color", appearance.color);
  write_color("back_color", appearance.back_color);
  write_color("pattern_color", appearance.pattern_color);
  if (!appearance.image.empty()) {
    out += fmt::format("texture = {}\n", toml_string(appearance.image));
  } else if (appearance.pattern != Pattern::kPlain) {
    out += fmt::format("texture = \"{}\"\n",
                       kPatternWords.at(static_cast<std::size_t>(appearance.pattern)));
  }
  const auto& repeat = appearance.texture_repeat;
  if (repeat != Appearance().texture_repeat) {
    out +=
        fmt::format("texture_repeat = [{}, {}]\n", toml_number(repeat[0]), toml_number(repeat[1]));
  }
  if (!appearance.smooth) out += "smooth = false\n";
  if (!appearance.visible) out += "visible = false\n";
  return out;
}

}  // namespace weft::scenes
