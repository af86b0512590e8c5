// The patterns of docs/appearance.md, as playback/rendering/paint/pattern.cpp makes them.
export type Rgb = [number, number, number]; // 8-bit sRGB
type Light = [number, number, number]; // linear

export const PATTERNS = ["checks", "stripes", "dots", "tartan", "carpet", "eyeball"] as const;
export type Pattern = (typeof PATTERNS)[number];

interface Inks {
  ground: Light;
  figure: Light;
  dark: Light;
  pale: Light;
}

const FIGURES: Record<Pattern, Rgb> = {
  checks: [242, 236, 222],
  stripes: [242, 236, 222],
  dots: [242, 236, 222],
  tartan: [40, 92, 70],
  carpet: [226, 178, 92],
  eyeball: [240, 238, 232],
};

const SAMPLES = 3; // of a pixel along each axis

function light(rgb: Rgb): Light {
  return rgb.map((channel) => {
    const c = channel / 255;
    return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
  }) as Light;
}

function encoded(channel: number): number {
  const c = Math.min(Math.max(channel, 0), 1);
  return Math.round(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055));
}

const fraction = (x: number): number => x - Math.floor(x);
const fold = (x: number): number => Math.abs(x - Math.round(x));
const clamp01 = (x: number): number => Math.min(Math.max(x, 0), 1);
const mixed = (a: Light, b: Light, part: number): Light => a.map((c, k) => (1 - part) * c + part * b[k]!) as Light;
const times = (a: Light, factor: number): Light => a.map((c) => c * factor) as Light;

function dots(x: number, y: number, inks: Inks): Light {
  const shift = (Math.floor(8 * y) % 2) * 0.5;
  return Math.hypot(fold(8 * x + shift + 0.5), fraction(8 * y) - 0.5) < 0.27 ? inks.figure : inks.ground;
}

function thread(place: number, inks: Inks): Light {
  const x = 2 * fold(3 * place);
  const bands: [number, Light][] = [
    [0.045, inks.pale],
    [0.3, inks.ground],
    [0.36, inks.dark],
    [0.42, inks.ground],
    [0.74, inks.dark],
    [0.8, inks.figure],
    [0.86, inks.dark],
  ];
  return bands.find(([end]) => x < end)?.[1] ?? inks.figure;
}

function tartan(x: number, y: number, inks: Inks): Light {
  const isWarp = fraction(0.25 * (Math.floor(192 * x) + Math.floor(192 * y))) < 0.5;
  return thread(isWarp ? x : y, inks);
}

function rosette(x: number, y: number, radius: number, petals: number): number {
  return Math.hypot(x, y) - radius * (0.78 + 0.22 * Math.cos(petals * Math.atan2(y, x)));
}

function flowers(px: number, py: number, cell: number, field: Light, inks: Inks): Light {
  const odd = (Math.abs(Math.floor(py / cell)) % 2) * 0.5;
  const x = fraction(px / cell + odd) - 0.5;
  const y = fraction(py / cell) - 0.5;
  if (Math.hypot(x, y) < 0.09) return inks.dark;
  if (rosette(x, y, 0.28, 4) < 0) return inks.figure;
  if (Math.abs(y + 0.18 * Math.sin(2 * Math.PI * (x + 0.25))) < 0.035) return mixed(field, inks.figure, 0.55);
  return field;
}

function medallion(x: number, y: number, size: number, inks: Inks): Light | null {
  const middle = rosette(x, y, size, 8);
  if (middle > 0) return null;
  if (middle > -0.06 * size) return inks.figure;
  if (rosette(x, y, 0.8 * size, 8) > 0) return inks.dark;
  if (rosette(x, y, 0.74 * size, 8) > 0) return inks.pale;
  if (rosette(x, y, 0.5 * size, 16) > 0) return flowers(x, y, 0.16 * size, inks.ground, inks);
  if (rosette(x, y, 0.44 * size, 16) > 0) return inks.figure;
  return rosette(x, y, 0.22 * size, 8) > 0 ? inks.dark : inks.pale;
}

function carpetBorder(x: number, y: number, rim: number, inks: Inks): Light {
  const along = Math.min(x, 1 - x) === rim ? y : x;
  const [qx, qy] = [fold(10 * along) / 10, rim - 0.08];
  if (Math.hypot(qx, qy) < 0.009) return inks.ground;
  if (rosette(qx, qy, 0.034, 6) < 0) return inks.figure;
  return Math.abs(qy + 0.026 * Math.cos(20 * Math.PI * along)) < 0.004 ? inks.pale : inks.dark;
}

