import uPlot from "uplot";

import { h, scrollBox, tableHead } from "./dom";
import { count, formatNumber, toNumber } from "./format";
import type { Plot, Series } from "./report";
import { mergeSeries, type Rows } from "./series";

const COLOURS = 8; // --series-1 .. --series-8 in style.css
const DASHES = [[], [8, 4], [2, 3], [10, 3, 2, 3], [5, 5], [14, 4]];
const BORDERS = ["solid", "dashed", "dotted", "dashed", "dotted", "dashed"]; // the nearest CSS has to DASHES
const FEW_POINTS = 8;
const HEIGHT = 280;
const live: uPlot[] = [];

function variable(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

/** Redraws every plot, after the colours of the page have changed. */
export function redrawPlots(): void {
  for (const chart of live) chart.redraw(false, true);
}

/** Lines of a logarithmic axis: whole decades, at most seven of them; 1, 2, 5 where there are few decades. */
function logSplits(low: number, high: number): number[] {
  const first = Math.floor(Math.log10(low));
  const last = Math.ceil(Math.log10(high));
  const step = Math.max(1, Math.ceil((last - first) / 7));
  const mantissas = last - first <= 2 ? [1, 2, 5] : [1];
  const splits: number[] = [];
  for (let decade = first; decade <= last; decade += step) {
    for (const mantissa of mantissas) splits.push(mantissa * 10 ** decade);
  }
  return splits.filter((value) => value >= low && value <= high);
}

function axis(label: string, size: number, rotateFree: boolean, log: boolean): uPlot.Axis {
  return {
    ...(log && {
      splits: (_chart: uPlot, _axis: number, low: number, high: number) => logSplits(low, high),
      filter: (_chart: uPlot, splits: number[]) => splits,
    }),
    label,
    size,
    labelSize: 22,
    labelFont: "12px system-ui, sans-serif",
    font: "11px system-ui, sans-serif",
    space: rotateFree ? 64 : 36,
    stroke: () => variable("--muted"),
    grid: { stroke: () => variable("--grid"), width: 1 },
    ticks: { stroke: () => variable("--grid"), width: 1, size: 5 },
    values: (_chart, splits) => splits.map((value) => (value === null ? "" : formatNumber(value))),
  };
}

function scale(log: boolean): uPlot.Scale {
  if (log) return { time: false, distr: 3 };
  return {
    time: false,
    range: (_chart, low, high) => {
      if (low === null || high === null) return [0, 1];
      if (low !== high) return [low, high];
      const margin = low === 0 ? 1 : Math.abs(low) * 0.1;
      return [low - margin, high + margin];
    },
  };
}

function paddedScale(log: boolean): uPlot.Scale {
  if (log) return scale(true);
  return {
    range: (_chart, low, high) => {
      if (low === null || high === null) return [0, 1];
      const margin = low !== high ? (high - low) * 0.06 : low === 0 ? 1 : Math.abs(low) * 0.1;
      const touchesZero = low >= 0 && low - margin < 0 && low < (high - low) * 0.5;
      return [touchesZero ? 0 : low - margin, high + margin];
    },
  };
}

/** How the legend marks a series; uPlot counts x as series 0. */
function borderOf(series: number): string {
  return BORDERS[(series - 1) % BORDERS.length] ?? "solid";
}

function lineOf(series: Series, index: number, scattered: boolean): uPlot.Series {
  const stroke = (): string => variable(`--series-${(index % COLOURS) + 1}`);
  const line: uPlot.Series = {
    label: series.name,
    stroke,
    width: 1.75,
    dash: DASHES[index % DASHES.length] ?? [],
    value: (_chart, value) => (value === null || value === undefined ? "–" : formatNumber(value, 4)),
  };
  // Where there are few, each point is a run of its own and not a sample of a curve.
  if (series.x.length <= FEW_POINTS) line.points = { show: true, size: 6, fill: stroke, width: 0 };
  if (scattered) {
    line.paths = () => null;
    line.points = { show: true, size: 4, fill: stroke };
  }
  return line;
}

/** The cursor shows each series' own nearest point, also where only another series has one. */
function nearestPoint(rows: Rows): (chart: uPlot, series: number, at: number, x: number) => number {
  return (_chart, series, at, x) => {
    const ys = rows.ys[series - 1];
    if (!ys || ys[at] !== undefined) return at;
    let left = at;
    let right = at;
    while (left >= 0 && ys[left] === undefined) --left;
    while (right < ys.length && ys[right] === undefined) ++right;
    const gap = (row: number): number => Math.abs((rows.x[row] ?? Infinity) - x);
    if (left < 0) return right < ys.length ? right : at;
    return right >= ys.length || gap(left) <= gap(right) ? left : right;
  };
}

function makeLegendReachable(chart: uPlot): void {
  chart.root.querySelectorAll<HTMLElement>(".u-legend .u-series").forEach((row, i) => {
    const head = row.querySelector<HTMLElement>("th");
    if (!head || i === 0) return;
    head.tabIndex = 0;
    head.setAttribute("role", "button");
    head.setAttribute("aria-pressed", "true");
    head.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      chart.setSeries(i, { show: !(chart.series[i]?.show ?? true) });
    });
  });
}

