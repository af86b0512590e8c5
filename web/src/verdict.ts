import { allowed, basis, measured, ratioBar, sabotageItem, verdictPill } from "./check_parts";
import { h } from "./dom";
import { count } from "./format";
import { needsAttention, undetected, type Check, type Report } from "./report";

function tile(value: string, label: string, state = ""): HTMLElement {
  return h("div", { class: `tile ${state}` }, h("dd", {}, value), h("dt", {}, label));
}

function sentence(report: Report): string {
  const s = report.summary;
  const gated = s.checks_passed + s.checks_failed;
  const checks =
    s.checks_failed === 0
      ? `All ${count(gated, "check")} hold`
      : `${s.checks_failed} of ${count(gated, "check")} ${s.checks_failed === 1 ? "fails" : "fail"}`;
  if (gated === 0) return "Nothing was gated: no number was compared with a bound.";
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
        `${s.checks_passed} of ${s.checks_passed + s.checks_failed}`,
        "checks pass",
        s.checks_failed > 0 ? "bad" : "",
      ),
      tile(
        `${s.sabotages_detected} of ${s.sabotages}`,
        "sabotages noticed",
        s.sabotages_detected < s.sabotages ? "bad" : "",
      ),
      tile(String(s.checks_not_gated), "measured, not gated"),
      tile(`${flags("tight")} / ${flags("loose")}`, "tight / loose bounds"),
    ),
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
