// Draws a world into a plain canvas: with WebGL, or without it as flat triangles from far to near.
import { Color, Mesh, MeshLambertMaterial, SRGBColorSpace, Vector3, WebGLRenderer } from "three";

import type { World } from "./distance_world";

/** One for all views: browsers allow few contexts. null: there is no WebGL; undefined: not asked yet. */
let shared: WebGLRenderer | null | undefined;

function renderer(): WebGLRenderer | null {
  if (shared === undefined) {
    // Asked first, since three.js complains on the console where there is none.
    const canvas = document.createElement("canvas");
    const context = canvas.getContext("webgl2", { antialias: true, alpha: true });
    shared = context ? new WebGLRenderer({ canvas, context, antialias: true, alpha: true }) : null;
    shared?.setClearColor(0, 0);
  }
  return shared;
}

export function hasWebGL(): boolean {
  return renderer() !== null;
}

interface Face {
  depth: number;
  points: number[]; // x y of three corners [pixels]
  colour: string;
}

const LIGHT = new Vector3(0.3, 0.9, 0.45).normalize();

/** behind: [m] by which a mesh is taken for farther away, so that what lies on it stays in front. */
function addFaces(
  faces: Face[],
  mesh: Mesh,
  world: World,
  width: number,
  height: number,
  behind: number,
): void {
  const position = mesh.geometry.getAttribute("position");
  const colours = mesh.geometry.getAttribute("color");
  const index = mesh.geometry.getIndex();
  const own = (mesh.material as MeshLambertMaterial).color;
  const count = index ? index.count : position.count;
  const corners = [new Vector3(), new Vector3(), new Vector3()];
  const [a, b, c] = corners as [Vector3, Vector3, Vector3];
  const normal = new Vector3();
  const colour = new Color();
  const inverse = world.camera.matrixWorldInverse;
  for (let i = 0; i + 2 < count; i += 3) {
    const nodes = [0, 1, 2].map((k) => (index ? index.getX(i + k) : i + k));
    corners.forEach((corner, k) => {
      corner.fromBufferAttribute(position, nodes[k] ?? 0).applyMatrix4(mesh.matrixWorld);
    });
    normal.copy(b).sub(a).cross(corners[2]?.clone().sub(a) ?? c).normalize();
    const shade = 0.72 + 0.28 * Math.abs(normal.dot(LIGHT));
    colour.copy(own);
    if (colours) {
      const mean = (channel: number): number =>
        nodes.reduce((sum, node) => sum + colours.getComponent(node, channel), 0) / 3;
      colour.setRGB(mean(0), mean(1), mean(2));
    }
    colour.multiplyScalar(shade);
    const depth = corners.reduce((sum, corner) => sum + corner.clone().applyMatrix4(inverse).z / 3, -behind);
    const points = corners.flatMap((corner) => {
      corner.project(world.camera);
      return [(0.5 + 0.5 * corner.x) * width, (0.5 - 0.5 * corner.y) * height];
    });
    if (points.every(Number.isFinite)) faces.push({ depth, points, colour: colour.getStyle(SRGBColorSpace) });
  }
}

function paintFlat(world: World, target: CanvasRenderingContext2D, width: number, height: number): void {
  world.camera.updateMatrixWorld();
  const faces: Face[] = [];
  for (const body of world.bodies) addFaces(faces, body, world, width, height, 0.2 * world.radius);
  addFaces(faces, world.cloth, world, width, height, 0);
  faces.sort((p, q) => p.depth - q.depth);
  target.lineWidth = 1;
  target.lineJoin = "round";
  for (const { points, colour } of faces) {
    const [ax = 0, ay = 0, bx = 0, by = 0, cx = 0, cy = 0] = points;
    target.beginPath();
    target.moveTo(ax, ay);
    target.lineTo(bx, by);
    target.lineTo(cx, cy);
    target.closePath();
    target.fillStyle = colour;
    target.strokeStyle = colour; // closes the hairlines between neighbours
    target.fill();
    target.stroke();
  }
}

/** Draws over the whole canvas, whose size is in device pixels. */
export function paintWorld(world: World, canvas: HTMLCanvasElement): void {
  const target = canvas.getContext("2d");
  const { width, height } = canvas;
  if (!target || width === 0 || height === 0) return;
  world.camera.aspect = width / height;
  world.camera.updateProjectionMatrix();
  target.clearRect(0, 0, width, height);
  const gl = renderer();
  if (!gl) return paintFlat(world, target, width, height);
  gl.setSize(width, height, false);
  gl.render(world.scene, world.camera);
  target.drawImage(gl.domElement, 0, 0);
}
