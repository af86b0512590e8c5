import { toNumber } from "./format";
import type { Plot, Series } from "./report";

/** Rows as uPlot wants them: one ascending x for all series; undefined = no point of this series here, null = a gap. */
export interface Rows {
  x: number[];
  ys: (number | null | undefined)[][];
  /** Series whose x goes back and forth: drawn as points, since a line through sorted points would be an invention. */
  scattered: boolean[];
  /** Points that cannot be drawn: not finite, or not positive on a logarithmic axis. */
  hidden: number;
}

interface Point {
  x: number;
  y: number | null;
}

function isMonotone(values: number[]): boolean {
  const rising = values.every((value, i) => i === 0 || value >= (values[i - 1] ?? value));
  return rising || values.every((value, i) => i === 0 || value <= (values[i - 1] ?? value));
}

function drawable(value: number, log: boolean): boolean {
  return Number.isFinite(value) && (!log || value > 0);
}

function points(series: Series, plot: Plot): Point[] {
  const list: Point[] = [];
  const length = Math.min(series.x.length, series.y.length);
  for (let i = 0; i < length; ++i) {
    const x = toNumber(series.x[i] ?? "NaN");
    const y = toNumber(series.y[i] ?? "NaN");
    if (drawable(x, plot.log_x)) list.push({ x, y: drawable(y, plot.log_y) ? y : null });
  }
  return list;
}

/** Merges the series of a plot. A series may have several points at one x; each keeps a row of its own. */
export function mergeSeries(plot: Plot): Rows {
  const slots = new Map<number, number>(); // x -> how many rows it needs
  let hidden = 0;
  const all = plot.series.map((series) => {
    const list = points(series, plot);
    const total = Math.max(series.x.length, series.y.length);
    hidden += total - list.filter((point) => point.y !== null).length;
    const seen = new Map<number, number>();
    for (const { x } of list) seen.set(x, (seen.get(x) ?? 0) + 1);
    for (const [x, needed] of seen) slots.set(x, Math.max(slots.get(x) ?? 0, needed));
    return list;
  });

  const x: number[] = [];
  const firstRow = new Map<number, number>();
  for (const value of [...slots.keys()].sort((a, b) => a - b)) {
    firstRow.set(value, x.length);
    for (let i = 0; i < (slots.get(value) ?? 0); ++i) x.push(value);
  }
  const ys = all.map((list) => {
    const column: (number | null | undefined)[] = new Array<undefined>(x.length).fill(undefined);
    const used = new Map<number, number>();
    for (const point of list) {
      const nth = used.get(point.x) ?? 0;
      used.set(point.x, nth + 1);
      column[(firstRow.get(point.x) ?? 0) + nth] = point.y;
    }
    return column;
  });
  return { x, ys, scattered: all.map((list) => !isMonotone(list.map((point) => point.x))), hidden };
}
