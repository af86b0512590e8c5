// node player_test.mjs CHROMIUM WEFT DUMP_RECORDING [--long]: runs scenes, exports them, opens the pages from file:// and
// compares what they show with what Weft says of the recordings.
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { copyFileSync, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const require = createRequire(new URL("../../../web/package.json", import.meta.url));
const { chromium } = require("playwright-core");
const axe = readFileSync(require.resolve("axe-core/axe.min.js"), "utf8");
const [executablePath, weft, dumpRecording, length] = process.argv.slice(2);
assert(executablePath && weft && dumpRecording, "usage: node player_test.mjs CHROMIUM WEFT DUMP_RECORDING [--long]");
const isLong = length === "--long";
const scenes = join(dirname(fileURLToPath(import.meta.url)), "scenes");
const work = mkdtempSync(join(tmpdir(), "weft-player-"));
const at = (name) => join(work, name);

const MB = 1e6;
// A page opens within 3 s; other tests run beside this one and take half of the processors.
const LIMITS = { frames: 5 * MB, nodes: 20 * MB, opening: 2 * 3000 /* ms */ };

const command = (...words) => execFileSync(weft, words, { cwd: work, encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });

/** Runs a scene once and gives the name of its recording. */
function record(scene, engine, ...more) {
  const name = `${scene.replace(/^.*\/|\.toml$/g, "")}_${engine}.weftrec`;
  if (!existsSync(at(name))) command("run", scene, "--engine", engine, ...more, "-o", name);
  return name;
}

const pageOf = (recording) => recording.replace(".weftrec", ".html");
const pages = new Map();

/** Exports a recording once and says by how much its page rounds positions [m]. */
function exported(recording) {
  if (!pages.has(recording)) {
    const said = command("export", "--html", pageOf(recording), recording);
    pages.set(recording, { page: pageOf(recording), error: 1e-3 * Number(/at most (\S+) mm/.exec(said)[1]) });
  }
  return pages.get(recording);
}

/** What Weft says of a recording in the frame nearest to a time [s], or in its last. */
function truth(recording, time) {
  const out = `${recording}.json`;
  execFileSync(dumpRecording, [recording, out, ...(time === undefined ? [] : [String(time)])], { cwd: work });
  return JSON.parse(readFileSync(at(out), "utf8"));
}

function launch(...more) {
  return chromium.launchPersistentContext(mkdtempSync(join(work, "profile-")), {
    executablePath,
    headless: true,
    args: ["--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking",
      "--disable-component-update", "--disable-sync", ...more],
  });
}
// One with WebGL in software, and one that has none at all.
const browser = await launch("--use-angle=swiftshader", "--enable-unsafe-swiftshader");
const browserWithoutWebGL = await launch("--disable-gpu", "--disable-3d-apis");

async function open(file, { width = 640, height = 480, colorScheme = "light", webgl = true, hash = "" } = {}) {
  const page = await (webgl ? browser : browserWithoutWebGL).newPage();
  const complaints = [];
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) complaints.push(message.text());
  });
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("request", (request) => {
    if (!/^(file|data|blob):/.test(request.url())) complaints.push(`asked for ${request.url()}`);
  });
  await page.emulateMedia({ colorScheme });
  await page.setViewportSize({ width, height });
  await page.goto(pathToFileURL(at(file)).href + hash);
  await page.waitForFunction(() => window.weft !== undefined, undefined, { timeout: 60_000 });
  await page.evaluate(() => window.weft.ready);
  return { page, complaints };
}

/** Gives files to the page as a drop does. */
async function drop(page, files) {
  const handle = await page.evaluateHandle(() => new DataTransfer());
  for (const [name, bytes] of files) {
    // In pieces: one message to the browser has a largest size.
    const parts = [];
    const all = bytes.toString("base64");
    for (let i = 0; i < all.length; i += 16e6) parts.push(all.slice(i, i + 16e6));
    await page.evaluate(() => (window.parts = []));
    for (const part of parts) await page.evaluate((text) => window.parts.push(text), part);
    await page.evaluate(
      async ([transfer, name]) => {
        const response = await new Promise((done) => {
          const text = atob(window.parts.join(""));
          done(Uint8Array.from({ length: text.length }, (_, i) => text.charCodeAt(i)));
        });
        transfer.items.add(new File([response], name));
      },
      [handle, name],
    );
  }
  const before = await page.evaluate(() => ({ notes: window.weft.notes().join(), at: window.weft.openingTime() }));
  await page.dispatchEvent("body", "drop", { dataTransfer: handle });
  await page.waitForFunction(
    (old) => window.weft.notes().join() !== old.notes || (window.weft.openingTime() !== old.at && !Number.isNaN(window.weft.openingTime())),
    before,
    { timeout: 60_000 },
  );
}

