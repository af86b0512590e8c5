import type { Check, Numeric } from "./report";

const SUPERSCRIPTS: Record<string, string> = {
  "-": "⁻",
  "0": "⁰",
  "1": "¹",
  "2": "²",
  "3": "³",
  "4": "⁴",
  "5": "⁵",
  "6": "⁶",
  "7": "⁷",
  "8": "⁸",
  "9": "⁹",
};

/** Words become the numbers they name. */
export function toNumber(value: Numeric): number {
  return typeof value === "number" ? value : Number(value);
}

/** Three significant digits by default; powers of ten where plain digits would hide the size. */
export function formatNumber(value: Numeric | number, digits = 3): string {
  const number = toNumber(value);
  if (Number.isNaN(number)) return "NaN";
  if (!Number.isFinite(number)) return number > 0 ? "Infinity" : "−Infinity";
  if (number === 0) return "0";
  const size = Math.abs(number);
  if (Number.isInteger(number) && size < 1e6) return String(number).replace("-", "−");
  if (size >= 1e-3 && size < 1e5) return String(Number(number.toPrecision(digits))).replace("-", "−");
  const [mantissa = "", exponent = ""] = number.toExponential(digits - 1).split("e");
  const power = [...exponent.replace("+", "")].map((c) => SUPERSCRIPTS[c] ?? c).join("");
  const factor = Number(mantissa);
  if (factor === 1) return `10${power}`;
  return `${String(factor).replace("-", "−")}\u2009×\u200910${power}`;
}

/** The number with its unit; a dimensionless one stands alone. */
export function formatQuantity(value: Numeric, unit: string, digits = 3): string {
  const text = formatNumber(value, digits);
  if (!Number.isFinite(toNumber(value))) return text;
  return unit === "" || unit === "1" ? text : `${text}\u00a0${unit}`;
}

/** Every digit of the stored value, for tooltips. */
export function exactQuantity(value: Numeric, unit: string): string {
  return unit === "" || unit === "1" ? String(value) : `${value} ${unit}`;
}

export function formatRatio(check: Check): string {
  if (check.ratio === null) return "";
  const ratio = toNumber(check.ratio);
  if (!Number.isFinite(ratio)) return Number.isNaN(ratio) ? "NaN" : "∞";
  return formatNumber(ratio, 2);
}

export function count(number: number, one: string, many: string = `${one}s`): string {
  return `${number} ${number === 1 ? one : many}`;
}
