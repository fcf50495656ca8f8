// The worker and its life: one request at a time, ended to stop it, started again when its memory has run out.

/** Why a request came to no end of its own. */
export class Interrupted extends Error {
  /** @param {"stopped" | "memory" | "failed"} kind */
  constructor(kind, message) {
    super(message);
    this.kind = kind;
  }
}

export class Runner {
  #module;
  #worker;
  #waiting = new Map();
  #next = 1;

  /** Called with { stage, pass, done, points } while a request runs. */
  onProgress = () => {};

  /** Starts loading; the first request waits for it. */
  constructor() {
    // Compiled once, for all workers that follow.
    this.#module = WebAssembly.compileStreaming(fetch("taut/taut_web_bg.wasm"));
    this.#start();
  }

  #start() {
    const worker = new Worker("worker.js", { type: "module" });
    this.#worker = worker;
    worker.onmessage = ({ data }) => this.#receive(data);
    worker.onerror = (event) => this.#end(new Interrupted("failed", event.message || "the worker could not be started"));
    this.#module.then(
      (module) => worker.postMessage({ module }),
      (error) => this.#end(new Interrupted("failed", `the module could not be loaded: ${error.message}`)),
    );
  }

  #receive(data) {
    if (data.progress) {
      this.onProgress(data.progress);
      return;
    }
    if (data.dead) {
      this.#restart(new Interrupted(data.dead.kind, data.dead.message));
      return;
    }
    const waiting = this.#waiting.get(data.id);
    this.#waiting.delete(data.id);
    if ("error" in data) waiting?.reject(new Error(data.error));
    else waiting?.resolve(data.result);
  }

  #end(why) {
    const waiting = [...this.#waiting.values()];
    this.#waiting.clear();
    waiting.forEach(({ reject }) => reject(why));
  }

  #restart(why) {
    this.#worker.terminate();
    this.#start();
    this.#end(why);
  }

  /** Ends what runs. The next request finds a new worker, which has no points yet. */
  stop() {
    this.#restart(new Interrupted("stopped", "stopped"));
  }

  /** Asks the worker to do something. */
  ask(action, values = {}, transfer = []) {
    return new Promise((resolve, reject) => {
      const id = this.#next++;
      this.#waiting.set(id, { resolve, reject });
      this.#worker.postMessage({ id, action, values }, transfer);
    });
  }
}
