// A server of static files, a browser, and what the tests ask of the page.

import { createHash } from "node:crypto";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { extname, join, normalize } from "node:path";
import { chromium } from "playwright-core";

const { PAGE, TAUT, CHROMIUM } = process.env;

const TYPES = {
  ".html": "text/html; charset=utf-8",
  ".css": "text/css",
  ".js": "text/javascript",
  ".svg": "image/svg+xml",
  ".wasm": "application/wasm",
  ".csv": "text/csv",
};

/** Milliseconds until a wait has failed: machines of tests are slow and shared. */
export const PATIENCE_MS = 120_000;

/** Serves the folder of the page; returns its address and what ends it. */
export async function serve() {
  const server = createServer((request, response) => {
    const path = normalize(new URL(request.url, "http://localhost").pathname).replace(/\/$/, "/index.html");
    try {
      const body = readFileSync(join(PAGE, path));
      response.writeHead(200, { "content-type": TYPES[extname(path)] ?? "application/octet-stream" }).end(body);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((listening) => server.listen(0, "127.0.0.1", listening));
  return { address: `http://127.0.0.1:${server.address().port}/`, close: () => server.close() };
}

/** Starts a browser; `flags` are further ones of V8. */
export function launch(flags = "") {
  return chromium.launch({
    executablePath: CHROMIUM,
    args: ["--no-sandbox", "--disable-gpu", ...(flags ? [`--js-flags=${flags}`] : [])],
  });
}

/** Opens the page at a state of its address; collects its errors and requests. */
export async function open(browser, address, hash = "", context = {}) {
  const page = await (await browser.newContext({ acceptDownloads: true, ...context })).newPage();
  page.setDefaultTimeout(PATIENCE_MS);
  const seen = { errors: [], requests: [] };
  page.on("pageerror", (error) => seen.errors.push(error.message));
  page.on("console", (message) => message.type() === "error" && seen.errors.push(message.text()));
  page.on("request", (request) => seen.requests.push(request.url()));
  await page.goto(address + hash);
  await page.waitForSelector("body[data-ready=yes]");
  return { page, seen };
}

/** Solves, and returns the words of the verdict and the fields of the report. */
export async function solve(page) {
  await page.click("#solve");
  await page.waitForSelector("body[data-solved][data-state=idle]");
  const rows = await page.$$eval("#fields tr", (rows) => rows.map((row) => [...row.children].map((cell) => cell.textContent)));
  return {
    verdict: await page.textContent("#verdict-title"),
    text: await page.textContent("#verdict-text"),
    fields: Object.fromEntries(rows),
    times: JSON.parse(await page.getAttribute("body", "data-times")),
  };
}

/** Saves a file of the answer, and returns its bytes. */
export async function saved(page, name) {
  const [download] = await Promise.all([page.waitForEvent("download"), page.click(`#downloads button:has-text("${name}")`)]);
  return readFileSync(await download.path());
}

/** Counts the colors of an element as it is seen. */
export async function colors(page, selector) {
  const element = await page.waitForSelector(selector);
  const png = (await element.screenshot()).toString("base64");
  const reader = await page.context().newPage();
  const count = await reader.evaluate(async (png) => {
    const image = new Image();
    image.src = `data:image/png;base64,${png}`;
    await image.decode();
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    const pixels = new Uint32Array(context.getImageData(0, 0, image.width, image.height).data.buffer);
    return new Set(pixels).size;
  }, png);
  await reader.close();
  return count;
}

const folder = mkdtempSync(join(tmpdir(), "taut-page-"));

/** A path for a file of the command. */
export const scratch = (name) => join(folder, name);

/** Runs the command; returns what it says. */
export const taut = (...words) => execFileSync(TAUT, words, { encoding: "utf8", maxBuffer: 1 << 28 });

export const sha256 = (bytes) => createHash("sha256").update(bytes).digest("hex");

/** The hash of what an answer is, without how it came about. */
export function answerHash(json) {
  const { kind, answer, certificate } = JSON.parse(json);
  return sha256(JSON.stringify({ kind, answer, certificate }));
}
