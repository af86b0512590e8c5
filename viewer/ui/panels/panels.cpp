#include <weft/viewer/ui/panels/panels.hpp>

#include <imgui.h>

namespace weft::viewer {

void tip(Action action) {
  if (!ImGui::IsItemHovered()) return;
  ImGui::SetTooltip("%s", tooltip(action).c_str());
}

bool action_button(Session& session, Action action, const char* label, float width) {
  const bool is_pressed = ImGui::Button(label, ImVec2(width, 0.0f));
  tip(action);
  if (is_pressed) session.perform(action);
  return is_pressed;
}

void begin_panel(const PanelFrame& frame, const char* name, float x, float y, float width,
                 float height, bool is_right, bool is_low) {
  const float s = frame.scale;
  const ImVec2 place(is_right ? frame.width - x * s : x * s, is_low ? frame.height - y * s : y * s);
  ImGui::SetNextWindowPos(place, ImGuiCond_Always,
                          ImVec2(is_right ? 1.0f : 0.0f, is_low ? 1.0f : 0.0f));
  ImGui::SetNextWindowSize(ImVec2(width * s, height * s), ImGuiCond_Always);
  int flags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
              ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav |
              ImGuiWindowFlags_NoFocusOnAppearing;
  if (height == 0.0f) flags |= ImGuiWindowFlags_AlwaysAutoResize;
  ImGui::Begin(name, nullptr, flags);
}

void draw_message(const PanelFrame& frame) {
  const SnapshotPtr shown = frame.session.source().shown();
  std::string text = frame.session.message();
  if (text.empty() && shown && shown->blow_up)
    text =
        "blew up: " + shown->blow_up->reason + "; R starts again, Shift+R with the laws as written";
  if (text.empty() && !shown) text = "loading " + frame.session.title();
  if (text.empty()) return;
  const float wrap = 0.42f * frame.width;
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap);
  ImGui::SetNextWindowPos(ImVec2(0.5f * frame.width, kMargin * frame.scale), ImGuiCond_Always,
                          ImVec2(0.5f, 0.0f));
  ImGui::SetNextWindowSize(ImVec2(size.x + 24.0f * frame.scale, 0.0f));
  ImGui::Begin("message", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::PushTextWrapPos(wrap + 12.0f * frame.scale);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::End();
}

}  // namespace weft::viewer
