// Tested by tests/viewer/window_test.py.

#include <imgui.h>

#include <weft/viewer/ui/panels/panels.hpp>

namespace weft::viewer {
namespace {

void speed_slider(Session& session, float width) {
  double speed = session.source().speed();
  const double low = 0.05;
  const double high = 16.0;
  ImGui::SetNextItemWidth(width);
  if (ImGui::SliderScalar("##speed", ImGuiDataType_Double, &speed, &low, &high, "speed %.2f",
                          ImGuiSliderFlags_Logarithmic)) {
    session.source().set_speed(speed);
  }
  if (ImGui::IsItemHovered()) {
    ImGui::SetTooltip("Simulated over wall time, at most  [%s slower, %s faster]",
                      info_of(Action::kSlower).key.data(), info_of(Action::kFaster).key.data());
  }
}

void frame_slider(Session& session, float width) {
  Source& source = session.source();
  const int last = source.num_frames() - 1;
  int frame = source.frame();
  ImGui::SetNextItemWidth(width);
  if (ImGui::SliderInt("##frame", &frame, 0, last > 0 ? last : 1, "") && last > 0) {
    source.seek(frame);
  }
  if (ImGui::IsItemHovered()) {
    ImGui::SetTooltip(
        "%s  [%s, %s, %s, %s]",
        session.live() != nullptr ? "Look back at kept frames; nothing is simulated again"
                                  : "Frame of the recording",
        info_of(Action::kFirstFrame).key.data(), info_of(Action::kStepBack).key.data(),
        info_of(Action::kStepForward).key.data(), info_of(Action::kLastFrame).key.data());
  }
}

void status(Session& session) {
  const SnapshotPtr shown = session.source().shown();
  if (!shown) return;
  ImGui::AlignTextToFramePadding();
  if (session.live() != nullptr) {
    const bool looks_back = session.source().frame() < session.source().num_frames() - 1 &&
                            !session.source().is_playing();
    ImGui::Text("t = %.3f s   step %d   %.2f ms/step%s", shown->state.time, shown->step,
                1e3 * shown->step_time, looks_back ? "   looks back" : "");
    if (shown->num_parts > 1) {
      ImGui::SameLine();
      ImGui::TextDisabled("in %d parts", shown->num_parts);
      if (ImGui::IsItemHovered()) {
        ImGui::SetTooltip("The laws as they are set now need a shorter step than the scene's");
      }
    }
  } else {
    ImGui::Text("t = %.3f s   frame %d of %d", shown->state.time, shown->step + 1,
                session.source().num_frames());
  }
}

}  // namespace

void draw_timeline(const PanelFrame& frame) {
  Session& session = frame.session;
  const float width = frame.width / frame.scale - 2.0f * kMargin;
  begin_panel(frame, "timeline", kMargin, kMargin, width, kTimelineHeight, false, true);
  const float s = frame.scale;
  const bool is_playing = session.source().is_playing();
  frame_slider(session, ImGui::GetContentRegionAvail().x);
  action_button(session, Action::kPause, is_playing ? "Pause" : "Run", 64.0f * s);
  ImGui::SameLine();
  action_button(session, Action::kRestart, "Restart", 64.0f * s);
  ImGui::SameLine();
  action_button(session, Action::kFirstFrame, "|<", 30.0f * s);
  ImGui::SameLine();
  action_button(session, Action::kStepBack, "<", 30.0f * s);
  ImGui::SameLine();
  action_button(session, Action::kStepForward, ">", 30.0f * s);
  ImGui::SameLine();
  action_button(session, Action::kLastFrame, ">|", 30.0f * s);
  ImGui::SameLine();
  speed_slider(session, 130.0f * s);
  ImGui::SameLine();
  status(session);
  ImGui::End();
}

}  // namespace weft::viewer
