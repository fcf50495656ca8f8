// The slider through the steps of an algorithm.

const at = (id) => document.getElementById(id);

/** Milliseconds between two steps that are played. */
const PLAY_INTERVAL = 700;

/** Pixels: wider pictures have no more to show. */
const WIDTH_MAX = 860;

const INTROS = {
  ball: "The farthest point joins a core-set, round by round, until its smallest ball holds all points.",
  centers: "Farthest-first centers, then the branches that prove that no k balls are much smaller.",
  surface: "Facets of the triangulation tell, the surest first, which parts of space are on one side of the surface.",
  delaunay: "Points are inserted one by one; each replaces the triangles whose circumcircles hold it.",
};

export class Stepper {
  #runner;
  #load;
  #chosen = null;
  #count = 0;
  #timer = 0;
  #wanted = 0;
  #isDrawing = false;
  #dark = matchMedia("(prefers-color-scheme: dark)");

  /** `load` sees to it that the worker has the points. */
  constructor(runner, load) {
    this.#runner = runner;
    this.#load = load;
    at("show-steps").addEventListener("click", () => this.#open());
    at("step").addEventListener("input", () => this.#go(Number(at("step").value)));
    at("back").addEventListener("click", () => this.#go(this.#wanted - 1));
    at("forward").addEventListener("click", () => this.#go(this.#wanted + 1));
    at("play").addEventListener("click", () => (this.#timer ? this.#pause() : this.#play()));
    this.#dark.addEventListener("change", () => this.#count > 0 && this.#go(this.#wanted));
  }

  /** Offers the steps of a tool that has some. */
  offer(tool, options) {
    this.close();
    this.#chosen = { tool: tool.name, options };
    at("steps").hidden = !tool.steps;
    at("steps-intro").textContent = INTROS[tool.name] ?? "";
  }

  close() {
    this.#pause();
    this.#count = 0;
    at("steps").hidden = at("stepper").hidden = true;
    at("show-steps").hidden = false;
    delete document.body.dataset.step;
  }

  async #open() {
    at("show-steps").disabled = true;
    try {
      await this.#load();
      const { count } = await this.#runner.ask("steps", this.#chosen);
      this.#count = count;
      at("step").max = count - 1;
      at("show-steps").hidden = true;
      at("stepper").hidden = false;
      await this.#go(0);
    } catch (error) {
      at("steps-intro").textContent = error.message;
    } finally {
      at("show-steps").disabled = false;
    }
  }

  /** Shows a step; while one is drawn, the last that was wanted comes next. */
  async #go(step) {
    this.#wanted = Math.min(Math.max(step, 0), this.#count - 1);
    at("step").value = this.#wanted;
    if (this.#isDrawing) return;
    this.#isDrawing = true;
    try {
      let shown = -1;
      while (this.#count > 0 && shown !== this.#wanted) {
        shown = this.#wanted;
        const width = Math.min(at("stepper").clientWidth, WIDTH_MAX);
        this.#draw(shown, await this.#runner.ask("step", { step: shown, dark: this.#dark.matches, width }));
      }
    } catch (error) {
      this.#pause();
      at("step-text").textContent = error.message;
    } finally {
      this.#isDrawing = false;
    }
  }

  #draw(step, { title, text, picture }) {
    at("step-title").textContent = title;
    at("step-text").textContent = text;
    at("back").disabled = step === 0;
    at("forward").disabled = step === this.#count - 1;
    const image = at("step-picture");
    const earlier = image.src;
    image.src = URL.createObjectURL(new Blob([picture], { type: "image/svg+xml" }));
    image.alt = `${title}. ${text}`;
    if (earlier) URL.revokeObjectURL(earlier);
    document.body.dataset.step = step;
  }

  #play() {
    if (this.#wanted === this.#count - 1) this.#go(0);
    at("play").textContent = "Pause";
    this.#timer = setInterval(() => {
      if (this.#wanted >= this.#count - 1) this.#pause();
      else this.#go(this.#wanted + 1);
    }, PLAY_INTERVAL);
  }

  #pause() {
    clearInterval(this.#timer);
    this.#timer = 0;
    at("play").textContent = "Play";
  }
}
