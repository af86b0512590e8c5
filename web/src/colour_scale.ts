import { formatNumber } from "./format";

// "viridis" by N. J. Smith, S. van der Walt and E. Firing (CC0), every 16th of its 256 colours, as in the pictures.
const COLOURS: [number, number, number][] = [
  [68, 1, 84],
  [72, 24, 106],
  [71, 45, 123],
  [66, 64, 134],
  [59, 82, 139],
  [51, 99, 141],
  [44, 114, 142],
  [38, 130, 142],
  [33, 145, 140],
  [31, 159, 136],
  [39, 173, 129],
  [61, 188, 116],
  [92, 200, 99],
  [129, 211, 77],
  [170, 220, 50],
  [213, 226, 26],
  [253, 231, 37],
];

/** Where there is no value: not on the scale. */
export const NO_VALUE: [number, number, number] = [190, 60, 60];

/** The colour of a place on the scale, 0 to 1; channels 0 to 255. */
export function colourAt(place: number): [number, number, number] {
  if (!Number.isFinite(place)) return NO_VALUE;
  const at = Math.min(Math.max(place, 0), 1) * (COLOURS.length - 1);
  const left = Math.min(Math.floor(at), COLOURS.length - 2);
  const a = COLOURS[left] ?? NO_VALUE;
  const b = COLOURS[left + 1] ?? NO_VALUE;
  return [0, 1, 2].map((c) => (a[c] ?? 0) + ((b[c] ?? 0) - (a[c] ?? 0)) * (at - left)) as [
    number,
    number,
    number,
  ];
}

export const GRADIENT = `linear-gradient(to right, ${COLOURS.map((rgb) => `rgb(${rgb.join(" ")})`).join(", ")})`;

const UNITS: [number, string][] = [
  [1, "m"],
  [1e-3, "mm"],
  [1e-6, "µm"],
  [1e-9, "nm"],
  [1e-12, "pm"],
];

/** The unit in which a length [m] reads well. */
export function lengthUnit(length: number): { factor: number; name: string } {
  // A metre is for what is longer than the cloth of most scenes; 0.3 m reads better as 300 mm.
  const [size, name] = UNITS.find(([unit]) => length >= unit) ?? (length > 0 ? [1e-12, "pm"] : [1, "m"]);
  return { factor: 1 / size, name };
}

export function lengthText(length: number): string {
  if (!Number.isFinite(length)) return "–";
  const unit = lengthUnit(length);
  return `${formatNumber(length * unit.factor)}\u00a0${unit.name}`;
}