/** Drops files or folders of the disk, as a hand does: the page can read them again. */
async function dropFromDisk(page, names) {
  const session = await page.context().newCDPSession(page);
  const data = { items: [], files: names.map(at), dragOperationsMask: 1 };
  const before = await page.evaluate(() => window.weft.openingTime());
  for (const type of ["dragEnter", "dragOver", "drop"]) {
    await session.send("Input.dispatchDragEvent", { type, x: 300, y: 300, data });
  }
  await page.waitForFunction((old) => !Object.is(window.weft.openingTime(), old), before, { timeout: 60_000 });
}

/** A run that is held now and then, so that one can compare with what it has written by then. */
class HeldRun {
  /** duration: so long that it does not end between two looks. */
  constructor(folder, duration) {
    mkdirSync(at(folder));
    this.base = join(folder, "live");
    this.log = at(`${this.base}.partial.weftrec-wal`);
    const words = ["run", join(scenes, "many_frames.toml"), "--engine", "bullet_forces", "--duration", duration, "-o", `${this.base}.weftrec`];
    this.run = spawn(weft, words, { cwd: work });
    this.ended = new Promise((done) => this.run.on("exit", done));
  }

  /** The bytes that it has written and not yet moved into its database. */
  get written() {
    return statSync(this.log).size;
  }

  /** Lets it write some chunks more and holds it; gives what Weft says of the file by then. */
  async goOn(until) {
    this.run.kill("SIGCONT");
    while (!(existsSync(this.log) && (await until()))) {
      assert.equal(this.run.exitCode, null, "the run ended too early to look at");
      await new Promise((done) => setTimeout(done, 20));
    }
    this.run.kill("SIGSTOP");
    // A copy: who reads the log may tidy it up.
    for (const end of ["", "-wal"]) copyFileSync(at(`${this.base}.partial.weftrec${end}`), at(`${this.base}_copy.weftrec${end}`));
    return truth(`${this.base}_copy.weftrec`);
  }
}

const bytesOf = (name) => readFileSync(at(name));

function largest(a, b, what) {
  assert.equal(a.length, b.length, `${what}: ${a.length} numbers, expected ${b.length}`);
  return a.reduce((most, value, i) => Math.max(most, Math.abs(value - b[i])), 0);
}

// A log begins anew once its pages are in the recording, in the file that it has: what follows its newest pages is older. SQLite's
// file format, 4: a header of 32 bytes, and 24 bytes before each page, with the header's salt.
function used(log) {
  const size = 24 + log.readUInt32BE(8);
  const salt = log.subarray(16, 24);
  let end = 32;
  while (end + size <= log.length && log.subarray(end + 8, end + 16).equals(salt)) end += size;
  return end;
}

/** Compares the frame that is shown with Weft's. position: [m]; strain: what such a position may change of it. */
async function compare(page, expected, { position, strain }, index = 0) {
  for (const [name, cloth] of Object.entries(expected.cloths)) {
    const shown = await page.evaluate(
      ([body, i]) => ({
        positions: window.weft.positions(body, i),
        strain: window.weft.strain(body, i),
        triangles: window.weft.triangles(body, i),
      }),
      [name, index],
    );
    const off = largest(shown.positions, cloth.positions, `positions of ${name}`);
    assert(off <= position, `${name} is ${off} m off, allowed ${position} m`);
    assert.deepEqual(shown.triangles, cloth.triangles, `triangles of ${name}`);
    // Of two springs that changed alike, one shorter and one longer, rounding may choose the other.
    const sized = (values) => (position > 0 ? values.map(Math.abs) : values);
    const strainOff = largest(sized(shown.strain), sized(cloth.strain), `strain of ${name}`);
    assert(strainOff <= strain, `strain of ${name} is ${strainOff} off, allowed ${strain}`);
  }
  for (const [name, pose] of Object.entries(expected.rigids)) {
    const shown = await page.evaluate(([body, i]) => window.weft.positions(body, i), [name, index]);
    const scale = Math.max(1, ...pose.map(Math.abs));
    assert(largest(shown, pose, name) <= 1e-6 * scale, `${name} stands where it should`);
  }
}

