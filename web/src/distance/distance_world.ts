// A distance view as three.js sees it: cloth, bodies, light, camera. No drawing here.
import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  CapsuleGeometry,
  CircleGeometry,
  Color,
  ConeGeometry,
  CylinderGeometry,
  DirectionalLight,
  DoubleSide,
  FrontSide,
  HemisphereLight,
  Mesh,
  MeshLambertMaterial,
  PerspectiveCamera,
  Scene,
  SphereGeometry,
  SRGBColorSpace,
  Vector3,
} from "three";

import { colourAt } from "../colour_scale";
import type { DistanceView } from "./distance_data";

export interface World {
  scene: Scene;
  camera: PerspectiveCamera;
  target: Vector3;
  /** [m] of a ball around the cloth in all frames. */
  radius: number;
  cloth: Mesh<BufferGeometry, MeshLambertMaterial>;
  bodies: Mesh[];
  /** Moves everything to a frame. */
  pose: (frame: number) => void;
  /** Colours the cloth; distances and the end of the scale in [m]. */
  paint: (distances: Float64Array, highest: number) => void;
  /** Puts the camera back to where it started. */
  reset: () => void;
}

function bodyGeometry(shape: string, sizes: number[], extent: number): BufferGeometry | null {
  const [a = 1, b = 1, c = 1] = sizes;
  switch (shape) {
    case "sphere":
      return new SphereGeometry(a, 48, 32);
    case "box":
      return new BoxGeometry(a, b, c);
    case "plane":
      return new CircleGeometry(extent, 64).rotateX(-Math.PI / 2);
    case "capsule":
      return new CapsuleGeometry(a, b, 12, 32);
    case "cylinder":
      return new CylinderGeometry(a, a, b, 48);
    case "cone":
      return new ConeGeometry(a, b, 48);
    default:
      return null;
  }
}

interface Bounds {
  centre: Vector3;
  radius: number;
}

/** Of the cloth over all frames. */
function boundsOf(view: DistanceView): Bounds {
  const low = new Vector3(Infinity, Infinity, Infinity);
  const high = new Vector3(-Infinity, -Infinity, -Infinity);
  const place = new Vector3();
  for (const positions of view.positions) {
    for (let i = 0; i + 2 < positions.length; i += 3) {
      place.set(positions[i] ?? 0, positions[i + 1] ?? 0, positions[i + 2] ?? 0);
      if (!Number.isFinite(place.x + place.y + place.z)) continue;
      low.min(place);
      high.max(place);
    }
  }
  if (!(low.x <= high.x)) return { centre: new Vector3(), radius: 1 };
  return {
    centre: low.clone().add(high).multiplyScalar(0.5),
    radius: Math.max(high.distanceTo(low) / 2, 1e-6),
  };
}

/** Distance from the centre at which a camera that looks at it sees the cloth of every frame. */
function fittingDistance(
  view: DistanceView,
  centre: Vector3,
  towards: Vector3,
  camera: PerspectiveCamera,
): number {
  const slope = Math.tan((0.5 * camera.fov * Math.PI) / 180);
  const right = new Vector3(0, 1, 0).cross(towards).normalize();
  const up = towards.clone().cross(right);
  const place = new Vector3();
  let distance = 1e-6;
  for (const positions of view.positions) {
    for (let i = 0; i + 2 < positions.length; i += 3) {
      place.set(positions[i] ?? 0, positions[i + 1] ?? 0, positions[i + 2] ?? 0).sub(centre);
      const needed =
        Math.max(Math.abs(place.dot(up)), Math.abs(place.dot(right)) / camera.aspect) / slope +
        place.dot(towards);
      if (needed > distance) distance = needed; // false where a node is not finite
    }
  }
  return distance;
}

function clothMesh(view: DistanceView): World["cloth"] {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(3 * view.drawnNodes), 3));
  geometry.setAttribute("color", new BufferAttribute(new Float32Array(3 * view.drawnNodes), 3));
  geometry.setIndex(new BufferAttribute(view.triangles, 1));
  const mesh = new Mesh(geometry, new MeshLambertMaterial({ vertexColors: true, side: DoubleSide }));
  mesh.frustumCulled = false;
  return mesh;
}

export function makeWorld(view: DistanceView, aspect: number): World {
  const { centre, radius } = boundsOf(view);
  const scene = new Scene();
  // Mostly from all sides, so that a colour on the cloth is near that on the scale.
  scene.add(new HemisphereLight(0xffffff, 0xc8c8cc, 2.3));
  const sun = new DirectionalLight(0xffffff, 1.1);
  sun.position.set(centre.x + radius, centre.y + 3 * radius, centre.z + 1.5 * radius);
  sun.target.position.copy(centre);
  scene.add(sun, sun.target);

  const cloth = clothMesh(view);
  scene.add(cloth);
  const bodies: { mesh: Mesh; poses: number[][] }[] = [];
  for (const body of view.bodies) {
    const geometry = bodyGeometry(body.shape, body.sizes, 1.25 * radius);
    if (!geometry) continue;
    const mesh = new Mesh(
      geometry,
      new MeshLambertMaterial({
        color: body.shape === "plane" ? 0xe4e6e9 : 0xb4b8be,
        // What lies on a surface must not be lost in it.
        polygonOffset: true,
        polygonOffsetFactor: 1,
        polygonOffsetUnits: 1,
        side: body.shape === "plane" ? DoubleSide : FrontSide,
      }),
    );
    bodies.push({ mesh, poses: body.poses });
    scene.add(mesh);
  }

  const camera = new PerspectiveCamera(30, aspect, radius / 50, radius * 50);
  const reset = (): void => {
    // From the front right and above, as near as all frames of the cloth fit.
    const towards = new Vector3(0.55, 0.5, 0.85).normalize();
    const away = 1.08 * fittingDistance(view, centre, towards, camera);
    camera.position.copy(towards).multiplyScalar(away).add(centre);
    camera.lookAt(centre);
  };
  reset();

  const colour = new Color();
  return {
    scene,
    camera,
    target: centre,
    radius,
    cloth,
    bodies: bodies.map(({ mesh }) => mesh),
    reset,
    pose: (frame) => {
      const attribute = cloth.geometry.getAttribute("position");
      (attribute.array as Float32Array).set(view.positions[frame] ?? []);
      attribute.needsUpdate = true;
      cloth.geometry.computeVertexNormals();
      for (const { mesh, poses } of bodies) {
        const [x = 0, y = 0, z = 0, w = 1, i = 0, j = 0, k = 0] = poses[frame] ?? [];
        mesh.position.set(x, y, z);
        mesh.quaternion.set(i, j, k, w);
        mesh.updateMatrixWorld();
      }
    },
    paint: (distances, highest) => {
      const attribute = cloth.geometry.getAttribute("color");
      for (let node = 0; node < view.drawnNodes; ++node) {
        const place = (distances[node] ?? NaN) / (highest > 0 ? highest : 1);
        const [r, g, b] = colourAt(place);
        colour.setRGB(r / 255, g / 255, b / 255, SRGBColorSpace);
        attribute.setXYZ(node, colour.r, colour.g, colour.b);
      }
      attribute.needsUpdate = true;
    },
  };
}
