// Tested by tests/viewer/window_test.py.

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <weft/viewer/ui/contact_marks.hpp>
#include <weft/viewer/ui/theme.hpp>

namespace weft::viewer {
namespace {

constexpr ImU32 kSticks = IM_COL32(20, 90, 190, 255);
constexpr ImU32 kSlides = IM_COL32(215, 95, 0, 255);

/// Length of the arrow of a large force, as a part of the way from the camera to its target.
constexpr double kArrow = 0.08;
/// Of all forces this part is at most as long: a few nodes that are hit do not make all others vanish.
constexpr double kQuantile = 0.95;
/// An arrow is at most this much longer.
constexpr double kLongest = 2.0;

double large_force(const std::vector<scenes::NodeTouch>& touches) {
  std::vector<double> sizes;
  for (const scenes::NodeTouch& touch : touches) sizes.push_back(touch.force.norm());
  const auto place = sizes.begin() +
                     static_cast<std::ptrdiff_t>(kQuantile * static_cast<double>(sizes.size() - 1));
  std::nth_element(sizes.begin(), place, sizes.end());
  return *place;
}

void draw_arrow(ImDrawList& list, ImVec2 from, ImVec2 to, ImU32 color, float scale) {
  const float length = std::hypot(to.x - from.x, to.y - from.y);
  list.AddLine(from, to, color, 1.5f * scale);
  list.AddCircleFilled(from, 2.0f * scale, color, 6);
  if (length < 5.0f * scale) return;
  const ImVec2 along((to.x - from.x) / length, (to.y - from.y) / length);
  const float head = 5.0f * scale;
  const ImVec2 back(to.x - head * along.x, to.y - head * along.y);
  list.AddTriangleFilled(to, ImVec2(back.x - 0.5f * head * along.y, back.y + 0.5f * head * along.x),
                         ImVec2(back.x + 0.5f * head * along.y, back.y - 0.5f * head * along.x),
                         color);
}

/// length: of the arrow of this force, where the camera looks at [pixel].
void draw_legend(const PanelFrame& frame, ImDrawList& list, double force, float length,
                 float raised) {
  const float s = frame.scale;
  char text[96];
  std::snprintf(text, sizeof(text), "%.3g N on the cloth", force);
  const float width = std::max(length + ImGui::CalcTextSize(text).x + 30.0f * s, 250.0f * s);
  const float line = ImGui::GetTextLineHeight();
  const float height = 2.0f * line + 14.0f * s;
  const float left = 0.5f * (frame.width - width);
  const float below =
      frame.session.view().shows_panels ? kTimelineHeight + 2.0f * kMargin : kMargin;
  const float top = frame.height - height - (below + raised) * s;
  list.AddRectFilled(ImVec2(left, top), ImVec2(left + width, top + height), kPaper, 6.0f * s);
  const float x = left + 10.0f * s;
  float y = top + 4.0f * s;
  draw_arrow(list, ImVec2(x, y + 0.5f * line), ImVec2(x + length, y + 0.5f * line), kInk, s);
  list.AddText(ImVec2(x + length + 10.0f * s, y), kInk, text);
  y += line + 6.0f * s;
  const auto entry = [&](float at, ImU32 color, const char* name) {
    list.AddCircleFilled(ImVec2(at + 5.0f * s, y + 0.5f * line), 5.0f * s, color);
    list.AddText(ImVec2(at + 16.0f * s, y), kInk, name);
  };
  entry(x, kSticks, "held by friction");
  entry(x + 0.55f * width, kSlides, "slides");
}

}  // namespace

void draw_contacts(const PanelFrame& frame, const Snapshot& shown, const scenes::Camera& camera,
                   double aspect) {
  if (!shown.touches || shown.touches->empty()) return;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const double force = large_force(*shown.touches);
  if (!(force > 0.0)) return;
  const double length = kArrow * (camera.position - camera.target).norm();
  for (const scenes::NodeTouch& touch : *shown.touches) {
    const Vector3<double> foot = shown.state.cloths.at(touch.cloth).positions.col(touch.node);
    Vector3<double> arrow = length / force * touch.force;
    if (arrow.norm() > kLongest * length) arrow *= kLongest * length / arrow.norm();
    const auto from = project(camera, aspect, foot);
    const auto to = project(camera, aspect, foot + arrow);
    if (!from || !to) continue;
    const auto pixel = [&](const Place& place) {
      return ImVec2(static_cast<float>(place.x) * frame.width,
                    static_cast<float>(place.y) * frame.height);
    };
    draw_arrow(list, pixel(*from), pixel(*to), touch.is_sticking ? kSticks : kSlides, frame.scale);
  }
  const bool has_strain = frame.session.view().style == scenes::SurfaceStyle::kScalar;
  const double pixels =
      kArrow * static_cast<double>(frame.height) / (2.0 * std::tan(0.5 * camera.field_of_view));
  draw_legend(frame, list, force, static_cast<float>(pixels), has_strain ? 64.0f : 0.0f);
}

}  // namespace weft::viewer
