// Colours and pictures of a body, as playback/rendering/paint/body_paint.cpp chooses them.
import { CanvasTexture, Color, RepeatWrapping, SRGBColorSpace, Texture } from "three";
import type { TomlTable } from "smol-toml";

import { patternPixels, PATTERNS, type Pattern, type Rgb } from "./pattern";
import { quantity, text } from "../scene";

export interface Paint {
  front: Color;
  back: Color;
  /** Of the front, in place of its colour. */
  picture: Texture | null;
  pictureOnBack: boolean;
  isEyeball: boolean;
  isFlat: boolean;
  isVisible: boolean;
  /** Of a plain ball that moves: octants in both colours show how it turns. */
  isTwoTone: boolean;
}

/** One pair for each cloth, then from the start again. */
const CLOTHS: [Rgb, Rgb][] = [
  [[58, 116, 186], [244, 186, 124]],
  [[190, 78, 58], [236, 216, 170]],
  [[52, 138, 112], [238, 206, 150]],
  [[116, 88, 160], [232, 200, 214]],
];
const FIXED: Rgb = [222, 220, 216];
const MOVING: [Rgb, Rgb] = [[214, 120, 84], [244, 232, 214]];

function color(rgb: Rgb): Color {
  return new Color().setRGB(rgb[0] / 255, rgb[1] / 255, rgb[2] / 255, SRGBColorSpace);
}

function rgbOf(value: unknown): Rgb | null {
  const match = /^#([0-9a-f]{2})([0-9a-f]{2})([0-9a-f]{2})$/i.exec(typeof value === "string" ? value : "");
  return match ? (match.slice(1).map((digits) => parseInt(digits, 16)) as Rgb) : null;
}

/** A resolved scene has colours as "#rrggbb". */
export function colourOf(entry: TomlTable): Color | null {
  const rgb = rgbOf(entry["color"]);
  return rgb && color(rgb);
}

const SIMPLE_SIZE = 512; // [pixel]
const DETAIL_SIZE = 1024;

function patternTexture(pattern: Pattern, ground: Rgb, entry: TomlTable): Texture {
  const size = pattern === "carpet" || pattern === "eyeball" ? DETAIL_SIZE : SIMPLE_SIZE;
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = size;
  const context = canvas.getContext("2d");
  context?.putImageData(patternPixels(pattern, ground, rgbOf(entry["pattern_color"]), size), 0, 0);
  return new CanvasTexture(canvas);
}

/** The picture of a file comes later than the body; loaded tells when it is there. */
function fileTexture(bytes: Uint8Array, loaded: () => void): Texture {
  const texture = new Texture();
  const image = new Image();
  const url = URL.createObjectURL(new Blob([bytes as Uint8Array<ArrayBuffer>]));
  image.addEventListener("load", () => {
    texture.image = image;
    texture.needsUpdate = true;
    URL.revokeObjectURL(url);
    loaded();
  });
  image.src = url;
  return texture;
}

function pictureOf(entry: TomlTable, ground: Rgb, assets: Map<string, Uint8Array>, loaded: () => void): Texture | null {
  // A drawn mesh has texture coordinates of its own; the page shows the simulated cloth, for which the picture is not made.
  const name = entry["drawn_mesh"] === undefined ? text(entry["texture"]) : "";
  if (name === "" || name === "plain") return null;
  const file = assets.get(name);
  const isPattern = (PATTERNS as readonly string[]).includes(name);
  if (!file && !isPattern) return null;
  const texture = file ? fileTexture(file, loaded) : patternTexture(name as Pattern, ground, entry);
  const repeat = Array.isArray(entry["texture_repeat"]) ? entry["texture_repeat"].map((r) => quantity(r)) : [1, 1];
  texture.wrapS = texture.wrapT = RepeatWrapping;
  texture.repeat.set(repeat[0] ?? 1, repeat[1] ?? 1);
  texture.colorSpace = SRGBColorSpace;
  texture.anisotropy = 8;
  return texture;
}

function base(entry: TomlTable, front: Rgb, assets: Map<string, Uint8Array>, loaded: () => void): Paint {
  return {
    front: color(front),
    back: color(front),
    picture: pictureOf(entry, front, assets, loaded),
    pictureOnBack: true,
    isEyeball: entry["texture"] === "eyeball",
    isFlat: entry["smooth"] === false,
    isVisible: entry["visible"] !== false,
    isTwoTone: false,
  };
}

export function clothPaint(entry: TomlTable, index: number, assets: Map<string, Uint8Array>, loaded: () => void): Paint {
  const palette = CLOTHS[index % CLOTHS.length]!;
  const own = rgbOf(entry["color"]);
  const back = rgbOf(entry["back_color"]);
  const paint = base(entry, own ?? palette[0], assets, loaded);
  // The other side of a dyed cloth is paler and warmer.
  const paler = color([236, 222, 196]).lerp(paint.front, 0.45);
  paint.back = back ? color(back) : own ? paler : color(palette[1]);
  paint.pictureOnBack = !back;
  return paint;
}

export function bodyPaint(entry: TomlTable, assets: Map<string, Uint8Array>, loaded: () => void): Paint {
  const isMoving = entry["mass"] !== undefined;
  const own = rgbOf(entry["color"]);
  const paint = base(entry, own ?? (isMoving ? MOVING[0] : FIXED), assets, loaded);
  paint.isTwoTone = isMoving && !own && !paint.picture && entry["shape"] === "sphere";
  if (paint.isTwoTone) paint.back = color(MOVING[1]);
  return paint;
}
