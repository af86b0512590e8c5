// Energies and other metrics over time, with a line at the time that is shown.
import uPlot from "uplot";

import { h } from "../dom";
import { formatNumber } from "../format";
import type { Recording } from "./files/recording";

const HEIGHT = 190;
const DASHES = [[], [7, 4], [2, 3], [9, 3, 2, 3]];

interface Line {
  label: string;
  colour: string;
  dash: number[];
  times: number[];
  values: number[];
}

function variable(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

/** "cloth_kinetic_energy_J" is "kinetic". */
function shortName(metric: string): string {
  return metric.replace(/^cloth_/, "").replace(/_energy_J$/, "").replace(/_[A-Za-z]+$/, "").replaceAll("_", " ");
}

function linesOf(recordings: Recording[]): Line[] {
  const lines: Line[] = [];
  recordings.forEach((recording, r) => {
    recording.metrics
      .filter((metric) => metric.name.endsWith("_J"))
      .forEach((metric, m) => {
        const who = recordings.length > 1 ? `${recording.engine || recording.name} ` : "";
        const number = recordings.length > 1 ? r : m;
        lines.push({
          label: who + shortName(metric.name),
          colour: `--series-${(number % 8) + 1}`,
          dash: DASHES[m % DASHES.length] ?? [],
          times: metric.times,
          values: metric.values,
        });
      });
  });
  return lines;
}

/** Recordings have times of their own: of each series the point that is nearest, also where only another one has one. */
function pointNear(chart: uPlot, series: number, at: number): number {
  const column = chart.data[series];
  if (!column || series === 0) return at;
  for (let away = 0; away < column.length; ++away) {
    if (column[at - away] !== undefined) return at - away; // null is a value that is none
    if (column[at + away] !== undefined) return at + away;
  }
  return at;
}

export class EnergyPlot {
  readonly element = h("div", { class: "chart", role: "img" });
  private chart: uPlot | null = null;
  private time = 0;

  constructor(private readonly seek: (time: number) => void) {
    new ResizeObserver(() => {
      if (this.chart && this.element.clientWidth > 0) this.chart.setSize({ width: this.element.clientWidth, height: HEIGHT });
    }).observe(this.element);
  }

  /** false: there is nothing to plot. */
  show(recordings: Recording[]): boolean {
    this.chart?.destroy();
    this.chart = null;
    const lines = linesOf(recordings);
    const hasAny = lines.some((line) => line.values.some(Number.isFinite));
    if (!hasAny) return false;
    const times = [...new Set(lines.flatMap((line) => line.times))].sort((a, b) => a - b);
    const place = new Map(times.map((time, i) => [time, i]));
    const columns = lines.map((line) => {
      const column: (number | null | undefined)[] = new Array(times.length).fill(undefined);
      line.times.forEach((time, i) => (column[place.get(time)!] = Number.isFinite(line.values[i]) ? line.values[i]! : null));
      return column;
    });
    this.element.setAttribute("aria-label", `Energies over time: ${lines.map((line) => line.label).join(", ")}`);
    this.chart = new uPlot(this.options(lines), [times, ...columns] as uPlot.AlignedData, this.element);
    this.chart.over.addEventListener("click", () => {
      const left = this.chart?.cursor.left;
      if (this.chart && left !== undefined && left !== null && left >= 0) this.seek(this.chart.posToVal(left, "x"));
    });
    this.chart.over.addEventListener("mouseleave", () => window.setTimeout(() => this.showValues()));
    return true;
  }

  setTime(time: number): void {
    this.time = time;
    this.chart?.redraw(false, false);
    this.showValues();
  }

  /** The legend has the values at the time that is shown, unless the mouse asks for others. */
  private showValues(): void {
    const { chart } = this;
    if (!chart || chart.over.matches(":hover")) return;
    const left = chart.valToPos(this.time, "x");
    if (!Number.isFinite(left)) return;
    chart.setCursor({ left, top: 0 });
    const times = Array.from(chart.data[0]);
    const nearest = times.reduce((best, time, i) => (Math.abs(time - this.time) < Math.abs(times[best]! - this.time) ? i : best), 0);
    chart.setLegend({ idxs: chart.data.map((_, series) => pointNear(chart, series, nearest)) });
  }

  redraw(): void {
    this.chart?.redraw(false, true);
  }

  private options(lines: Line[]): uPlot.Options {
    const axis = (label: string, size: number): uPlot.Axis => ({
      label,
      size,
      labelSize: 18,
      labelFont: "12px system-ui, sans-serif",
      font: "11px system-ui, sans-serif",
      stroke: () => variable("--muted"),
      grid: { stroke: () => variable("--grid"), width: 1 },
      ticks: { stroke: () => variable("--grid"), width: 1, size: 4 },
      values: (_chart, splits) => splits.map((value) => (value === null ? "" : formatNumber(value))),
    });
    const number = (_chart: uPlot, value: number | null): string => (value == null ? "–" : formatNumber(value, 4));
    return {
      width: Math.max(this.element.clientWidth, 200),
      height: HEIGHT,
      scales: { x: { time: false } },
      axes: [axis("time [s]", 36), axis("energy [J]", 52)],
      cursor: { y: false, drag: { x: false, y: false }, dataIdx: pointNear },
      series: [
        { label: "t [s]", value: number },
        ...lines.map((line): uPlot.Series => ({
          label: line.label,
          stroke: () => variable(line.colour),
          width: 1.75,
          dash: line.dash,
          spanGaps: false,
          points: { show: false },
          value: number,
        })),
      ],
      // Before it is ready, a plot knows no places.
      hooks: { ready: [() => window.setTimeout(() => this.showValues())], draw: [(chart) => this.drawTime(chart)] },
    };
  }

  private drawTime(chart: uPlot): void {
    const x = chart.valToPos(this.time, "x", true);
    const { ctx, bbox } = chart;
    if (!(x >= bbox.left && x <= bbox.left + bbox.width)) return;
    ctx.save();
    ctx.strokeStyle = variable("--accent");
    ctx.lineWidth = 2 * uPlot.pxRatio;
    ctx.setLineDash([]);
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
    ctx.restore();
  }
}
