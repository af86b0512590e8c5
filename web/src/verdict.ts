import { allowed, basis, comparedValues, measured, ratioBar, sabotageItem, verdictPill } from "./check_parts";
import { h } from "./dom";
import { count } from "./format";
import { renderPictureRow } from "./pictures";
import { families, family, needsAttention, undetected, unique, type Check, type Report } from "./report";

const FIRST_ENGINE = "bullet_weft";
const FIRST_SCENE = "drape_sphere";
const AT_THE_END = "At the end";

function tile(value: string, label: string, state = ""): HTMLElement {
  return h("div", { class: `tile ${state}` }, h("dd", {}, value), h("dt", {}, label));
}

function boundedChecks(report: Report): number {
  const s = report.summary;
  return s.checks_passed + s.checks_failed + s.checks_known + s.checks_stale;
}

/** One line per engine: how it stands against everything it was held to. */
function engineLines(report: Report): HTMLElement | null {
  const names = families(report);
  if (names.length < 2) return null;
  const line = (name: string): HTMLElement => {
    const own = report.checks.filter((check) => family(check.engine) === name);
    const bounded = own.filter((check) => check.verdict !== "info");
    const passed = bounded.filter((check) => check.verdict === "pass").length;
    const known = bounded.filter((check) => check.verdict === "known");
    const bad = own.filter(needsAttention).length;
    const causes = unique(known.map((check) => check.cause)).length;
    const state = bad > 0 ? "fail" : known.length > 0 ? "known" : bounded.length > 0 ? "pass" : "info";
    const words = [
      bounded.length > 0 ? `${passed} of ${count(bounded.length, "check")} pass` : `${count(own.length, "row")} without a bound`,
      known.length > 0 && `${known.length} fail as known deviations of ${count(causes, "cause")}`,
      bad > 0 && `${bad} ${bad === 1 ? "needs" : "need"} attention`,
    ].filter(Boolean);
    return h(
      "li",
      {},
      h("span", { class: `pill ${state}` }, state === "pass" ? "✓ pass" : state === "info" ? "no bound" : "✗ fail"),
      h("b", {}, name),
      h("span", {}, words.join("; ")),
    );
  };
  return h("ul", { class: "engines", "aria-label": "Engines" }, names.map(line));
}

/** The pictures that show most at a glance: a row in which the fast solver stands beside the others. */
function firstPictures(report: Report): HTMLElement | null {
  const rows = report.sections.flatMap((section) =>
    section.picture_rows.map((row) => ({ id: section.id, row })),
  );
  const shows = (row: { pictures: { title: string }[] }): boolean =>
    row.pictures.some((picture) => family(picture.title) === FIRST_ENGINE);
  const chosen =
    rows.find(({ id, row }) => id === FIRST_SCENE && row.title === AT_THE_END && shows(row)) ??
    rows.find(({ row }) => row.title === AT_THE_END && shows(row)) ??
    rows[0];
  if (!chosen) return null;
  return h(
    "div",
    { class: "first-pictures" },
    // No heading: this stands before the first section.
    h("p", {}, h("b", {}, `${chosen.id}: ${chosen.row.title.toLowerCase()}`)),
    renderPictureRow("", chosen.row.pictures),
  );
}

function sentence(report: Report): string {
  const s = report.summary;
  const bounded = boundedChecks(report);
  const failed = s.checks_failed + s.checks_stale;
  const known = s.checks_known > 0 ? `${s.checks_known} of ${count(bounded, "check")} fail as known deviations` : "";
  const unknown = `${failed} of ${count(bounded, "check")} ${failed === 1 ? "fails" : "fail"}`;
  const checks =
    failed > 0
      ? [unknown, known && `${known} beside`].filter(Boolean).join(", ")
      : known
        ? `${count(s.checks_passed, "check holds", "checks hold")}, ${known}`
        : `All ${count(bounded, "check")} hold`;
  if (bounded === 0) return "No number was compared with a bound.";
  if (s.sabotages === 0)
    return `${checks}. No sabotage was tried, so nothing shows that the checks can fail.`;
  const missed = s.sabotages - s.sabotages_detected;
  const sabotages =
    missed === 0
      ? `all ${count(s.sabotages, "sabotage")} were noticed`
      : `${missed} of ${count(s.sabotages, "sabotage")} ${missed === 1 ? "was" : "were"} not noticed`;
  return `${checks}; ${sabotages}.`;
}

