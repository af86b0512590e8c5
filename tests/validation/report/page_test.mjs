// node page_test.mjs CHROMIUM SAMPLE_FOLDER: opens the sample reports from file:// as a reader would.
import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const require = createRequire(new URL("../../../web/package.json", import.meta.url));
const { chromium } = require("playwright-core");
const axe = readFileSync(require.resolve("axe-core/axe.min.js"), "utf8");
const [executablePath, samples] = process.argv.slice(2);
assert(executablePath && samples, "usage: node page_test.mjs CHROMIUM SAMPLE_FOLDER");

const profiles = [];
function launch(...more) {
  const profile = mkdtempSync(join(tmpdir(), "weft-page-"));
  profiles.push(profile);
  return chromium.launchPersistentContext(profile, {
    executablePath,
    headless: true,
    args: [
      "--no-sandbox",
      "--disable-quic",
      "--no-first-run",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-sync",
      ...more,
    ],
  });
}
// One with WebGL in software, which is slow in everything, and one that has none at all.
const browser = await launch("--use-angle=swiftshader", "--enable-unsafe-swiftshader");
const browserWithoutWebGL = await launch("--disable-gpu", "--disable-3d-apis");

async function open(name, { width = 1200, colorScheme = "light", webgl = false } = {}) {
  const page = await (webgl ? browser : browserWithoutWebGL).newPage();
  const complaints = [];
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) complaints.push(message.text());
  });
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("request", (request) => {
    if (!/^(file|data):/.test(request.url())) complaints.push(`asked for ${request.url()}`);
  });
  await page.emulateMedia({ colorScheme });
  await page.setViewportSize({ width, height: 900 });
  await page.goto(pathToFileURL(resolve(samples, name, "index.html")).href);
  await page.waitForSelector("#verdict", { timeout: 30_000 });
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  return { page, complaints };
}

/** Per chart: pixels that are not background, and pixels in the colour of the first series (axes and text are grey). */
const inkPerChart = (page) =>
  page.$$eval(".chart canvas", (canvases) =>
    canvases.map((canvas) => {
      const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
      const ink = { any: 0, blue: 0 };
      for (let i = 0; i < data.length; i += 4) {
        ink.any += data[i + 3] > 0 ? 1 : 0;
        ink.blue += data[i + 3] > 200 && data[i + 2] - data[i] > 80 ? 1 : 0;
      }
      return ink;
    }),
  );

/** What the canvas of the cloth in 3D shows: pixels with a colour (the scale has no grey), and a hash of all. */
const clothPicture = (page) =>
  page.$eval("canvas.cloth", (canvas) => {
    // Read from a copy: the browser warns of a canvas that is read again and again.
    const copy = document.createElement("canvas");
    [copy.width, copy.height] = [canvas.width, canvas.height];
    const context = copy.getContext("2d", { willReadFrequently: true });
    context.drawImage(canvas, 0, 0);
    const { data } = context.getImageData(0, 0, copy.width, copy.height);
    let coloured = 0;
    let hash = 0;
    for (let i = 0; i < data.length; i += 4) {
      const [r, g, b] = [data[i], data[i + 1], data[i + 2]];
      coloured += data[i + 3] > 200 && Math.max(r, g, b) - Math.min(r, g, b) > 40 ? 1 : 0;
      hash = (Math.imul(hash, 31) + r + 7 * g + 49 * b) | 0;
    }
    return { coloured, hash };
  });

/** The picture once it has been drawn anew after what was done. */
async function clothAfter(page, action) {
  await page.locator("canvas.cloth").scrollIntoViewIfNeeded();
  await action();
  await page.waitForTimeout(600); // a frame of the software renderer takes up to 100 ms on a busy machine
  return clothPicture(page);
}

const visibleRows = (page) => page.locator(".checks tbody tr:visible");
const sidewaysOverflow = (page) =>
  page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);

