// The page: points in, a tool chosen, an answer found and checked in the worker, and shown.

import { asked, given, make, show } from "./form.js";
import { Runner } from "./runner.js";
import * as state from "./state.js";
import { Stepper } from "./stepper.js";
import { clearResults, showPicture, showTimes, showVerdict } from "./view.js";

/** Bytes of a file that is read: more do not fit beside their points. */
const FILE_BYTES_MAX = 1.5e9;

const at = (id) => document.getElementById(id);
const runner = new Runner();
const stepper = new Stepper(runner, () => load());

let tools = [];
let samples = [];
/** What the worker is given when it starts again: a sample by its name, or a file. */
let origin = null;
/** States whether the worker has these points. */
let isLoaded = false;
let description = null;
let isBusy = false;

const tool = () => tools.find(({ name }) => name === at("tool").value);
const options = () => given(at("options"), tool());

function remember() {
  state.write({ tool: tool().name, points: origin?.sample, options: options() });
}

function say(words) {
  at("status").textContent = words;
}

function complain(words) {
  at("error").textContent = words;
  at("error").hidden = !words;
}

/** Marks the page as working or as waiting. */
function setBusy(busy) {
  isBusy = busy;
  at("solve").disabled = busy;
  at("stop").hidden = !busy;
  at("progress").hidden = !busy;
  at("progress").removeAttribute("value");
  document.body.dataset.state = busy ? "busy" : "idle";
}

runner.onProgress = ({ stage, pass, points, done }) => {
  if (!isBusy) return;
  const share = points > 0 ? Math.min(1, done / points) : null;
  if (share === null || stage !== "solving") at("progress").removeAttribute("value");
  else at("progress").value = share;
  say(pass > 0 ? `${stage}: pass ${pass}` : stage);
};

/** Runs some work of the worker; says what went wrong, and gives the worker its points again when it has ended. */
async function attempt(work) {
  if (isBusy) return false;
  setBusy(true);
  complain("");
  try {
    await work();
    return true;
  } catch (error) {
    if (error.kind) isLoaded = false;
    if (error.kind === "stopped") say("Stopped.");
    else if (error.kind === "memory") {
      say("");
      complain("The memory of the page has run out. Nothing else is lost: choose fewer points or another tool. The command taut has no such limit.");
    } else {
      say("");
      complain(error.kind ? `Something went wrong, and the worker was started again: ${error.message}` : error.message);
    }
    return false;
  } finally {
    setBusy(false);
  }
}

/** The bytes of the points, or the name of a sample that is calculated. */
async function fetched() {
  if (origin.file) return { bytes: await origin.file.arrayBuffer(), name: origin.file.name };
  const sample = samples.find(({ name }) => name === origin.sample);
  if (!sample.file) return { sample: sample.name };
  const response = await fetch(`samples/${sample.file}`);
  if (!response.ok) throw new Error(`${sample.file}: the server says ${response.status}`);
  return { bytes: await response.arrayBuffer(), name: sample.file };
}

/** Sees to it that the worker has the points. */
async function load() {
  if (isLoaded) return;
  const points = await fetched();
  description = await runner.ask("open", points, points.bytes ? [points.bytes] : []);
  isLoaded = true;
  const { name, rows, columns } = description;
  const digits = (number) => (number < 10_000 ? String(number) : number.toLocaleString("en"));
  const counted = (number, noun) => `${digits(number)} ${noun}${number === 1 ? "" : "s"}`;
  at("points").textContent = `${name}: ${counted(rows, "point")}, ${counted(columns, "coordinate")} each`;
}

/** Tells how much memory the tool takes. Returns false if that is too much. */
async function limit() {
  const { fits, words } = await runner.ask("limit", { tool: tool().name });
  at("limit").textContent = words;
  at("limit").hidden = !words;
  return fits;
}

async function choosePoints(chosen) {
  origin = chosen;
  isLoaded = false;
  clearResults();
  stepper.close();
  at("points").textContent = "Loading…";
  remember();
  const done = await attempt(async () => {
    if (origin.file?.size > FILE_BYTES_MAX) throw new Error(`${origin.file.name} is larger than 1.5 GB, which a page cannot hold: use the command taut`);
    await load();
    await limit();
  });
  say(done ? "" : at("status").textContent);
  if (!isLoaded) at("points").textContent = "No points.";
  return done;
}

