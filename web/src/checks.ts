import { allowed, basis, comparedValues, measured, ratioBar, sabotageItem, verdictPill } from "./check_parts";
import { h, scrollBox, tableHead } from "./dom";
import { count } from "./format";
import { families, family, needsAttention, undetected, unique, type Check, type Report } from "./report";

interface Filter {
  case: string;
  engine: string;
  verdict: string;
}

const ALL: Filter = { case: "", engine: "", verdict: "" };
const VERDICTS: [string, string][] = [
  ["", "any verdict"],
  ["attention", "failed"],
  ["pass", "passed"],
  ["known", "failed, known deviation"],
  ["info", "no bound"],
  ["tight", "tight bound"],
  ["loose", "loose bound"],
];

function matches(check: Check, filter: Filter): boolean {
  if (filter.case !== "" && check.case !== filter.case) return false;
  if (filter.engine !== "" && family(check.engine) !== filter.engine) return false;
  switch (filter.verdict) {
    case "":
      return true;
    case "attention":
      return needsAttention(check);
    case "tight":
    case "loose":
      return check.flag === filter.verdict;
    default:
      return check.verdict === filter.verdict;
  }
}

function sabotageCell(check: Check): HTMLElement | null {
  const total = check.sabotages.length;
  if (total === 0) return null;
  const missed = undetected(check).length;
  return h(
    "span",
    { class: missed > 0 ? "bad" : "" },
    `${total - missed}\u00a0of\u00a0${total}`,
    h("span", { class: "muted small block" }, "noticed"),
  );
}

function more(check: Check): HTMLElement | null {
  const facts: [string, string][] = [
    ["against", check.formula],
    ["source", check.source],
    ["bound", check.tolerance?.why ?? ""],
    ["known deviation", check.cause],
    ["note", check.note],
  ];
  const shown = facts.filter(([, value]) => value !== "");
  if (shown.length === 0 && check.sabotages.length === 0) return null;
  return h(
    "details",
    { "data-print-open": true },
    h("summary", {}, "details"),
    h(
      "dl",
      { class: "more" },
      shown.map(([term, value]) => [h("dt", { class: term }, term), h("dd", { class: term }, value)]),
    ),
    check.sabotages.length > 0 &&
      h(
        "ul",
        { class: "sabotages" },
        check.sabotages.map((s) => sabotageItem(s, check)),
      ),
  );
}

function row(check: Check, sections: Map<string, string>): HTMLElement {
  const target = sections.get(check.case);
  const cell = (label: string, kind: string, ...content: (HTMLElement | string | null)[]): HTMLElement =>
    h("td", { role: "cell", class: kind, "data-label": label }, content);
  return h(
    "tr",
    { role: "row", class: `${check.verdict} ${needsAttention(check) ? "attention" : ""}` },
    cell("", "", verdictPill(check.verdict)),
    cell(
      "",
      "where",
      target === undefined ? check.case : h("a", { href: `#${target}` }, check.case),
      h("span", { class: "muted small block" }, check.engine),
    ),
    h(
      "th",
      { scope: "row", role: "rowheader", class: "claim" },
      check.claim,
      h("span", { class: "muted small block" }, check.metric),
      comparedValues(check),
      more(check),
    ),
    cell("measured", "number", measured(check)),
    cell("allowed", "number", allowed(check)),
    cell("ratio", "", ratioBar(check)),
    cell("basis", "", basis(check)),
    cell("sabotages", "", sabotageCell(check)),
  );
}

function select(label: string, options: [string, string][]): HTMLSelectElement {
  return h(
    "select",
    { "aria-label": label },
    options.map(([value, text]) => h("option", { value }, text)),
  );
}

