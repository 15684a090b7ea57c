// The data of a view as arrays, and the small algebra of views.

// Numbers of 16 bits, little-endian, in base64; of 32 bits where they are wide.
function numbers(text, wide = false) {
  const raw = atob(text);
  if (wide) {
    const bytes = Uint8Array.from(raw, (c) => c.charCodeAt(0));
    const view = new DataView(bytes.buffer);
    return Uint32Array.from({ length: raw.length / 4 }, (_, i) => view.getUint32(4 * i, true));
  }
  const out = new Uint16Array(raw.length / 2);
  for (let i = 0; i < out.length; i++) out[i] = raw.charCodeAt(2 * i) | (raw.charCodeAt(2 * i + 1) << 8);
  return out;
}

// Points around their middle, the farthest at distance 1.
function centred(points) {
  const k = numbers(points.data);
  const at = new Float32Array(k.length);
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < k.length; i++) {
    low[i % 3] = Math.min(low[i % 3], k[i]);
    high[i % 3] = Math.max(high[i % 3], k[i]);
  }
  let far = 1;
  for (let i = 0; i < k.length; i += 3) {
    far = Math.max(far, Math.hypot(...[0, 1, 2].map((j) => k[i + j] - (low[j] + high[j]) / 2)));
  }
  for (let i = 0; i < k.length; i++) at[i] = (k[i] - (low[i % 3] + high[i % 3]) / 2) / far;
  return at;
}

const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const unit = (a) => a.map((x) => x / Math.hypot(...a));

// Rows of the rotation that looks at a surface from an azimuth and an elevation (radians), `up` being up.
function looking(up, azimuth, elevation) {
  const side = Math.abs(up[1]) > 0.9 ? [0, 0, up[1]] : Math.abs(up[2]) > 0.9 ? [0, -up[2], 0] : [0, 0, 1];
  const front = unit(cross(cross(up, side), up));
  const right = cross(up, front);
  const [c, s, e, f] = [Math.cos(azimuth), Math.sin(azimuth), Math.cos(elevation), Math.sin(elevation)];
  const toEye = [0, 1, 2].map((k) => e * (c * front[k] + s * right[k]) + f * up[k]);
  const across = [0, 1, 2].map((k) => c * right[k] - s * front[k]);
  return [across, cross(toEye, across), toEye];
}

// The face under a point of a side and its barycentric coordinates there, the nearest to the eye; null beside the surface.
function picked(points, corners, rows, [x, y]) {
  let best = null;
  for (let f = 0; f < corners.length; f += 3) {
    const p = [0, 1, 2].map((k) => {
      const i = 3 * corners[f + k];
      const v = [points[i], points[i + 1], points[i + 2]];
      return [dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)];
    });
    const area = (a, b, c) => (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    const whole = area(...p);
    if (whole === 0) continue;
    const at = [x, y];
    const w = [area(at, p[1], p[2]), area(p[0], at, p[2]), area(p[0], p[1], at)].map((a) => a / whole);
    if (Math.min(...w) < 0) continue;
    const depth = w[0] * p[0][2] + w[1] * p[1][2] + w[2] * p[2][2];
    if (best === null || depth > best.depth) best = { face: f, weights: w, depth };
  }
  return best;
}

// Where a picked place lies among other points with the same faces.
function placed(points, corners, pick, rows) {
  const v = [0, 0, 0];
  pick.weights.forEach((w, k) => {
    for (let j = 0; j < 3; j++) v[j] += w * points[3 * corners[pick.face + k] + j];
  });
  return rows.map((row) => dot(row, v));
}

// The edges of one face alone, as pairs of corners: where a layout is cut open, and the boundary.
function rims(corners) {
  const sides = new Map();
  for (let i = 0; i < corners.length; i += 3) {
    for (let k = 0; k < 3; k++) {
      const [a, b] = [corners[i + k], corners[i + ((k + 1) % 3)]];
      const key = a < b ? a * 4294967296 + b : b * 4294967296 + a;
      if (sides.has(key)) sides.set(key, null); else sides.set(key, [a, b]);
    }
  }
  return [...sides.values()].filter((side) => side !== null).flat();
}
