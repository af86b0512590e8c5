// A recording with what is needed to show it: its scene and the meshes of its cloths.
import { characterMeshes } from "./meshes/character_mesh";
import { makeClothMesh, type ClothMesh } from "./meshes/cloth_mesh";
import { computeEnergies, KINETIC } from "./energy";
import type { Frame } from "./files/chunk_codec";
import type { Metric, Recording } from "./files/recording";
import { readScene, text, type Scene } from "./scene";
import { nodeStrain, springsOf } from "./drawing/strain";

export interface Exhibit {
  recording: Recording;
  scene: Scene;
  /** Of each cloth; null for a source that this page does not know. */
  meshes: (ClothMesh | null)[];
  /** The largest strain [-] of the last frame, where most scenes carry their full load: one scale for all frames. */
  strainRange: number;
  notes: string[];
}

export function makeExhibit(recording: Recording): Exhibit {
  const scene = readScene(recording.sceneText);
  const notes = [...recording.notes];
  const led = new Map<string, ClothMesh>();
  for (const character of scene.characters) {
    try {
      for (const [name, mesh] of characterMeshes(character)) led.set(name, mesh);
    } catch (error) {
      notes.push(`The model of “${text(character["name"])}” cannot be read (${(error as Error).message}).`);
    }
  }
  const meshes = recording.bodies
    .filter((body) => body.isCloth)
    .map((body) => {
      const entry = scene.cloths.get(body.name);
      const mesh = led.get(body.name) ?? (entry ? makeClothMesh(entry) : null);
      if (mesh && mesh.rest.length / 3 === body.nodes) return mesh;
      notes.push(`The nodes of “${body.name}” are drawn as points: this page does not know the source of its triangles.`);
      return null;
    });
  return { recording, scene, meshes, strainRange: strainRange(recording, meshes), notes };
}

function strainRange(recording: Recording, meshes: (ClothMesh | null)[]): number {
  const last = recording.times.length - 1;
  if (last < 0) return 0;
  const frame: Frame = recording.frame(last);
  let largest = 0;
  meshes.forEach((mesh, c) => {
    if (!mesh) return;
    for (const value of nodeStrain(springsOf(mesh, recording.topology(c, last)), frame.positions[c]!)) {
      if (Math.abs(value) > largest) largest = Math.abs(value);
    }
  });
  return largest;
}

/** Fills in the energies that the recording does not have. */
export function startEnergies(exhibit: Exhibit, known: Metric[], onProgress: (done: boolean) => void): (() => void) | null {
  const { recording, scene } = exhibit;
  const meshes = exhibit.meshes.filter((mesh) => mesh !== null);
  const isThere = recording.metrics.some((metric) => metric.name === KINETIC);
  if (isThere || meshes.length !== exhibit.meshes.length || recording.positionError > 0) return null;
  return computeEnergies(recording, meshes, scene.gravity, known, onProgress).stop;
}
