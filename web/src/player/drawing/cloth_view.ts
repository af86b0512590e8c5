// A cloth in the 3D scene: both sides, wires, strain.
import {
  BackSide,
  BufferAttribute,
  BufferGeometry,
  Color,
  DoubleSide,
  DynamicDrawUsage,
  FrontSide,
  Group,
  Mesh,
  MeshBasicMaterial,
  MeshStandardMaterial,
  Points,
  PointsMaterial,
  SRGBColorSpace,
  type Material,
} from "three";

import type { ClothMesh } from "../meshes/cloth_mesh";
import { divergingColour } from "./diverging";
import type { Paint } from "./paint";
import type { Topology } from "../files/recording";
import { nodeStrain, springsOf, type Springs } from "./strain";
import { tube } from "../meshes/tube";

export interface Look {
  strain: boolean;
  wires: boolean;
  /** [-] at the ends of the strain's scale. */
  strainRange: number;
  /** In place of the front's own colour: that of the recording among several. */
  tint: Color | null;
}

const ROPE_SIDES = 10;

export class ClothView {
  readonly group = new Group();
  private readonly geometry = new BufferGeometry();
  private readonly front: MeshStandardMaterial;
  private readonly back: MeshStandardMaterial;
  private readonly scalar = new MeshStandardMaterial({ vertexColors: true, side: DoubleSide, roughness: 1 });
  private readonly paper = new MeshStandardMaterial({ side: DoubleSide, roughness: 1 });
  private readonly wire = new MeshBasicMaterial({ wireframe: true });
  private readonly meshes: Record<"front" | "back" | "scalar" | "paper" | "wire", Mesh>;
  private readonly points: Points<BufferGeometry, PointsMaterial> | null = null;
  private shown: Topology | null | undefined;
  private springs: Springs | null = null;
  private nodeOf = new Uint32Array(); // of each vertex
  private triangles = new Uint32Array(); // of nodes