async function compareEnergies(page, metrics) {
  await page.waitForFunction(
    (frames) => window.weft.metric("cloth_kinetic_energy_J").values.length === frames,
    metrics.cloth_kinetic_energy_J.length,
    { timeout: 60_000 },
  );
  for (const [name, values] of Object.entries(metrics)) {
    const shown = await page.evaluate((metric) => window.weft.metric(metric).values, name);
    const largestValue = Math.max(...values.map((value) => Math.abs(value ?? 0)));
    values.forEach((value, i) => {
      // JSON has no NaN: both say null.
      if (value === null) return assert(!Number.isFinite(shown[i]), `${name} of frame ${i}`);
      assert(Math.abs(shown[i] - value) <= 1e-9 * largestValue, `${name} of frame ${i}: ${shown[i]}, expected ${value}`);
    });
  }
}

const notes = (page) => page.evaluate(() => window.weft.notes());
const frames = (page) => page.evaluate(() => window.weft.times().length);

/** Coloured pixels of the canvas as it is on the screen, and a hash of all. */
/** The first picture of these that fits: beside other work a frame is shown some time after it was drawn. */
async function pictureThat(page, fits, tries = 20) {
  let last = await picture(page);
  for (let i = 1; i < tries && !fits(last); ++i) last = await picture(page);
  return last;
}

async function picture(page) {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  const png = (await page.locator("canvas.view").screenshot()).toString("base64");
  return page.evaluate(async (data) => {
    const image = new Image();
    image.src = `data:image/png;base64,${data}`;
    await image.decode();
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [image.width, image.height];
    const context = canvas.getContext("2d", { willReadFrequently: true });
    context.drawImage(image, 0, 0);
    const pixels = context.getImageData(0, 0, canvas.width, canvas.height).data;
    let coloured = 0;
    let hash = 0;
    for (let i = 0; i < pixels.length; i += 4) {
      const [r, g, b] = [pixels[i], pixels[i + 1], pixels[i + 2]];
      coloured += Math.max(r, g, b) - Math.min(r, g, b) > 60 ? 1 : 0;
      hash = (Math.imul(hash, 31) + r + 7 * g + 49 * b) | 0;
    }
    return { coloured, hash };
  }, png);
}

const SHORT_SCENES = [
  ["hang", "reference", "1.2 s"],
  ["tear", "bullet_forces", "0.6 s"],
  ["squishy_ball", "bullet_soft", "0.1 s"],
  ["colliders", "bullet_soft", "0.05 s"],
  ["caped_figure", "bullet_forces", "0.08 s"],
  ["stack", "bullet_soft", "0.1 s"],
  ["sock_puppet", "bullet_weft", "0.04 s"],
];
const OTHER_SCENES = ["drape_sphere", "drop_ground", "drop_box", "wind_hover", "heavy_strip", "ball_on_cloth", "curtain",
  "towel", "ghost", "ooze", "flying_carpet", "drape_torsion", "materials", "wind"];

