// Tested by tests/viewer/window_test.py.

#include <imgui.h>

#include <cstdio>

#include <weft/playback/rendering/paint/color_map.hpp>
#include <weft/viewer/ui/contact_marks.hpp>
#include <weft/viewer/ui/panels/panels.hpp>
#include <weft/viewer/ui/theme.hpp>

namespace weft::viewer {
namespace {

/// Text that can be read over any picture.
void label(ImDrawList& list, ImVec2 place, const char* text, float scale) {
  const ImVec2 size = ImGui::CalcTextSize(text);
  const float pad = 4.0f * scale;
  list.AddRectFilled(ImVec2(place.x - pad, place.y - pad),
                     ImVec2(place.x + size.x + pad, place.y + size.y + pad), kPaper, pad);
  list.AddText(place, kInk, text);
}

void draw_legend(const PanelFrame& frame, ImDrawList& list) {
  const float s = frame.scale;
  const double limit = 100.0 * frame.stage.strain_scale().limit();  // [%]
  const scenes::ColorMap map(-limit, limit);
  const float width = 260.0f * s;
  const float height = 14.0f * s;
  const float left = 0.5f * (frame.width - width);
  const float bottom_space = frame.session.view().shows_panels ? kTimelineHeight + kMargin : 0.0f;
  const float top = frame.height - (bottom_space + kMargin + 44.0f) * s;
  list.AddRectFilled(ImVec2(left - 24.0f * s, top - 8.0f * s),
                     ImVec2(left + width + 24.0f * s, top + 40.0f * s), kPaper, 6.0f * s);
  constexpr int kBands = 64;
  for (int i = 0; i < kBands; ++i) {
    const scenes::Rgb color = map.color(limit * (2.0 * (i + 0.5) / kBands - 1.0));
    list.AddRectFilled(ImVec2(left + width * static_cast<float>(i) / kBands, top),
                       ImVec2(left + width * static_cast<float>(i + 1) / kBands, top + height),
                       IM_COL32(color[0], color[1], color[2], 255));
  }
  char text[48];
  for (const double value : {-limit, 0.0, limit}) {
    std::snprintf(text, sizeof(text), value == 0.0 ? "strain [%%]" : "%+.3g", value);
    const ImVec2 size = ImGui::CalcTextSize(text);
    const auto x = left + width * static_cast<float>(0.5 + 0.5 * value / limit) - 0.5f * size.x;
    list.AddText(ImVec2(x, top + height + 4.0f * s), kInk, text);
  }
}

ImVec2 on_screen(const PanelFrame& frame, const Place& place) {
  return {static_cast<float>(place.x) * frame.width, static_cast<float>(place.y) * frame.height};
}

void draw_worst(const PanelFrame& frame, ImDrawList& list, const Snapshot& shown,
                const scenes::Camera& camera, double aspect) {
  const auto& worst = shown.measures.worst;
  if (!worst) return;
  const scenes::ClothState& cloth = shown.state.cloths.at(worst->id.cloth);
  const auto place = project(camera, aspect, cloth.positions.col(worst->id.node));
  if (!place) return;
  const ImVec2 at = on_screen(frame, *place);
  const float s = frame.scale;
  list.AddCircle(at, 11.0f * s, kPaper, 0, 5.0f * s);
  list.AddCircle(at, 11.0f * s, IM_COL32(205, 30, 50, 255), 0, 2.5f * s);
  char text[160];
  std::snprintf(text, sizeof(text), "%s node %d: strain %+.3g %%", cloth.name.c_str(),
                worst->id.node, 100.0 * worst->strain);
  label(list, ImVec2(at.x + 20.0f * s, at.y - 8.0f * s), text, s);
}

void draw_pull(const PanelFrame& frame, ImDrawList& list, const Snapshot& shown,
               const scenes::Camera& camera, double aspect) {
  const auto& pull = frame.session.pull();
  if (!pull || frame.session.live() == nullptr) return;
  const scenes::ClothState& cloth = shown.state.cloths.at(pull->id.cloth);
  const auto node = project(camera, aspect, cloth.positions.col(pull->id.node));
  const auto target = project(camera, aspect, pull->target);
  if (!node || !target) return;
  const float s = frame.scale;
  const ImVec2 from = on_screen(frame, *node);
  const ImVec2 to = on_screen(frame, *target);
  list.AddLine(from, to, kPaper, 5.0f * s);
  list.AddLine(from, to, IM_COL32(25, 110, 200, 255), 2.5f * s);
  list.AddCircleFilled(from, 5.0f * s, IM_COL32(25, 110, 200, 255));
  char text[96];
  std::snprintf(text, sizeof(text), "%.3g N of at most %.3g N", shown.pull_force,
                frame.session.live()->simulation().largest_pull(pull->id.cloth));
  label(list, ImVec2(to.x + 14.0f * s, to.y + 8.0f * s), text, s);
}

void draw_carry(const PanelFrame& frame, ImDrawList& list, const Snapshot& shown,
                const scenes::Camera& camera, double aspect) {
  const auto& carry = frame.session.carry();
  if (!carry) return;
  const scenes::RigidState& rigid = shown.state.rigids.at(carry->collider);
  const auto center = project(camera, aspect, rigid.position);
  const auto target = project(camera, aspect, carry->target);
  if (!center || !target) return;
  const float s = frame.scale;
  const ImVec2 from = on_screen(frame, *center);
  const ImVec2 to = on_screen(frame, *target);
  list.AddLine(from, to, kPaper, 5.0f * s);
  list.AddLine(from, to, IM_COL32(25, 110, 200, 255), 2.5f * s);
  char text[160];
  if (shown.pull_force > 0.0) {
    std::snprintf(text, sizeof(text), "%s: %.3g N", rigid.name.c_str(), shown.pull_force);
  } else {
    std::snprintf(text, sizeof(text), "%s: (%.3g, %.3g, %.3g) m", rigid.name.c_str(),
                  rigid.position.x(), rigid.position.y(), rigid.position.z());
  }
  label(list, ImVec2(to.x + 14.0f * s, to.y + 8.0f * s), text, s);
}

}  // namespace

void draw_marks(const PanelFrame& frame) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const ViewState& view = frame.session.view();
  const SnapshotPtr shown = frame.session.source().shown();
  if (!shown) return;
  const double aspect = static_cast<double>(frame.width / frame.height);
  if (view.style == scenes::SurfaceStyle::kScalar) draw_legend(frame, list);
  if (!view.shows_worst && !view.shows_contacts && !frame.session.pull() &&
      !frame.session.carry()) {
    return;
  }
  const scenes::Camera camera =
      followed(frame.session.source().drawn_scene(), view.camera, shown->state);
  // Labels over the arrows.
  if (view.shows_contacts) draw_contacts(frame, *shown, camera, aspect);
  if (view.shows_worst) draw_worst(frame, list, *shown, camera, aspect);
  draw_pull(frame, list, *shown, camera, aspect);
  draw_carry(frame, list, *shown, camera, aspect);
}

}  // namespace weft::viewer
