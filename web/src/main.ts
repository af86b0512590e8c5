import "uplot/dist/uPlot.min.css";
import "./style.css";
import "./parts.css";
import "./print.css";

import { renderChecks } from "./checks";
import { renderDeviations, renderLimits, renderProvenance } from "./closing";
import { h } from "./dom";
import { drawDistanceViews } from "./distance/distance_view";
import { redrawPlots } from "./plot";
import { needsAttention, readReport, type Report } from "./report";
import { renderSections, sectionAnchors } from "./sections";
import { installTooltips } from "./tooltip";
import { renderFailures, renderVerdict } from "./verdict";

function navigation(report: Report, anchors: Map<string, string>): HTMLElement {
  const link = (id: string, text: string, state = ""): HTMLElement =>
    h("li", {}, h("a", { href: `#${id}`, class: state }, text));
  return h(
    "nav",
    { "aria-label": "Contents" },
    h(
      "ul",
      {},
      link("checks", "Checks"),
      report.sections.map((section) => {
        const bad = report.checks.some((check) => check.case === section.id && needsAttention(check));
        return link(anchors.get(section.id) ?? "cases", section.id, bad ? "bad" : "");
      }),
      report.departures.length > 0 && link("deviations", "Known deviations"),
      report.limits.length > 0 && link("limits", "Not tested"),
      report.provenance.length > 0 && link("provenance", "Provenance"),
    ),
  );
}

function followColours(): void {
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redrawPlots);
  const opened: HTMLDetailsElement[] = [];
  window.addEventListener("beforeprint", () => {
    document.documentElement.dataset["print"] = "";
    for (const details of document.querySelectorAll<HTMLDetailsElement>(
      "details[data-print-open]:not([open])",
    )) {
      details.open = true;
      opened.push(details);
    }
    redrawPlots();
    drawDistanceViews();
  });
  window.addEventListener("afterprint", () => {
    delete document.documentElement.dataset["print"];
    for (const details of opened.splice(0)) details.open = false;
    redrawPlots();
  });
}

function show(page: HTMLElement, report: Report): void {
  document.title = `${report.passed ? "PASS" : "FAIL"}: ${report.title}`;
  const anchors = sectionAnchors(report);
  const sections = renderSections(report);
  const parts = [
    renderFailures(report, anchors),
    renderChecks(report, anchors),
    sections?.element ?? null,
    renderDeviations(report),
    renderLimits(report),
    renderProvenance(report),
  ];
  page.append(
    h("a", { class: "skip", href: "#checks" }, "Skip to the checks"),
    renderVerdict(report),
    navigation(report, anchors),
    h("main", {}, parts),
  );
  sections?.start();
  installTooltips();
  followColours();
}

const page = document.getElementById("page");
if (page) {
  try {
    show(page, readReport());
  } catch (error) {
    // Said on the page and not only in the console: who opens a broken report must not see a blank sheet.
    page.replaceChildren(
      h("p", { class: "broken", role: "alert" }, `This report cannot be shown. ${String(error)}`),
    );
    throw error;
  }
}
