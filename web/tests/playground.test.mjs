// The playground in a browser: each tool on a sample, and what a page owes its visitors.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { answerHash, colors, launch, open, saved, scratch, serve, solve, taut } from "./page.mjs";

let browser;
let server;

before(async () => {
  server = await serve();
  browser = await launch();
});

after(async () => {
  await browser.close();
  server.close();
});

const at = (hash, context) => open(browser, server.address, hash, context);

const tools = [
  ["ball", "clouds", /^✓ Verified within a gap of/, "ball.json"],
  ["ellipsoid", "iris", /^✓ Verified within a gap of/, "ellipsoid.json"],
  ["centers", "europe", /^✓ Verified within a gap of/, "centers.json"],
  ["delaunay", "clouds", /^✓ Verified$/, "delaunay.ply"],
  ["curve", "loops", /^✓ Verified$/, "curve.geojson"],
  ["surface", "knot", /^✓ Verified$/, "surface.obj"],
];

for (const [tool, sample, words, file] of tools) {
  test(`${tool}: a sample is solved, verified, drawn and saved`, async () => {
    const { page, seen } = await at(`#tool=${tool}&points=${sample}`);
    const { verdict, fields } = await solve(page);
    assert.match(verdict, words);
    assert.match(fields.verified, /^yes/);
    assert.ok((await colors(page, "#frame iframe")) > 20, "the picture is not blank");
    const json = JSON.parse(await saved(page, `${tool}.json`));
    assert.ok(json.kind && json.answer && json.certificate);
    const bytes = (await saved(page, file)).toString("latin1");
    if (file.endsWith("json")) JSON.parse(bytes);
    else assert.match(bytes, file.endsWith("ply") ? /^ply\n/ : /^# \d+ vertices/);
    assert.deepEqual(seen.errors, []);
    const foreign = seen.requests.filter((url) => !url.startsWith(server.address) && !/^(blob|data):/.test(url));
    assert.deepEqual(foreign, [], "no request leaves the page");
    await page.context().close();
  });
}

test("answers that are exact have the bits of the command", async () => {
  const delaunay = await at("#tool=delaunay&points=plane-100000");
  const { fields } = await solve(delaunay.page);
  const found = answerHash(await saved(delaunay.page, "delaunay.json"));
  await delaunay.page.context().close();
  const [points, json] = [scratch("plane.npy"), scratch("plane.json")];
  taut("generate", "uniform", "-n", "100000", "-d", "2", "--seed", "1", "-o", points);
  const said = taut("delaunay", points, "--threads", "1", "-o", json);
  assert.equal(found, answerHash(readFileSync(json, "utf8")));
  const hash = fields.hash.split(" ")[0];
  assert.ok(said.includes(hash), `${hash} is not in\n${said}`);
  console.log(`Delaunay of 100,000 points: ${hash}`);

  const surface = await at("#tool=surface&points=knot");
  await solve(surface.page);
  const shape = answerHash(await saved(surface.page, "surface.json"));
  await surface.page.context().close();
  const knot = join(process.env.PAGE, "samples/knot.xyz");
  taut("surface", knot, "-o", scratch("knot.json"));
  assert.equal(shape, answerHash(readFileSync(scratch("knot.json"), "utf8")));
  console.log(`Surface of the knot: ${shape.slice(0, 16)}`);
});

test("the words are those of the command", async () => {
  // Of a triangulation, which has the same digits everywhere.
  const { page } = await at("#tool=delaunay&points=clouds");
  const { verdict, text, fields } = await solve(page);
  await page.context().close();
  const clouds = join(process.env.PAGE, "samples/clouds.csv");
  const said = taut("delaunay", clouds, "-o", scratch("clouds.json")).replace(/[;\s]+/g, " ");
  for (const name of ["sites", "simplices", "hull", "dimension", "verified", "hash"]) {
    assert.ok(said.includes(`${name} ${fields[name].replace(/[;\s]+/g, " ")}`), `${name}: ${fields[name]}\n${said}`);
  }
  const verified = taut("verify", scratch("clouds.json"), clouds);
  assert.ok(verified.startsWith(`${verdict.slice(2)}: ${text}`), `${verdict}: ${text}\n${verified}`);
});

test("memory that has run out is told, and the page goes on", async () => {
  // Pages of 64 KiB: enough for a few points, not for the triangulation.
  const small = await launch("--wasm-max-mem-pages=200");
  const { page } = await open(small, server.address, "#tool=delaunay&points=plane-100000");
  await page.click("#solve");
  await page.waitForSelector("#error:not([hidden])");
  assert.match(await page.textContent("#error"), /memory of the page has run out/);
  await page.selectOption("#sample", "few");
  await page.waitForSelector("body[data-state=idle]");
  const { verdict } = await solve(page);
  assert.match(verdict, /^✓ Verified/);
  assert.equal(await page.isHidden("#error"), true);
  await small.close();
});

test("points that cannot fit are refused before anything runs", async () => {
  const { page } = await at("#tool=surface&points=knot");
  const points = scratch("many.npy");
  taut("generate", "uniform", "-n", "800000", "-d", "3", "--type", "f32", "-o", points);
  await page.setInputFiles("#file", points);
  await page.waitForSelector("#points:has-text('800,000 points')");
  assert.match(await page.textContent("#limit"), /at most 4\.0 GiB: about 710,000 points fit/);
  await page.click("#solve");
  await page.waitForSelector("#error:not([hidden])");
  assert.match(await page.textContent("#error"), /points fit/);
  assert.equal(await page.isHidden("#verdict"), true);
  await page.context().close();
});

test("work is stopped, and can begin again", async () => {
  const { page } = await at("#tool=surface&points=torus-36000");
  await page.click("#solve");
  await page.waitForSelector("#stop:not([hidden])");
  await page.click("#stop");
  await page.waitForSelector("body[data-state=idle]");
  assert.equal(await page.textContent("#status"), "Stopped.");
  await page.selectOption("#sample", "knot");
  await page.waitForSelector("body[data-state=idle]");
  assert.match((await solve(page)).verdict, /^✓ Verified/);
  await page.context().close();
});

test("a phone shows all of it in its width, dark if it likes", async () => {
  const phone = { viewport: { width: 360, height: 740 }, deviceScaleFactor: 2, isMobile: true, hasTouch: true, colorScheme: "dark" };
  const { page, seen } = await at("#tool=ball&points=clouds", phone);
  await solve(page);
  const [width, ground] = await page.evaluate(() => [
    document.documentElement.scrollWidth,
    getComputedStyle(document.documentElement).backgroundColor,
  ]);
  assert.ok(width <= 360, `${width} pixels wide`);
  const brightness = ground.match(/\d+/g).slice(0, 3).map(Number).reduce((a, b) => a + b);
  assert.ok(brightness < 120, ground);
  assert.deepEqual(seen.errors, []);
  await page.context().close();
});

test("points are pasted, opened and refused by name", async () => {
  const { page } = await at("#tool=ball&points=clouds");
  await page.click("#paste summary");
  await page.fill("#text", "x,y\n0,0\n2,0\n1,1\n");
  await page.click("#use-text");
  await page.waitForSelector("#points:has-text('3 points')");
  // The last digit depends on the vectors.
  const radius = async () => Number((await solve(page)).fields.radius);
  assert.ok(Math.abs((await radius()) - 1) < 1e-12);

  await page.setInputFiles("#file", { name: "three.geojson", mimeType: "", buffer: Buffer.from('{"type":"MultiPoint","coordinates":[[0,0],[4,0],[2,1]]}') });
  await page.waitForSelector("#points:has-text('three.geojson')");
  assert.ok(Math.abs((await radius()) - 2) < 1e-12);

  await page.setInputFiles("#file", { name: "bad.csv", mimeType: "", buffer: Buffer.from("x,y\n0,0\n1,nan\n") });
  await page.waitForSelector("#error:not([hidden])");
  assert.match(await page.textContent("#error"), /bad\.csv.*must be finite/);
  await page.context().close();
});

test("the address holds the state", async () => {
  const { page } = await at("#tool=centers&points=europe&k=8&discrete=true");
  assert.equal(await page.inputValue("[name=k]"), "8");
  assert.equal(await page.isChecked("[name=discrete]"), true);
  await page.fill("[name=k]", "3");
  await page.dispatchEvent("[name=k]", "change");
  const url = new URLSearchParams(new URL(page.url()).hash.slice(1));
  assert.deepEqual(Object.fromEntries(url), { tool: "centers", points: "europe", k: "3", discrete: "true" });
  await page.context().close();
});

for (const [tool, sample, first, last] of [
  ["ball", "normal-64", /The ball of 2 points/, /smallest ball/],
  ["delaunay", "few", /Point 1 of 60/, /Point 60 of 60/],
  ["surface", "knot", /^0 of [\d,]+ facets obeyed/, /The surface: 4000 triangles/],
  ["centers", "few", /Farthest first: 1 center/, /The answer: 4 centers/],
]) {
  test(`${tool}: steps are shown one by one`, async () => {
    const { page, seen } = await at(`#tool=${tool}&points=${sample}`);
    await solve(page);
    await page.click("#show-steps");
    await page.waitForSelector("body[data-step='0']");
    const words = async () => (await page.textContent("#step-title")) + (await page.textContent("#step-text"));
    assert.match(await words(), first);
    const end = Number(await page.getAttribute("#step", "max"));
    assert.ok(end >= 2, `${end + 1} steps`);
    await page.click("#forward");
    await page.waitForSelector("body[data-step='1']");
    await page.fill("#step", String(end));
    await page.waitForSelector(`body[data-step='${end}']`);
    assert.match(await words(), last);
    assert.ok((await colors(page, "#step-picture")) > 10, "the picture is not blank");
    assert.deepEqual(seen.errors, []);
    await page.context().close();
  });
}

test("nothing can be sent elsewhere, even by the page's own code", async () => {
  const { page } = await at("#tool=ball&points=clouds");
  const refused = await page.evaluate(() => fetch("https://example.org/").then(() => false, () => true));
  assert.equal(refused, true);
  await solve(page);
  const frame = page.frames().find((frame) => frame !== page.mainFrame());
  assert.equal(await frame.evaluate(() => fetch("/index.html").then(() => false, () => true)), true);
  await page.context().close();
});
