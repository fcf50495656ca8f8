// What a page does by itself: words for the mark under the pointer, flat pictures that are moved and saved, scenes of space that are turned.
"use strict";
(() => {
  const tip = document.getElementById("tip");
  const data = (figure) => JSON.parse(figure.querySelector("script.data").textContent);

  // Words: the row of the input, a line for each named coordinate, then what else there is to say.
  const words = (names, mark) => {
    const lines = mark.id === null ? [] : ["point " + mark.id];
    names.forEach((name, k) => { if (name) lines.push(name + ": " + mark.words[k]); });
    return lines.concat(mark.words.slice(names.length).filter(Boolean)).join("\n");
  };
  const show = (text, event) => {
    tip.textContent = text;
    const x = Math.min(event.clientX + 14, innerWidth - tip.offsetWidth - 8);
    const y = Math.min(event.clientY + 14, innerHeight - tip.offsetHeight - 8);
    tip.style.transform = "translate(" + Math.max(8, x) + "px," + Math.max(8, y) + "px)";
    tip.style.visibility = "visible";
  };
  const hide = () => { tip.style.visibility = "hidden"; };
  const nearest = (marks, x, y, reach) => {
    let best = null, square = reach * reach;
    for (const mark of marks) {
      const d = (mark.at[0] - x) ** 2 + (mark.at[1] - y) ** 2;
      if (d <= square) { square = d; best = mark; }
    }
    return best;
  };
  // A mark is its place, number and words, or number and words alone if these tell the place.
  const placed = (list, map) => map.map(([zero, one, log], k) => zero + one * (log ? Math.log10(list[k + 1]) : Number(list[k + 1])));
  const mark = (list, map) => {
    const [at, id, ...words] = Array.isArray(list[0]) ? list : [placed(list, map), ...list];
    return { at, id, words: words.map(String) };
  };

  // A picture as a file of its own: the colors of the page go with it, its fonts do not.
  const save = (svg, name) => {
    const copy = svg.cloneNode(true), style = document.createElementNS("http://www.w3.org/2000/svg", "style");
    style.textContent = document.querySelector("style").textContent.replace(/@font-face\s*\{[^}]*\}/g, "");
    copy.prepend(style);
    const url = URL.createObjectURL(new Blob([new XMLSerializer().serializeToString(copy)], { type: "image/svg+xml" }));
    const link = document.createElement("a");
    link.href = url; link.download = name; link.click();
    setTimeout(() => URL.revokeObjectURL(url), 1000);
  };
  const hint = (figure, text, saved) => {
    const line = document.createElement("div"), button = document.createElement("button");
    line.className = "hint"; line.textContent = text + " ";
    button.type = "button"; button.textContent = "Save picture"; button.addEventListener("click", saved);
    line.append(button); figure.querySelector(".sheet").after(line);
  };
  // An element that switches something off and on; `turn` tells which.
  const button = (element, turn) => {
    const press = () => {
      const is = turn();
      element.classList.toggle("off", is); element.setAttribute("aria-pressed", String(!is));
    };
    element.setAttribute("tabindex", "0"); element.setAttribute("role", "button"); element.setAttribute("aria-pressed", "true");
    element.addEventListener("click", press);
    element.addEventListener("keydown", (event) => { if (event.key === "Enter" || event.key === " ") { event.preventDefault(); event.stopPropagation(); press(); } });
  };
  const file = (figure, end) => figure.querySelector("h3").textContent.toLowerCase().replace(/[^a-z0-9]+/g, "-").slice(0, 60) + end;

  for (const figure of document.querySelectorAll("figure.flat")) {
    const { names, ends, map, marks } = data(figure), svg = figure.querySelector(".sheet svg");
    const all = marks.map((list) => mark(list, map)), plot = !!svg.querySelector("[data-layer=dots], [data-layer=zeros]"), box = svg.viewBox.baseVal, whole = [box.x, box.y, box.width, box.height];
    const off = new Set(), layer = all.map((_, i) => ends.findIndex((end) => i < end));
    const named = (number) => svg.querySelector(`[data-entry="${number}"]`)?.textContent.trim();
    let shown = all;
    const place = (event) => {
      const at = svg.getBoundingClientRect(), unit = box.width / at.width;
      return [box.x + (event.clientX - at.left) * unit, box.y + (event.clientY - at.top) * unit, unit];
    };
    const view = (x, y, width) => {
      const height = width * whole[3] / whole[2];
      box.width = width; box.height = height;
      box.x = Math.min(whole[0] + whole[2] - width, Math.max(whole[0], x));
      box.y = Math.min(whole[1] + whole[3] - height, Math.max(whole[1], y));
      svg.style.touchAction = width < whole[2] ? "none" : "pan-y";
    };
    const enlarge = (factor, [x, y]) => {
      const width = Math.min(whole[2], Math.max(whole[2] / 40, box.width / factor)), part = width / box.width;
      view(x - (x - box.x) * part, y - (y - box.y) * part, width);
    };
    const middle = () => [box.x + box.width / 2, box.y + box.height / 2];
    let held = null;
    svg.setAttribute("tabindex", "0");
    svg.addEventListener("pointerdown", (event) => { if (event.target.closest("[data-entry]")) return; held = place(event); svg.setPointerCapture(event.pointerId); hide(); });
    for (const end of ["pointerup", "pointercancel"]) svg.addEventListener(end, () => { held = null; });
    svg.addEventListener("pointermove", (event) => {
      const [x, y, unit] = place(event);
      if (held) { view(box.x + held[0] - x, box.y + held[1] - y, box.width); return; }
      const found = nearest(shown, x, y, 12 * unit);
      if (found) show([words(names, found), plot && named(layer[all.indexOf(found)])].filter(Boolean).join("\n"), event); else hide();
    });
    svg.addEventListener("pointerleave", hide);
    // The wheel scrolls the page until the picture was clicked.
    svg.addEventListener("wheel", (event) => {
      if (document.activeElement !== svg && !event.ctrlKey) return;
      event.preventDefault(); enlarge(Math.exp(-event.deltaY * .0015), place(event));
    }, { passive: false });
    svg.addEventListener("keydown", (event) => {
      const step = box.width / 10, keys = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step] };
      if (keys[event.key]) view(box.x + keys[event.key][0], box.y + keys[event.key][1], box.width);
      else if (event.key === "+" || event.key === "=") enlarge(1.3, middle());
      else if (event.key === "-") enlarge(1 / 1.3, middle());
      else if (event.key === "0") view(whole[0], whole[1], whole[2]);
      else return;
      event.preventDefault();
    });
    // An entry of the legend hides its marks, and shows them again.
    for (const entry of ends.length ? svg.querySelectorAll("[data-entry]") : []) {
      const number = Number(entry.dataset.entry);
      button(entry, () => {
        const is = !off.delete(number);
        if (is) off.add(number);
        for (const marks of svg.querySelectorAll(`[data-of="${number}"]`)) marks.style.display = is ? "none" : "";
        shown = all.filter((_, i) => !off.has(layer[i]));
        return is;
      });
    }
    hint(figure, "Click and wheel to zoom, drag to move; arrow keys, + and − do the same, 0 goes back.", () => save(svg, file(figure, ".svg")));
  }

  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const along = (a, b, t) => [a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const unit = (a) => along([0, 0, 0], a, 1 / Math.sqrt(dot(a, a)));
  const range = (n, f) => Array.from({ length: n }, (_, i) => f(i));
  const turn = Math.PI / 180;
  const wires = range(5, (k) => range(73, (i) => {
    const t = (k - 2) * 30 * turn, s = i * 5 * turn;
    return [Math.cos(t) * Math.cos(s), Math.cos(t) * Math.sin(s), Math.sin(t)];
  })).concat(range(6, (k) => range(73, (i) => {
    const t = k * 30 * turn, s = i * 5 * turn;
    return [Math.cos(s) * Math.cos(t), Math.cos(s) * Math.sin(t), Math.sin(s)];
  })));

  // A scene as its data, read once for all its pictures.
  const read = (figure) => {
    const scene = data(figure);
    const triples = (numbers) => Array.from({ length: numbers.length / 3 }, (_, i) => Array.from(numbers.slice(3 * i, 3 * i + 3)));
    for (const l of scene.layers) if (l.kind === "mesh") {
      l.vertices = triples(new Float32Array(surfaces.bytes(l.vertices))); l.triangles = triples(new Uint32Array(surfaces.bytes(l.triangles)));
    }
    for (const l of scene.layers) l.marks = l.marks.map((m) => {
      const [at, size, id, ...words] = Array.isArray(m[0]) ? m : [placed(m, scene.map), l.size, ...m, l.label];
      return { at, size, id, words: words.map(String) };
    });
    scene.bodies = scene.layers.filter((l) => l.kind === "surface").map((l) => [l, surfaces.decode(l)]);
    return scene;
  };

  // Draws a scene on a canvas as `start` says, without the layers that are off, and lets it be turned; returns how to draw it again.
  const view = (scene, canvas, start, off) => {
    const pen = canvas.getContext("2d"), { bodies, eye } = scene, perspective = start.perspective;
    const count = scene.layers.reduce((n, l) => n + l.marks.length, 0), side = start.height / start.width, small = start.width < 500 ? .5 : 1;
    let { azimuth, elevation, zoom } = start, marks = [], queued = false, moving = false, rest = 0;
    const shown = () => scene.layers.filter((l) => !off.has(l)), sheet = document.createElement("canvas");

    const draw = () => {
      queued = false;
      const layers = shown(), solids = bodies.filter(([l]) => !off.has(l)).map(([, body]) => body);
      const css = getComputedStyle(document.documentElement), color = (name) => css.getPropertyValue("--" + name).trim();
      const w = canvas.clientWidth || start.width, h = w * side, dpr = devicePixelRatio || 1;
      canvas.width = Math.round(w * dpr); canvas.height = Math.round(h * dpr);
      pen.setTransform(dpr, 0, 0, dpr, 0, 0);
      pen.lineJoin = "round";
      const [sa, ca, se, ce] = [Math.sin(azimuth * turn), Math.cos(azimuth * turn), Math.sin(elevation * turn), Math.cos(elevation * turn)];
      const frame = [[-sa, ca, 0], [-se * ca, -se * sa, ce], [ce * ca, ce * sa, se]];
      const scale = zoom * 0.47 * Math.min(w, h) / (perspective ? eye / Math.sqrt(eye * eye - 1) : 1);
      const turned = (p) => frame.map((axis) => dot(axis, p));
      const grow = (z) => perspective ? eye / (eye - z) : 1;
      const pixel = (v) => { const s = scale * grow(v[2]); return [w / 2 + s * v[0], h / 2 - s * v[1]]; };
      const toEye = (v) => perspective ? [-v[0], -v[1], eye - v[2]] : [0, 0, 1];
      const path = (chain, closed) => {
        if (chain.length < 2) return;
        pen.beginPath();
        chain.forEach((at, i) => i ? pen.lineTo(at[0], at[1]) : pen.moveTo(at[0], at[1]));
        if (closed) pen.closePath();
      };
      marks = [];

      for (const layer of layers) if (layer.kind === "spheres") {
        const wired = layer.marks.length <= scene.wired, ink = color(layer.tone);
        const balls = layer.marks.map((m) => ({ c: turned(m.at), r: m.size, m })).sort((a, b) => a.c[2] - b.c[2]);
        pen.strokeStyle = ink; pen.setLineDash(layer.look === "dashed" ? [6, 5] : []);
        for (const { c, r, m } of balls) {
          const e = toEye(c), sine = perspective ? Math.min(0.999, r / Math.sqrt(dot(e, e))) : 0, axis = unit(e);
          const ring = r * Math.sqrt(1 - sine * sine), u = unit(cross(axis, Math.abs(axis[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0])), v = cross(axis, u);
          path(range(96, (i) => {
            const t = i / 96 * 2 * Math.PI;
            return pixel(along(along(along(c, axis, r * sine), u, ring * Math.cos(t)), v, ring * Math.sin(t)));
          }), true);
          if (layer.look === "filled") {
            if (wired && r > 0) {
              const at = pixel(c), size = r * scale * grow(c[2]);
              const shade = pen.createRadialGradient(at[0] - .28 * size, at[1] - .4 * size, 0, at[0] - .28 * size, at[1] - .4 * size, 1.5 * size);
              [[0, "05"], [.7, "17"], [1, "3d"]].forEach(([t, alpha]) => shade.addColorStop(t, ink + alpha));
              pen.fillStyle = shade; pen.globalAlpha = 1;
            } else { pen.fillStyle = ink; pen.globalAlpha = .08; }
            pen.fill();
          }
          pen.globalAlpha = wired ? 1 : .7; pen.lineWidth = wired ? 2 : .8; pen.stroke();
          if (m.id !== null) marks.push({ at: pixel(c), id: m.id, words: m.words });
        }
        pen.setLineDash([]);
        if (!wired || layer.look === "dashed") continue;
        pen.lineWidth = .8;
        for (const front of [false, true]) {
          pen.globalAlpha = front ? .6 : .3;
          for (const { c, r } of balls) for (const wire of wires) {
            let chain = [];
            for (const n of wire) {
              const normal = turned(n), at = along(c, normal, r);
              if ((dot(normal, toEye(at)) > 0) === front) chain.push(pixel(at));
              else { path(chain, false); if (chain.length > 1) pen.stroke(); chain = []; }
            }
            path(chain, false); if (chain.length > 1) pen.stroke();
          }
        }
      }

      // Surfaces are coarse while they move and finer than the screen at rest.
      const fine = moving ? 1 : Math.min(2 * dpr, Math.sqrt(6e6 / (w * h))), reach = Math.ceil(fine * .75);
      let seen = null;
      if (solids.length) {
        const [across, down] = [w, h].map((side) => Math.max(1, Math.round(side * fine)));
        const camera = { frame, middle: [w / 2 * fine, h / 2 * fine], scale: scale * fine, eye: perspective ? eye : 0 };
        seen = surfaces.draw(solids, camera, across, down, color);
        sheet.width = across; sheet.height = down;
        sheet.getContext("2d").putImageData(new ImageData(seen.paint(Math.ceil(fine / 2)), across, down), 0, 0);
        pen.globalAlpha = 1; pen.imageSmoothingQuality = "high";
        pen.drawImage(sheet, 0, 0, across / fine, down / fine);
      }
      const hidden = (v, at) => seen !== null && seen.hides(at[0] * fine, at[1] * fine, perspective ? grow(v[2]) : 1 + v[2] / eye, reach);

      const pieces = [];
      for (const layer of layers) {
        if (layer.kind === "points" || layer.kind === "crosses") for (const m of layer.marks) {
          const v = turned(m.at), at = pixel(v);
          pieces.push({ z: v[2], layer, at, hidden: hidden(v, at), size: m.size * grow(v[2]) * Math.sqrt(zoom) });
          if (layer.kind === "points") marks.push({ at, id: m.id, words: m.words });
        }
        for (const chain of layer.chains || []) for (let i = 1; i < chain.length; i++) {
          const a = turned(chain[i - 1]), b = turned(chain[i]);
          const ends = [pixel(a), pixel(b)];
          const steps = seen ? Math.min(4000, Math.max(1, Math.ceil(Math.hypot(ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]) / 1.5))) : 1;
          let begun = a, before = null;
          for (let j = 0; j <= steps; j++) {
            const v = along(a, along(b, a, -1), Math.min(1, (j + .5) / steps)), now = j < steps ? hidden(v, pixel(v)) : null;
            if (before === null) before = now;
            if (now === before) continue;
            const end = j < steps ? along(a, along(b, a, -1), j / steps) : b;
            pieces.push({ z: (begun[2] + end[2]) / 2, layer, hidden: before, chain: [pixel(begun), pixel(end)] });
            begun = end; before = now;
          }
        }
        if (layer.kind === "mesh") for (const t of layer.triangles) {
          const [a, b, c] = t.map((i) => turned(layer.vertices[i])), n = cross(along(b, a, -1), along(c, a, -1)), size = Math.sqrt(dot(n, n));
          const light = size > 0 ? Math.abs(dot(n, [-.3, .5, .81])) / size : 0;
          pieces.push({ z: (a[2] + b[2] + c[2]) / 3, layer, face: [pixel(a), pixel(b), pixel(c)], light });
        }
      }
      pieces.sort((a, b) => a.z - b.z);
      const many = count > 2000, rimless = seen !== null && count > 50, inks = {}, ground = color("ground");
      for (const p of pieces) {
        const tone = p.layer.tone, ink = inks[tone] || (inks[tone] = color(tone)), bulk = tone === "point";
        const low = bulk ? (many ? .12 : .25) : .6, high = bulk && many ? .6 : .95;
        pen.globalAlpha = p.hidden ? .2 : low + (high - low) * Math.min(1, Math.max(0, (p.z + 1) / 2));
        pen.fillStyle = pen.strokeStyle = ink;
        if (p.face) { pen.globalAlpha = (seen ? .3 : 1) * (.25 + .5 * p.light); path(p.face, true); pen.fill(); pen.lineWidth = .4; pen.stroke(); }
        else if (p.chain) { pen.lineWidth = p.layer.look === "thin" ? .8 : 2; pen.setLineDash(p.layer.look === "dashed" ? [6, 5] : []); path(p.chain, false); pen.stroke(); pen.setLineDash([]); }
        else if (p.layer.kind === "crosses") {
          pen.lineWidth = 2; pen.beginPath();
          pen.moveTo(p.at[0] - 6, p.at[1]); pen.lineTo(p.at[0] + 6, p.at[1]); pen.moveTo(p.at[0], p.at[1] - 6); pen.lineTo(p.at[0], p.at[1] + 6);
          pen.stroke();
        } else {
          pen.beginPath(); pen.arc(p.at[0], p.at[1], p.size, 0, 2 * Math.PI); pen.fill();
          if (!bulk && !p.hidden && !rimless) { pen.strokeStyle = ground; pen.lineWidth = 1.4; pen.stroke(); }
        }
      }

      pen.globalAlpha = 1; pen.font = "12px " + getComputedStyle(document.body).fontFamily; pen.fillStyle = pen.strokeStyle = color("muted");
      pen.textAlign = "center"; pen.textBaseline = "middle"; pen.lineWidth = 1;
      scene.names.forEach((name, k) => {
        const v = turned([0, 1, 2].map((j) => j === k ? 1 : 0)), tip = (t) => [56 * small + t * v[0], h - 56 * small - t * v[1]];
        if (Math.hypot(v[0], v[1]) < .05) return;
        path([tip(0), tip(26 * small)], false); pen.stroke();
        pen.fillText(name.length > 14 ? name.slice(0, 13) + "…" : name, ...tip(26 * small + 11));
      });
    };
    const redraw = () => { if (!queued) { queued = true; requestAnimationFrame(draw); } };
    const move = () => {
      if (bodies.length) { moving = true; clearTimeout(rest); rest = setTimeout(() => { moving = false; redraw(); }, 160); }
      redraw();
    };
    const rotate = (dx, dy) => {
      azimuth = (azimuth - dx) % 360; elevation = Math.min(90, Math.max(-90, elevation + dy)); move();
    };
    const enlarge = (factor) => { zoom = Math.min(20, Math.max(.3, zoom * factor)); move(); };

    const held = new Map();
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId); held.set(event.pointerId, [event.clientX, event.clientY]); hide();
    });
    canvas.addEventListener("pointermove", (event) => {
      const before = held.get(event.pointerId), now = [event.clientX, event.clientY];
      if (!before) {
        const at = canvas.getBoundingClientRect(), found = nearest(marks, now[0] - at.left, now[1] - at.top, 10);
        if (found) show(words(scene.names, found), event); else hide();
        return;
      }
      if (held.size === 2) {
        const other = [...held].find(([id]) => id !== event.pointerId)[1];
        const gap = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]);
        if (gap(before) > 0) enlarge(gap(now) / gap(before));
      } else rotate((now[0] - before[0]) * .45, (now[1] - before[1]) * .45);
      held.set(event.pointerId, now);
    });
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (event) => held.delete(event.pointerId));
    canvas.addEventListener("pointerleave", hide);
    // The wheel scrolls the page until the picture was clicked.
    canvas.addEventListener("wheel", (event) => {
      if (document.activeElement !== canvas && !event.ctrlKey) return;
      event.preventDefault(); enlarge(Math.exp(-event.deltaY * .0015));
    }, { passive: false });
    canvas.addEventListener("keydown", (event) => {
      const keys = { ArrowLeft: [-6, 0], ArrowRight: [6, 0], ArrowUp: [0, 6], ArrowDown: [0, -6] };
      if (keys[event.key]) rotate(...keys[event.key]);
      else if (event.key === "+" || event.key === "=") enlarge(1.15);
      else if (event.key === "-") enlarge(1 / 1.15);
      else if (event.key === "0") { ({ azimuth, elevation, zoom } = start); redraw(); }
      else return;
      event.preventDefault();
    });
    addEventListener("resize", redraw);
    document.fonts.ready.then(redraw);
    for (const query of ["(prefers-color-scheme: dark)", "print"]) matchMedia(query).addEventListener("change", draw);
    draw();
    return redraw;
  };

  // The canvases of a figure show one scene; an entry of the legend hides its layer in all of them, and shows it again.
  const space = (figure, scene, starts) => {
    const canvases = [...figure.querySelectorAll("canvas")], off = new Set();
    const redraws = canvases.map((canvas, i) => view(scene, canvas, starts[i], off)), redraw = () => redraws.forEach((again) => again());
    for (const entry of figure.querySelectorAll(".legend li")) {
      const layer = scene.layers[entry.dataset.layer], toggle = () => {
        if (off.has(layer)) off.delete(layer); else off.add(layer);
        for (const other of figure.querySelectorAll(".legend li")) {
          const is = off.has(scene.layers[other.dataset.layer]);
          other.classList.toggle("off", is); other.setAttribute("aria-pressed", String(!is));
        }
        redraw();
      };
      entry.tabIndex = 0; entry.setAttribute("role", "button"); entry.setAttribute("aria-pressed", "true");
      entry.addEventListener("click", toggle);
      entry.addEventListener("keydown", (event) => { if (event.key === "Enter" || event.key === " ") { event.preventDefault(); toggle(); } });
    }
    hint(figure, "Click an entry above to hide it.", () => {
      const across = Math.ceil(Math.sqrt(canvases.length)), [{ width, height }] = canvases, link = document.createElement("a");
      const all = document.createElement("canvas"), pen = all.getContext("2d");
      all.width = across * width; all.height = Math.ceil(canvases.length / across) * height;
      canvases.forEach((canvas, i) => pen.drawImage(canvas, i % across * width, Math.floor(i / across) * height));
      link.href = all.toDataURL("image/png"); link.download = file(figure, ".png"); link.click();
    });
  };
  // Fixed views are of the scene before them.
  let scene = null;
  for (const figure of document.querySelectorAll("figure.space")) {
    if (!figure.matches(".views")) { scene = read(figure); space(figure, scene, [{ zoom: 1, ...scene }]); }
    else { const { views, ...start } = data(figure); space(figure, scene, views.map(([azimuth, elevation]) => ({ ...start, azimuth, elevation }))); }
  }
})();
