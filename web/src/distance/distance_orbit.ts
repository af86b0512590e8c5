// Turning a view by mouse, finger and keyboard.
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

import type { World } from "./distance_world";

export function orbit(canvas: HTMLCanvasElement, world: World, draw: () => void): OrbitControls {
  const controls = new OrbitControls(world.camera, canvas);
  controls.target.copy(world.target);
  controls.enablePan = false;
  // The wheel scrolls the page until the reader has taken hold of the picture.
  controls.enableZoom = false;
  canvas.addEventListener("focus", () => (controls.enableZoom = true));
  canvas.addEventListener("blur", () => (controls.enableZoom = false));
  canvas.addEventListener("pointerdown", () => canvas.focus({ preventScroll: true }));
  // Up and down scrolls the page on a phone, sideways turns the view.
  canvas.style.touchAction = "pan-y";
  controls.update();
  controls.addEventListener("change", draw);
  return controls;
}

const TURNS: Record<string, [number, number]> = {
  ArrowLeft: [-0.15, 0],
  ArrowRight: [0.15, 0],
  ArrowUp: [0, -0.15],
  ArrowDown: [0, 0.15],
};

export function turnByKeys(canvas: HTMLCanvasElement, world: World, controls: OrbitControls): void {
  canvas.addEventListener("keydown", (event) => {
    const turn = TURNS[event.key];
    if (!turn) return;
    event.preventDefault();
    const arm = world.camera.position.clone().sub(controls.target);
    const radius = arm.length();
    const around = Math.atan2(arm.x, arm.z) + turn[0];
    const down = Math.min(Math.max(Math.acos(arm.y / radius) + turn[1], 0.05), Math.PI - 0.05);
    world.camera.position
      .set(Math.sin(down) * Math.sin(around), Math.cos(down), Math.sin(down) * Math.cos(around))
      .multiplyScalar(radius)
      .add(controls.target);
    controls.update();
  });
}