  constructor(
    readonly mesh: ClothMesh | null,
    private readonly paint: Paint,
    /** [m] */
    private readonly ropeRadius: number,
  ) {
    const isRope = mesh !== null && mesh.triangles.length === 0;
    const common = { roughness: 0.85, metalness: 0, flatShading: paint.isFlat };
    this.front = new MeshStandardMaterial({ ...common, side: isRope ? DoubleSide : FrontSide });
    this.back = new MeshStandardMaterial({ ...common, side: BackSide });
    for (const material of [this.front, this.back, this.scalar, this.paper]) {
      Object.assign(material, { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
    }
    const make = (material: Material): Mesh => {
      const part = new Mesh(this.geometry, material);
      part.frustumCulled = false;
      part.castShadow = part.receiveShadow = true;
      this.group.add(part);
      return part;
    };
    this.meshes = {
      front: make(this.front),
      back: make(this.back),
      scalar: make(this.scalar),
      paper: make(this.paper),
      wire: make(this.wire),
    };
    this.meshes.wire.castShadow = false;
    if (!mesh) {
      this.points = new Points(this.geometry, new PointsMaterial({ size: 3, sizeAttenuation: false }));
      this.points.frustumCulled = false;
      this.group.add(this.points);
    }
    this.group.visible = paint.isVisible;
  }

  /** Springs and their lengths in the cloth as it is now; null where the scene does not say. */
  strainOf(positions: ArrayLike<number>): Float64Array | null {
    return this.springs && nodeStrain(this.springs, positions);
  }

  dispose(): void {
    this.geometry.dispose();
    this.paint.picture?.dispose();
    for (const material of [this.front, this.back, this.scalar, this.paper, this.wire]) material.dispose();
  }

  /** Moves to a frame; origin [m] is taken off in double precision. */
  pose(positions: ArrayLike<number>, topology: Topology | null, origin: readonly number[]): void {
    if (this.shown === undefined || this.shown !== topology) this.adopt(topology, positions.length / 3);
    const isRope = this.mesh !== null && this.triangles.length === 0;
    if (isRope) return tube(this.geometry, positions, origin, this.ropeRadius, ROPE_SIDES);
    const place = this.geometry.getAttribute("position") as BufferAttribute;
    const to = place.array as Float32Array;
    for (let v = 0; v < this.nodeOf.length; ++v) {
      const from = 3 * this.nodeOf[v]!;
      for (let k = 0; k < 3; ++k) to[3 * v + k] = positions[from + k]! - origin[k]!;
    }
    place.needsUpdate = true;
    if (this.mesh) this.shade(to);
  }

  look(look: Look, positions: ArrayLike<number>): void {
    const strain = look.strain ? this.strainOf(positions) : null;
    const hasSurface = this.mesh !== null;
    const plain = hasSurface && !strain && !look.wires;
    this.meshes.front.visible = this.meshes.back.visible = plain;
    this.meshes.scalar.visible = strain !== null;
    this.meshes.paper.visible = hasSurface && look.wires && !strain;
    this.meshes.wire.visible = hasSurface && look.wires;
    const picture = look.tint ? null : this.paint.picture;
    for (const [material, own, map] of [
      [this.front, this.paint.front, picture],
      [this.back, this.paint.back, this.paint.pictureOnBack ? picture : null],
    ] as const) {
      if (material.map !== map) material.needsUpdate = true;
      material.map = map;
      material.color.copy(map ? new Color(material === this.back ? 0xd8d4cc : 0xffffff) : own);
    }
    if (look.tint) {
      this.front.color.copy(look.tint);
      this.back.color.copy(look.tint).lerp(new Color(0xffffff), 0.45);
    }
    this.paper.color.set(0xe4e4e0);
    this.wire.color.copy(strain ? new Color(0x2a2e34) : (look.tint ?? this.paint.front));
    this.wire.transparent = strain !== null;
    this.wire.opacity = strain ? 0.35 : 1;
    this.points?.material.color.copy(look.tint ?? this.paint.front);
    if (strain) this.colour(strain, look.strainRange);
  }

  private colour(strain: Float64Array, range: number): void {
    let colours = this.geometry.getAttribute("color") as BufferAttribute | undefined;
    const vertices = this.geometry.getAttribute("position").count;
    if (!colours || colours.count !== vertices) {
      colours = new BufferAttribute(new Float32Array(3 * vertices), 3).setUsage(DynamicDrawUsage);
      this.geometry.setAttribute("color", colours);
    }
    const colour = new Color();
    const perNode = this.nodeOf.length > 0 ? 1 : ROPE_SIDES + 1;
    for (let v = 0; v < vertices; ++v) {
      const node = this.nodeOf.length > 0 ? this.nodeOf[v]! : Math.floor(v / perNode);
      const [r, g, b] = divergingColour(strain[node]! / range);
      colour.setRGB(r / 255, g / 255, b / 255, SRGBColorSpace);
      colours.setXYZ(v, colour.r, colour.g, colour.b);
    }
    colours.needsUpdate = true;
  }

  /** Makes vertices and triangles for what the cloth consists of from now on. */
  private adopt(topology: Topology | null, nodes: number): void {
    this.shown = topology;
    const mesh = this.mesh;
    this.triangles = mesh ? ((topology?.triangles ?? mesh.triangles) as Uint32Array<ArrayBuffer>) : new Uint32Array();
    this.springs = mesh && springsOf(mesh, topology);
    for (const name of Object.keys(this.geometry.attributes)) this.geometry.deleteAttribute(name);
    if (mesh && this.triangles.length === 0) return;
    const index = this.layOut(nodes, topology);
    this.geometry.setIndex(mesh ? new BufferAttribute(index, 1) : null);
    const array = (): BufferAttribute =>
      new BufferAttribute(new Float32Array(3 * this.nodeOf.length), 3).setUsage(DynamicDrawUsage);
    this.geometry.setAttribute("position", array());
    this.geometry.setAttribute("normal", array());
  }

  /** Vertices: one for each node, or one for each node and place in the picture where the picture has seams. */
  private layOut(nodes: number, topology: Topology | null): Uint32Array<ArrayBuffer> {
    const mesh = this.mesh;
    const corners = mesh && this.paint.picture ? mesh.cornerPlaces : new Float32Array();
    if (corners.length === 0 || corners.length !== 2 * this.triangles.length) {
      this.nodeOf = Uint32Array.from({ length: nodes }, (_, i) => i);
      if (mesh && this.paint.picture) this.setPlaces(mesh, topology, nodes);
      return this.triangles as Uint32Array<ArrayBuffer>;
    }
    const known = new Map<string, number>();
    const nodeOf: number[] = [];
    const places: number[] = [];
    const index = this.triangles.map((node, corner) => {
      const key = `${node} ${corners[2 * corner]} ${corners[2 * corner + 1]}`;
      let vertex = known.get(key);
      if (vertex === undefined) {
        vertex = nodeOf.length;
        known.set(key, vertex);
        nodeOf.push(node);
        places.push(corners[2 * corner]!, corners[2 * corner + 1]!);
      }
      return vertex;
    });
    this.nodeOf = Uint32Array.from(nodeOf);
    this.geometry.setAttribute("uv", new BufferAttribute(new Float32Array(places), 2));
    return index as Uint32Array<ArrayBuffer>;
  }

  private setPlaces(mesh: ClothMesh, topology: Topology | null, nodes: number): void {
    const first = mesh.rest.length / 3;
    const places = new Float32Array(2 * nodes);
    const centre = [0, 1, 2].map((k) => {
      let sum = 0;
      for (let i = k; i < mesh.rest.length; i += 3) sum += mesh.rest[i]!;
      return sum / first;
    });
    for (let node = 0; node < nodes; ++node) {
      const origin = node < first ? node : (topology?.origins[node - first] ?? 0);
      if (mesh.nodePlaces.length > 0) {
        places.set(mesh.nodePlaces.subarray(2 * origin, 2 * origin + 2), 2 * node);
        continue;
      }
      places.set(placeByDirection([0, 1, 2].map((k) => mesh.rest[3 * origin + k]! - centre[k]!), this.paint.isEyeball), 2 * node);
    }
    this.geometry.setAttribute("uv", new BufferAttribute(places, 2));
  }

  /** Normals by node, so that a seam of the picture is none of the surface. */
  private shade(positions: Float32Array): void {
    const index = this.geometry.getIndex()?.array;
    const normals = this.geometry.getAttribute("normal") as BufferAttribute;
    if (!index) return;
    const sums = new Float32Array(positions.length);
    for (let i = 0; i + 2 < index.length; i += 3) {
      const [a, b, c] = [3 * index[i]!, 3 * index[i + 1]!, 3 * index[i + 2]!];
      const ux = positions[b]! - positions[a]!;
      const uy = positions[b + 1]! - positions[a + 1]!;
      const uz = positions[b + 2]! - positions[a + 2]!;
      const vx = positions[c]! - positions[a]!;
      const vy = positions[c + 1]! - positions[a + 1]!;
      const vz = positions[c + 2]! - positions[a + 2]!;
      const [nx, ny, nz] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
      if (!Number.isFinite(nx + ny + nz)) continue;
      for (let k = 0; k < 3; ++k) {
        const node = 3 * this.nodeOf[index[i + k]!]!;
        sums[node]! += nx;
        sums[node + 1]! += ny;
        sums[node + 2]! += nz;
      }
    }
    for (let v = 0; v < this.nodeOf.length; ++v) {
      const at = 3 * this.nodeOf[v]!;
      const length = Math.hypot(sums[at]!, sums[at + 1]!, sums[at + 2]!) || 1;
      normals.setXYZ(v, sums[at]! / length, sums[at + 1]! / length, sums[at + 2]! / length);
    }
    normals.needsUpdate = true;
  }
}

/** Place in the picture of a closed body without coordinates: longitude and latitude, or for an eye the angle from its axis. */
function placeByDirection(direction: number[], isEyeball: boolean): [number, number] {
  const length = Math.hypot(...direction) || 1;
  const [x = 0, y = 0, z = 0] = direction.map((c) => c / length);
  if (!isEyeball) return [Math.atan2(x, z) / (2 * Math.PI) + 0.5, Math.asin(y) / Math.PI + 0.5];
  const across = Math.max(Math.hypot(x, y), 1e-6);
  const turn = Math.acos(Math.min(Math.max(z, -1), 1)) / Math.PI;
  return [0.5 + (0.5 * x * turn) / across, 0.5 + (0.5 * y * turn) / across];
}