function draw(box: HTMLElement, plot: Plot, rows: Rows): void {
  const chart = new uPlot(
    {
      width: Math.max(box.clientWidth, 200),
      height: HEIGHT,
      padding: [12, 26, 0, 0],
      scales: { x: scale(plot.log_x), y: paddedScale(plot.log_y) },
      axes: [axis(plot.x_label, 36, true, plot.log_x), axis(plot.y_label, 66, false, plot.log_y)],
      series: [
        { label: plot.x_label, value: (_chart, value) => (value === null ? "–" : formatNumber(value, 4)) },
        ...plot.series.map((series, i) => lineOf(series, i, rows.scattered[i] ?? false)),
      ],
      cursor: { dataIdx: nearestPoint(rows), points: { size: 7 } },
      legend: { live: true, markers: { width: 2, dash: (_chart, i) => borderOf(i) } },
      hooks: {
        setSeries: [
          (self, index) => {
            if (index === null) return;
            const head = self.root.querySelectorAll(".u-legend .u-series")[index]?.querySelector("th");
            head?.setAttribute("aria-pressed", String(self.series[index]?.show ?? true));
          },
        ],
      },
    },
    [rows.x, ...rows.ys] as uPlot.AlignedData,
    box,
  );
  const area = chart.root.querySelector(".u-wrap");
  area?.setAttribute("role", "img");
  const names = plot.series.map((series) => series.name).join(", ");
  area?.setAttribute("aria-label", `${plot.title}: ${plot.y_label} against ${plot.x_label}; ${names}`);
  makeLegendReachable(chart);
  live.push(chart);
  new ResizeObserver(() => {
    const width = Math.floor(box.clientWidth);
    if (width > 0 && width !== chart.width) chart.setSize({ width, height: HEIGHT });
  }).observe(box);
}

/** The plot in numbers: for readers without a picture, and where a value is not finite. */
function valuesTable(plot: Plot): HTMLElement {
  const row = (series: Series): HTMLElement => {
    const values = series.y.map(toNumber);
    const finite = values.filter(Number.isFinite);
    const lowest = finite.reduce((a, b) => Math.min(a, b), Infinity);
    const highest = finite.reduce((a, b) => Math.max(a, b), -Infinity);
    const cell = (text: string): HTMLElement => h("td", { class: "number" }, text);
    return h(
      "tr",
      {},
      h("th", { scope: "row" }, series.name),
      cell(String(values.length)),
      cell(finite.length > 0 ? formatNumber(lowest, 4) : "–"),
      cell(finite.length > 0 ? formatNumber(highest, 4) : "–"),
      cell(series.y.length > 0 ? formatNumber(series.y[series.y.length - 1] ?? "NaN", 4) : "–"),
      cell(String(values.length - finite.length)),
    );
  };
  const heads = ["series", "points", "lowest", "highest", "last", "not finite"];
  const table = h("table", {}, tableHead(heads), h("tbody", {}, plot.series.map(row)));
  return h("details", {}, h("summary", {}, "In numbers"), scrollBox(`${plot.title} in numbers`, table));
}

/** One plot; call the returned function once the element is in the page and has a width. */
export function renderPlot(plot: Plot): { element: HTMLElement; start: () => void } {
  const rows = mergeSeries(plot);
  const empty = !rows.ys.some((column) => column.some((value) => typeof value === "number"));
  const box = h("div", { class: "chart" }, empty && h("p", { class: "muted" }, "No finite values to draw."));
  const reason =
    plot.log_x || plot.log_y ? "not finite, or not positive on a logarithmic axis" : "not finite";
  const element = h(
    "figure",
    { class: "plot" },
    h("figcaption", {}, plot.title),
    box,
    rows.hidden > 0 &&
      !empty &&
      h("p", { class: "muted small" }, `Not drawn: ${count(rows.hidden, "point")}, ${reason}.`),
    valuesTable(plot),
  );
  return {
    element,
    start: () => {
      if (!empty) draw(box, plot, rows);
    },
  };
}
