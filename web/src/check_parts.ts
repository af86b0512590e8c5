// The pieces of a check that both the table and the list of failures show.
import { h } from "./dom";
import { exactQuantity, formatQuantity, formatRatio, toNumber } from "./format";
import type { Check, Sabotage, Verdict } from "./report";

const WORDS: Record<Verdict, string> = {
  pass: "✓ pass",
  fail: "✗ fail",
  info: "no bound",
  known: "✗ fail, known",
  stale: "✗ stale",
};

export function verdictPill(verdict: Verdict): HTMLElement {
  return h("span", { class: `pill ${verdict}` }, WORDS[verdict]);
}

export function measured(check: Check): HTMLElement {
  return h(
    "span",
    { "data-tip": exactQuantity(check.measured, check.unit), tabindex: 0 },
    formatQuantity(check.measured, check.unit),
  );
}

/** The numbers that an error was computed from, each beside the expected one. */
export function comparedValues(check: Check): HTMLElement | null {
  if (check.values.length === 0) return null;
  return h(
    "ul",
    { class: "values small" },
    check.values.map((pair) =>
      h(
        "li",
        {
          "data-tip": `${exactQuantity(pair.value, pair.unit)}, expected ${exactQuantity(pair.expected, pair.unit)}`,
          tabindex: 0,
        },
        `${pair.quantity} `,
        h("b", {}, formatQuantity(pair.value, pair.unit, 5)),
        `, expected ${formatQuantity(pair.expected, pair.unit, 5)}`,
      ),
    ),
  );
}

export function allowed(check: Check): HTMLElement | string {
  if (!check.tolerance) return "–";
  return h(
    "span",
    { "data-tip": exactQuantity(check.tolerance.value, check.unit), tabindex: 0 },
    formatQuantity(check.tolerance.value, check.unit),
  );
}

const FLAG_REASON = {
  tight: "Tight: more than half of what is allowed. A small change could break it.",
  loose: "Loose: less than a hundredth of what is allowed. A large error could hide below this bound.",
};

/** The full width of the bar is the bound. */
export function ratioBar(check: Check): HTMLElement | null {
  if (check.ratio === null) return null;
  const ratio = toNumber(check.ratio);
  const share = Number.isFinite(ratio) ? Math.min(Math.max(ratio, 0), 1) : 1;
  const state = ["fail", "known", "stale"].includes(check.verdict) ? "fail" : check.flag || "pass";
  const fill = h("span", { class: "fill" });
  fill.style.width = share > 0 ? `max(2px, ${share * 100}%)` : "0";
  return h(
    "span",
    { class: `ratio ${state}` },
    h(
      "span",
      { class: "ratio-text" },
      formatRatio(check),
      check.flag !== "" &&
        h(
          "span",
          { class: `flag ${check.flag}`, tabindex: 0, "data-tip": FLAG_REASON[check.flag] },
          check.flag,
        ),
    ),
    h("span", { class: "bar", "aria-hidden": "true" }, fill),
  );
}

/** The kind of bound; its reason is a bubble on screen and plain text on paper. */
export function basis(check: Check): HTMLElement | null {
  const tolerance = check.tolerance;
  if (!tolerance) return null;
  return h(
    "span",
    {},
    h("span", { class: "basis", tabindex: 0, "data-tip": tolerance.why || undefined }, tolerance.basis),
    h("span", { class: "print-only small" }, tolerance.why),
  );
}

export function sabotageItem(sabotage: Sabotage, check: Check): HTMLElement {
  return h(
    "li",
    { class: sabotage.detected ? "noticed" : "unnoticed" },
    h("span", { class: "mark", "aria-hidden": "true" }, sabotage.detected ? "✓" : "✗"),
    h(
      "span",
      {},
      `${sabotage.name}: ${formatQuantity(sabotage.measured, check.unit)}, `,
      sabotage.detected ? "noticed" : h("strong", {}, "not noticed"),
    ),
  );
}
