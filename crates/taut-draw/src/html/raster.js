// Opaque triangles by a depth buffer, as in the still pictures: 10⁵ of them take less than a frame, and nothing is sorted.
"use strict";
const surfaces = (() => {
  const LIGHT = [-.3, .5, .81], AMBIENT = .25, SHARP = .766, FAN = 64, CLIFF = .025, HAIR = 2e-3, PARTS = 256;

  const bytes = (text) => {
    const raw = atob(text), out = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; i++) out[i] = raw.charCodeAt(i);
    return out.buffer;
  };

  // Unit normals at the corners, nine numbers a triangle; smooth, they are means over the triangles around the vertex that face nearly
  // the same way.
  const normals = (places, triangles, smooth) => {
    const count = triangles.length / 3, areas = new Float64Array(3 * count), flat = new Float64Array(3 * count), out = new Float32Array(9 * count);
    for (let t = 0; t < count; t++) {
      const [a, b, c] = [0, 1, 2].map((k) => 3 * triangles[3 * t + k]);
      const [ux, uy, uz] = [0, 1, 2].map((k) => places[b + k] - places[a + k]), [vx, vy, vz] = [0, 1, 2].map((k) => places[c + k] - places[a + k]);
      const n = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx], size = Math.hypot(...n);
      for (let k = 0; k < 3; k++) {
        areas[3 * t + k] = n[k]; flat[3 * t + k] = size > 0 ? n[k] / size : 0;
        for (let j = 0; j < 3; j++) out[9 * t + 3 * j + k] = flat[3 * t + k];
      }
    }
    if (!smooth) return out;
    const first = new Uint32Array(places.length / 3 + 1), around = new Uint32Array(3 * count);
    for (const v of triangles) first[v + 1]++;
    for (let v = 1; v < first.length; v++) first[v] += first[v - 1];
    const next = first.slice();
    triangles.forEach((v, corner) => { around[next[v]++] = corner; });
    for (let v = 0; v + 1 < first.length; v++) {
      if (first[v + 1] - first[v] > FAN) continue;
      for (let i = first[v]; i < first[v + 1]; i++) {
        const own = 3 * Math.floor(around[i] / 3);
        let x = 0, y = 0, z = 0;
        for (let j = first[v]; j < first[v + 1]; j++) {
          const o = 3 * Math.floor(around[j] / 3);
          if (flat[own] * flat[o] + flat[own + 1] * flat[o + 1] + flat[own + 2] * flat[o + 2] < SHARP) continue;
          x += areas[o]; y += areas[o + 1]; z += areas[o + 2];
        }
        const size = Math.hypot(x, y, z), at = 3 * around[i];
        if (size > 0) { out[at] = x / size; out[at + 1] = y / size; out[at + 2] = z / size; }
      }
    }
    return out;
  };

  // A layer of the page's data as numbers.
  const decode = (layer) => {
    const places = new Float32Array(bytes(layer.vertices)), triangles = new Uint32Array(bytes(layer.triangles));
    return { tones: [layer.tone, layer.back], places, triangles, normals: normals(places, triangles, layer.smooth), turned: new Float64Array(places.length) };
  };

  // The shades of a color "#rrggbb": from a third of it to halfway to white.
  const ramp = (hex) => {
    const base = [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16));
    return Array.from({ length: 256 }, (_, i) => base.map((c) => Math.round((1 - i / 255) * .33 * c + i / 255 * (.5 * c + 127.5))));
  };

  // What is seen of solids on a sheet of so many samples; `camera` has a frame, the middle of the sheet, the scale, and the eye or 0.
  const draw = (solids, camera, width, height, color) => {
    const near = new Float32Array(width * height), shade = new Uint8Array(width * height), ink = new Uint8Array(width * height);
    const { frame, middle, scale, eye } = camera, [right, up, ahead] = frame, inks = [];
    solids.forEach((solid, which) => {
      const { places, turned, triangles, normals } = solid;
      inks.push(...solid.tones.map((tone) => ramp(color(tone))));
      for (let i = 0; i < places.length; i += 3) {
        const x = places[i], y = places[i + 1], z = places[i + 2], depth = ahead[0] * x + ahead[1] * y + ahead[2] * z;
        const zoom = eye ? eye / (eye - depth) : 1;
        turned[i] = Math.round((middle[0] + scale * zoom * (right[0] * x + right[1] * y + right[2] * z)) * PARTS);
        turned[i + 1] = Math.round((middle[1] - scale * zoom * (up[0] * x + up[1] * y + up[2] * z)) * PARTS);
        turned[i + 2] = eye ? zoom : 1 + depth / 4;
      }
      // The direction of the light, turned back to the data.
      const [lx, ly, lz] = [0, 1, 2].map((k) => LIGHT[0] * right[k] + LIGHT[1] * up[k] + LIGHT[2] * ahead[k]);
      for (let t = 0; t < triangles.length; t += 3) {
        const a = 3 * triangles[t];
        let b = 3 * triangles[t + 1], c = 3 * triangles[t + 2];
        const ax = turned[a], ay = turned[a + 1];
        let bx = turned[b], by = turned[b + 1], cx = turned[c], cy = turned[c + 1];
        let whole = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
        if (whole === 0) continue;
        const left = Math.max(0, Math.floor((Math.min(ax, bx, cx) - PARTS / 2) / PARTS)), last = Math.min(width - 1, Math.floor((Math.max(ax, bx, cx) - PARTS / 2) / PARTS));
        const top = Math.max(0, Math.floor((Math.min(ay, by, cy) - PARTS / 2) / PARTS)), bottom = Math.min(height - 1, Math.floor((Math.max(ay, by, cy) - PARTS / 2) / PARTS));
        if (left > last || top > bottom) continue;
        const n = 3 * t, side = whole > 0 ? 1 : 0, towards = side ? -255 : 255;
        const light = (k) => Math.min(255, Math.max(0, 255 * AMBIENT + (1 - AMBIENT) * towards * (normals[n + k] * lx + normals[n + k + 1] * ly + normals[n + k + 2] * lz)));
        const la = light(0);
        let lb = light(3), lc = light(6);
        if (whole < 0) { [b, c] = [c, b]; [bx, by, cx, cy] = [cx, cy, bx, by]; [lb, lc] = [lc, lb]; whole = -whole; }
        const za = turned[a + 2], zb = turned[b + 2], zc = turned[c + 2], own = 2 * which + side;
        // Edges at the top and at the left belong to the triangle, the others do not.
        const owned = (px, py, qx, qy) => qy < py || (qy === py && qx > px) ? 0 : 1;
        const oa = owned(bx, by, cx, cy), ob = owned(cx, cy, ax, ay), oc = owned(ax, ay, bx, by);
        const da = -(cy - by) * PARTS, db = -(ay - cy) * PARTS, dc = -(by - ay) * PARTS;
        const x0 = left * PARTS + PARTS / 2;
        for (let y = top; y <= bottom; y++) {
          const y0 = y * PARTS + PARTS / 2;
          let ea = (cx - bx) * (y0 - by) - (cy - by) * (x0 - bx), eb = (ax - cx) * (y0 - cy) - (ay - cy) * (x0 - cx), ec = (bx - ax) * (y0 - ay) - (by - ay) * (x0 - ax);
          for (let x = left, i = y * width + left; x <= last; x++, i++) {
            if (ea >= oa && eb >= ob && ec >= oc) {
              const z = (ea * za + eb * zb + ec * zc) / whole;
              if (z > near[i]) { near[i] = z; shade[i] = (ea * la + eb * lb + ec * lc) / whole + .5; ink[i] = own; }
            }
            ea += da; eb += db; ec += dc;
          }
        }
      }
    });

    // Colors; half as bright where the surface ends or steps back.
    const paint = (reach) => {
      const pixels = new Uint8ClampedArray(4 * width * height), down = reach * width;
      for (let y = 0, i = 0; y < height; y++) for (let x = 0; x < width; x++, i++) {
        if (near[i] === 0) continue;
        const edge = near[i] - CLIFF, at = 4 * i, rgb = inks[ink[i]][shade[i]];
        const cliff = (x >= reach && near[i - reach] < edge) || (x + reach < width && near[i + reach] < edge) ||
          (y >= reach && near[i - down] < edge) || (y + reach < height && near[i + down] < edge);
        const bright = cliff ? .5 : 1;
        pixels[at] = rgb[0] * bright; pixels[at + 1] = rgb[1] * bright; pixels[at + 2] = rgb[2] * bright; pixels[at + 3] = 255;
      }
      return pixels;
    };

    // Whether all samples around a place, in samples, are nearer than it is.
    const hides = (x, y, nearness, reach) => {
      const u = Math.floor(x), v = Math.floor(y);
      if (u < reach || v < reach || u + reach >= width || v + reach >= height) return false;
      for (let j = v - reach; j <= v + reach; j++) for (let i = u - reach; i <= u + reach; i++) {
        if (!(near[j * width + i] > nearness + HAIR)) return false;
      }
      return true;
    };
    return { width, height, paint, hides };
  };

  return { bytes, decode, draw };
})();
