// Points, lines and arrows of a frame, as balls, rods and rods with a tip.
import { ConeGeometry, CylinderGeometry, Group, InstancedMesh, Matrix4, MeshStandardMaterial, Quaternion, SphereGeometry, Vector3, type BufferGeometry } from "three";

import type { Mark } from "../files/marks";

// As in playback/rendering/meshes/mark_mesh.cpp, in radii of a point.
const ROD_RADIUS = 0.4;
const TIP_RADIUS = 1.1;
const TIP_LENGTH = 3.5;
const LONGEST_TIP = 0.5; // of an arrow
const UP = new Vector3(0, 1, 0);

/** Stands a body of length 1 along y, around its middle, between two places. */
function between(from: Vector3, to: Vector3, radius: number): Matrix4 {
  const way = to.clone().sub(from);
  const turn = new Quaternion().setFromUnitVectors(UP, way.clone().normalize());
  const middle = from.clone().add(to).multiplyScalar(0.5);
  return new Matrix4().compose(middle, turn, new Vector3(radius, way.length(), radius));
}

export class MarkView {
  readonly group = new Group();
  private readonly ball = new SphereGeometry(1, 10, 8);
  private readonly rod = new CylinderGeometry(1, 1, 1, 8);
  private readonly tip = new ConeGeometry(1, 1, 10);

  /** radius: of a point [m]. */
  constructor(private readonly radius: number) {}

  show(marks: Mark[], origin: readonly number[]): void {
    this.clear();
    for (const mark of marks) this.add(mark, origin);
  }

  dispose(): void {
    this.clear();
    for (const geometry of [this.ball, this.rod, this.tip]) geometry.dispose();
  }

  private clear(): void {
    for (const part of this.group.children as InstancedMesh[]) {
      (part.material as MeshStandardMaterial).dispose();
      part.dispose();
    }
    this.group.clear();
  }

  private add(mark: Mark, origin: readonly number[]): void {
    const balls: Matrix4[] = [];
    const rods: Matrix4[] = [];
    const tips: Matrix4[] = [];
    const place = (values: Float32Array, i: number): Vector3 =>
      new Vector3(values[i]! - origin[0]!, values[i + 1]! - origin[1]!, values[i + 2]! - origin[2]!);
    for (let i = 0; i + 2 < mark.from.length; i += 3) {
      const from = place(mark.from, i);
      if (!Number.isFinite(from.length())) continue;
      if (mark.kind === "points") {
        balls.push(new Matrix4().compose(from, new Quaternion(), new Vector3().setScalar(this.radius)));
        continue;
      }
      const to = place(mark.to, i);
      const length = to.distanceTo(from);
      // A force of zero has no direction.
      if (!Number.isFinite(length) || length < 1e-3 * this.radius) continue;
      const tip = mark.kind === "arrows" ? Math.min(TIP_LENGTH * this.radius, LONGEST_TIP * length) : 0;
      const neck = to.clone().lerp(from, tip / length);
      rods.push(between(from, neck, ROD_RADIUS * this.radius));
      if (tip > 0) tips.push(between(neck, to, (TIP_RADIUS * tip) / TIP_LENGTH));
    }
    const put = (geometry: BufferGeometry, matrices: Matrix4[]): void => {
      if (matrices.length === 0) return;
      const part = new InstancedMesh(geometry, new MeshStandardMaterial({ color: mark.colour, roughness: 0.7 }), matrices.length);
      part.frustumCulled = false;
      matrices.forEach((matrix, i) => part.setMatrixAt(i, matrix));
      this.group.add(part);
    };
    put(this.ball, balls);
    put(this.rod, rods);
    put(this.tip, tips);
  }
}
