// The scale for values of both signs, as in the pictures (playback/rendering/paint/color_map.cpp): straight lines in CIELAB from
// a blue and a red to a warm white.
const COLOURS: [number, number, number][] = [
  [33, 75, 150],
  [69, 93, 161],
  [96, 112, 171],
  [122, 132, 182],
  [146, 152, 193],
  [169, 173, 203],
  [193, 195, 214],
  [216, 217, 224],
  [240, 239, 235],
  [235, 215, 208],
  [228, 190, 182],
  [221, 166, 156],
  [212, 142, 131],
  [202, 119, 107],
  [191, 94, 84],
  [178, 69, 61],
  [165, 40, 40],
];

/** The colour of a value between -1 and 1; channels 0 to 255. Grey where there is none. */
export function divergingColour(value: number): [number, number, number] {
  if (!Number.isFinite(value)) return [150, 150, 150];
  const at = Math.min(Math.max(0.5 + 0.5 * value, 0), 1) * (COLOURS.length - 1);
  const left = Math.min(Math.floor(at), COLOURS.length - 2);
  const [a, b] = [COLOURS[left]!, COLOURS[left + 1]!];
  return [0, 1, 2].map((c) => a[c]! + (b[c]! - a[c]!) * (at - left)) as [number, number, number];
}

export const DIVERGING_GRADIENT = `linear-gradient(to right, ${COLOURS.map((rgb) => `rgb(${rgb.join(" ")})`).join(", ")})`;
