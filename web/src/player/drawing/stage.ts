// The 3D scene of one recording.
import {
  Box3,
  Color,
  DirectionalLight,
  FrontSide,
  HemisphereLight,
  Mesh,
  MeshStandardMaterial,
  Quaternion,
  Scene,
  Vector3,
  BufferAttribute,
  type BufferGeometry,
} from "three";
import type { TomlTable } from "smol-toml";

import { boundsOf } from "./bounds";
import { ClothView, type Look } from "./cloth_view";
import type { Exhibit } from "../exhibit";
import { Ground } from "./ground";
import { MarkView } from "./mark_view";
import { bodyPaint, clothPaint, colourOf, type Paint } from "./paint";
import { clothEntry, quantity, text } from "../scene";
import { shapeGeometry } from "../meshes/shape_geometry";

/** Obstacles are drawn 0.2 % smaller: between its nodes a cloth is flat, and a ball would shine through it. */
const BODY_SCALE = 0.998;
const SHADOW_PIXELS = 2048;
/** A point that a program has drawn has this radius, in radii of the scene. */
const POINT_RADIUS = 0.009;

/** Octants in two colours. */
function paintOctants(geometry: BufferGeometry, paint: Paint): BufferGeometry {
  const split = geometry.toNonIndexed();
  const place = split.getAttribute("position");
  const colours = new Float32Array(3 * place.count);
  for (let v = 0; v < place.count; v += 3) {
    const middle = [0, 1, 2].map((axis) => [0, 1, 2].reduce((sum, k) => sum + place.getComponent(v + k, axis), 0));
    const colour = middle[0]! * middle[1]! * middle[2]! > 0 ? paint.front : paint.back;
    for (let k = 0; k < 3; ++k) colour.toArray(colours, 3 * (v + k));
  }
  split.setAttribute("color", new BufferAttribute(colours, 3));
  return split;
}

function bodyMesh(geometry: BufferGeometry, paint: Paint): Mesh {
  const material = new MeshStandardMaterial({
    color: paint.picture || paint.isTwoTone ? 0xffffff : paint.front,
    map: paint.picture,
    vertexColors: paint.isTwoTone,
    roughness: 0.6,
    flatShading: paint.isFlat,
    side: FrontSide,
    shadowSide: FrontSide,
  });
  const mesh = new Mesh(paint.isTwoTone ? paintOctants(geometry, paint) : geometry, material);
  mesh.castShadow = mesh.receiveShadow = true;
  mesh.visible = paint.isVisible;
  mesh.scale.setScalar(BODY_SCALE);
  return mesh;
}

export class Stage {
  readonly scene = new Scene();
  readonly cloths: ClothView[] = [];
  readonly bounds: Box3;
  /** [m], what everything is drawn relative to. */
  readonly origin: Vector3;
  /** [m] */
  readonly radius: number;
  /** Moves with the body that the camera follows. */
  readonly shift = new Vector3();
  private readonly bodies: (Mesh | null)[];
  private readonly ground: Ground | null;
  private readonly marks: MarkView;
  private readonly sun = new DirectionalLight(0xfff6ea, 2.1);
  private readonly sky = new HemisphereLight(0xffffff, 0xb8b4ae, 1.35);
  private followed: { isCloth: boolean; index: number; start: Vector3 } | null = null;
  private shown = -1;

  constructor(
    readonly exhibit: Exhibit,
    private readonly loaded: () => void,
    /** Of another stage that the same camera sees; null: the middle of this one. */
    sharedOrigin: Vector3 | null,
  ) {
    const { recording, scene } = exhibit;
    const entries = recording.bodies.filter((b) => !b.isCloth).map((b) => scene.colliders.get(b.name) ?? {});
    const geometries = entries.map(shapeGeometry);
    this.bounds = boundsOf(recording, geometries);
    this.origin = sharedOrigin ?? this.bounds.getCenter(new Vector3());
    this.radius = Math.max(this.bounds.getSize(new Vector3()).length() / 2, 1e-6);
    this.addCloths();
    this.bodies = geometries.map((geometry, r) => {
      const mesh = geometry && bodyMesh(geometry, bodyPaint(entries[r] ?? {}, recording.assets, loaded));
      if (mesh) this.scene.add(mesh);
      return mesh;
    });
    this.ground = this.makeGround(entries);
    this.marks = new MarkView(POINT_RADIUS * this.radius);
    this.scene.add(this.marks.group);
    this.addLights();
    this.findFollowed();
  }

  private addCloths(): void {
    const { recording, scene, meshes } = this.exhibit;
    const names = recording.bodies.filter((body) => body.isCloth).map((body) => body.name);
    names.forEach((name, c) => {
      const entry = clothEntry(scene, name);
      const rope = Math.max(quantity(entry["collision_margin"], 0.01), 0.004 * this.radius);
      const cloth = new ClothView(meshes[c] ?? null, clothPaint(entry, c, recording.assets, this.loaded), rope);
      this.cloths.push(cloth);
      this.scene.add(cloth.group);
    });
  }

