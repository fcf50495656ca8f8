// What is shown of an answer: the verdict, the fields of the report, the picture.

import { make } from "./form.js";

const at = (id) => document.getElementById(id);

export function clearResults() {
  for (const id of ["verdict", "picture", "steps"]) at(id).hidden = true;
  at("frame").replaceChildren();
  delete document.body.dataset.solved;
}

/** A row of a report: what is proved is marked as such. */
function row({ name, value, remark, standing }) {
  const cell = make("td", {}, value);
  const words = [standing, remark].filter(Boolean).join(": ");
  if (standing === "proved") cell.append(" ", make("b", {}, "proved"), remark ? make("span", {}, `: ${remark}`) : "");
  else if (words) cell.append(" ", make("span", {}, words));
  return make("tr", {}, make("th", { scope: "row" }, name), cell);
}

/** Shows what the checker said, in the words of the command. */
export function showVerdict(said, downloads) {
  at("verdict").hidden = false;
  at("verdict").classList.toggle("rejected", !said.verified);
  const [first] = said.verdict.split("\n");
  const [title, ...rest] = first.split(": ");
  at("verdict-title").textContent = said.verified ? `✓ ${title}` : `✗ ${title}`;
  at("verdict-text").textContent = rest.join(": ");
  at("claims").replaceChildren(...(said.claims ?? []).map(row));
  at("fields").replaceChildren(...said.fields.map(row));
  at("downloads").replaceChildren("Save", ...downloads);
}

const seconds = (time) => (time < 1000 ? `${time.toFixed(time < 10 ? 1 : 0)} ms` : `${(time / 1000).toFixed(2)} s`);

/** Shows how long each stage took, in milliseconds. */
export function showTimes(times) {
  at("times").textContent = Object.entries(times)
    .map(([stage, time]) => `${stage} ${seconds(time)}`)
    .join(" · ");
  document.body.dataset.times = JSON.stringify(times);
}

/** Shows a page of pictures in a frame of its own, or says why there is none. */
export function showPicture(page, why) {
  at("picture").hidden = false;
  if (page === null) {
    at("frame").replaceChildren(make("p", { className: "quiet" }, why));
    return Promise.resolve();
  }
  const frame = make("iframe", { title: "Pictures of the answer", src: "picture.html" });
  frame.setAttribute("sandbox", "allow-scripts");
  return new Promise((resolve) => {
    frame.addEventListener("load", () => frame.contentWindow.postMessage(page, "*"), { once: true });
    const measured = ({ source, data }) => {
      if (!frame.isConnected) removeEventListener("message", measured);
      if (source !== frame.contentWindow || typeof data?.height !== "number") return;
      frame.style.height = `${Math.ceil(Math.min(Math.max(data.height, 200), 20_000))}px`;
      resolve();
    };
    addEventListener("message", measured);
    at("frame").replaceChildren(frame);
  });
}
