import { renderDistanceView } from "./distance/distance_view";
import { anchor, h, scrollBox, tableHead } from "./dom";
import { count } from "./format";
import { renderPictureRow } from "./pictures";
import { renderPlot } from "./plot";
import { needsAttention, type Report, type Section } from "./report";

export interface Rendered {
  element: HTMLElement;
  /** Draws what needs a width; call it once the element is in the page. */
  start: () => void;
}

export function sectionAnchors(report: Report): Map<string, string> {
  return new Map(report.sections.map((section, i) => [section.id, anchor("section", i)]));
}

function looksNumeric(text: string): boolean {
  return /^\s*[-−+]?(\d|\.\d|NaN|Infinity|∞)/.test(text);
}

/** Says that there is no number: such a cell does not decide how its column is aligned. */
function isGap(text: string): boolean {
  return /^(|-|unstable|blew up)$/.test(text.trim());
}

function renderTable(table: Section["tables"][number]): HTMLElement {
  const numeric = table.columns.map(
    (_, column) =>
      table.rows.some((row) => looksNumeric(row[column] ?? "")) &&
      table.rows.every((row) => isGap(row[column] ?? "") || looksNumeric(row[column] ?? "")),
  );
  const alignment = (column: number): string => (numeric[column] ? "number" : "");
  return h(
    "div",
    { class: "data" },
    h("h4", {}, table.title),
    scrollBox(
      table.title,
      h(
        "table",
        {},
        tableHead(table.columns, alignment),
        h(
          "tbody",
          {},
          table.rows.map((row) =>
            h(
              "tr",
              {},
              row.map((cell, i) => h("td", { class: alignment(i) }, cell)),
            ),
          ),
        ),
      ),
    ),
  );
}

function standing(report: Report, section: Section): HTMLElement | null {
  const own = report.checks.filter((check) => check.case === section.id && check.verdict !== "info");
  if (own.length === 0) return null;
  const passed = own.filter((check) => check.verdict === "pass").length;
  const known = own.some((check) => check.verdict === "known");
  const bad = report.checks.some((check) => check.case === section.id && needsAttention(check));
  return h(
    "span",
    { class: `pill ${bad ? "fail" : known ? "known" : "pass"}` },
    `${bad || known ? "✗" : "✓"} ${passed} of ${count(own.length, "check")}`,
  );
}

function renderSection(report: Report, section: Section, id: string): Rendered {
  const plots = section.plots.map(renderPlot);
  const distances = (section.distance_views ?? []).map((view) => renderDistanceView(view, section.id));
  const element = h(
    "section",
    { id, class: "section", "aria-labelledby": `${id}-title` },
    h("h3", { id: `${id}-title` }, section.id, standing(report, section)),
    section.summary !== "" && h("p", { class: "lead" }, section.summary),
    distances.map((view) => view.element),
    section.picture_rows.map((row) => renderPictureRow(row.title, row.pictures)),
    plots.length > 0 &&
      h(
        "div",
        { class: "plots" },
        plots.map((plot) => plot.element),
      ),
    section.tables.map(renderTable),
    section.scene_text !== "" &&
      h(
        "details",
        { class: "scene" },
        h("summary", {}, "Scene as it was run"),
        h("pre", { tabindex: 0 }, section.scene_text),
      ),
  );
  return { element, start: () => [...plots, ...distances].forEach((part) => part.start()) };
}

/** Pictures, plots and tables, one section per scene or case. */
export function renderSections(report: Report): Rendered | null {
  if (report.sections.length === 0) return null;
  const parts = report.sections.map((section, i) => renderSection(report, section, anchor("section", i)));
  const hasPlots = report.sections.some((section) => section.plots.length > 0);
  const element = h(
    "section",
    { id: "cases", "aria-labelledby": "cases-title" },
    h("h2", { id: "cases-title" }, "Case by case"),
    hasPlots &&
      h(
        "p",
        { class: "muted lead screen-only" },
        "Plots: drag to zoom, double-click to reset, choose a name in the legend to hide its line. ",
        "Pictures: choose one to enlarge it, then flip through its row with the arrow keys.",
      ),
    parts.map((part) => part.element),
  );
  return { element, start: () => parts.forEach((part) => part.start()) };
}
