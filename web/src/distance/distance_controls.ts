// The controls of a distance view: engine, time, colour scale.
import { GRADIENT, lengthUnit } from "../colour_scale";
import type { DistanceView } from "./distance_data";
import { h } from "../dom";
import { formatNumber } from "../format";

const FRAME_TIME = 350; // [ms] between frames while it plays

export function makeLegend(): { element: HTMLElement; show: (highest: number) => void } {
  const marks = [0, 0.5, 1].map(() => h("span"));
  const bar = h("span", { class: "scale-bar", "aria-hidden": "true" });
  bar.style.background = GRADIENT;
  const element = h(
    "div",
    { class: "scale" },
    h("span", { class: "small" }, "distance to the reference"),
    bar,
    h("span", { class: "scale-marks small" }, marks),
  );
  const show = (highest: number): void => {
    const unit = lengthUnit(highest);
    marks.forEach((mark, i) => {
      mark.textContent = `${formatNumber(highest * unit.factor * 0.5 * i)}\u00a0${unit.name}`;
    });
  };
  return { element, show };
}

export function labelled(text: string, control: HTMLElement): HTMLElement {
  return h("label", {}, h("span", { class: "muted small" }, text), control);
}

function option(value: string, text: string): HTMLOptionElement {
  return h("option", { value }, text);
}

export interface Controls {
  engine: HTMLSelectElement;
  range: HTMLSelectElement;
  slider: HTMLInputElement;
  play: HTMLButtonElement;
  reset: HTMLButtonElement;
}

export function makeControls(view: DistanceView): Controls {
  return {
    engine: h("select", { "aria-label": "engine" }, view.engines.map((engine, i) => option(String(i), engine.name))),
    range: h("select", { "aria-label": "colour scale" }, option("now", "of this moment"), option("run", "of the whole run")),
    slider: h("input", {
      type: "range",
      min: 0,
      max: view.times.length - 1,
      step: 1,
      value: view.times.length - 1,
      "aria-label": "Time",
    }),
    play: h("button", { type: "button" }, "Play"),
    reset: h("button", { type: "button" }, "Reset view"),
  };
}

export function playOnClick(controls: Controls, count: number, show: () => void): void {
  const { play, slider } = controls;
  let timer = 0;
  const stop = (): void => {
    window.clearInterval(timer);
    timer = 0;
    play.textContent = "Play";
  };
  play.addEventListener("click", () => {
    if (timer !== 0) return stop();
    play.textContent = "Stop";
    if (Number(slider.value) >= count - 1) slider.value = "0";
    show();
    timer = window.setInterval(() => {
      slider.value = String(Number(slider.value) + 1);
      show();
      if (Number(slider.value) >= count - 1) stop();
    }, FRAME_TIME);
  });
  slider.addEventListener("pointerdown", stop);
}