function sceneTests() {
  // Every scene has an engine of its own that is the first it names.
  const list = isLong ? [...SHORT_SCENES, ...OTHER_SCENES.map((scene) => [scene, "", "0.06 s"])] : SHORT_SCENES;
  return list.map(([scene, engine, duration]) => [
    `${scene}: page and dropped recording show what Weft says of it`,
    async () => {
      const name = `${scene}_short.weftrec`;
      command("run", scene, ...(engine ? ["--engine", engine] : []), "--duration", duration, "-o", name);
      const expected = truth(name);
      const { page: file, error } = exported(name);
      const first = await open(file);
      await first.page.evaluate((time) => window.weft.seek(time), expected.frame.time);
      // A side of a triangle may be a few millimetres short: its strain shares the rounding of two nodes.
      await compare(first.page, expected.frame, { position: error * 1.0001, strain: 0.02 });
      await compareEnergies(first.page, expected.metrics);
      assert.deepEqual(first.complaints, []);
      await first.page.close();
      const second = await open("player.html");
      await drop(second.page, [[name, bytesOf(name)]]);
      await second.page.evaluate((time) => window.weft.seek(time), expected.frame.time);
      await compare(second.page, expected.frame, { position: 0, strain: 1e-12 });
      await compareEnergies(second.page, expected.metrics);
      assert.deepEqual(await notes(second.page), []);
      assert.deepEqual(second.complaints, []);
      await second.page.close();
    },
  ]);
}

const hang = () => record("hang", "reference");

