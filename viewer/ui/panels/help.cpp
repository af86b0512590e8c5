// Tested by tests/viewer/window_test.py.

#include <imgui.h>

#include <cstdint>

#include <weft/viewer/ui/panels/panels.hpp>

namespace weft::viewer {
namespace {

constexpr float kKeyWidth = 104.0f;
constexpr int kNumColumns = 3;

float height_of(const ActionInfo& info, float text_width) {
  const ImVec2 size =
      ImGui::CalcTextSize(info.help.data(), info.help.data() + info.help.size(), false, text_width);
  return size.y + ImGui::GetStyle().ItemSpacing.y;
}

/// The rows of one column, from the first group on that is not yet shown, until its share of all is there.
void draw_column(const PanelFrame& frame, float left, float text_width, std::size_t& next,
                 float limit) {
  float height = 0.0f;
  const auto table = action_table();
  while (next < table.size()) {
    const std::string_view group = table[next].group;
    if (height > limit) return;
    ImGui::SetCursorPosX(left);
    ImGui::TextDisabled("%s", std::string(group).c_str());
    height += ImGui::GetTextLineHeightWithSpacing();
    for (; next < table.size() && table[next].group == group; ++next) {
      const ActionInfo& info = table[next];
      ImGui::SetCursorPosX(left);
      ImGui::TextUnformatted(info.key.data(), info.key.data() + info.key.size());
      ImGui::SameLine(left + kKeyWidth * frame.scale);
      ImGui::PushTextWrapPos(left + kKeyWidth * frame.scale + text_width);
      ImGui::TextUnformatted(info.help.data(), info.help.data() + info.help.size());
      ImGui::PopTextWrapPos();
      height += height_of(info, text_width);
    }
  }
}

/// Picture, name and summary of an entry of the list; true if it is chosen.
bool draw_row(const PanelFrame& frame, std::size_t row) {
  const std::string& name = frame.session.list()[row];
  const float s = frame.scale;
  const ImVec2 size(0.75f * Thumbnails::kWidth * s, 0.75f * Thumbnails::kHeight * s);
  ImGui::PushID(static_cast<int>(row));
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const bool is_chosen =
      ImGui::Selectable("##row", row == frame.session.row(), 0, ImVec2(0.0f, size.y + 2.0f * s));
  tip(Action::kListOpen);
  const bool is_visible = ImGui::IsItemVisible();
  if (is_visible) {
    const Thumbnails::Entry& entry = frame.thumbnails.get(name);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 end(corner.x + size.x, corner.y + size.y);
    if (entry.texture != 0) {
      // OpenGL counts rows from below.
      list.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(entry.texture)),
                    corner, end, ImVec2(0.0f, 1.0f), ImVec2(1.0f, 0.0f));
    } else {
      list.AddRect(corner, end, ImGui::GetColorU32(ImGuiCol_Border));
    }
    const ImVec2 text(end.x + 10.0f * s, corner.y + 2.0f * s);
    list.AddText(text, ImGui::GetColorU32(ImGuiCol_Text), name.c_str());
    const float wrap = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x - text.x;
    list.AddText(nullptr, 0.0f, ImVec2(text.x, text.y + ImGui::GetTextLineHeightWithSpacing()),
                 ImGui::GetColorU32(ImGuiCol_TextDisabled), entry.summary.c_str(), nullptr, wrap);
  }
  ImGui::PopID();
  return is_chosen;
}

}  // namespace

void draw_help(const PanelFrame& frame) {
  const float s = frame.scale;
  const float width = std::min(frame.width - 2.0f * kMargin * s, 1240.0f * s);
  const float height = frame.height - 4.0f * kMargin * s;
  ImGui::SetNextWindowPos(ImVec2(0.5f * frame.width, 0.5f * frame.height), ImGuiCond_Always,
                          ImVec2(0.5f, 0.5f));
  ImGui::SetNextWindowSizeConstraints(ImVec2(width, 0.0f), ImVec2(width, height));
  ImGui::SetNextWindowFocus();
  ImGui::SetNextWindowBgAlpha(0.97f);
  ImGui::Begin("help", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize);
  ImGui::Text("Keys and mouse   [%s closes this list]", info_of(Action::kHelp).key.data());
  ImGui::PushTextWrapPos(0.0f);
  ImGui::TextDisabled(
      "Drag: turn.  Right drag: move.  Wheel: nearer, farther.  Ctrl and drag, or the middle "
      "button: "
      "pull at a node of the cloth.  Shift and drag: move a collider.  Every control says its key "
      "when the mouse rests on it.");
  ImGui::PopTextWrapPos();
  ImGui::Separator();
  const float gap = 1.5f * kMargin * s;
  const float column = (ImGui::GetContentRegionAvail().x - (kNumColumns - 1) * gap) / kNumColumns;
  const float text_width = column - kKeyWidth * s;
  float all = 0.0f;
  for (const ActionInfo& info : action_table()) all += height_of(info, text_width);
  std::size_t next = 0;
  const float left = ImGui::GetCursorPosX();
  const float top = ImGui::GetCursorPosY();
  float bottom = top;
  for (int i = 0; i < kNumColumns; ++i) {
    const bool is_last = i + 1 == kNumColumns;
    ImGui::SetCursorPosY(top);
    draw_column(frame, left + static_cast<float>(i) * (column + gap), text_width, next,
                is_last ? 1e9f : 0.9f * all / kNumColumns);
    bottom = std::max(bottom, ImGui::GetCursorPosY());
  }
  ImGui::SetCursorPosY(bottom);
  ImGui::Dummy(ImVec2(1.0f, 1.0f));
  ImGui::End();
}

void draw_scene_list(const PanelFrame& frame) {
  Session& session = frame.session;
  const float s = frame.scale;
  ImGui::SetNextWindowPos(ImVec2(0.5f * frame.width, 0.5f * frame.height), ImGuiCond_Always,
                          ImVec2(0.5f, 0.5f));
  ImGui::SetNextWindowSize(
      ImVec2(520.0f * s, std::min(640.0f * s, frame.height - 8.0f * kMargin * s)));
  ImGui::SetNextWindowBgAlpha(0.97f);
  ImGui::Begin("scenes", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav);
  ImGui::Text("Open  [%s, %s, %s]", info_of(Action::kListUp).key.data(),
              info_of(Action::kListDown).key.data(), info_of(Action::kListOpen).key.data());
  ImGui::Separator();
  ImGui::BeginChild("rows");
  frame.thumbnails.begin_picture();
  static std::size_t last_row = 0;
  for (std::size_t i = 0; i < session.list().size(); ++i) {
    if (draw_row(frame, i)) {
      session.open(i);
      break;
    }
    if (i == session.row() && i != last_row) {
      last_row = i;
      ImGui::SetScrollHereY(0.5f);
    }
  }
  ImGui::EndChild();
  ImGui::End();
}

}  // namespace weft::viewer