const tests = {
  async "a failing report says so first, and then what to look at"() {
    const { page, complaints } = await open("failing");
    assert.equal(await page.textContent("#verdict"), "FAIL");
    assert.match(
      await page.textContent(".sentence"),
      /2 of 12 checks fail; 1 of 14 sabotages was not noticed\./,
    );
    assert.match(await page.title(), /^FAIL: /);
    assert.equal(await page.locator(".failure").count(), 2);
    assert.match(
      await page.textContent(".failure >> nth=0"),
      /Energy never grows.*0\.031.*3\.1.*one damper missing.*not noticed.*Energy plot of hang/s,
    );
    assert.match(await page.textContent(".failure >> nth=1"), /NaN/);
    const order = await page.$$eval(".checks tbody tr", (rows) =>
      rows.map((row) => row.classList.contains("attention")),
    );
    assert.deepEqual(order.slice(0, 3), [true, true, false], "failed rows come first");
    assert.deepEqual(complaints, []);
  },

  async "a passing report says PASS and lists no failure"() {
    const { page, complaints } = await open("passing");
    assert.equal(await page.textContent("#verdict"), "PASS");
    assert.equal(await page.locator(".failures").count(), 0);
    assert.match(await page.textContent(".sentence"), /All 10 checks hold; all 11 sabotages were noticed\./);
    assert.deepEqual(complaints, []);
  },

  async "known deviations are failures that are told apart, grouped by cause"() {
    const { page, complaints } = await open("deviations");
    assert.equal(await page.textContent("#verdict"), "PASS");
    assert.match(await page.textContent(".sentence"), /1 checks? holds?, 2 of 3 checks fail as known deviations/);
    assert.equal(await page.locator(".failures").count(), 0);
    assert.equal(await page.locator(".causes > .deviation").count(), 2, "two causes for three deviations");
    assert.match(
      await page.textContent(".causes > .deviation >> nth=0"),
      /bullet_weft: The bending force forgets its step\..*2 deviations/s,
    );
    await page.getByLabel("Verdict", { exact: true }).selectOption("known");
    assert.equal(await visibleRows(page).count(), 2);
    assert.deepEqual(complaints, []);
  },

  async "the first screen has a row of pictures and a line for each engine, the fast solver first"() {
    const { page } = await open("deviations");
    const lines = await page.locator(".engines li").allTextContents();
    assert.equal(lines.length, 2);
    assert.match(lines[0], /✗ fail.*bullet_weft.*0 of 2 checks pass; 2 fail as known deviations of 1 cause/);
    assert.match(lines[1], /✓ pass.*reference.*1 of 1 check/);
    assert.deepEqual(await page.locator(".first-pictures figcaption b").allTextContents(), [
      "bullet_weft float32",
      "reference",
    ]);
    const bottom = await page.$eval(".engines", (list) => list.getBoundingClientRect().bottom);
    assert(bottom < 900, `the engines end at ${bottom} px`);
  },

  async "an error stands beside its value and the expected one"() {
    const { page } = await open("deviations");
    assert.match(await page.textContent(".checks tbody tr >> nth=0"), /H \/ W 0\.585, expected 0\.5862/);
  },

  async "the first column of the matrix is the fast solver"() {
    const { page } = await open("failing");
    const heads = await page.locator(".matrix thead th").allTextContents();
    assert.equal(heads[0], "case");
    assert.equal(heads[1], "bullet_forces", "no bullet_weft in this sample: the next of the list");
    assert(heads.every((head) => !/float/.test(head)));
  },

  async "an empty report does not claim that anything was checked"() {
    const { page, complaints } = await open("empty");
    assert.match(await page.textContent(".sentence"), /No number was compared with a bound/);
    assert.deepEqual(complaints, []);
  },

  async "every plot is drawn, also with numbers that are not finite"() {
    const { page, complaints } = await open("failing");
    const ink = await inkPerChart(page);
    const drawn = { any: 2000, blue: 100 }; // pixels; axes and labels alone give about 4000, an empty canvas none
    assert.equal(ink.length, 4);
    assert(
      ink.every(({ any, blue }) => any > drawn.any && blue > drawn.blue),
      JSON.stringify(ink),
    );
    assert.match(await page.textContent("#section-2"), /Not drawn: 5 points/);
    assert.deepEqual(complaints, []);
  },

  async "the cursor shows the value of each series"() {
    const { page } = await open("failing");
    const area = page.locator(".u-over").first();
    await area.scrollIntoViewIfNeeded();
    await area.hover({ position: { x: 200, y: 60 } });
    await page.waitForTimeout(100);
    const values = await page.locator(".u-legend").first().locator(".u-value").allTextContents();
    assert.equal(values.length, 5);
    assert(
      values.every((value) => /\d/.test(value)),
      values.join(" | "),
    );
  },

  async "a series can be hidden from the keyboard"() {
    const { page } = await open("failing");
    const name = page.locator(".u-legend .u-series th[role=button]").first();
    await name.focus();
    await page.keyboard.press("Enter");
    assert.equal(await name.getAttribute("aria-pressed"), "false");
    await page.keyboard.press("Enter");
    assert.equal(await name.getAttribute("aria-pressed"), "true");
  },

  async "filters by case, engine and verdict"() {
    const { page } = await open("failing");
    const all = await visibleRows(page).count();
    assert.equal(all, 14);
    await page.getByLabel("Verdict", { exact: true }).selectOption("info");
    assert.equal(await visibleRows(page).count(), 2);
    await page.getByLabel("Engine", { exact: true }).selectOption("bullet_soft");
    assert.equal(await visibleRows(page).count(), 1);
    assert.match(await page.textContent(".filters [role=status]"), /1 of 14 rows/);
    await page.getByRole("button", { name: "Show all" }).click();
    assert.equal(await visibleRows(page).count(), all);
    await page.getByRole("button", { name: / hang, bullet_soft;/ }).click();
    assert.equal(await visibleRows(page).count(), 2);
  },

  async "marks tight, loose and rows without a bound"() {
    const { page } = await open("failing");
    assert.deepEqual((await page.locator(".checks .flag").allTextContents()).sort(), [
      "loose",
      "tight",
      "tight",
    ]);
    const info = page.locator(".checks tr.info").first();
    assert.match(await info.textContent(), /no bound/);
    assert.equal(await info.locator(".bar").count(), 0);
  },

  async "the reason of a bound is a bubble for mouse and keyboard"() {
    const { page } = await open("passing");
    await page.locator(".checks .basis").first().focus();
    assert.match(await page.textContent("#tooltip"), /C h with p = 1/);
    assert(await page.locator("#tooltip").isVisible());
    await page.keyboard.press("Escape");
    assert(!(await page.locator("#tooltip").isVisible()));
  },

  async "the reason of a bound is plain text on paper"() {
    const { page } = await open("passing");
    await page.emulateMedia({ media: "print" });
    const reason = page.locator(".checks .print-only").first();
    assert(await reason.isVisible());
    assert.match(await reason.textContent(), /C h with p = 1/);
  },

  async "hostile text is shown, not run"() {
    const { page } = await open("failing");
    assert.equal(await page.evaluate(() => window.hacked), undefined);
    assert.match(await page.textContent(".failure >> nth=1"), /<\/script><script>window\.hacked/);
  },

  async "pictures have alternative text and open large"() {
    const { page } = await open("failing");
    const images = await page.$$eval(".pictures img", (list) =>
      list.map((image) => [image.alt, image.naturalWidth]),
    );
    assert.equal(images.length, 12, "eight of the sections, and the four of the first screen");
    assert(images.every(([alt, width]) => alt !== "" && width === 320));
    await page.locator(".picture").first().click();
    assert.match(await page.textContent("dialog [role=status]"), /1 of 4: reference/);
    await page.keyboard.press("ArrowRight");
    assert.match(await page.textContent("dialog [role=status]"), /2 of 4: bullet_soft/);
    await page.keyboard.press("Escape");
    await page.waitForSelector("dialog", { state: "detached" });
  },

  async "no sideways scrolling, from a phone to a desk"() {
    for (const width of [320, 400, 800, 1200]) {
      const { page, complaints } = await open("failing", { width });
      assert.equal(await sidewaysOverflow(page), 0, `at ${width} px`);
      assert.deepEqual(complaints, []);
      await page.close();
    }
  },

  async "breaks no rule of accessibility that a program can check"() {
    for (const options of [{ width: 1200 }, { width: 400, colorScheme: "dark" }]) {
      const { page } = await open("failing", options);
      await page.evaluate(axe);
      const { violations } = await page.evaluate(() => globalThis.axe.run());
      assert.deepEqual(
        violations.map(({ id, nodes }) => `${id}: ${nodes[0].html}`),
        [],
      );
      await page.close();
    }
  },

  async "text has contrast in light and dark"() {
    const kReadable = 4.5; // WCAG 2.2, level AA, normal text
    for (const colorScheme of ["light", "dark"]) {
      const { page } = await open("failing", { colorScheme });
      const ratios = await page.evaluate(() => {
        const canvas = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
        const luminance = (name) => {
          canvas.fillStyle = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
          canvas.fillRect(0, 0, 1, 1);
          const [r, g, b] = [...canvas.getImageData(0, 0, 1, 1).data].map((v) => {
            const c = v / 255;
            return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
          });
          return 0.2126 * r + 0.7152 * g + 0.0722 * b;
        };
        const pairs = [
          ["--text", "--ground"],
          ["--muted", "--ground"],
          ["--muted", "--card"],
          ["--muted", "--track"],
          ["--accent", "--ground"],
          ["--pass", "--pass-ground"],
          ["--fail", "--fail-ground"],
          ["--fail", "--card"],
          ["--warn", "--warn-ground"],
        ];
        return pairs.map(([front, back]) => {
          const [a, b] = [luminance(front), luminance(back)];
          return [`${front} on ${back}`, (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05)];
        });
      });
      for (const [pair, ratio] of ratios)
        assert(ratio >= kReadable, `${colorScheme}: ${pair} is ${ratio.toFixed(2)}`);
      await page.close();
    }
  },
};

