// The surfaces of a rigged glTF 2.0 model, as characters/gltf_*.cpp reads them. The model comes out of a recording, whose
// writer has checked it.
import { Matrix4, Quaternion, Vector3 } from "three";

import { fromBase64, view } from "./bytes";

/** A bone and its bind matrix, which a vertex follows with a weight. */
export interface Influence {
  joint: number; // in Model.joints
  weight: number;
}

export interface Vertex {
  place: [number, number, number];
  influences: Influence[];
}

/** A list of triangles with one material. */
export interface Part {
  node: string;
  mesh: string;
  material: string;
  vertices: Vertex[];
  triangles: number[];
  /** Two for each corner of each triangle; empty: none. */
  cornerPlaces: number[];
}

export interface Model {
  parts: Part[];
  /** At rest, in the model's frame: bone times inverse bind matrix. */
  joints: Matrix4[];
}

type Json = { [key: string]: any };

const MAGIC = 0x46546c67;
const BINARY_CHUNK = 0x004e4942;
const SIZES: Record<string, number> = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16 };
const TRIANGLES = 4;

class Document {
  readonly root: Json;
  private readonly buffers: Uint8Array[];

  constructor(bytes: Uint8Array) {
    const words = view(bytes);
    let text = bytes;
    let binary = new Uint8Array();
    if (words.getUint32(0, true) === MAGIC) {
      const length = words.getUint32(12, true);
      text = bytes.subarray(20, 20 + length);
      const next = 20 + length;
      if (next + 8 <= bytes.length && words.getUint32(next + 4, true) === BINARY_CHUNK) {
        binary = bytes.slice(next + 8, next + 8 + words.getUint32(next, true));
      }
    }
    this.root = JSON.parse(new TextDecoder().decode(text)) as Json;
    this.buffers = (this.root["buffers"] ?? []).map((buffer: Json) => {
      const uri = buffer["uri"] as string | undefined;
      return uri === undefined ? binary : fromBase64(uri.slice(uri.indexOf(",") + 1));
    });
  }

  /** One array for each element. */
  accessor(index: number): number[][] {
    const accessor = this.root["accessors"][index] as Json;
    const bufferView = this.root["bufferViews"][accessor["bufferView"]] as Json;
    const words = view(this.buffers[bufferView["buffer"]]!);
    const [read, size, largest] = this.reader(words, accessor["componentType"]);
    const rows = SIZES[accessor["type"] as string]!;
    const stride = (bufferView["byteStride"] as number | undefined) ?? rows * size;
    const begin = (bufferView["byteOffset"] ?? 0) + (accessor["byteOffset"] ?? 0);
    return Array.from({ length: accessor["count"] as number }, (_, i) =>
      Array.from({ length: rows }, (_, r) => {
        const value = read(begin + i * stride + r * size);
        return accessor["normalized"] === true && largest > 0 ? Math.max(value / largest, -1) : value;
      }),
    );
  }

  private reader(words: DataView, component: number): [(at: number) => number, number, number] {
    switch (component) {
      case 5120:
        return [(at) => words.getInt8(at), 1, 127];
      case 5121:
        return [(at) => words.getUint8(at), 1, 255];
      case 5122:
        return [(at) => words.getInt16(at, true), 2, 32767];
      case 5123:
        return [(at) => words.getUint16(at, true), 2, 65535];
      case 5125:
        return [(at) => words.getUint32(at, true), 4, 0];
      case 5126:
        return [(at) => words.getFloat32(at, true), 4, 0];
      default:
        throw new Error(`a model has numbers of the unknown kind ${component}`);
    }
  }
}

interface Bone {
  node: number;
  frame: Matrix4; // at rest, in the model
}

function localMatrix(node: Json): Matrix4 {
  if (node["matrix"]) return new Matrix4().fromArray(node["matrix"]);
  const turn = new Quaternion(...((node["rotation"] ?? [0, 0, 0, 1]) as [number, number, number, number])).normalize();
  const place = new Vector3(...((node["translation"] ?? [0, 0, 0]) as [number, number, number]));
  return new Matrix4().compose(place, turn, new Vector3(...((node["scale"] ?? [1, 1, 1]) as [number, number, number])));
}

