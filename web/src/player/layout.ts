// The page: head, picture, bar, panel, and what stands in the picture's place when there is none.
import { h } from "../dom";
import { DIVERGING_GRADIENT } from "./drawing/diverging";

export interface Layout {
  title: HTMLElement;
  summary: HTMLElement;
  open: HTMLButtonElement;
  help: HTMLButtonElement;
  stage: HTMLElement;
  canvas: HTMLCanvasElement;
  labels: HTMLElement;
  legend: HTMLElement;
  marks: HTMLElement[];
  invitation: HTMLElement;
  choose: HTMLButtonElement;
  stills: HTMLElement;
  veil: HTMLElement;
}

export function makeLayout(page: HTMLElement, transport: HTMLElement, panel: HTMLElement): Layout {
  const title = h("h1", {}, "Weft playback");
  const summary = h("p", { class: "summary muted" });
  const open = h("button", { type: "button", title: "Open recordings (.weftrec), or drop them on the page" }, "Open…");
  const help = h("button", { type: "button", class: "icon", "aria-label": "Keys", title: "Keys (?)" }, "?");
  const canvas = h("canvas", { class: "view", role: "img", tabindex: 0, "aria-label": "Playback in 3D" });
  const labels = h("div", { class: "labels" });
  const marks = [0, 1, 2].map(() => h("span"));
  const bar = h("span", { class: "scale-bar", "aria-hidden": "true" });
  bar.style.background = DIVERGING_GRADIENT;
  const legend = h(
    "div",
    { class: "legend", hidden: true },
    h("span", { class: "small" }, "strain [%], + is longer"),
    bar,
    h("span", { class: "scale-marks small" }, marks),
  );
  const choose = h("button", { type: "button", class: "primary" }, "Choose a file…");
  const invitation = h(
    "div",
    { class: "invitation", hidden: true },
    h("p", { class: "big" }, "Drop a recording here"),
    h("p", { class: "muted" }, "A .weftrec file that weft run wrote, finished or partial. Several at once are played together. Nothing leaves this page."),
    choose,
  );
  const stills = h("div", { class: "stills", hidden: true });
  const veil = h("div", { class: "veil", hidden: true }, h("p", {}, "Drop to play"));
  const stage = h("div", { class: "stage" }, canvas, labels, legend, invitation, stills, veil);
  page.append(
    h("header", {}, h("div", {}, title, summary), h("div", { class: "actions" }, open, help)),
    h("main", {}, h("div", { class: "theatre" }, stage, transport), panel),
  );
  return { title, summary, open, help, stage, canvas, labels, legend, marks, invitation, choose, stills, veil };
}
