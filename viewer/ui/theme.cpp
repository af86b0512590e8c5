#include <weft/viewer/ui/theme.hpp>

#include <imgui.h>

#include <weft/playback/rendering/assets.hpp>

namespace weft::viewer {
namespace {

constexpr float kTextSize = 15.0f;  // [pixel] at scale 1

void set_colors(ImVec4* colors) {
  const ImVec4 accent(0.27f, 0.52f, 0.80f, 1.0f);
  colors[ImGuiCol_WindowBg] = ImVec4(0.10f, 0.11f, 0.13f, 0.88f);
  colors[ImGuiCol_PopupBg] = ImVec4(0.12f, 0.13f, 0.15f, 0.97f);
  colors[ImGuiCol_Border] = ImVec4(1.0f, 1.0f, 1.0f, 0.10f);
  colors[ImGuiCol_TitleBg] = colors[ImGuiCol_TitleBgActive] = ImVec4(0.08f, 0.09f, 0.11f, 0.95f);
  colors[ImGuiCol_Button] = ImVec4(1.0f, 1.0f, 1.0f, 0.10f);
  colors[ImGuiCol_ButtonHovered] = ImVec4(1.0f, 1.0f, 1.0f, 0.20f);
  colors[ImGuiCol_ButtonActive] = accent;
  colors[ImGuiCol_FrameBg] = ImVec4(1.0f, 1.0f, 1.0f, 0.08f);
  colors[ImGuiCol_FrameBgHovered] = ImVec4(1.0f, 1.0f, 1.0f, 0.14f);
  colors[ImGuiCol_FrameBgActive] = ImVec4(1.0f, 1.0f, 1.0f, 0.20f);
  colors[ImGuiCol_SliderGrab] = colors[ImGuiCol_SliderGrabActive] = accent;
  colors[ImGuiCol_CheckMark] = accent;
  colors[ImGuiCol_Header] = ImVec4(0.27f, 0.52f, 0.80f, 0.45f);
  colors[ImGuiCol_HeaderHovered] = ImVec4(0.27f, 0.52f, 0.80f, 0.65f);
  colors[ImGuiCol_HeaderActive] = accent;
  colors[ImGuiCol_Text] = ImVec4(0.94f, 0.95f, 0.96f, 1.0f);
  colors[ImGuiCol_TextDisabled] = ImVec4(0.66f, 0.69f, 0.72f, 1.0f);
}

}  // namespace

void apply_theme(double scale) {
  ImGuiStyle style;
  ImGui::StyleColorsDark(&style);
  style.WindowRounding = 6.0f;
  style.FrameRounding = 4.0f;
  style.GrabRounding = 4.0f;
  style.PopupRounding = 4.0f;
  style.ScrollbarSize = 10.0f;
  style.WindowPadding = ImVec2(10.0f, 10.0f);
  style.ItemSpacing = ImVec2(6.0f, 5.0f);
  set_colors(style.Colors);
  style.ScaleAllSizes(static_cast<float>(scale));
  ImGui::GetStyle() = style;
  ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
  fonts.Clear();
  const scenes::Asset& font = scenes::find_asset("font/inter-medium-ascii.otf");
  ImFontConfig config;
  config.FontDataOwnedByAtlas = false;
  fonts.AddFontFromMemoryTTF(const_cast<unsigned char*>(font.bytes), static_cast<int>(font.size),
                             kTextSize * static_cast<float>(scale), &config);
}

}  // namespace weft::viewer
