// The worker: one session of taut, asked by messages. A module that ends takes the worker with it, and says why before.

import init, { Session, samples, tools } from "./taut/taut_web.js";

/** Milliseconds between two reports of progress. */
const REPORT_INTERVAL = 60;

let panic = null;
let session = null;
let steps = null;

const progress = { stage: "", pass: 0, points: 0, done: 0 };
let reported = 0;

function report() {
  const now = performance.now();
  if (now - reported < REPORT_INTERVAL) return;
  reported = now;
  postMessage({ progress });
}

globalThis.tautPass = (pass, points) => {
  Object.assign(progress, { pass, points, done: 0 });
  report();
};
globalThis.tautPoints = (points) => {
  progress.done += points;
  report();
};
globalThis.tautPanicked = (message) => {
  panic = message;
};

function begin(stage) {
  Object.assign(progress, { stage, pass: 0, points: 0, done: 0 });
  reported = 0;
  report();
}

/** Runs one stage, and returns its result and how long it took. */
function timed(stage, work) {
  begin(stage);
  const start = performance.now();
  const result = work();
  return [result, performance.now() - start];
}

const actions = {
  describe: () => ({ tools: JSON.parse(tools()), samples: JSON.parse(samples()) }),

  open({ bytes, name, sample }) {
    steps?.free();
    session?.free();
    steps = session = null;
    begin("reading");
    session = bytes ? Session.open(new Uint8Array(bytes), name) : Session.generate(sample);
    return JSON.parse(session.describe());
  },

  limit: ({ tool }) => JSON.parse(session.limit(tool)),

  solve({ tool, options }) {
    const [, solving] = timed("solving", () => session.solve(tool, options));
    const [said, checking] = timed("checking", () => JSON.parse(session.check()));
    return { ...said, times: { solving, checking } };
  },

  picture() {
    const [page, drawing] = timed("drawing", () => session.picture());
    return { page, drawing };
  },

  download: ({ name }) => (name.endsWith(".json") ? session.json() : session.file(name)),

  steps({ tool, options }) {
    steps?.free();
    steps = null;
    begin("tracing");
    steps = session.steps(tool, options);
    return { count: steps.count() };
  },

  step: ({ step, dark, width }) => ({ ...JSON.parse(steps.words(step)), picture: steps.picture(step, dark, width) }),
};

/** Says why the module has ended, from what it threw. */
function ending(error) {
  const isCapacity = panic?.includes("capacity overflow") || panic?.includes("allocation");
  if (panic && !isCapacity) return { kind: "failed", message: panic };
  if (error instanceof WebAssembly.RuntimeError || error instanceof RangeError || isCapacity) {
    return { kind: "memory", message: "the memory of the page has run out" };
  }
  return null;
}

let ready = null;

addEventListener("message", async ({ data }) => {
  if (data.module) {
    ready = init({ module_or_path: data.module });
    return;
  }
  const { id, action, values } = data;
  try {
    while (!ready) await new Promise((resume) => setTimeout(resume, 5));
    await ready;
    postMessage({ id, result: actions[action](values) });
  } catch (error) {
    const dead = ending(error);
    postMessage(dead ? { dead } : { id, error: error.message ?? String(error) });
  }
});
