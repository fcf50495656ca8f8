// Figures of the playground: what is sent, how soon it is ready, and its times beside one thread of the command.

import { readFileSync, readdirSync, statSync } from "node:fs";
import { join } from "node:path";
import { brotliCompressSync, constants } from "node:zlib";

import { launch, open, scratch, serve, solve, taut } from "./page.mjs";

/** Runs of each; the least time counts, as others share the machine. */
const RUNS = 3;

const least = (times) => Math.min(...times);

/** Bytes of all files of the first visit, as a server sends them. */
function sent() {
  const folder = process.env.PAGE;
  const files = readdirSync(folder, { recursive: true }).filter((name) => statSync(join(folder, name)).isFile());
  const of = (name) => {
    const bytes = readFileSync(join(folder, name));
    return brotliCompressSync(bytes, { params: { [constants.BROTLI_PARAM_SIZE_HINT]: bytes.length } }).length;
  };
  return files.filter((name) => !name.startsWith("samples")).map(of).reduce((a, b) => a + b);
}

/** Milliseconds from the request of the page to its first points. */
async function ready(browser, address) {
  const start = performance.now();
  const { page } = await open(browser, address);
  const time = performance.now() - start;
  await page.context().close();
  return time;
}

/** Milliseconds of each stage in the browser, for several requests to one page: at the first its code is not all compiled for speed. */
async function inBrowser(browser, address, hash) {
  const { page } = await open(browser, address, hash);
  const times = [];
  for (let run = 0; run <= RUNS; run++) times.push((await solve(page)).times);
  await page.context().close();
  return times;
}

/** Milliseconds of each stage of the command on one thread. */
function native(...words) {
  const said = taut(...words, "--threads", "1", "-o", scratch("answer.json"));
  const line = said.match(/^ {2}time +(.*)$/m)[1];
  const unit = { ms: 1, s: 1000 };
  return Object.fromEntries(
    [...line.matchAll(/(\w+) ([\d.]+) (ms|s)\b/g)].map(([, stage, value, of]) => [stage, value * unit[of]]),
  );
}

const server = await serve();
const browser = await launch();
console.log(`sent              ${(sent() / 1e6).toFixed(2)} MB with brotli, samples left out`);
const starts = [];
for (let run = 0; run < RUNS; run++) starts.push(await ready(browser, server.address));
console.log(`ready             ${(least(starts) / 1000).toFixed(2)} s`);

taut("generate", "uniform", "-n", "100000", "-d", "2", "--seed", "1", "-o", scratch("plane.npy"));
taut("generate", "curve", "--shape", "gear20", "-n", "10000", "-d", "2", "-o", scratch("gear.npy"));
taut("generate", "torus", "-n", "36000", "-d", "3", "--seed", "1", "-o", scratch("torus.npy"));
for (const [tool, sample, file] of [
  ["delaunay", "plane-100000", "plane.npy"],
  ["curve", "gear-10000", "gear.npy"],
  ["surface", "torus-36000", "torus.npy"],
]) {
  const [first, ...again] = await inBrowser(browser, server.address, `#tool=${tool}&points=${sample}`);
  const command = Array.from({ length: RUNS }, () => native(tool, scratch(file)));
  for (const stage of ["solving", "checking"]) {
    const [here, there] = [again, command].map((times) => least(times.map((time) => time[stage])));
    const ratio = `${(here / there).toFixed(2)} times`;
    const words = `first ${first[stage].toFixed(0)} ms, then ${here.toFixed(0)} ms, the command ${there.toFixed(0)} ms: ${ratio}`;
    console.log(`${tool.padEnd(9)} ${stage.padEnd(8)} ${words}`);
  }
}
await browser.close();
server.close();
