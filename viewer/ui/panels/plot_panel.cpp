// Tested by tests/viewer/window_test.py.

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <weft/viewer/ui/panels/panels.hpp>

namespace weft::viewer {
namespace {

struct Curve {
  const char* name;
  ImU32 color;
  std::function<double(const PlotPoint&)> value;
};

struct Range {
  double low = 0.0;
  double high = 0.0;
};

Range range_of(const std::vector<PlotPoint>& points, const std::vector<Curve>& curves) {
  Range range;  // with zero
  for (const Curve& curve : curves) {
    for (const PlotPoint& point : points) {
      const double value = curve.value(point);
      if (!std::isfinite(value)) continue;
      range.low = std::min(range.low, value);
      range.high = std::max(range.high, value);
    }
  }
  if (range.high == range.low) range.high = range.low + 1.0;
  return range;
}

bool is_known(const std::vector<PlotPoint>& points, const std::vector<Curve>& curves) {
  return std::any_of(curves.begin(), curves.end(),
                     [&](const Curve& curve) { return std::isfinite(curve.value(points.back())); });
}

/// A curve through the middle of each column of pixels: at most one point for each.
void draw_curve(ImDrawList& list, const std::vector<PlotPoint>& points, const Curve& curve,
                const Range& range, ImVec2 from, ImVec2 to, float thickness) {
  const double first = points.front().time;
  const double span = std::max(points.back().time - first, 1e-9);
  const auto place = [&](const PlotPoint& point) {
    const auto x = static_cast<float>((point.time - first) / span);
    const auto y = static_cast<float>((curve.value(point) - range.low) / (range.high - range.low));
    return ImVec2(from.x + x * (to.x - from.x), to.y - y * (to.y - from.y));
  };
  const auto width = static_cast<std::size_t>(std::max(to.x - from.x, 1.0f));
  const std::size_t stride = points.size() / width + 1;
  std::vector<ImVec2> line;
  for (std::size_t i = 0; i < points.size(); i += stride) {
    if (std::isfinite(curve.value(points[i]))) line.push_back(place(points[i]));
  }
  if (std::isfinite(curve.value(points.back()))) line.push_back(place(points.back()));
  list.AddPolyline(line.data(), static_cast<int>(line.size()), curve.color, 0, thickness);
}

int frame_at(const Source& source, double time) {
  int frame = 0;
  while (frame + 1 < source.num_frames() && source.frame_time(frame + 1) <= time) ++frame;
  return frame;
}

void plot(const PanelFrame& frame, const char* title, const char* format,
          const std::vector<PlotPoint>& points, const std::vector<Curve>& curves, float height) {
  ImGui::TextDisabled("%s", title);
  for (const Curve& curve : curves) {
    if (curves.size() == 1) break;
    ImGui::SameLine();
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(curve.color), "%s", curve.name);
  }
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const ImVec2 size(ImGui::GetContentRegionAvail().x, height);
  const ImVec2 to(from.x + size.x, from.y + size.y);
  ImGui::InvisibleButton(title, size);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(from, to, IM_COL32(255, 255, 255, 12), 3.0f * frame.scale);
  if (points.size() < 2) return;
  if (!is_known(points, curves)) {
    const ImVec2 place(from.x + 6.0f * frame.scale, from.y + 4.0f * frame.scale);
    list.AddText(place, IM_COL32(255, 255, 255, 150), "not known once a cloth has torn");
    return;
  }
  const Range range = range_of(points, curves);
  const ImVec2 inset(3.0f * frame.scale, 3.0f * frame.scale);
  const ImVec2 inner_from(from.x + inset.x, from.y + inset.y);
  const ImVec2 inner_to(to.x - inset.x, to.y - inset.y);
  for (const Curve& curve : curves) {
    draw_curve(list, points, curve, range, inner_from, inner_to, 1.5f * frame.scale);
  }
  const SnapshotPtr shown = frame.session.source().shown();
  const double span = points.back().time - points.front().time;
  if (shown && span > 0.0) {
    const auto part = static_cast<float>((shown->state.time - points.front().time) / span);
    const float x = inner_from.x + std::clamp(part, 0.0f, 1.0f) * (inner_to.x - inner_from.x);
    list.AddLine(ImVec2(x, from.y), ImVec2(x, to.y), IM_COL32(255, 255, 255, 90));
  }
  char text[64];
  std::snprintf(text, sizeof(text), format, range.high);
  const ImVec2 text_size = ImGui::CalcTextSize(text);
  list.AddText(ImVec2(to.x - text_size.x - inset.x, from.y), IM_COL32(255, 255, 255, 150), text);
  if (!ImGui::IsItemHovered()) return;
  const float x = (ImGui::GetIO().MousePos.x - inner_from.x) / (inner_to.x - inner_from.x);
  const double time = points.front().time + std::clamp(x, 0.0f, 1.0f) * span;
  const auto point = std::lower_bound(points.begin(), points.end(), time,
                                      [](const PlotPoint& p, double t) { return p.time < t; });
  ImGui::BeginTooltip();
  ImGui::Text("t = %.3f s; a click goes there  [%s hides the plots]", time,
              info_of(Action::kPlots).key.data());
  for (const Curve& curve : curves) {
    if (point == points.end()) break;
    std::snprintf(text, sizeof(text), format, curve.value(*point));
    ImGui::Text("%s %s", curve.name, text);
  }
  ImGui::EndTooltip();
  if (ImGui::IsItemClicked()) {
    frame.session.source().seek(frame_at(frame.session.source(), time));
  }
}

}  // namespace

void draw_plot_panel(const PanelFrame& frame) {
  const std::vector<PlotPoint> points = frame.session.source().plot();
  const bool is_live = frame.session.live() != nullptr;
  begin_panel(frame, "plots", kMargin, 2.0f * kMargin + kTimelineHeight, kLawWidth, kPlotHeight,
              true, true);
  const float rows = is_live ? 3.0f : 2.0f;
  const float text = ImGui::GetTextLineHeightWithSpacing() + ImGui::GetStyle().ItemSpacing.y;
  const float height = ImGui::GetContentRegionAvail().y / rows - text;
  const ImU32 blue = IM_COL32(110, 175, 250, 255);
  const ImU32 orange = IM_COL32(250, 170, 90, 255);
  plot(frame, "Energy [J]", "%.3g J", points,
       {{"kinetic", blue, [](const PlotPoint& p) { return p.measures.kinetic_energy; }},
        {"potential", orange, [](const PlotPoint& p) { return p.measures.potential_energy; }}},
       height);
  plot(frame, "Largest strain [%]", "%.3g %%", points,
       {{"strain", blue, [](const PlotPoint& p) { return 100.0 * p.measures.largest_strain; }}},
       height);
  if (is_live) {
    plot(frame, "Wall time of a step [ms]", "%.3g ms", points,
         {{"step", blue, [](const PlotPoint& p) { return 1e3 * p.step_time; }}}, height);
  }
  ImGui::End();
}

}  // namespace weft::viewer