/** Nodes of the scene, each before those below it. */
function readBones(document: Document): Bone[] {
  const { root } = document;
  const bones: Bone[] = [];
  const waiting: { node: number; above: Matrix4 }[] = [];
  const push = (nodes: number[], above: Matrix4): void => {
    for (const node of [...nodes].reverse()) waiting.push({ node, above });
  };
  push(root["scenes"][root["scene"] ?? 0]["nodes"] ?? [], new Matrix4());
  for (let next = waiting.pop(); next; next = waiting.pop()) {
    const node = root["nodes"][next.node] as Json;
    const frame = next.above.clone().multiply(localMatrix(node));
    bones.push({ node: next.node, frame });
    push(node["children"] ?? [], frame);
  }
  return bones;
}

/** Gives each bone with its bind matrix one number for the whole model. */
class Joints {
  readonly matrices: Matrix4[] = [];
  private readonly known = new Map<string, number>();
  constructor(private readonly bones: Bone[]) {}

  number(bone: number, inverseBind: Matrix4): number {
    const key = `${bone} ${inverseBind.elements.join(" ")}`;
    let number = this.known.get(key);
    if (number === undefined) {
      number = this.matrices.length;
      this.known.set(key, number);
      this.matrices.push(this.bones[bone]!.frame.clone().multiply(inverseBind));
    }
    return number;
  }
}

function readInfluences(document: Document, attributes: Json, skin: number[], vertices: number): Influence[][] {
  const sets: [number[][], number[][]][] = [];
  for (let set = 0; attributes[`JOINTS_${set}`] !== undefined; ++set) {
    sets.push([document.accessor(attributes[`JOINTS_${set}`]), document.accessor(attributes[`WEIGHTS_${set}`])]);
  }
  return Array.from({ length: vertices }, (_, v) => {
    const influences = sets.flatMap(([joints, weights]) =>
      joints[v]!.map((joint, k) => ({ joint: skin[joint]!, weight: weights[v]![k]! })),
    );
    const own = influences.filter(({ weight }) => weight !== 0);
    const sum = own.reduce((total, { weight }) => total + weight, 0);
    return own.map(({ joint, weight }) => ({ joint, weight: weight / sum }));
  });
}

export function readModel(bytes: Uint8Array): Model {
  const document = new Document(bytes);
  const { root } = document;
  const bones = readBones(document);
  const joints = new Joints(bones);
  const boneOf = new Map(bones.map(({ node }, b) => [node, b]));
  const parts: Part[] = [];
  for (const [b, { node: index }] of bones.entries()) {
    const node = root["nodes"][index] as Json;
    if (node["mesh"] === undefined) continue;
    const mesh = root["meshes"][node["mesh"]] as Json;
    let skin = [joints.number(b, new Matrix4())];
    if (node["skin"] !== undefined) {
      const entry = root["skins"][node["skin"]] as Json;
      const binds = entry["inverseBindMatrices"] === undefined ? [] : document.accessor(entry["inverseBindMatrices"]);
      skin = (entry["joints"] as number[]).map((joint, j) => {
        const bind = binds[j] ? new Matrix4().fromArray(binds[j]) : new Matrix4();
        return joints.number(boneOf.get(joint)!, bind);
      });
    }
    for (const primitive of mesh["primitives"] as Json[]) {
      if ((primitive["mode"] ?? TRIANGLES) !== TRIANGLES) continue;
      const attributes = primitive["attributes"] as Json;
      const places = document.accessor(attributes["POSITION"]) as [number, number, number][];
      const influences =
        node["skin"] === undefined
          ? places.map(() => [{ joint: skin[0]!, weight: 1 }])
          : readInfluences(document, attributes, skin, places.length);
      const triangles =
        primitive["indices"] === undefined ? places.map((_, i) => i) : document.accessor(primitive["indices"]).flat();
      const pictures = attributes["TEXCOORD_0"] === undefined ? [] : document.accessor(attributes["TEXCOORD_0"]);
      parts.push({
        node: (node["name"] as string | undefined) ?? `node_${index}`,
        mesh: (mesh["name"] as string | undefined) ?? `mesh_${node["mesh"]}`,
        material: (root["materials"]?.[primitive["material"]]?.["name"] as string | undefined) ?? "",
        vertices: places.map((place, v) => ({ place, influences: influences[v]! })),
        triangles,
        cornerPlaces: pictures.length === 0 ? [] : triangles.flatMap((v) => [pictures[v]![0]!, 1 - pictures[v]![1]!]),
      });
    }
  }
  return { parts, joints: joints.matrices };
}