Object.assign(tests, {
  async "the cloth in 3D is drawn, and moves with the slider, the mouse and the keys"() {
    for (const webgl of [true, false]) {
      const { page, complaints } = await open("failing", { webgl });
      const slider = page.getByLabel("Time", { exact: true });
      const last = await clothAfter(page, async () => {});
      assert(last.coloured > 5000, `${last.coloured} coloured pixels, WebGL: ${webgl}`);
      assert.match(await page.textContent(".readout"), /t\s=\s1\ss: largest distance 32\.5\smm/);
      const first = await clothAfter(page, () => slider.fill("0"));
      assert.notEqual(first.hash, last.hash, "the slider moves the cloth");
      assert.match(await page.textContent(".readout"), /t\s=\s0\ss: largest distance 0\sm/);
      const box = await page.locator("canvas.cloth").boundingBox();
      const turned = await clothAfter(page, async () => {
        await page.mouse.move(box.x + 200, box.y + 150);
        await page.mouse.down();
        await page.mouse.move(box.x + 300, box.y + 150, { steps: 3 });
        await page.mouse.up();
      });
      assert.notEqual(turned.hash, first.hash, "the mouse turns it");
      const byKey = await clothAfter(page, () => page.keyboard.press("ArrowLeft"));
      assert.notEqual(byKey.hash, turned.hash, "the keys turn it");
      const back = await clothAfter(page, () => page.getByRole("button", { name: "Reset view" }).click());
      assert.equal(back.hash, first.hash, "and it goes back");
      assert.deepEqual(complaints, []);
      await page.close();
    }
  },

  async "the cloth's colours follow the engine, and a run that ended says so"() {
    const { page } = await open("failing");
    const soft = await clothAfter(page, async () => {});
    const engine = page.getByLabel("engine", { exact: true });
    const ended = await clothAfter(page, () => engine.selectOption("bullet_forces float64"));
    assert.notEqual(ended.hash, soft.hash);
    assert.match(await page.textContent(".readout"), /bullet_forces float64.*the run had ended before/);
    await clothAfter(page, () => page.getByLabel("Time", { exact: true }).fill("3"));
    assert.match(await page.textContent(".readout"), /largest distance 17\.6\spm/);
    assert.deepEqual(await page.locator(".scale-marks span").allTextContents(), [
      "0\u00a0pm",
      "8.78\u00a0pm",
      "17.6\u00a0pm",
    ]);
    await page.getByLabel("colour scale", { exact: true }).selectOption("run");
    assert.equal(await page.locator(".scale-marks span").last().textContent(), "31.2\u00a0pm");
  },

  async "paper has the cloth as a still picture without controls"() {
    const { page } = await open("failing");
    await page.evaluate(() => window.dispatchEvent(new Event("beforeprint")));
    await page.emulateMedia({ media: "print" });
    assert((await clothPicture(page)).coloured > 2000);
    assert(await page.locator(".scale").first().isVisible());
    assert(!(await page.getByLabel("Time", { exact: true }).isVisible()));
  },

  async "the numbers of the table are those of report.json"() {
    const { page } = await open("failing");
    const report = JSON.parse(readFileSync(join(resolve(samples), "failing", "report.json"), "utf8"));
    const bad = (check) => check.verdict === "fail" || check.sabotages.some((s) => !s.detected);
    const expected = [...report.checks.filter(bad), ...report.checks.filter((c) => !bad(c))].map((check) => {
      const text = (value) => (check.unit === "1" ? `${value}` : `${value} ${check.unit}`);
      const caught = check.sabotages.filter((s) => s.detected).length;
      return [
        check.case + check.engine,
        text(check.measured),
        check.tolerance ? text(check.tolerance.value) : null,
        check.sabotages.length > 0 ? `${caught}\u00a0of\u00a0${check.sabotages.length}noticed` : "",
      ];
    });
    const shown = await page.$$eval(".checks tbody tr", (rows) =>
      rows.map((row) => {
        const cell = (label) => row.querySelector(`[data-label="${label}"]`);
        const exact = (label) => cell(label).querySelector("[data-tip]")?.dataset.tip ?? null;
        return [
          row.querySelector(".where").textContent,
          exact("measured"),
          exact("allowed"),
          cell("sabotages").textContent,
        ];
      }),
    );
    assert.deepEqual(shown, expected);
  },
});

let failed = 0;
for (const [claim, run] of Object.entries(tests)) {
  try {
    await run();
    console.log(`ok    ${claim}`);
  } catch (error) {
    failed += 1;
    console.log(`FAIL  ${claim}\n${error.stack}`);
  }
}
await browser.close();
await browserWithoutWebGL.close();
for (const profile of profiles) rmSync(profile, { recursive: true, force: true });
process.exit(failed === 0 ? 0 : 1);
