// Tested by tests/viewer/window_test.py.

#include <imgui.h>

#include <cmath>

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

/// So long after its time a note stands beside the frame. [s]
constexpr double kNoteTime = 1.0;

/// Ticks below the slider where the program has said something; the one under the mouse is told.
void note_ticks(Session& session, float scale) {
  const std::vector<scenes::Note> notes = session.source().notes();
  const int last = session.source().num_frames() - 1;
  if (notes.empty() || last < 1) return;
  const double begin = session.source().frame_time(0);
  const double duration = session.source().frame_time(last) - begin;
  const ImVec2 low = ImGui::GetItemRectMin();
  const ImVec2 high = ImGui::GetItemRectMax();
  const ImVec2 mouse = ImGui::GetMousePos();
  for (const scenes::Note& note : notes) {
    const double part = (note.time - begin) / duration;
    if (part < 0.0 || part > 1.0) continue;
    const float x = low.x + static_cast<float>(part) * (high.x - low.x);
    ImGui::GetWindowDrawList()->AddTriangleFilled(
        ImVec2(x - 4.0f * scale, high.y), ImVec2(x + 4.0f * scale, high.y),
        ImVec2(x, high.y - 7.0f * scale), ImGui::GetColorU32(ImGuiCol_PlotHistogram));
    if (ImGui::IsItemHovered() && std::abs(mouse.x - x) < 5.0f * scale) {
      ImGui::SetTooltip("t = %.3f s: %s", note.time, note.text.c_str());
    }
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

/// What the program has said last, for a while.
std::string note_at(Session& session, double time) {
  std::string text;
  for (const scenes::Note& note : session.source().notes()) {
    if (note.time <= time && note.time > time - kNoteTime) text = "   " + note.text;
  }
  return text;
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
    ImGui::Text("t = %.3f s   frame %d of %d%s", shown->state.time, shown->step + 1,
                session.source().num_frames(), note_at(session, shown->state.time).c_str());
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
  note_ticks(session, s);
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
