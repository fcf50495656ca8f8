// As much of a browser as the viewer of a page touches: runs the script of a page and says what it drew, as lines of "name value".
"use strict";
const html = require("fs").readFileSync(process.argv[2], "utf8");
const scripts = [...html.matchAll(/<script( type="application\/json" class="data")?>([\s\S]*?)<\/script>/g)];
const scenes = scripts.filter((s) => s[1]).map((s) => s[2]).filter((text) => text.includes('"layers"'));
const program = scripts.filter((s) => !s[1]).pop()[2];

const images = [], strokes = [];
const context = () => new Proxy({ alpha: 1 }, {
  get: (_, name) => {
    if (name === "putImageData") return (image) => images.push(image);
    if (name === "createRadialGradient") return () => ({ addColorStop() {} });
    if (name === "stroke") return function () { strokes.push(this.globalAlpha); };
    return name in _ ? _[name] : () => {};
  },
  set: (target, name, value) => { target[name] = value; return true; },
});
const canvas = () => ({ listeners: {}, clientWidth: 400, width: 0, height: 0, pen: context(),
  getContext(kind) { return kind === "2d" ? this.pen : null; },
  addEventListener(name, f) { this.listeners[name] = f; }, setPointerCapture() {} });
const element = () => ({ dataset: { layer: "0" }, classList: { toggle() {} }, listeners: {}, append() {}, after() {}, setAttribute() {},
  addEventListener(name, f) { this.listeners[name] = f; } });
const entry = element();
const colors = { answer: "#0072b2", second: "#b87f00", ground: "#ffffff" };
const shown = canvas();
global.ImageData = class { constructor(data, width, height) { Object.assign(this, { data, width, height }); } };
global.devicePixelRatio = 1;
global.getComputedStyle = () => ({ fontFamily: "Inter", getPropertyValue: (name) => colors[name.slice(2)] || "#808080" });
global.requestAnimationFrame = (f) => f();
global.addEventListener = () => {};
global.matchMedia = () => ({ addEventListener() {} });
global.document = {
  getElementById: () => ({ style: {} }), documentElement: {}, body: {}, activeElement: null, createElement: (tag) => tag === "canvas" ? canvas() : element(),
  fonts: { ready: { then() {} } },
  querySelectorAll: (what) => what !== "figure.space" ? [] : scenes.slice(0, 1).map((textContent) => ({
    querySelector: (part) => part === "canvas" ? shown : { ...element(), textContent },
    matches: () => false,
    querySelectorAll: (what) => what === ".legend li" ? [entry] : what === "canvas" ? [shown] : [],
  })),
};
new Function(program)();

const tell = (when) => {
  const { data, width, height } = images.pop();
  let covered = 0, blue = 0;
  for (let i = 0; i < data.length; i += 4) if (data[i + 3]) { covered++; blue += data[i + 2] > data[i]; }
  console.log(when + "-part " + covered / (width * height));
  console.log(when + "-blue " + blue / covered);
  console.log(when + "-width " + width);
  console.log(when + "-pale " + strokes.filter((alpha) => alpha === .2).length);
  strokes.length = 0;
};
tell("rest");
shown.listeners.keydown({ key: "ArrowLeft", preventDefault() {} });
tell("moving");
images.length = 0;
entry.listeners.click();
console.log("hidden-images " + images.length);
