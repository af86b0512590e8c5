// The data of the page, as validation/report/formats/to_json.cpp writes it.

/** JSON has no NaN and no infinities; they arrive as words. */
export type Numeric = number | "NaN" | "Infinity" | "-Infinity";
/** "known": fails as a stated deviation; "stale": is stated as one and is none any more, which fails. */
export type Verdict = "pass" | "fail" | "info" | "known" | "stale";

export interface Tolerance {
  value: Numeric;
  basis: string;
  why: string;
}

/** What an error was computed from. */
export interface ComparedValue {
  quantity: string;
  value: Numeric;
  expected: Numeric;
  unit: string;
}

export interface Sabotage {
  name: string;
  measured: Numeric;
  detected: boolean;
}

export interface Check {
  case: string;
  engine: string;
  claim: string;
  metric: string;
  unit: string;
  formula: string;
  source: string;
  measured: Numeric;
  tolerance: Tolerance | null;
  ratio: Numeric | null;
  flag: "" | "tight" | "loose";
  verdict: Verdict;
  note: string;
  /** Of a known or stale deviation: why it is expected to fail. */
  cause: string;
  values: ComparedValue[];
  sabotages: Sabotage[];
}

export interface Series {
  name: string;
  x: Numeric[];
  y: Numeric[];
}

export interface Plot {
  title: string;
  x_label: string;
  y_label: string;
  log_x: boolean;
  log_y: boolean;
  series: Series[];
}

export interface Picture {
  title: string;
  caption: string;
  file: string;
  /** "image/jpeg" or "image/png". */
  mime: string;
  base64: string;
}

/** Numbers in equal steps from lowest to highest; base64 of 16-bit words, low byte first. */
export interface QuantizedData {
  lowest: number;
  highest: number;
  steps_base64: string;
}

/** The reference's cloth over time, and how far engines are from it [m]. */
export interface DistanceViewData {
  simulated_nodes: number;
  times: Numeric[];
  triangles_base64: string;
  positions: QuantizedData[];
  engines: { name: string; largest: Numeric[]; distances: QuantizedData[] }[];
  bodies: { shape: string; sizes: Numeric[]; poses: Numeric[][] }[];
}

export interface Section {
  id: string;
  summary: string;
  picture_rows: { title: string; pictures: Picture[] }[];
  plots: Plot[];
  tables: { title: string; columns: string[]; rows: string[][] }[];
  /** Reports of older versions have none. */
  distance_views?: DistanceViewData[];
  scene_text: string;
}

export interface Report {
  schema: string;
  schema_version: number;
  title: string;
  passed: boolean;
  summary: {
    checks_passed: number;
    checks_failed: number;
    checks_not_gated: number;
    checks_known: number;
    checks_stale: number;
    sabotages: number;
    sabotages_detected: number;
  };
  checks: Check[];
  sections: Section[];
  departures: { engine: string; what: string; measured: string; reason: string }[];
  limits: string[];
  provenance: { name: string; value: string }[];
}

const SCHEMA_VERSION = 3;

/** Reads the data slot; throws with one clear line if it is not a report this page knows. */
export function readReport(): Report {
  const text = document.getElementById("weft-report")?.textContent ?? "";
  const report = JSON.parse(text) as Report;
  if (report.schema !== "weft-report" || report.schema_version !== SCHEMA_VERSION) {
    throw new Error(
      `The data is ${report.schema} version ${report.schema_version}, expected weft-report version ${SCHEMA_VERSION}.`,
    );
  }
  return report;
}

export function undetected(check: Check): Sabotage[] {
  return check.sabotages.filter((sabotage) => !sabotage.detected);
}

/** A check that keeps the report from passing: its bound is broken, what was stated of it is stale, or it did not notice a sabotage. */
export function needsAttention(check: Check): boolean {
  return check.verdict === "fail" || check.verdict === "stale" || undetected(check).length > 0;
}

/** The program behind an engine's title, without precision and step. */
export function family(engine: string): string {
  const name = engine.split(/[ ,]/)[0] ?? engine;
  // The laws alone, and the reference's statics, are the reference's side.
  return name === "laws" ? "reference" : name;
}

const FIRST = ["bullet_weft", "bullet_forces"];

/** The families of all checks: the fast solver first, the reference last. */
export function families(report: Report): string[] {
  const rank = (name: string): number => {
    const at = FIRST.indexOf(name);
    if (at >= 0) return at;
    return name === "reference" ? FIRST.length + 1 : FIRST.length;
  };
  return unique(report.checks.map((check) => family(check.engine))).sort((a, b) => rank(a) - rank(b));
}

export function unique(values: string[]): string[] {
  return [...new Set(values)];
}
