// node gltf_validator_test.mjs WEFT: Khronos' validator has nothing to say against the .glb files of weft export.
// Exit status 77: the package gltf-validator is not here ('npm ci' in web/).
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";

const require = createRequire(new URL("../../../../web/package.json", import.meta.url));
let validator;
try {
  validator = require("gltf-validator");
} catch {
  console.log("skipped: the package gltf-validator is not here ('npm ci' in web/)");
  process.exit(77);
}

const [weft] = process.argv.slice(2);
assert(weft, "usage: node gltf_validator_test.mjs WEFT");
const work = mkdtempSync(join(tmpdir(), "weft-gltf-"));
const command = (...words) => execFileSync(weft, words, { cwd: work, encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });

/** The scenes have textures of all kinds, a seam, ropes or none, bodies that move, stand and are led, and a cloth that tears. */
const SCENES = [
  ["ball_on_cloth", "reference", "0.4 s"],
  ["stack", "bullet_weft", "0.4 s"],
  ["squishy_ball", "bullet_forces", "0.2 s"],
  ["sock_puppet", "bullet_forces", "0.2 s"],
  ["tear", "bullet_forces", "1 s"],
  ["colliders", "bullet_soft", "0.1 s"],
];
const engines = command("list");
try {
  for (const [scene, engine, duration] of SCENES) {
    if (!engines.includes(engine)) continue; // a build without Bullet
    command("run", scene, "--engine", engine, "--duration", duration, "-o", `${scene}.weftrec`);
    command("export", "--gltf", `${scene}.glb`, "--gltf-error", "5 mm", `${scene}.weftrec`);
    const bytes = new Uint8Array(readFileSync(join(work, `${scene}.glb`)));
    const report = await validator.validateBytes(bytes, { uri: `${scene}.glb`, maxIssues: 20 });
    const { numErrors, numWarnings, numInfos, numHints, messages } = report.issues;
    const { animationCount, drawCallCount, totalVertexCount, hasMorphTargets, hasTextures } = report.info;
    console.log(`${scene}: ${numErrors} errors, ${numWarnings} warnings, ${numInfos} infos, ${numHints} hints; ` +
      `${drawCallCount} primitives, ${totalVertexCount} vertices, morph targets ${hasMorphTargets}, textures ${hasTextures}`);
    for (const message of messages) console.log(" ", JSON.stringify(message));
    assert.equal(numErrors + numWarnings, 0, scene);
    assert.equal(animationCount, 1, scene);
    assert(hasMorphTargets, scene);
  }
  // The validator itself: one wrong bound of an accessor, and it must say so.
  const bytes = readFileSync(join(work, "ball_on_cloth.glb"));
  const at = bytes.indexOf('"max":[') + 7;
  bytes.write("9", at, "latin1");
  const broken = await validator.validateBytes(new Uint8Array(bytes), {});
  assert(broken.issues.numErrors > 0, "a damaged file passes");
} finally {
  rmSync(work, { recursive: true });
}