export function renderVerdict(report: Report): HTMLElement {
  const s = report.summary;
  const flags = (kind: string): number => report.checks.filter((check) => check.flag === kind).length;
  const state = report.passed ? "pass" : "fail";
  return h(
    "header",
    { class: `verdict ${state}` },
    h("h1", {}, report.title),
    h(
      "p",
      { class: "result" },
      h("strong", { id: "verdict" }, report.passed ? "PASS" : "FAIL"),
      h("span", { class: "sentence" }, sentence(report)),
    ),
    h(
      "dl",
      { class: "tiles" },
      tile(
        `${s.checks_passed} of ${boundedChecks(report)}`,
        "checks pass",
        s.checks_failed + s.checks_stale > 0 ? "bad" : "",
      ),
      s.checks_known > 0 && tile(String(s.checks_known), "fail, known deviations"),
      tile(
        `${s.sabotages_detected} of ${s.sabotages}`,
        "sabotages noticed",
        s.sabotages_detected < s.sabotages ? "bad" : "",
      ),
      tile(String(s.checks_not_gated), "measured, no bound"),
      tile(`${flags("tight")} / ${flags("loose")}`, "tight / loose bounds"),
    ),
    firstPictures(report),
    engineLines(report),
  );
}

function failure(check: Check, sections: Map<string, string>): HTMLElement {
  const missed = undetected(check);
  const target = sections.get(check.case);
  const fact = (term: string, value: HTMLElement | string | null): HTMLElement | null =>
    value === null || value === "" ? null : h("div", {}, h("dt", {}, term), h("dd", {}, value));
  return h(
    "li",
    { class: "failure" },
    h(
      "p",
      { class: "failure-head" },
      verdictPill(check.verdict),
      h("strong", {}, check.claim),
      h("span", { class: "muted" }, `${check.case} · ${check.engine}`),
    ),
    h(
      "dl",
      { class: "facts" },
      fact(check.metric, measured(check)),
      fact("compared", comparedValues(check)),
      fact("allowed", allowed(check)),
      fact("measured / allowed", ratioBar(check)),
      fact("basis", basis(check)),
      fact("compared with", check.formula),
    ),
    check.tolerance !== null &&
      check.tolerance.why !== "" &&
      h("p", { class: "small muted" }, `Bound: ${check.tolerance.why}`),
    missed.length > 0 &&
      h(
        "ul",
        { class: "sabotages" },
        missed.map((sabotage) => sabotageItem(sabotage, check)),
      ),
    (check.note !== "" || target !== undefined) &&
      h(
        "p",
        { class: "look" },
        check.note !== "" && h("span", {}, h("b", {}, "Look at: "), `${check.note} `),
        target !== undefined && h("a", { href: `#${target}` }, `Pictures and plots of ${check.case}`),
      ),
  );
}

/** Every check that keeps the report from passing, with what to look at; nothing if there is none. */
export function renderFailures(report: Report, sections: Map<string, string>): HTMLElement | null {
  const failed = report.checks.filter(needsAttention);
  if (failed.length === 0) return null;
  return h(
    "section",
    { class: "failures", id: "failures", "aria-labelledby": "failures-title" },
    h("h2", { id: "failures-title" }, "What failed"),
    h(
      "ol",
      {},
      failed.map((check) => failure(check, sections)),
    ),
  );
}
