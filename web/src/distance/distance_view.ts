// A cloth in 3D, coloured by how far an engine is from the reference, with a slider for the time.
import { lengthText } from "../colour_scale";
import { labelled, makeControls, makeLegend, playOnClick, type Controls } from "./distance_controls";
import { decode, type DistanceView, type EngineDistances } from "./distance_data";
import { orbit, turnByKeys } from "./distance_orbit";
import { hasWebGL, paintWorld } from "./distance_painter";
import { makeWorld, type World } from "./distance_world";
import { h } from "../dom";
import { count, formatNumber } from "../format";
import type { DistanceViewData } from "../report";

const views = new Set<() => void>();

/** Draws every view at once, also those that were never on the screen: paper has no scrolling. */
export function drawDistanceViews(): void {
  for (const draw of views) draw();
}

function highestOf(engine: EngineDistances): number {
  return engine.largest.reduce((a, b) => (Number.isFinite(b) ? Math.max(a, b) : a), 0);
}

function describe(view: DistanceView, engine: EngineDistances, frame: number): string {
  const time = `t\u00a0=\u00a0${formatNumber(view.times[frame] ?? NaN)}\u00a0s`;
  const largest = engine.largest[frame] ?? NaN;
  if (!Number.isFinite(largest)) return `${engine.name}, ${time}: the run had ended before`;
  return `${engine.name}, ${time}: largest distance ${lengthText(largest)}`;
}

interface Parts extends Controls {
  canvas: HTMLCanvasElement;
  readout: HTMLElement;
  legend: ReturnType<typeof makeLegend>;
}

class LiveView {
  private world: World | null = null;
  private wanted = 0;

  constructor(
    private readonly view: DistanceView,
    private readonly name: string,
    private readonly parts: Parts,
  ) {
    for (const control of [parts.engine, parts.range, parts.slider]) {
      control.addEventListener("input", () => this.update());
    }
    playOnClick(parts, view.times.length, () => this.update());
    parts.reset.addEventListener("click", () => {
      this.world?.reset();
      this.drawSoon();
    });
    this.update();
    // Made when first seen: a report has many views.
    const seen = new IntersectionObserver((entries) => {
      if (!entries.some((entry) => entry.isIntersecting)) return;
      seen.disconnect();
      this.make();
      this.drawSoon();
    });
    seen.observe(parts.canvas);
    new ResizeObserver(() => this.drawSoon()).observe(parts.canvas);
    views.add(() => {
      this.make();
      this.draw();
    });
  }

  private make(): void {
    if (this.world) return;
    const { canvas } = this.parts;
    this.world = makeWorld(this.view, canvas.clientWidth / Math.max(canvas.clientHeight, 1) || 1);
    const controls = orbit(canvas, this.world, () => this.drawSoon());
    turnByKeys(canvas, this.world, controls);
    this.update();
  }

  private update(): void {
    const { parts, view } = this;
    const frame = Number(parts.slider.value);
    const engine = view.engines[Number(parts.engine.value)];
    if (!engine) return;
    const highest = parts.range.value === "run" ? highestOf(engine) : (engine.largest[frame] ?? NaN);
    this.world?.pose(frame);
    this.world?.paint(engine.distances[frame] ?? new Float64Array(), highest);
    parts.legend.show(Number.isFinite(highest) ? highest : 0);
    const text = describe(view, engine, frame);
    parts.readout.textContent = text;
    parts.slider.setAttribute("aria-valuetext", `${formatNumber(view.times[frame] ?? NaN)} s`);
    parts.canvas.setAttribute("aria-label", `Cloth of ${this.name} in 3D. ${text}`);
    this.drawSoon();
  }

  private drawSoon(): void {
    cancelAnimationFrame(this.wanted);
    this.wanted = requestAnimationFrame(() => this.draw());
  }

  private draw(): void {
    if (!this.world) return;
    const { canvas } = this.parts;
    const ratio = Math.min(window.devicePixelRatio, 2);
    const width = Math.round(canvas.clientWidth * ratio);
    const height = Math.round(canvas.clientHeight * ratio);
    if (width > 0 && (canvas.width !== width || canvas.height !== height)) {
      canvas.width = width;
      canvas.height = height;
    }
    paintWorld(this.world, canvas);
  }
}

function hint(view: DistanceView): string {
  const nodes =
    view.drawnNodes < view.simulatedNodes
      ? `${view.drawnNodes} of ${count(view.simulatedNodes, "node")} are drawn; the largest distance is over all. `
      : "";
  const turn = hasWebGL()
    ? "Drag to turn, click and use the wheel to zoom, arrow keys turn too."
    : "This browser has no WebGL: flat triangles, drag to turn.";
  return nodes + turn;
}

/** One view; call start once it is in the page and has a width. */
export function renderDistanceView(
  data: DistanceViewData,
  name: string,
): { element: HTMLElement; start: () => void } {
  const view = decode(data);
  const controls = makeControls(view);
  const canvas = h("canvas", { class: "cloth", tabindex: 0, role: "img" });
  const readout = h("p", { class: "readout", role: "status" });
  const legend = makeLegend();
  const element = h(
    "div",
    { class: "distance" },
    h("h4", {}, "Distance to the reference, painted on its cloth"),
    h(
      "div",
      { class: "distance-box" },
      canvas,
      h(
        "div",
        { class: "distance-side" },
        readout,
        legend.element,
        h("div", { class: "distance-time screen-only" }, controls.play, controls.slider, controls.reset),
        h(
          "div",
          { class: "distance-choice screen-only" },
          labelled("engine", controls.engine),
          labelled("colour scale", controls.range),
        ),
        h("p", { class: "muted small screen-only" }, hint(view)),
      ),
    ),
  );
  return {
    element,
    start: () => void new LiveView(view, name, { ...controls, canvas, readout, legend }),
  };
}
