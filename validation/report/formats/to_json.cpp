// Tested by tests/validation/report/json_test.cpp.

#include <nlohmann/json.hpp>

#include <weft/validation/report/formats/base64.hpp>
#include <weft/validation/report/formats/distance_view_json.hpp>
#include <weft/validation/report/formats/json_number.hpp>
#include <weft/validation/report/formats/json_text.hpp>
#include <weft/validation/report/picture_path.hpp>
#include <weft/validation/report/ratio.hpp>
#include <weft/validation/report/report.hpp>

namespace weft::validation {
namespace {

using Json = nlohmann::ordered_json;

template <typename Item, typename Convert>
Json list(const std::vector<Item>& items, Convert convert) {
  Json array = Json::array();
  for (const Item& item : items) array.push_back(convert(item));
  return array;
}

const char* verdict_word(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPass:
      return "pass";
    case Verdict::kFail:
      return "fail";
    case Verdict::kInfo:
      return "info";
    case Verdict::kKnown:
      return "known";
    case Verdict::kStale:
      return "stale";
  }
  return "fail";
}

Json tolerance_json(const std::optional<Tolerance>& tolerance) {
  if (!tolerance) return nullptr;
  return {{"value", json_number(tolerance->value)},
          {"basis", to_string(tolerance->basis)},
          {"why", tolerance->why}};
}

Json check_json(const CheckResult& check) {
  const std::optional<double> share = ratio(check);
  Json json = {{"case", check.case_id},
               {"engine", check.engine},
               {"claim", check.claim},
               {"metric", check.metric},
               {"unit", check.unit},
               {"formula", check.formula},
               {"source", check.source},
               {"measured", json_number(check.measured)},
               {"tolerance", tolerance_json(check.tolerance)},
               {"ratio", share ? json_number(*share) : Json(nullptr)},
               {"flag", ratio_flag(check)},
               {"verdict", verdict_word(check.verdict)},
               {"note", check.note}};
  json["cause"] = check.cause;
  json["values"] = list(check.values, [](const ComparedValue& pair) -> Json {
    return {{"quantity", pair.quantity},
            {"value", json_number(pair.value)},
            {"expected", json_number(pair.expected)},
            {"unit", pair.unit}};
  });
  json["sabotages"] = list(check.sabotages, [](const SabotageResult& sabotage) -> Json {
    return {{"name", sabotage.name},
            {"measured", json_number(sabotage.measured)},
            {"detected", sabotage.detected}};
  });
  return json;
}

Json summary_json(const Report& report) {
  int passed = 0;
  int failed = 0;
  int not_gated = 0;
  int known = 0;
  int stale = 0;
  int sabotages = 0;
  int detected = 0;
  for (const CheckResult& check : report.checks) {
    passed += check.verdict == Verdict::kPass ? 1 : 0;
    failed += check.verdict == Verdict::kFail ? 1 : 0;
    not_gated += check.verdict == Verdict::kInfo ? 1 : 0;
    known += check.verdict == Verdict::kKnown ? 1 : 0;
    stale += check.verdict == Verdict::kStale ? 1 : 0;
    for (const SabotageResult& sabotage : check.sabotages) {
      ++sabotages;
      detected += sabotage.detected ? 1 : 0;
    }
  }
  return {{"checks_passed", passed},       {"checks_failed", failed},
          {"checks_not_gated", not_gated}, {"checks_known", known},
          {"checks_stale", stale},         {"sabotages", sabotages},
          {"sabotages_detected", detected}};
}

Json plot_json(const Plot& plot) {
  Json json = {{"title", plot.title},
               {"x_label", plot.x_label},
               {"y_label", plot.y_label},
               {"log_x", plot.log_x},
               {"log_y", plot.log_y}};
  json["series"] = list(plot.series, [](const Series& series) -> Json {
    return {{"name", series.name}, {"x", json_numbers(series.x)}, {"y", json_numbers(series.y)}};
  });
  return json;
}

Json picture_rows_json(const Report& report, std::size_t section) {
  const std::vector<PictureRow>& rows = report.sections[section].picture_rows;
  Json array = Json::array();
  for (std::size_t r = 0; r < rows.size(); ++r) {
    Json pictures = Json::array();
    for (std::size_t p = 0; p < rows[r].pictures.size(); ++p) {
      const Picture& picture = rows[r].pictures[p];
      pictures.push_back({{"title", picture.title},
                          {"caption", picture.caption},
                          {"file", picture_path(report, section, r, p)},
                          {"mime", picture_type(picture.image).mime},
                          {"base64", to_base64(picture.image)}});
    }
    array.push_back({{"title", rows[r].title}, {"pictures", pictures}});
  }
  return array;
}

Json section_json(const Report& report, std::size_t index) {
  const Section& section = report.sections[index];
  Json json = {{"id", section.id}, {"summary", section.summary}};
  json["picture_rows"] = picture_rows_json(report, index);
  json["plots"] = list(section.plots, plot_json);
  json["tables"] = list(section.tables, [](const Table& table) -> Json {
    return {{"title", table.title}, {"columns", table.columns}, {"rows", table.rows}};
  });
  json["distance_views"] = list(section.distance_views, distance_view_json);
  json["scene_text"] = section.scene_text;
  return json;
}

}  // namespace

std::string to_json(const Report& report) {
  Json json = {{"schema", "weft-report"},
               {"schema_version", kReportSchemaVersion},
               {"title", report.title},
               {"passed", report.passed()},
               {"summary", summary_json(report)}};
  json["checks"] = list(report.checks, check_json);
  json["sections"] = Json::array();
  for (std::size_t i = 0; i < report.sections.size(); ++i) {
    json["sections"].push_back(section_json(report, i));
  }
  json["departures"] = list(report.deviations, [](const Deviation& deviation) -> Json {
    return {{"engine", deviation.engine},
            {"what", deviation.what},
            {"measured", deviation.measured},
            {"reason", deviation.reason}};
  });
  json["limits"] = report.limits;
  json["provenance"] = list(report.provenance, [](const auto& entry) -> Json {
    return {{"name", entry.first}, {"value", entry.second}};
  });
  return json_text(json);
}

}  // namespace weft::validation