const tests = {
  async "at t = 1 s the nodes of an exported page are those of the recording"() {
    const name = hang();
    const expected = truth(name, 1.0);
    const { page: file, error } = exported(name);
    assert.equal(error, 1e-5);
    const { page, complaints } = await open(file);
    const slider = page.getByLabel("Time", { exact: true });
    const index = await page.evaluate(() => window.weft.times().findIndex((time) => Math.abs(time - 1) < 1e-6));
    await slider.fill(String(index));
    assert.equal(await page.textContent(".time"), "t\u00a0=\u00a01.000\u00a0s");
    await compare(page, expected.frame, { position: error * 1.0001, strain: 1e-3 });
    await page.waitForFunction(() => location.hash === "#t=1");
    assert.deepEqual(complaints, []);
  },

  async "a link leads to a moment, also while the page is open"() {
    const { page, complaints } = await open(exported(hang()).page, { hash: "#t=0.5" });
    assert.equal(await page.textContent(".time"), "t\u00a0=\u00a00.500\u00a0s");
    await page.evaluate(() => (location.hash = "#t=1.5"));
    await page.waitForFunction(() => document.querySelector(".time").textContent.includes("1.500"));
    assert.deepEqual(complaints, []);
  },

  async "buttons and keys play, step, colour and turn"() {
    const { page, complaints } = await open(exported(hang()).page);
    const time = () => page.textContent(".time");
    await page.keyboard.press("ArrowRight");
    assert.match(await time(), /0\.020/);
    await page.getByRole("button", { name: "One frame back" }).click();
    assert.match(await time(), /0\.000/);
    await page.keyboard.press("End");
    assert.match(await time(), /2\.000/);
    const plain = await picture(page);
    assert(plain.coloured > 5000, `${plain.coloured} coloured pixels`);
    await page.keyboard.press("c");
    assert(await page.locator(".legend").isVisible());
    const strained = await pictureThat(page, (now) => now.hash !== plain.hash);
    assert.notEqual(strained.hash, plain.hash, "strain has other colours");
    assert.match(await page.locator(".scale-marks").textContent(), /−[\d.]+0\+[\d.]+/);
    await page.keyboard.press("c");
    await page.keyboard.press("w");
    assert.notEqual((await pictureThat(page, (now) => now.hash !== plain.hash)).hash, plain.hash, "wires");
    await page.keyboard.press("w");
    await page.keyboard.press("Shift+ArrowLeft");
    assert.notEqual((await pictureThat(page, (now) => now.hash !== plain.hash)).hash, plain.hash, "the view turns");
    await page.keyboard.press("r");
    assert.equal((await pictureThat(page, (now) => now.hash === plain.hash)).hash, plain.hash, "and goes back");
    await page.keyboard.press("Home");
    await page.keyboard.press(" ");
    await page.waitForFunction(() => document.querySelector(".time").textContent !== "t\u00a0=\u00a00.000\u00a0s");
    await page.keyboard.press(" ");
    assert.equal(await page.locator(".play").getAttribute("aria-label"), "Play");
    await page.keyboard.press("?");
    assert.match(await page.textContent("dialog"), /one frame back, forward/);
    await page.keyboard.press("Escape");
    await page.waitForSelector("dialog", { state: "detached" });
    assert.deepEqual(complaints, []);
  },

  async "fingers turn and zoom, and a click into the plot leads to its time"() {
    const { page, complaints } = await open(exported(hang()).page, { width: 400, height: 800 });
    const touch = await page.context().newCDPSession(page);
    const send = (type, points) =>
      touch.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
    const first = await picture(page);
    await send("touchStart", [[150, 300]]);
    for (const x of [170, 200, 230]) await send("touchMove", [[x, 300]]);
    await send("touchEnd", []);
    const turned = await pictureThat(page, (now) => now.hash !== first.hash);
    assert.notEqual(turned.hash, first.hash, "one finger turns");
    await send("touchStart", [[180, 300], [220, 300]]);
    for (const d of [3, 6, 9]) await send("touchMove", [[180 - d, 300], [220 + d, 300]]);
    await send("touchEnd", []);
    const near = await pictureThat(page, (now) => now.coloured > turned.coloured);
    assert(near.coloured > turned.coloured, `two fingers zoom: ${turned.coloured} to ${near.coloured} pixels`);
    await page.getByRole("button", { name: "Reset view" }).click();
    assert.equal((await pictureThat(page, (now) => now.hash === first.hash)).hash, first.hash);
    const over = page.locator(".u-over");
    await over.scrollIntoViewIfNeeded();
    const { width } = await over.boundingBox();
    await over.click({ position: { x: width / 2, y: 40 } });
    assert.match(await page.textContent(".time"), /t\s=\s(0\.98|1\.0)\d*\ss/);
    assert.deepEqual(complaints, []);
  },

  async "two engines are shown side by side and over one another, each with its own nodes"() {
    const names = [hang(), record("hang", "bullet_soft")];
    command("export", "--html", "both.html", ...names);
    const { page, complaints } = await open("both.html", { hash: "#t=1" });
    assert.deepEqual(await page.locator(".label").allTextContents(), ["reference float64", "bullet_soft float32"]);
    for (const [i, name] of names.entries()) {
      await compare(page, truth(name, 1).frame, { position: 1.0001e-5, strain: 1e-3 }, i);
    }
    // Times of both engines differ by rounding: each has its own value beside the plot.
    await page.waitForFunction(() => /^t \[s\]1reference.*kinetic0\.02.*bullet_soft.*kinetic0\.02/.test(document.querySelector(".u-legend").textContent));
    const beside = await picture(page);
    await page.keyboard.press("o");
    assert.notEqual((await picture(page)).hash, beside.hash);
    await page.getByRole("checkbox", { name: "bullet_soft float32" }).uncheck();
    assert.deepEqual(await page.locator(".label").allTextContents(), ["reference float64"]);
    assert.deepEqual(complaints, []);
  },

  async "a recording that is being written shows every committed frame"() {
    const run = spawn(weft, ["run", join(scenes, "many_frames.toml"), "--engine", "bullet_forces", "-o", "live.weftrec"], { cwd: work });
    const ended = new Promise((done) => run.on("exit", done));
    const log = at("live.partial.weftrec-wal");
    // Some chunks: the header alone is there at once.
    while (!(existsSync(log) && statSync(log).size > 1.5 * MB)) {
      assert.equal(run.exitCode, null, "the run ended too early to look at");
      await new Promise((done) => setTimeout(done, 20));
    }
    run.kill("SIGSTOP");
    copyFileSync(at("live.partial.weftrec"), at("copy.weftrec"));
    copyFileSync(log, at("copy.weftrec-wal"));
    run.kill("SIGKILL");
    await ended;
    const [main, wal] = [bytesOf("copy.weftrec"), bytesOf("copy.weftrec-wal")];
    const expected = truth("copy.weftrec"); // last: it may tidy up the log
    assert(expected.frames > 0 && !expected.finished);
    const { page, complaints } = await open("player.html");
    await drop(page, [["copy.weftrec", main], ["copy.weftrec-wal", wal]]);
    assert.equal(await frames(page), expected.frames);
    assert.match((await notes(page)).join(), new RegExp(`partial recording.*Shown: ${expected.frames} frames`));
    await page.evaluate(() => window.weft.seek(1e9));
    await compare(page, expected.frame, { position: 0, strain: 1e-12 });
    // Without its log: fewer frames, and it says where the others are.
    await drop(page, [["alone.weftrec", main]]);
    assert((await frames(page)) < expected.frames);
    assert.match((await notes(page)).join(), /“-wal”/);
    // A log that ends in the middle of a page, as one that is being written: what was committed before.
    await drop(page, [["copy.weftrec", main], ["copy.weftrec-wal", wal.subarray(0, Math.round(0.7 * used(wal)))]]);
    const some = await frames(page);
    assert(some < expected.frames, `${some} frames of a log that is cut off`);
    assert.deepEqual(complaints, []);
  },

  async "a recording that is being written is followed while it grows"() {
    const { page, complaints } = await open("player.html");
    const held = new HeldRun("followed", "10 s");
    try {
      const first = await held.goOn(() => held.written > 1.5 * MB);
      await dropFromDisk(page, [`${held.base}.partial.weftrec`, `${held.base}.partial.weftrec-wal`]);
      assert.equal(await frames(page), first.frames);
      assert.match((await notes(page)).join(), /New frames are shown as they come/);
      await page.keyboard.press("End");
      await page.keyboard.press("w");
      const bytes = held.written;
      const second = await held.goOn(() => held.written > bytes + 1 * MB);
      assert(second.frames > first.frames + 10, `${second.frames} frames after ${first.frames}`);
      await page.waitForFunction((count) => window.weft.times().length === count, second.frames, { timeout: 120_000 });
      await page.waitForFunction((text) => document.querySelector(".frame-number").textContent === text, `frame ${second.frames} of ${second.frames}`);
      await compare(page, second.frame, { position: 0, strain: 1e-12 });
      await compareEnergies(page, second.metrics);
      assert(await page.getByRole("checkbox", { name: "Wireframe" }).isChecked());
      // Who looks at an earlier frame keeps looking at it.
      await page.keyboard.press("Home");
      await held.goOn(async () => (await frames(page)) > second.frames);
      assert.match(await page.textContent(".frame-number"), /^frame 1 of/);
      held.run.kill("SIGCONT");
      assert.equal(await held.ended, 0);
      await page.waitForFunction(() => /no longer there: its run has ended/.test(window.weft.notes().join()), undefined, { timeout: 120_000 });
    } finally {
      held.run.kill("SIGKILL");
    }
    assert.deepEqual(complaints, []);
  },

  async "a folder in which a run writes is followed to the end of the run"() {
    const { page, complaints } = await open("player.html");
    const held = new HeldRun("folder", "6 s");
    try {
      const first = await held.goOn(() => held.written > 1.5 * MB);
      await dropFromDisk(page, ["folder"]);
      assert.equal(await frames(page), first.frames);
      await page.keyboard.press("End");
      held.run.kill("SIGCONT");
      assert.equal(await held.ended, 0);
    } finally {
      held.run.kill("SIGKILL");
    }
    const whole = truth(`${held.base}.weftrec`);
    await page.waitForFunction((count) => window.weft.times().length === count, whole.frames, { timeout: 120_000 });
    await page.waitForFunction(() => window.weft.notes().length === 0, undefined, { timeout: 120_000 });
    assert.deepEqual(await page.evaluate(() => window.weft.recordings()), ["live.weftrec"]);
    await compare(page, whole.frame, { position: 0, strain: 1e-12 });
    assert.deepEqual(complaints, []);
  },

  async "a recording that is cut off, or damaged, says so and shows what is whole"() {
    const name = record(join(scenes, "many_frames.toml"), "bullet_forces");
    const whole = bytesOf(name);
    const { page, complaints } = await open("player.html");
    await drop(page, [["half.weftrec", whole.subarray(0, Math.round(0.5 * whole.length))]]);
    assert.match((await notes(page)).join(), /cut off: .* missing.*Shown: \S+ frame/);
    await drop(page, [["cut.weftrec", whole.subarray(0, Math.round(0.9 * whole.length))]]);
    const left = await frames(page);
    assert(left > 200 && left < 300, `${left} frames of 300 are left of 90 %`);
    assert.match((await notes(page)).join(), new RegExp(`cut off: .* missing.*Shown: ${left} frames`));
    const time = (await page.evaluate(() => window.weft.times())).at(-1);
    await page.evaluate((last) => window.weft.seek(last), time);
    await compare(page, truth(name, time).frame, { position: 0, strain: 1e-12 });

    const damaged = Buffer.from(whole);
    damaged[Math.round(0.5 * whole.length)] ^= 0x40;
    await drop(page, [["damaged.weftrec", damaged]]);
    assert.match((await notes(page)).join(), /Frames \d+ to \d+ are damaged/);
    assert((await frames(page)) < 300);
    assert.deepEqual(complaints, []);
  },

  async "what is no recording is refused by name, and what is shown stays"() {
    const name = hang();
    const { page, complaints } = await open("player.html");
    assert(await page.getByText("Drop a recording here").isVisible());
    for (const [bytes, reason] of [
      [Buffer.from("a text"), /other\.weftrec is not a recording/],
      [Buffer.alloc(0), /other\.weftrec is empty/],
      [bytesOf(name).subarray(0, 60), /other\.weftrec is not a recording/],
      [bytesOf(name).subarray(0, 3000), /other\.weftrec cannot be read, .* missing at its end/],
    ]) {
      await drop(page, [["other.weftrec", bytes]]);
      assert.match((await notes(page)).join(), reason);
    }
    const foreign = Buffer.from(bytesOf(name));
    foreign.writeUInt32BE(0, 68);
    await drop(page, [["other.weftrec", foreign]]);
    assert.match((await notes(page)).join(), /a SQLite database, but not a recording/);
    const newer = Buffer.from(bytesOf(name));
    newer.writeUInt32BE(3, 60);
    await drop(page, [["other.weftrec", newer]]);
    assert.match((await notes(page)).join(), /format version 3, which this page does not know/);
    await drop(page, [[name, bytesOf(name)]]);
    assert.equal(await frames(page), 101);
    await drop(page, [["other.weftrec", Buffer.from("a text")]]);
    assert.equal(await frames(page), 101, "what is shown stays");
    assert.deepEqual(complaints, []);
  },

  async "a forged recording is refused, whatever its numbers ask for"() {
    const sql = await require("sql.js")();
    const { page, complaints } = await open("player.html");
    for (const [change, reason] of [
      ["UPDATE chunk SET raw_bytes = 1000000000000", /would have 1000000000000 bytes/],
      ["UPDATE chunk SET raw_bytes = raw_bytes - 8", /the file is damaged/],
      ["UPDATE body SET nodes = 700 WHERE kind = 'cloth'", /numbers in a chunk, expected/],
      ["UPDATE chunk SET codec = 'other'", /codec “other”, which this page does not know/],
      ["UPDATE scene SET text = 'no scene'", /cannot|expected|Invalid|invalid/],
      ["DROP TABLE chunk", /the file is damaged/],
    ]) {
      const database = new sql.Database(bytesOf(hang()));
      database.run(change);
      await drop(page, [["forged.weftrec", Buffer.from(database.export())]]);
      assert.match((await notes(page)).join(), reason, change);
      assert(await page.getByText("Drop a recording here").isVisible());
    }
    assert.deepEqual(complaints, []);
  },

  async "300 frames of 2,500 nodes are below 5 MB"() {
    const name = record(join(scenes, "many_frames.toml"), "bullet_forces");
    const { page: file, error } = exported(name);
    const size = statSync(at(file)).size;
    console.log(`      ${(statSync(at(name)).size / MB).toFixed(1)} MB recording, ${(size / MB).toFixed(2)} MB page, rounded by ${1e3 * error} mm`);
    assert(size <= LIMITS.frames);
    const { page, complaints } = await open(file);
    const opening = await page.evaluate(() => window.weft.openingTime());
    console.log(`      opened in ${Math.round(opening)} ms`);
    assert(opening <= LIMITS.opening);
    await page.evaluate(() => window.weft.seek(1));
    await compare(page, truth(name, 1).frame, { position: error * 1.0001, strain: 2e-3 });
    assert.deepEqual(complaints, []);
  },

  async "without WebGL there is a still picture, and the player says what to do"() {
    const { page, complaints } = await open(exported(hang()).page, { webgl: false });
    const poster = page.locator(".stills .poster");
    assert.equal(await poster.count(), 1);
    assert.equal(await poster.evaluate((image) => image.naturalWidth), 960);
    assert.match(await poster.getAttribute("alt"), /^hang at t = /);
    assert.match(await page.textContent(".stills"), /draws no 3D/);
    // Its numbers are there all the same.
    assert.equal(await page.evaluate(() => window.weft.times().length), 101);
    const player = await open("player.html", { webgl: false });
    assert.match(await player.page.textContent(".stills"), /weft render draws pictures/);
    assert.deepEqual([...complaints, ...player.complaints], []);
  },

  async "without scripts there is a still picture too"() {
    const file = exported(hang()).page;
    const plain = await chromium.launch({ executablePath, args: ["--no-sandbox"] });
    const page = await (await plain.newContext({ javaScriptEnabled: false })).newPage();
    await page.goto(pathToFileURL(at(file)).href);
    assert(await page.locator("img.poster").isVisible());
    await plain.close();
  },

  async "no sideways scrolling, from a phone to a desk"() {
    const { page, complaints } = await open(exported(hang()).page, { width: 320, height: 800 });
    for (const width of [320, 400, 800, 1280]) {
      await page.setViewportSize({ width, height: 800 });
      await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
      const overflow = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
      assert.equal(overflow, 0, `at ${width} px`);
    }
    assert.deepEqual(complaints, []);
  },

  async "breaks no rule of accessibility that a program can check"() {
    const file = exported(hang()).page;
    for (const [name, options] of [[file, {}], [file, { width: 400, colorScheme: "dark" }], ["player.html", {}]]) {
      const { page } = await open(name, options);
      await page.evaluate(axe);
      const { violations } = await page.evaluate(() => globalThis.axe.run());
      assert.deepEqual(violations.map(({ id, nodes }) => `${id}: ${nodes[0].html}`), []);
      const bare = await page.$$eval("button, select, input:not([type=file])", (controls) =>
        controls.filter((control) => control.offsetParent && !control.title && !control.closest("label") && !control.textContent).map((c) => c.outerHTML),
      );
      assert.deepEqual(bare, [], "every control has words");
      await page.close();
    }
  },
};

