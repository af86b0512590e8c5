// The cloths and skins of a character as meshes, node for node as Weft makes them (scenes/characters).
import { Matrix4, Quaternion, Vector3 } from "three";
import type { TomlTable } from "smol-toml";

import { fromBase64 } from "../files/bytes";
import { asSkin, surfaceBody, type ClothMesh } from "./cloth_mesh";
import { readModel, type Model, type Part, type Vertex } from "../files/gltf";
import { quantity, table, tables, text, vector } from "../scene";

type Surface = Pick<Part, "vertices" | "triangles" | "cornerPlaces">;

/** One vertex for each place, or for each place that also follows the same bones; without triangles that this makes thin. */
function welded(surface: Surface, bySkin: boolean): Surface {
  const firstOf = new Map<string, number>();
  const first = surface.vertices.map(({ place, influences }, v) => {
    const skin = bySkin ? influences.map(({ joint, weight }) => `${joint}*${weight}`).join("+") : "";
    const key = `${place.map((x) => x + 0).join(" ")} ${skin}`; // + 0: -0 and 0 are one place
    if (!firstOf.has(key)) firstOf.set(key, v);
    return firstOf.get(key)!;
  });
  const triangles: number[] = [];
  const cornerPlaces: number[] = [];
  for (let t = 0; t < surface.triangles.length; t += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => first[surface.triangles[t + k]!]!) as [number, number, number];
    if (a === b || b === c || c === a) continue;
    triangles.push(a, b, c);
    cornerPlaces.push(...surface.cornerPlaces.slice(2 * t, 2 * t + 6));
  }
  const used = new Set(triangles);
  const vertices: Vertex[] = [];
  const place = new Map<number, number>();
  surface.vertices.forEach((vertex, v) => {
    if (!used.has(v)) return;
    place.set(v, vertices.length);
    vertices.push(vertex);
  });
  return { vertices, triangles: triangles.map((v) => place.get(v)!), cornerPlaces };
}

function merged(parts: Part[], bySkin: boolean): Surface {
  const sum: Surface = { vertices: [], triangles: [], cornerPlaces: [] };
  const hasPlaces = parts.some((part) => part.cornerPlaces.length > 0);
  for (const part of parts.map((one) => welded(one, true))) {
    const offset = sum.vertices.length;
    sum.vertices.push(...part.vertices);
    sum.triangles.push(...part.triangles.map((v) => v + offset));
    const places = part.cornerPlaces.length > 0 ? part.cornerPlaces : part.triangles.flatMap(() => [0, 0]);
    if (hasPlaces) sum.cornerPlaces.push(...places);
  }
  return welded(sum, bySkin);
}

/** Where the bones have the nodes in the model's rest pose [m]. */
function restPositions(surface: Surface, model: Model, world: Matrix4): Float64Array {
  const joints = model.joints.map((joint) => world.clone().multiply(joint));
  const rest = new Float64Array(3 * surface.vertices.length);
  surface.vertices.forEach(({ place, influences }, v) => {
    const sum = new Vector3();
    for (const { joint, weight } of influences) {
      sum.addScaledVector(new Vector3(...place).applyMatrix4(joints[joint]!), weight);
    }
    sum.toArray(rest, 3 * v);
  });
  return rest;
}

function worldOf(character: TomlTable): Matrix4 {
  const quaternion = table(character["orientation"])?.["quaternion"];
  const [w = 1, x = 0, y = 0, z = 0] = Array.isArray(quaternion) ? quaternion.map((q) => quantity(q)) : [];
  const scale = quantity(character["scale"], 1);
  return new Matrix4().compose(new Vector3(...vector(character["position"])), new Quaternion(x, y, z, w).normalize(), new Vector3(scale, scale, scale));
}

function sceneName(character: string, part: string): string {
  return `${character}-${part}`.replace(/[^A-Za-z0-9_-]/g, "_");
}

/** Of every cloth and skin of a character, by its name. */
export function characterMeshes(character: TomlTable): Map<string, ClothMesh> {
  const meshes = new Map<string, ClothMesh>();
  const file = text(character["file"]);
  const model = readModel(fromBase64(file.slice(file.indexOf(",") + 1)));
  const world = worldOf(character);
  const taken = new Set<Part>();
  const add = (name: string, parts: Part[], entry: TomlTable | null): void => {
    const surface = merged(parts, entry === null);
    const body = surfaceBody(
      {
        rest: restPositions(surface, model, world),
        triangles: Uint32Array.from(surface.triangles),
        cornerPlaces: Float32Array.from(surface.cornerPlaces),
      },
      entry ?? {},
      {},
    );
    meshes.set(name, entry ? body : asSkin(body));
  };
  const take = (wanted: string): Part[] => {
    const key = (["node", "mesh", "material"] as const).find((k) => model.parts.some((part) => part[k] === wanted));
    const parts = model.parts.filter((part) => key && part[key] === wanted);
    for (const part of parts) taken.add(part);
    return parts;
  };
  for (const entry of tables(character["cloth"])) {
    const parts = take(text(entry["part"]));
    if (parts.length > 0) add(text(entry["name"]), parts, entry);
    // The page shows the simulated cloth, so what Weft draws in its place is no skin either.
    const drawn = table(entry["drawn_mesh"]);
    if (drawn) take(text(drawn["part"]));
  }
  for (const node of new Set(model.parts.map((part) => part.node))) {
    const group = model.parts.filter((part) => part.node === node && !taken.has(part));
    if (group.length > 0) add(`${sceneName(text(character["name"]), node)}-skin`, group, null);
  }
  return meshes;
}
