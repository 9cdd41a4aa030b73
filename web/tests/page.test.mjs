// The report of a small run, opened and used in a real browser. CRAZE_SAMPLE: the run's folder; CRAZE_CHROMIUM: the browser.
import assert from "node:assert/strict";
import { existsSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { after, before, test } from "node:test";

const browserPath = process.env.CRAZE_CHROMIUM || "/usr/bin/chromium";
const page_file = join(process.env.CRAZE_SAMPLE ?? "", "report", "index.html");
const driver = new URL("../node_modules/playwright-core/package.json", import.meta.url);
const missing = !existsSync(browserPath) ? `no browser at ${browserPath}`
  : !existsSync(driver) ? "no npm packages in web/"
  : !existsSync(page_file) ? `no page at ${page_file}` : null;
if (missing) console.log(`SKIP_PAGE: ${missing}; scripts/setup installs Chromium and the packages, report_sample writes the page`);

const shots = process.env.CRAZE_SHOTS;
const profile = mkdtempSync(join(tmpdir(), "craze-page-"));
let context, page;
const errors = [], requests = [];

before(async () => {
  if (missing) return;
  const { chromium } = await import("playwright-core");
  context = await chromium.launchPersistentContext(profile, {
    executablePath: browserPath, headless: true, viewport: { width: 1280, height: 900 }, acceptDownloads: true,
    args: ["--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update", "--disable-sync",
      "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
  context.setDefaultTimeout(120000);
  page = await context.newPage();
  // The test's own reading of pixels draws remarks on speed; nothing else may be said.
  const ours = /ReadPixels|willReadFrequently/;
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && !ours.test(message.text()) && errors.push(message.text()));
  page.on("pageerror", (error) => errors.push(error.message));
  page.on("request", (request) => requests.push(request.url()));
  await page.goto(pathToFileURL(page_file).href);
  await page.waitForFunction(() => document.documentElement.dataset.ready === "yes", null, { timeout: 300000 });
});

after(async () => {
  await context?.close();
  rmSync(profile, { recursive: true, force: true });
});

const check = (name, body) => test(name, { skip: missing ?? false }, body);
const look = async (name, target) => shots && (target ?? page).screenshot({ path: join(shots, `${name}.png`), ...(target ? {} : { fullPage: true }) });

check("every plot is drawn, with ink on it", async () => {
  const plots = await page.$$eval("figure.plot", (figures) =>
    figures.map((figure) => {
      const canvas = figure.querySelector("canvas");
      if (!canvas) return { id: figure.id, drawing: Boolean(figure.querySelector(".drawing svg path")), live: false };
      const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
      const seen = new Set();
      for (let k = 0; k < pixels.length; k += 4) if (pixels[k + 3] > 200) seen.add(`${pixels[k]},${pixels[k + 1]},${pixels[k + 2]}`);
      const tints = JSON.parse(figure.querySelector("script").textContent).series.map((s) => s.colour);
      const has = (hex) => seen.has([1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16)).join(","));
      return { id: figure.id, live: true, colours: tints.some(has) };
    }),
  );
  assert.ok(plots.length >= 8, `${plots.length} plots`);
  for (const plot of plots) assert.ok(plot.live ? plot.colours : plot.drawing, `${plot.id}: ${JSON.stringify(plot)}`);
  assert.ok(plots.filter((p) => p.live).length >= 8);
  await look("page");
});

check("moving over a plot reads its values", async () => {
  const figure = page.locator("#gray_histogram");
  await figure.scrollIntoViewIfNeeded();
  const box = await figure.locator(".u-over").boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  const value = await figure.locator(".u-legend .u-value").first().textContent();
  assert.ok(Number(value) > 100 && Number(value) < 156, `gray level in the middle: ${value}`);
});

check("the slider walks through the stack", async () => {
  const stage = page.locator("#slices .stage");
  const at = () => stage.evaluate((node) => node.dataset.slice);
  const picture = () => page.locator("#slices canvas").first().evaluate((canvas) => canvas.toDataURL().length + canvas.toDataURL().slice(-400));
  const slice = await at(), seen = await picture();
  await stage.locator("input[type=range]").first().evaluate((slider) => {
    slider.value = "0";
    slider.dispatchEvent(new Event("input"));
  });
  await page.waitForFunction((old) => document.querySelector("#slices .stage").dataset.slice !== old, slice);
  assert.notEqual(await picture(), seen);
  await stage.locator("select").selectOption("1");
  await page.waitForFunction(() => document.querySelector("#slices .stage").dataset.slice.startsWith("y"));
  await look("slices", page.locator("#slices"));
});

check("pores and cracks are coloured, and can be turned off", async () => {
  const tinted = () =>
    page.locator("#slices canvas").last().evaluate((canvas) => {
      const p = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
      let count = 0;
      for (let k = 0; k < p.length; k += 4) count += Math.abs(p[k] - p[k + 2]) > 20;
      return count;
    });
  assert.ok((await tinted()) > 100);
  for (const box of await page.locator("#slices input[type=checkbox]").all()) await box.uncheck();
  await page.waitForTimeout(200);
  assert.equal(await tinted(), 0);
  for (const box of await page.locator("#slices input[type=checkbox]").all()) await box.check();
});

check("scenes in space are drawn, turn, and can be cut", async () => {
  const scenes = await page.locator("figure.scene").all();
  assert.ok(scenes.length >= 1);
  for (const scene of scenes) {
    await scene.scrollIntoViewIfNeeded();
    const id = await scene.getAttribute("id");
    const shades = () =>
      scene.locator("canvas").evaluate((canvas) => {
        const copy = new OffscreenCanvas(canvas.width, canvas.height), c = copy.getContext("2d");
        c.drawImage(canvas, 0, 0);
        const p = c.getImageData(0, 0, copy.width, copy.height).data, seen = new Map();
        for (let k = 0; k < p.length; k += 4) {
          const key = (p[k] << 16) | (p[k + 1] << 8) | p[k + 2];
          seen.set(key, (seen.get(key) ?? 0) + 1);
        }
        return { shades: seen.size, sum: [...seen].reduce((sum, [key, n]) => (sum + key * n) % 1000003, 0) };
      });
    const first = await shades();
    assert.ok(first.shades > 20, `${id}: ${first.shades} shades`);
    await look(id, scene);
    const box = await scene.locator("canvas").boundingBox();
    await page.mouse.move(box.x + 200, box.y + 200);
    await page.mouse.down();
    await page.mouse.move(box.x + 320, box.y + 230, { steps: 4 });
    await page.mouse.up();
    await page.waitForTimeout(300);
    const turned = await shades();
    assert.notEqual(turned.sum, first.sum, `${id} did not turn`);
    await scene.locator("input[type=range]").evaluate((slider) => {
      slider.value = "50";
      slider.dispatchEvent(new Event("input"));
    });
    await page.waitForTimeout(300);
    assert.notEqual((await shades()).sum, turned.sum, `${id} was not cut`);
    await look(`${id}_cut`, scene);
  }
});

check("the data of a plot can be downloaded", async () => {
  const [download] = await Promise.all([page.waitForEvent("download"), page.locator("#gray_histogram .links a").first().click()]);
  const text = readFileSync(await download.path(), "utf8");
  assert.equal(text.split("\n")[0], "gray level,share of voxels [%]");
  assert.equal(text.trim().split("\n").length, 257);
});

check("it reads in the dark and in print", async () => {
  await page.emulateMedia({ colorScheme: "dark" });
  const background = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  assert.equal(background, "rgb(20, 23, 26)");
  await page.waitForTimeout(300);
  await look("dark");
  await page.emulateMedia({ media: "print", colorScheme: "light" });
  assert.ok(await page.locator("#gray_histogram .drawing svg").isVisible());
  assert.ok(await page.locator("#slices .drawing img").isVisible());
  await page.emulateMedia({ media: "screen" });
});

check("narrow screens have no sideways scroll", async () => {
  await page.setViewportSize({ width: 390, height: 800 });
  await page.waitForTimeout(300);
  const [wide, seen] = await page.evaluate(() => [document.documentElement.scrollWidth, document.documentElement.clientWidth]);
  assert.ok(wide <= seen + 1, `${wide} > ${seen}`);
  await look("narrow");
  await page.setViewportSize({ width: 1280, height: 900 });
});

check("nothing was fetched, nothing complained", () => {
  assert.deepEqual(requests.filter((url) => !url.startsWith("file:") && !url.startsWith("data:") && !url.startsWith("blob:")), []);
  assert.equal(requests.filter((url) => url.startsWith("file:")).length, 1);
  assert.deepEqual(errors, []);
});
