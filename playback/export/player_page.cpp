#include <weft/playback/export/player_page.hpp>

#include <span>
#include <string_view>

#include <weft/characters/base64.hpp>
#include <weft/core/error.hpp>
#include <weft/playback/export/player_template.hpp>

namespace weft::scenes {
namespace {

constexpr std::string_view kSlot = "<!--WEFT-RECORDINGS-->";
constexpr std::string_view kMark = "<!-- A playback page of Weft. -->";

bool begins_as_page(std::string_view beginning) {
  return beginning.find(kMark) != std::string_view::npos;
}

std::string base64(const std::string& bytes) {
  return characters::to_base64(std::as_bytes(std::span(bytes)));
}

/// A text inside of the double quotes of an attribute.
std::string attribute(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string elements_of(const PageRecording& recording) {
  return "<img class=\"poster\" alt=\"" + attribute(recording.poster_text) +
         "\" src=\"data:image/jpeg;base64," + base64(recording.poster_jpeg) + "\">\n" +
         "<script type=\"application/x-weft-recording\" data-name=\"" + attribute(recording.name) +
         "\">" + base64(recording.copy) + "</script>\n";
}

}  // namespace

const output::FileKind kPlayerPageKind{"a playback page", begins_as_page};

std::string player_page(const std::vector<PageRecording>& recordings) {
  const std::string_view page = player_template();
  const std::size_t at = page.find(kSlot);
  if (at == std::string_view::npos || !begins_as_page(page.substr(0, output::kBeginningBytes))) {
    throw Error("player_page: web/dist/player.html has no slot " + std::string(kSlot) +
                " or no mark, expected both; rebuild web/");
  }
  std::string html(page.substr(0, at));
  for (const PageRecording& recording : recordings) html += elements_of(recording);
  html += page.substr(at + kSlot.size());
  return html;
}

}  // namespace weft::scenes