async function solve() {
  clearResults();
  stepper.close();
  remember();
  const chosen = { tool: tool().name, options: asked(tool(), options()) };
  const start = performance.now();
  await attempt(async () => {
    await load();
    if (!(await limit())) throw new Error(at("limit").textContent);
    const said = await runner.ask("solve", chosen);
    showVerdict(said, downloads(chosen.tool));
    showTimes(said.times);
    say("drawing");
    try {
      const { page, drawing } = await runner.ask("picture");
      await showPicture(page);
      showTimes({ ...said.times, drawing });
    } catch (error) {
      if (error.kind) throw error;
      await showPicture(null, error.message);
    }
    stepper.offer(tool(), chosen.options);
    say(`Done in ${((performance.now() - start) / 1000).toFixed(2)} s.`);
    document.body.dataset.solved = chosen.tool;
  });
}

/** Buttons that save the answer. */
function downloads(name) {
  return ["json", ...tool().files].map((extension) => {
    const file = `${name}.${extension}`;
    const save = () =>
      attempt(async () => {
        const bytes = await runner.ask("download", { name: file });
        const link = make("a", { href: URL.createObjectURL(new Blob([bytes])), download: file });
        link.click();
        setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
      });
    return make("button", { type: "button", title: `Save ${file}`, onclick: save }, file);
  });
}

function chooseTool(name, values) {
  at("tool").value = name;
  at("tool-help").textContent = tool().help;
  show(at("options"), tool(), values);
}

/** The file that pasted text stands for. */
function pasted(text) {
  const begin = text.trimStart();
  const extension = begin.startsWith("{") ? "geojson" : begin.startsWith("ply") ? "ply" : /[,;]/.test(begin) ? "csv" : "txt";
  return new File([text], `pasted.${extension}`);
}

function listen() {
  at("input").addEventListener("submit", (event) => {
    event.preventDefault();
    solve();
  });
  at("stop").addEventListener("click", () => runner.stop());
  at("tool").addEventListener("change", async () => {
    chooseTool(at("tool").value, {});
    // A sample that does not suit the tool is changed for one that does.
    const suited = samples.filter((sample) => sample.tools.includes(tool().name));
    const suits = !origin.sample || suited.some(({ name }) => name === origin.sample);
    if (!suits) {
      at("sample").value = suited[0].name;
      await choosePoints({ sample: suited[0].name });
    } else {
      clearResults();
      stepper.close();
      remember();
      await attempt(async () => {
        await load();
        await limit();
      });
      say("");
    }
  });
  at("options").addEventListener("change", remember);
  at("sample").addEventListener("change", () => {
    if (at("sample").value) choosePoints({ sample: at("sample").value });
  });
  const take = (file) => {
    if (!file) return;
    at("sample").value = "";
    choosePoints({ file });
  };
  at("file").addEventListener("change", () => take(at("file").files[0]));
  at("use-text").addEventListener("click", () => take(pasted(at("text").value)));
  addEventListener("dragover", (event) => {
    event.preventDefault();
    document.body.classList.add("dropping");
  });
  addEventListener("dragleave", (event) => {
    if (!event.relatedTarget) document.body.classList.remove("dropping");
  });
  addEventListener("drop", (event) => {
    event.preventDefault();
    document.body.classList.remove("dropping");
    take(event.dataTransfer.files[0]);
  });
  addEventListener("hashchange", begin);
}

/** Brings the page to the state that its address tells. */
async function begin() {
  const told = state.read();
  const isKnown = tools.some(({ name }) => name === told.tool);
  chooseTool(isKnown ? told.tool : tools[0].name, told.options);
  const suited = samples.filter((sample) => sample.tools.includes(tool().name));
  const sample = samples.find(({ name }) => name === told.points) ?? suited[0];
  at("sample").value = sample.name;
  return choosePoints({ sample: sample.name });
}

async function start() {
  try {
    ({ tools, samples } = await runner.ask("describe"));
  } catch (error) {
    at("points").textContent = "";
    complain(error.message);
    return;
  }
  at("tool").append(...tools.map(({ name, help }) => make("option", { value: name, title: help }, name)));
  at("sample").append(make("option", { value: "", hidden: true }, "your own"));
  at("sample").append(...samples.map(({ name, title }) => make("option", { value: name }, title)));
  listen();
  if (await begin()) document.body.dataset.ready = "yes";
}

start();