function carpet(x: number, y: number, inks: Inks): Light {
  const rim = Math.min(x, 1 - x, y, 1 - y);
  if (rim < 0.018) return inks.dark;
  if (rim < 0.03) return inks.figure;
  if (rim < 0.13) return carpetBorder(x, y, rim, inks);
  if (rim < 0.142) return inks.figure;
  if (rim < 0.152) return inks.dark;
  const quarter = medallion(0.348 - Math.abs(x - 0.5), 0.348 - Math.abs(y - 0.5), 0.21, inks);
  if (quarter) return quarter;
  const [mx, my] = [x - 0.5, y - 0.5];
  const centre = medallion(mx, 0.82 * my, 0.27, inks);
  if (centre) return centre;
  const pendant = rosette(1.5 * mx, Math.abs(my) - 0.325, 0.035, 4);
  if (pendant < 0) return pendant < -0.01 ? inks.dark : inks.figure;
  return flowers(mx, my, 0.058, inks.ground, inks);
}

function eyeball(x: number, y: number, inks: Inks): Light {
  const [qx, qy] = [2 * x - 1, 2 * y - 1];
  const angle = 180 * Math.hypot(qx, qy); // [deg] from the axis
  const around = Math.atan2(qy, qx);
  const [pupil, iris] = [14, 34];
  if (angle < pupil) return [0.004, 0.004, 0.004];
  if (angle < iris) {
    const part = (angle - pupil) / (iris - pupil);
    const fibres = 0.5 + 0.25 * Math.sin(47 * around + 3 * Math.sin(5 * around)) + 0.25 * Math.sin(83 * around - 6 * part);
    const shade =
      (0.55 + 0.75 * fibres * (1 - 0.4 * part)) *
      (1 - 0.85 * clamp01((part - 0.8) / 0.2)) *
      (0.45 + 0.55 * clamp01(part / 0.12));
    return times(inks.ground, shade);
  }
  const wander = around + 0.05 * Math.sin(angle / 5) + 0.03 * Math.sin(angle / 2.3 + 4 * around);
  const vein = (fold((wander * 9) / (2 * Math.PI)) / 9) * 360 * Math.sin((angle * Math.PI) / 180);
  const strength = clamp01((angle - 52) / 70);
  const red = vein < 0.4 + 1.6 * strength ? 0.55 * strength : 0;
  const white = times(inks.figure, 0.55 + 0.45 * clamp01((angle - iris) / 4));
  return mixed(white, [0.45, 0.05, 0.04], red);
}

function at(pattern: Pattern, x: number, y: number, inks: Inks): Light {
  switch (pattern) {
    case "checks":
      return (Math.floor(8 * x) + Math.floor(8 * y)) % 2 === 0 ? inks.ground : inks.figure;
    case "stripes":
      return fraction(8 * x) < 0.5 ? inks.ground : inks.figure;
    case "dots":
      return dots(x, y, inks);
    case "tartan":
      return tartan(x, y, inks);
    case "carpet":
      return carpet(x, y, inks);
    case "eyeball":
      return eyeball(x, y, inks);
  }
}

/** One repetition; its first row is at v = 1. figure: null for the pattern's own. */
export function patternPixels(pattern: Pattern, ground: Rgb, figure: Rgb | null, size: number): ImageData {
  const inks = {
    ground: light(ground),
    figure: light(figure ?? FIGURES[pattern]),
    dark: light([26, 34, 62]),
    pale: light([240, 230, 206]),
  };
  const image = new ImageData(size, size);
  for (let row = 0; row < size; ++row) {
    for (let column = 0; column < size; ++column) {
      const sum: Light = [0, 0, 0];
      for (let k = 0; k < SAMPLES * SAMPLES; ++k) {
        const x = (column + ((k % SAMPLES) + 0.5) / SAMPLES) / size;
        const y = (size - row - (Math.floor(k / SAMPLES) + 0.5) / SAMPLES) / size;
        at(pattern, x, y, inks).forEach((channel, c) => (sum[c]! += channel));
      }
      const rgb = sum.map((channel) => encoded(channel / (SAMPLES * SAMPLES)));
      image.data.set([...rgb, 255], 4 * (row * size + column));
    }
  }
  return image;
}
