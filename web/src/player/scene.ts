// The resolved scene of a recording, as far as it is drawn. Values are in SI units (docs/scene_format.md).
import { parse, type TomlTable, type TomlValue } from "smol-toml";

export type Vector = [number, number, number];

export interface SceneCamera {
  position: Vector;
  target: Vector;
  /** Vertical [rad]. */
  fieldOfView: number;
  follow: string;
}

export interface Scene {
  name: string;
  summary: string;
  gravity: Vector;
  /** Also those of characters, by name. */
  cloths: Map<string, TomlTable>;
  characters: TomlTable[];
  colliders: Map<string, TomlTable>;
  camera: SceneCamera;
}

/** "0.01 s" and "1/100 s" are 0.01: a resolved scene has no prefixes. */
export function quantity(value: TomlValue | undefined, otherwise = 0): number {
  if (typeof value === "number") return value;
  if (typeof value === "bigint") return Number(value);
  if (typeof value !== "string") return otherwise;
  const [number = ""] = value.split(" ");
  const [above = "", below = "1"] = number.split("/");
  return Number(above) / Number(below);
}

export function vector(value: TomlValue | undefined, otherwise: Vector = [0, 0, 0]): Vector {
  if (!Array.isArray(value) || value.length !== 3) return otherwise;
  return value.map((part) => quantity(part)) as Vector;
}

export function table(value: TomlValue | undefined): TomlTable | null {
  return value !== null && typeof value === "object" && !Array.isArray(value) && !(value instanceof Date)
    ? (value as TomlTable)
    : null;
}

export function tables(value: TomlValue | undefined): TomlTable[] {
  return Array.isArray(value) ? value.map(table).filter((entry) => entry !== null) : [];
}

export function text(value: TomlValue | undefined): string {
  return typeof value === "string" ? value : "";
}

/** What the scene says of a cloth; a skin looks as its character. */
export function clothEntry(scene: Scene, name: string): TomlTable {
  const character = scene.characters.find((entry) => name.startsWith(`${text(entry["name"])}-`));
  return scene.cloths.get(name) ?? character ?? {};
}

function byName(entries: TomlTable[]): Map<string, TomlTable> {
  return new Map(entries.map((entry) => [text(entry["name"]), entry]));
}

export function readScene(toml: string): Scene {
  const root = parse(toml);
  const characters = tables(root["character"]);
  const camera = table(root["camera"]) ?? {};
  return {
    name: text(root["name"]),
    summary: text(root["summary"]),
    gravity: vector(table(root["world"])?.["gravity"], [0, -9.81, 0]),
    cloths: byName([...tables(root["cloth"]), ...characters.flatMap((c) => tables(c["cloth"]))]),
    characters,
    colliders: byName([...tables(root["collider"]), ...characters.flatMap((c) => tables(c["collider"]))]),
    camera: {
      position: vector(camera["position"], [8, 6, 10]),
      target: vector(camera["target"], [0, 1, 0]),
      fieldOfView: quantity(camera["field_of_view"], 0.6),
      follow: text(camera["follow"]),
    },
  };
}
