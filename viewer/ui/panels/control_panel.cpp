// Tested by tests/viewer/window_test.py.

#include <imgui.h>

#include <weft/viewer/model/cloth_type.hpp>
#include <weft/viewer/ui/panels/panels.hpp>

namespace weft::viewer {
namespace {

/// A row of choices of which one is on.
void style_buttons(Session& session, float width) {
  struct Row {
    Action action;
    const char* label;
    scenes::SurfaceStyle style;
  };
  constexpr Row kRows[] = {{Action::kShaded, "shaded", scenes::SurfaceStyle::kShaded},
                           {Action::kWireframe, "wire", scenes::SurfaceStyle::kWireframe},
                           {Action::kStrain, "strain", scenes::SurfaceStyle::kScalar}};
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  for (const Row& row : kRows) {
    if (row.action != Action::kShaded) ImGui::SameLine();
    const bool is_on = session.view().style == row.style;
    if (is_on) {
      ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_SliderGrab));
    }
    action_button(session, row.action, row.label, (width - 2.0f * gap) / 3.0f);
    if (is_on) ImGui::PopStyleColor();
  }
}

void toggle(Session& session, Action action, const char* label, bool is_on) {
  bool value = is_on;
  if (ImGui::Checkbox(label, &value)) session.perform(action);
  tip(action);
}

/// Weaker, the value, stronger, for three axes.
void axis_rows(Session& session, const char* title, const char* unit, const Vector3<double>& value,
               Action first, float width) {
  constexpr const char* kAxes[] = {"x", "y", "z"};
  ImGui::TextDisabled("%s [%s]", title, unit);
  const float button = ImGui::GetFrameHeight();
  for (int axis = 0; axis < 3; ++axis) {
    ImGui::PushID(title);
    ImGui::PushID(axis);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(kAxes[axis]);
    ImGui::SameLine(0.10f * width);
    ImGui::Text("%8.2f", value[axis]);
    ImGui::SameLine(width - 2.0f * button);
    action_button(session, static_cast<Action>(static_cast<int>(first) + 2 * axis + 1), "-",
                  button);
    ImGui::SameLine();
    action_button(session, static_cast<Action>(static_cast<int>(first) + 2 * axis), "+", button);
    ImGui::PopID();
    ImGui::PopID();
  }
}

/// Which recording has which color.
void recording_names(const std::vector<ShownRecording>& recordings) {
  for (const ShownRecording& recording : recordings) {
    if (recording.color) {
      // Lighter than in the picture, so that it can be read on the dark panel.
      const auto channel = [&](std::size_t i) {
        return 0.35f + 0.65f * static_cast<float>((*recording.color)[i]) / 255.0f;
      };
      const ImVec4 color(channel(0), channel(1), channel(2), 1.0f);
      ImGui::TextColored(color, "ghost: %s", recording.name.c_str());
    } else {
      ImGui::Text("solid: %s", recording.name.c_str());
    }
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", recording.name.c_str());
  }
}

void live_controls(Session& session, LiveSource& live, float width) {
  ImGui::TextDisabled("Engine");
  ImGui::SetNextItemWidth(width);
  if (ImGui::BeginCombo("##engine", live.engine().c_str())) {
    for (const std::string& name : live.engines()) {
      if (ImGui::Selectable(name.c_str(), name == live.engine())) live.set_engine(name);
    }
    ImGui::EndCombo();
  }
  tip(Action::kNextEngine);
  ImGui::TextDisabled("Cloth");
  ImGui::SetNextItemWidth(width);
  if (ImGui::BeginCombo("##cloth", cloth_types()[live.cloth_type()].name.data())) {
    for (std::size_t i = 0; i < cloth_types().size(); ++i) {
      const ClothType& type = cloth_types()[i];
      if (ImGui::Selectable(type.name.data(), i == live.cloth_type())) live.set_cloth_type(i);
      if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", type.summary.data());
    }
    ImGui::EndCombo();
  }
  tip(Action::kNextCloth);
  axis_rows(session, "Wind", "m/s", wind_of(live.drawn_scene()), Action::kWindXMore, width);
  axis_rows(session, "Gravity", "m/s^2", gravity_of(live.drawn_scene()), Action::kGravityXMore,
            width);
}

}  // namespace

void draw_control_panel(const PanelFrame& frame) {
  Session& session = frame.session;
  const float highest = frame.height - (kTimelineHeight + 3.0f * kMargin) * frame.scale;
  ImGui::SetNextWindowSizeConstraints(ImVec2(0.0f, 0.0f),
                                      ImVec2(kControlWidth * frame.scale, highest));
  begin_panel(frame, "controls", kMargin, kMargin, kControlWidth, 0.0f, false, false);
  const float width = ImGui::GetContentRegionAvail().x;
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const std::filesystem::path title(session.title());
  ImGui::TextUnformatted(title.filename().c_str());
  ImGui::PushTextWrapPos(0.0f);
  ImGui::TextDisabled("%s", session.source().drawn_scene().summary.c_str());
  ImGui::PopTextWrapPos();
  const bool is_live = session.live() != nullptr;
  const float half = 0.5f * (width - gap);
  action_button(session, Action::kSceneList, "Scenes", is_live ? half : width);
  if (is_live) {
    ImGui::SameLine();
    action_button(session, Action::kReload, "Reload", half);
  }
  ImGui::Separator();
  style_buttons(session, width);
  toggle(session, Action::kShadow, "shadows", session.view().has_shadow);
  ImGui::SameLine(0.5f * width);
  toggle(session, Action::kWorstNode, "worst node", session.view().shows_worst);
  toggle(session, Action::kPlots, "plots", session.view().shows_plots);
  if (is_live) {
    ImGui::SameLine(0.5f * width);
    toggle(session, Action::kLaws, "laws", session.view().shows_laws);
    toggle(session, Action::kContacts, "contacts", session.view().shows_contacts);
    ImGui::Separator();
    live_controls(session, *session.live(), width);
  } else {
    ImGui::Separator();
    toggle(session, Action::kGhosts, "ghosts", session.source().ghosts().has_value());
    ImGui::SameLine(0.5f * width);
    action_button(session, Action::kNextGhost, "Next solid");
    recording_names(session.source().recordings());
  }
  ImGui::Separator();
  action_button(session, Action::kResetView, "View", half);
  ImGui::SameLine();
  action_button(session, Action::kHelp, "Help", half);
  action_button(session, Action::kScreenshot, "Picture", half);
  ImGui::SameLine();
  action_button(session, Action::kFilm, session.view().is_filming ? "End film" : "Film", half);
  ImGui::End();
}

}  // namespace weft::viewer
