// node recorder_page_test.mjs CHROMIUM WEFT PROGRAM: what a program draws beside its bodies, and says, in the page that plays its recording: exported,
// and dropped as it is.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const require = createRequire(new URL("../../web/package.json", import.meta.url));
const { chromium } = require("playwright-core");
const [executablePath, weft, program] = process.argv.slice(2);
assert(executablePath && weft && program, "usage: node recorder_page_test.mjs CHROMIUM WEFT PROGRAM");
const work = mkdtempSync(join(tmpdir(), "weft-recorder-page-"));
const run = (file, ...words) => execFileSync(file, words, { cwd: work, encoding: "utf8" });

run(program);
run(weft, "export", "--html", "fall.html", "fall.weftrec");
run(weft, "export", "--player", "player.html");

const browser = await chromium.launch({
  executablePath,
  headless: true,
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
const complaints = [];

async function open(file) {
  const page = await browser.newPage({ viewport: { width: 900, height: 600 } });
  page.on("console", (message) => complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(String(error)));
  await page.goto(pathToFileURL(join(work, file)).href);
  await page.waitForFunction(() => window.weft !== undefined);
  await page.evaluate(() => window.weft.ready);
  return page;
}

async function check(page, error) {
  const { time, marks, positions, notes } = await page.evaluate(() => ({
    time: window.weft.seek(0.5),
    marks: window.weft.marks(),
    positions: window.weft.positions("cloth"),
    notes: window.weft.notes(),
  }));
  assert(Math.abs(time - 0.5) < 1e-6, `time ${time}`);
  assert.deepEqual(marks.map(({ name, kind }) => [name, kind]), [["near", "points"], ["velocity", "arrows"]]);
  const [near, velocity] = marks;
  assert(near.from.length >= 3 && near.to.length === 0);
  assert.deepEqual(velocity.from, near.from);
  // Each point is the place of a node that is near the middle.
  const places = [];
  for (let i = 0; i < positions.length; i += 3) places.push(positions.slice(i, i + 3));
  const nodes = places.filter((place) => Math.hypot(...place) <= 0.85);
  assert(Math.abs(near.from.length / 3 - nodes.length) <= 2, `${near.from.length / 3} points, ${nodes.length} nodes`);
  for (let i = 0; i < near.from.length; i += 3) {
    const nearest = Math.min(...places.map((place) => Math.hypot(...place.map((x, k) => x - near.from[i + k]))));
    assert(nearest <= 2 * error + 1e-6, `a point is ${nearest} m from the nearest node`);
  }
  assert(notes.some((note) => note.includes("t = 0.5 s: half of the time is over")), notes.join("\n"));
}

try {
  const exported = await open("fall.html");
  await check(exported, 2e-5);
  // They are in the picture, where a copy without table mark has none.
  await exported.waitForTimeout(500);
  const marked = await exported.locator("canvas").first().screenshot();
  execFileSync("python3", ["-c", "import sqlite3; db = sqlite3.connect('fall.weftrec'); db.execute('DROP TABLE mark'); db.commit()"], { cwd: work });
  const player = await open("player.html");
  const drop = async (name) => {
    const handle = await player.evaluateHandle((bytes) => {
      const transfer = new DataTransfer();
      transfer.items.add(new File([Uint8Array.from(atob(bytes), (c) => c.charCodeAt(0))], "fall.weftrec"));
      return transfer;
    }, readFileSync(join(work, name)).toString("base64"));
    await player.dispatchEvent("body", "drop", { dataTransfer: handle });
    await player.waitForFunction(() => window.weft.recordings().length === 1 && window.weft.openingTime() > 0);
  };
  await drop("fall.weftrec");
  assert.deepEqual(await player.evaluate(() => (window.weft.seek(0.5), window.weft.marks())), []);
  await player.waitForTimeout(500);
  const plain = await player.locator("canvas").first().screenshot();
  assert(!marked.equals(plain), "marks are not seen");
  run(program);
  await drop("fall.weftrec");
  await player.waitForFunction(() => window.weft.seek(0.5) > 0 && window.weft.marks().length === 2);
  await check(player, 0);
  assert.deepEqual(complaints, []);
  console.log("marks and notes: exported and dropped page agree with the recording");
} finally {
  await browser.close();
  rmSync(work, { recursive: true, force: true });
}
