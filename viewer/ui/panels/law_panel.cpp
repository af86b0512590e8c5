// Tested by tests/viewer/window_test.py.

#include <imgui.h>

#include <cstdio>
#include <cstdlib>

#include <weft/viewer/ui/panels/panels.hpp>

namespace weft::viewer {
namespace {

/// Dear ImGui takes digits after the point from the format, and treats smaller values of a logarithmic
/// slider as zero; nine reach down to rigidities of silk. Nobody wants to read as many.
double four_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.4g", value);
  return std::strtod(text, nullptr);
}

/// A slider with the range that belongs to the value it starts from: the range must not move away under
/// the mouse.
void parameter_slider(Session& session, const Parameter& parameter, std::size_t number,
                      float width) {
  ImGui::PushID(static_cast<int>(number));
  const bool is_chosen = number == session.chosen();
  const ImVec4 color = ImGui::GetStyleColorVec4(is_chosen ? ImGuiCol_CheckMark : ImGuiCol_Text);
  ImGui::TextColored(color, "%s", parameter.label.c_str());
  ImGui::SameLine();
  ImGui::TextDisabled("[%s]", parameter.unit.c_str());
  static ImGuiID active = 0;
  static SliderRange active_range;
  const SliderRange range =
      active == ImGui::GetID("##value") ? active_range : slider_range(parameter);
  double value = four_digits(parameter.value);
  ImGui::SetNextItemWidth(width);
  const int flags = range.is_logarithmic ? ImGuiSliderFlags_Logarithmic : 0;
  const bool is_changed = ImGui::SliderScalar("##value", ImGuiDataType_Double, &value, &range.low,
                                              &range.high, "%.9g", flags);
  if (ImGui::IsItemActivated()) {
    active = ImGui::GetID("##value");
    active_range = range;
    session.choose(number);
  }
  if (ImGui::IsItemDeactivated()) active = 0;
  if (ImGui::IsItemHovered()) {
    ImGui::SetTooltip("%s\nCtrl and click: type a number  [%s, %s: choose; %s, %s: change]",
                      parameter.summary.c_str(), info_of(Action::kPreviousParameter).key.data(),
                      info_of(Action::kNextParameter).key.data(),
                      info_of(Action::kLargerParameter).key.data(),
                      info_of(Action::kSmallerParameter).key.data());
  }
  if (is_changed && four_digits(value) != parameter.value) {
    session.live()->set_parameter(parameter, four_digits(value));
  }
  ImGui::PopID();
}

}  // namespace

void draw_law_panel(const PanelFrame& frame) {
  Session& session = frame.session;
  if (session.live() == nullptr) return;
  const scenes::Scene& scene = session.live()->drawn_scene();
  const std::vector<Parameter> parameters = parameters_of(scene);
  const float below = session.view().shows_plots ? kPlotHeight + kMargin : 0.0f;
  const float height = frame.height / frame.scale - kTimelineHeight - below - 3.0f * kMargin;
  if (height < 80.0f) return;
  begin_panel(frame, "laws", kMargin, kMargin, kLawWidth, height, true, false);
  const float width = ImGui::GetContentRegionAvail().x;
  std::size_t cloth = scene.cloths.size();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].cloth != cloth) {
      cloth = parameters[i].cloth;
      if (i > 0) ImGui::Separator();
      ImGui::Text("Laws of %s", scene.cloths[cloth].name.c_str());
    }
    parameter_slider(session, parameters[i], i, width);
    static std::size_t last_chosen = 0;
    if (i == session.chosen() && last_chosen != i) {
      last_chosen = i;
      ImGui::SetScrollHereY(0.5f);
    }
  }
  ImGui::End();
}

}  // namespace weft::viewer