/** Cases against engines: where the numbers are and how many pass. */
function matrix(report: Report, choose: (filter: Filter) => void): HTMLElement | null {
  const cases = unique(report.checks.map((check) => check.case));
  const engines = families(report);
  if (cases.length < 2 || engines.length < 2) return null;
  const cell = (name: string, engine: string): HTMLElement => {
    const here = report.checks.filter((check) => check.case === name && family(check.engine) === engine);
    if (here.length === 0) return h("td", { class: "none" }, "·");
    const bounded = here.filter((check) => check.verdict !== "info");
    const good = bounded.filter((check) => check.verdict === "pass").length;
    const known = here.filter((check) => check.verdict === "known").length;
    const state = here.some(needsAttention) ? "fail" : known > 0 ? "known" : bounded.length > 0 ? "pass" : "info";
    const text = bounded.length > 0 ? `${good}/${bounded.length}` : "info";
    const rest = known > 0 ? `, ${known} fail as known deviations` : "";
    const what = bounded.length > 0 ? `checks pass${rest}` : "rows without a bound";
    const button = h(
      "button",
      { type: "button", class: state, "aria-label": `${text} ${what}: ${name}, ${engine}; show them` },
      text,
    );
    button.addEventListener("click", () => choose({ ...ALL, case: name, engine }));
    return h("td", {}, button);
  };
  return scrollBox(
    "Checks passed per case and engine",
    h(
      "table",
      { class: "matrix" },
      tableHead(["case", ...engines]),
      h(
        "tbody",
        {},
        cases.map((name) =>
          h(
            "tr",
            {},
            h("th", { scope: "row" }, name),
            engines.map((engine) => cell(name, engine)),
          ),
        ),
      ),
    ),
  );
}

export function renderChecks(report: Report, sections: Map<string, string>): HTMLElement {
  const ordered = [
    ...report.checks.filter(needsAttention),
    ...report.checks.filter((check) => !needsAttention(check)),
  ];
  const rows = ordered.map((check) => ({ check, element: row(check, sections) }));
  const named = (name: string, values: string[]): [string, string][] => [
    ["", name],
    ...values.map((value): [string, string] => [value, value]),
  ];
  const byCase = select("Case", named("any case", unique(report.checks.map((check) => check.case))));
  const byEngine = select("Engine", named("any engine", families(report)));
  const byVerdict = select("Verdict", VERDICTS);
  const reset = h("button", { type: "button" }, "Show all");
  const shown = h("span", { class: "muted", role: "status" });

  const apply = (): void => {
    const filter = { case: byCase.value, engine: byEngine.value, verdict: byVerdict.value };
    let visible = 0;
    for (const { check, element } of rows) {
      element.hidden = !matches(check, filter);
      visible += element.hidden ? 0 : 1;
    }
    shown.textContent =
      visible === rows.length ? count(visible, "row") : `${visible} of ${count(rows.length, "row")}`;
    reset.disabled = visible === rows.length;
  };
  const box = h("section", { id: "checks", "aria-labelledby": "checks-title" });
  const choose = (filter: Filter): void => {
    [byCase.value, byEngine.value, byVerdict.value] = [filter.case, filter.engine, filter.verdict];
    apply();
    filters.scrollIntoView({ block: "start" });
  };
  for (const control of [byCase, byEngine, byVerdict]) control.addEventListener("change", apply);
  reset.addEventListener("click", () => choose(ALL));

  const heads = [
    "verdict",
    "case, engine",
    "claim, metric",
    "measured",
    "allowed",
    "ratio",
    "basis",
    "sabotages",
  ];
  // The roles are spelled out because narrow screens stack the cells, and a stacked table is no table to a browser.
  const table = h(
    "table",
    { class: "checks", role: "table" },
    tableHead(heads, (i) => (i === 3 || i === 4 ? "number" : "")),
    h(
      "tbody",
      { role: "rowgroup" },
      rows.map(({ element }) => element),
    ),
  );
  const filters = h("div", { class: "filters" }, byCase, byEngine, byVerdict, reset, shown);
  box.append(
    h("h2", { id: "checks-title" }, "Checks"),
    h(
      "p",
      { class: "muted lead" },
      "Each row compares one measured number with one bound that has a stated reason. The bar shows how much of the bound is used; " +
        "above 0.5 the bound is tight, below 0.01 it is loose. Rows without a bound are shown, but cannot fail. " +
        "A known deviation fails and is stated, with its cause, by more than the bound and less than 1.5 times what was stated. " +
        "A sabotage is a deliberate mistake that the check must notice.",
    ),
  );
  const overview = matrix(report, choose);
  if (overview) box.append(overview);
  box.append(filters, scrollBox("Table of checks", table));
  apply();
  return box;
}
