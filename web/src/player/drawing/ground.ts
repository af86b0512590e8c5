// The ground: a disc with a subtle grid that fades out, and the shadows on it.
import {
  CanvasTexture,
  CircleGeometry,
  Color,
  Group,
  Mesh,
  MeshBasicMaterial,
  ShadowMaterial,
  SRGBColorSpace,
  type Quaternion,
  type Vector3,
} from "three";

const EXTENT = 5; // radii of the scene
const PIXELS = 2048;

/** 1, 2 or 5 times a power of ten, about a fifth of the radius [m]. */
function gridCell(radius: number): number {
  const wanted = 0.2 * radius;
  const power = 10 ** Math.floor(Math.log10(wanted));
  const digit = wanted / power;
  return power * (digit < 1.5 ? 1 : digit < 3.5 ? 2 : digit < 7.5 ? 5 : 10);
}

function picture(extent: number, cell: number, tone: Color, isDark: boolean): CanvasTexture {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = PIXELS;
  const context = canvas.getContext("2d");
  if (context) {
    context.fillStyle = tone.getStyle(SRGBColorSpace);
    context.fillRect(0, 0, PIXELS, PIXELS);
    context.strokeStyle = isDark ? "rgb(255 255 255 / 9%)" : "rgb(40 50 70 / 11%)";
    context.lineWidth = 2;
    const step = (cell / (2 * extent)) * PIXELS;
    for (let at = PIXELS / 2 - Math.floor(PIXELS / 2 / step) * step; at < PIXELS; at += step) {
      context.beginPath();
      context.moveTo(at, 0);
      context.lineTo(at, PIXELS);
      context.moveTo(0, at);
      context.lineTo(PIXELS, at);
      context.stroke();
    }
    const fade = context.createRadialGradient(PIXELS / 2, PIXELS / 2, 0, PIXELS / 2, PIXELS / 2, PIXELS / 2);
    fade.addColorStop(0.1, "rgb(0 0 0 / 100%)");
    fade.addColorStop(0.5, "rgb(0 0 0 / 45%)");
    fade.addColorStop(0.95, "rgb(0 0 0 / 0%)");
    context.globalCompositeOperation = "destination-in";
    context.fillStyle = fade;
    context.fillRect(0, 0, PIXELS, PIXELS);
  }
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  texture.anisotropy = 16;
  return texture;
}

export class Ground {
  readonly group = new Group();
  private readonly surface = new MeshBasicMaterial({ transparent: true, depthWrite: false });
  private readonly shadow = new ShadowMaterial({ transparent: true, depthWrite: false });

  constructor(
    private readonly radius: number,
    private readonly own: Color | null,
    place: Vector3,
    orientation: Quaternion | null,
  ) {
    const disc = new CircleGeometry(EXTENT * radius, 96).rotateX(-Math.PI / 2);
    const surface = new Mesh(disc, this.surface);
    const shadow = new Mesh(disc, this.shadow);
    surface.renderOrder = -2;
    shadow.renderOrder = -1;
    shadow.receiveShadow = true;
    this.group.add(surface, shadow);
    this.group.position.copy(place);
    if (orientation) this.group.quaternion.copy(orientation);
  }

  setTheme(isDark: boolean): void {
    this.surface.map?.dispose();
    const plain = new Color(isDark ? 0x2c323b : 0xe2e5e9);
    this.surface.map = picture(EXTENT * this.radius, gridCell(this.radius), this.own ?? plain, isDark);
    this.surface.needsUpdate = true;
    this.shadow.opacity = isDark ? 0.45 : 0.3;
  }

  dispose(): void {
    this.surface.map?.dispose();
    this.surface.dispose();
    this.shadow.dispose();
    for (const child of this.group.children) (child as Mesh).geometry.dispose();
  }
}
