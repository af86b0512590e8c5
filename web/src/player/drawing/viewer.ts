// The canvas: camera, and the stages over one another or side by side.
import { PCFShadowMap, PerspectiveCamera, SRGBColorSpace, Vector3, WebGLRenderer } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

import type { Look } from "./cloth_view";
import type { SceneCamera } from "../scene";
import type { Stage } from "./stage";

export type Arrangement = "beside" | "over";

/** Screens narrower than this see the scene from farther away. */
const DESIGNED_ASPECT = 1.05;
const MAX_PIXEL_RATIO = 2;

/** null where there is no WebGL. Asked first, since three.js complains on the console where there is none. */
export function makeRenderer(canvas: HTMLCanvasElement): WebGLRenderer | null {
  const context = canvas.getContext("webgl2", { antialias: true, alpha: true });
  if (!context) return null;
  const renderer = new WebGLRenderer({ canvas, context, antialias: true, alpha: true });
  renderer.outputColorSpace = SRGBColorSpace;
  renderer.setClearColor(0, 0);
  renderer.autoClear = false;
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = PCFShadowMap;
  return renderer;
}

export class Viewer {
  readonly camera = new PerspectiveCamera(34, 1, 0.01, 1000);
  arrangement: Arrangement = "beside";
  private readonly orbit: OrbitControls;
  private stages: Stage[] = [];
  private hidden = new Set<number>();
  private readonly followed = new Vector3();
  private pending = 0;

  constructor(
    readonly canvas: HTMLCanvasElement,
    private readonly renderer: WebGLRenderer,
  ) {
    this.orbit = new OrbitControls(this.camera, canvas);
    this.orbit.addEventListener("change", () => this.drawSoon());
    new ResizeObserver(() => this.drawSoon()).observe(canvas);
  }

  show(stages: Stage[]): void {
    this.stages = stages;
    this.hidden.clear();
    this.reset();
  }

  /** The same stages, which have become longer: the camera stays. */
  exchange(stages: Stage[]): void {
    this.stages = stages;
    this.drawSoon();
  }

  setHidden(hidden: Set<number>): void {
    this.hidden = hidden;
    this.drawSoon();
  }

  /** Poses all stages; frames has one number for each. */
  pose(frames: number[], looks: Look[]): void {
    this.stages.forEach((stage, i) => stage.pose(frames[i] ?? 0, looks[i]!));
    const shift = this.stages[0]?.shift;
    if (shift && !shift.equals(this.followed)) {
      const way = shift.clone().sub(this.followed);
      this.camera.position.add(way);
      this.orbit.target.add(way);
      this.followed.copy(shift);
      this.orbit.update();
    }
    this.drawSoon();
  }

  /** The camera of the scene. */
  reset(): void {
    const first = this.stages[0];
    if (!first) return;
    const camera: SceneCamera = first.exhibit.scene.camera;
    const base = first.shift.clone().sub(first.origin);
    this.followed.copy(first.shift);
    this.camera.fov = (camera.fieldOfView * 180) / Math.PI;
    const target = new Vector3(...camera.target).add(base);
    const place = new Vector3(...camera.position).add(base);
    const aspect = this.aspect();
    const away = aspect < DESIGNED_ASPECT ? DESIGNED_ASPECT / aspect : 1;
    this.camera.position.copy(place).sub(target).multiplyScalar(away).add(target);
    this.camera.near = 0.01 * Math.max(place.distanceTo(target), first.radius);
    this.camera.far = this.camera.position.distanceTo(target) * away + 20 * first.radius;
    this.orbit.target.copy(target);
    this.orbit.update();
    this.drawSoon();
  }

  /** By angles [rad]. */
  turn(around: number, down: number): void {
    const arm = this.camera.position.clone().sub(this.orbit.target);
    const radius = arm.length();
    const angle = Math.atan2(arm.x, arm.z) + around;
    const polar = Math.min(Math.max(Math.acos(arm.y / radius) + down, 0.05), Math.PI - 0.05);
    this.camera.position.setFromSphericalCoords(radius, polar, angle).add(this.orbit.target);
    this.orbit.update();
  }

  zoom(factor: number): void {
    this.camera.position.sub(this.orbit.target).multiplyScalar(factor).add(this.orbit.target);
    this.orbit.update();
  }

  /** Part of the canvas, 0 to 1, at which each visible stage begins; for labels. */
  places(): { stage: number; left: number }[] {
    const visible = this.visible();
    if (this.arrangement === "over") return visible.map((stage) => ({ stage, left: 0 }));
    return visible.map((stage, i) => ({ stage, left: i / visible.length }));
  }

  drawSoon(): void {
    if (this.pending) return;
    this.pending = window.requestAnimationFrame(() => {
      this.pending = 0;
      this.draw();
    });
  }

  draw(): void {
    const { clientWidth, clientHeight } = this.canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, MAX_PIXEL_RATIO));
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = this.aspect();
    this.camera.updateProjectionMatrix();
    this.renderer.setScissorTest(false);
    this.renderer.clear();
    const visible = this.visible();
    const width = this.arrangement === "over" ? clientWidth : clientWidth / Math.max(visible.length, 1);
    this.renderer.setScissorTest(true);
    visible.forEach((index, i) => {
      const left = this.arrangement === "over" ? 0 : i * width;
      this.renderer.setViewport(left, 0, width, clientHeight);
      this.renderer.setScissor(left, 0, width, clientHeight);
      this.renderer.render(this.stages[index]!.scene, this.camera);
    });
  }

  private visible(): number[] {
    return this.stages.map((_, i) => i).filter((i) => !this.hidden.has(i));
  }

  private aspect(): number {
    const count = this.arrangement === "over" ? 1 : Math.max(this.visible().length, 1);
    return this.canvas.clientWidth / count / Math.max(this.canvas.clientHeight, 1) || 1;
  }
}
