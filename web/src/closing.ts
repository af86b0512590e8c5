import { h, scrollBox, tableHead } from "./dom";
import { count } from "./format";
import { family, unique, type Report } from "./report";

export function renderDeviations(report: Report): HTMLElement | null {
  if (report.departures.length === 0) return null;
  const heads = ["engine", "what differs", "measured"];
  const causes = unique(report.departures.map((item) => item.reason));
  const group = (reason: string): HTMLElement => {
    const items = report.departures.filter((item) => item.reason === reason);
    const engines = unique(items.map((item) => family(item.engine))).join(", ");
    return h(
      "li",
      { class: "deviation" },
      h("p", {}, h("b", {}, engines), `: ${reason}.`.replace(/\.\.$/, ".")),
      h(
        "details",
        { "data-print-open": true },
        h("summary", {}, count(items.length, "deviation")),
        scrollBox(
          `Known deviations of ${engines}`,
          h(
            "table",
            { class: "deviations" },
            tableHead(heads),
            h(
              "tbody",
              {},
              items.map((item) =>
                h(
                  "tr",
                  {},
                  h("th", { scope: "row" }, item.engine),
                  h("td", {}, item.what),
                  h("td", {}, item.measured),
                ),
              ),
            ),
          ),
        ),
      ),
    );
  };
  return h(
    "section",
    { id: "deviations", "aria-labelledby": "deviations-title" },
    h("h2", { id: "deviations-title" }, "Known deviations"),
    h("p", { class: "muted lead" }, "Where an engine is known to differ, by cause, and by how much."),
    h("ol", { class: "causes" }, causes.map(group)),
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
