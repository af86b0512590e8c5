import { h, scrollBox, tableHead } from "./dom";
import type { Report } from "./report";

export function renderDepartures(report: Report): HTMLElement | null {
  if (report.departures.length === 0) return null;
  const heads = ["engine", "what differs", "measured", "why"];
  return h(
    "section",
    { id: "departures", "aria-labelledby": "departures-title" },
    h("h2", { id: "departures-title" }, "Known departures"),
    h("p", { class: "muted lead" }, "Where an engine is known to differ, by how much, and why."),
    scrollBox(
      "Table of known departures",
      h(
        "table",
        { class: "departures" },
        tableHead(heads),
        h(
          "tbody",
          {},
          report.departures.map((item) =>
            h(
              "tr",
              {},
              h("th", { scope: "row" }, item.engine),
              h("td", {}, item.what),
              h("td", {}, item.measured),
              h("td", {}, item.reason),
            ),
          ),
        ),
      ),
    ),
  );
}

export function renderLimits(report: Report): HTMLElement | null {
  if (report.limits.length === 0) return null;
  return h(
    "section",
    { id: "limits", class: "limits", "aria-labelledby": "limits-title" },
    h("h2", { id: "limits-title" }, "What was not tested"),
    h(
      "ul",
      {},
      report.limits.map((limit) => h("li", {}, limit)),
    ),
  );
}

export function renderProvenance(report: Report): HTMLElement | null {
  if (report.provenance.length === 0) return null;
  return h(
    "section",
    { id: "provenance", "aria-labelledby": "provenance-title" },
    h("h2", { id: "provenance-title" }, "Provenance"),
    h(
      "dl",
      { class: "provenance" },
      report.provenance.map(({ name, value }) => [h("dt", {}, name), h("dd", {}, value)]),
    ),
  );
}