const longTests = {
  async "600 frames of 10,000 nodes are below 20 MB and open within 3 s, exported and dropped"() {
    const name = record(join(scenes, "many_nodes.toml"), "bullet_forces");
    const { page: file, error } = exported(name);
    const size = statSync(at(file)).size;
    console.log(`      ${(statSync(at(name)).size / MB).toFixed(1)} MB recording, ${(size / MB).toFixed(2)} MB page, rounded by ${1e3 * error} mm`);
    assert(size <= LIMITS.nodes);
    const { page, complaints } = await open(file);
    const opening = await page.evaluate(() => window.weft.openingTime());
    console.log(`      the page opened in ${Math.round(opening)} ms`);
    assert(opening <= LIMITS.opening);
    await page.evaluate(() => window.weft.seek(1));
    await compare(page, truth(name, 1).frame, { position: error * 1.0001, strain: 5e-3 });
    const player = await open("player.html");
    await drop(player.page, [[name, bytesOf(name)]]);
    const dropped = await player.page.evaluate(() => window.weft.openingTime());
    console.log(`      the dropped recording opened in ${Math.round(dropped)} ms`);
    assert(dropped <= LIMITS.opening);
    assert.deepEqual([...complaints, ...player.complaints], []);
  },
};

command("export", "--player", "player.html");
let failed = 0;
for (const [claim, run] of [...Object.entries(tests), ...sceneTests(), ...(isLong ? Object.entries(longTests) : [])]) {
  const begin = Date.now();
  try {
    await run();
    console.log(`ok    ${claim} (${((Date.now() - begin) / 1000).toFixed(1)} s)`);
  } catch (error) {
    failed += 1;
    console.log(`FAIL  ${claim}\n${error.stderr ?? ""}${error.stack}`);
  }
  for (const context of [browser, browserWithoutWebGL]) await Promise.all(context.pages().slice(1).map((page) => page.close()));
}
await browser.close();
await browserWithoutWebGL.close();
rmSync(work, { recursive: true, force: true });
process.exit(failed === 0 ? 0 : 1);