  private makeGround(entries: TomlTable[]): Ground | null {
    const at = entries.findIndex((entry) => text(entry["shape"]) === "plane");
    const plane = entries[at];
    if (!plane) {
      const foot = new Vector3(0, this.bounds.min.y - 0.02 * this.radius - this.origin.y, 0);
      return this.addGround(new Ground(this.radius, null, foot, null));
    }
    if (plane["visible"] === false) return null;
    const pose = this.exhibit.recording.times.length > 0 ? this.exhibit.recording.frame(0).poses[at] : undefined;
    const [x = 0, y = 0, z = 0, i = 0, j = 0, k = 0, w = 1] = pose ?? [];
    const turn = new Quaternion(i, j, k, w);
    // The foot of the middle on the plane.
    const normal = new Vector3(0, 1, 0).applyQuaternion(turn);
    const height = normal.dot(this.origin.clone().sub(new Vector3(x, y, z)));
    return this.addGround(new Ground(this.radius, colourOf(plane), normal.multiplyScalar(-height), turn));
  }

  private addGround(ground: Ground): Ground {
    this.scene.add(ground.group);
    return ground;
  }

  private addLights(): void {
    const { position, target } = this.exhibit.scene.camera;
    const ahead = new Vector3(...target).sub(new Vector3(...position)).setY(0).normalize();
    const right = new Vector3().crossVectors(ahead, new Vector3(0, 1, 0)).normalize();
    const towards = new Vector3(0, 1, 0).addScaledVector(right, -0.8).addScaledVector(ahead, -0.25).normalize();
    this.sun.position.copy(towards).multiplyScalar(3 * this.radius);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(SHADOW_PIXELS, SHADOW_PIXELS);
    const reach = 1.15 * this.radius;
    Object.assign(this.sun.shadow.camera, { left: -reach, right: reach, top: reach, bottom: -reach });
    Object.assign(this.sun.shadow.camera, { near: 0.5 * this.radius, far: 6 * this.radius });
    this.sun.shadow.normalBias = 0.006 * this.radius;
    this.sun.shadow.bias = -0.0004;
    this.sun.shadow.radius = 4;
    const fill = new DirectionalLight(0xdfe8ff, 0.55);
    fill.position.copy(right).addScaledVector(ahead, -0.8).add(new Vector3(0, 0.3, 0)).multiplyScalar(this.radius);
    this.scene.add(this.sun, this.sun.target, fill, this.sky);
  }

  private findFollowed(): void {
    const { recording, scene } = this.exhibit;
    const name = scene.camera.follow;
    const at = recording.bodies.findIndex((body) => body.name === name);
    const body = recording.bodies[at];
    if (name === "" || !body || recording.times.length === 0) return;
    const index = recording.bodies.slice(0, at).filter((other) => other.isCloth === body.isCloth).length;
    this.followed = { isCloth: body.isCloth, index, start: new Vector3() };
    this.followed.start.copy(this.placeOfFollowed(0) ?? new Vector3());
  }

  private placeOfFollowed(frame: number): Vector3 | null {
    if (!this.followed) return null;
    const { isCloth, index } = this.followed;
    const data = this.exhibit.recording.frame(frame);
    const pose = data.poses[index];
    if (!isCloth) return pose ? new Vector3(pose[0], pose[1], pose[2]) : null;
    const positions = data.positions[index];
    if (!positions) return null;
    const sum = new Vector3();
    for (let i = 0; i < positions.length; i += 3) sum.add(new Vector3(positions[i], positions[i + 1], positions[i + 2]));
    return sum.multiplyScalar(3 / positions.length);
  }

  /** Moves everything to a frame. */
  pose(index: number, look: Look): void {
    const { recording } = this.exhibit;
    if (recording.times.length === 0) return;
    const frame = recording.frame(index);
    const origin = this.origin.toArray();
    this.cloths.forEach((cloth, c) => {
      const positions = frame.positions[c]!;
      if (index !== this.shown) cloth.pose(positions, recording.topology(c, index), origin);
      cloth.look(look, positions);
    });
    this.bodies.forEach((mesh, r) => {
      const pose = frame.poses[r];
      if (!mesh || !pose) return;
      const [x = 0, y = 0, z = 0, i = 0, j = 0, k = 0, w = 1] = pose;
      mesh.position.set(x - origin[0], y - origin[1], z - origin[2]);
      mesh.quaternion.set(i, j, k, w).normalize();
    });
    if (index !== this.shown) this.marks.show(recording.marks(index), origin);
    const place = this.placeOfFollowed(index);
    if (place && Number.isFinite(place.length())) this.shift.copy(place).sub(this.followed!.start);
    if (this.ground && this.followed) {
      this.ground.group.position.x = this.shift.x;
      this.ground.group.position.z = this.shift.z;
      this.sun.target.position.copy(this.shift);
    }
    this.shown = index;
  }

  setTheme(isDark: boolean): void {
    this.ground?.setTheme(isDark);
    this.sky.intensity = isDark ? 1.1 : 1.35;
    this.sky.groundColor = new Color(isDark ? 0x8a8884 : 0xb8b4ae);
  }

  dispose(): void {
    for (const cloth of this.cloths) cloth.dispose();
    for (const mesh of this.bodies) {
      mesh?.geometry.dispose();
      (mesh?.material as MeshStandardMaterial | undefined)?.map?.dispose();
      (mesh?.material as MeshStandardMaterial | undefined)?.dispose();
    }
    this.ground?.dispose();
    this.marks.dispose();
    this.sun.shadow.map?.dispose();
  }
}
