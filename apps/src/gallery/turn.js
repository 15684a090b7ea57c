// The views: each a canvas with the surface on the left and its image on the right.

const CHECKS = 24; // across a layout
const CUBES = 10; // across an image in space
const TURN = 0.01; // radians a pixel
const FLAT = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];

class View {
  constructor(canvas, data, painter) {
    Object.assign(this, { canvas, data, painter, pick: null, asked: false });
    this.shape = {
      surface: centred(data.surface),
      image: data.image && centred(data.image),
      corners: numbers(data.corners, data.wide),
    };
    this.loaded = painter.load(this.shape);
    this.said = canvas.nextElementSibling;
    this.checks = !data.image ? 0 : data.flat ? CHECKS : CUBES;
    this.quantity = null;
    this.seams = false;
    this.controls();
    const sides = data.image ? ["surface", "image"] : ["surface"];
    this.sides = sides.map((points) => {
      const flat = points === "image" && data.flat;
      return { points, flat, azimuth: -0.5, elevation: data.lies && points === "surface" ? 1.1 : 0.35, zoom: 1, move: [0, 0] };
    });
    canvas.addEventListener("pointerdown", (e) => this.grab(e));
    canvas.addEventListener("pointermove", (e) => this.moved(e));
    canvas.addEventListener("pointerup", () => { this.held = null; });
    canvas.addEventListener("pointerleave", () => { if (!this.held) { this.pick = null; this.ask(); } });
    canvas.addEventListener("wheel", (e) => this.wheel(e), { passive: false });
    new ResizeObserver(() => this.ask()).observe(canvas);
  }

  // What the reader may choose, below the canvas: the density of the checks, seams, a quantity.
  controls() {
    const { data } = this;
    const row = document.createElement("p");
    row.className = "controls";
    const add = (words, part, event, act) => {
      const label = document.createElement("label");
      label.append(`${words} `, part);
      part.addEventListener(event, () => { act(part); this.ask(); });
      row.append(label, " ");
    };
    const input = (given) => Object.assign(document.createElement("input"), given);
    if (data.image) {
      const slider = input({ type: "range", min: 0, max: 100, value: this.checks });
      add("checks", slider, "input", () => { this.checks = Number(slider.value); });
    }
    if (data.cut) {
      const box = input({ type: "checkbox", checked: true });
      this.seams = true;
      add("seams", box, "change", () => { this.seams = box.checked; });
    }
    if (data.quantities && data.quantities.length > 0) {
      const list = document.createElement("select");
      [{ name: "none" }, ...data.quantities].forEach(({ name }) => list.append(new Option(name)));
      const range = document.createElement("span");
      const choose = () => {
        this.quantity = data.quantities[list.selectedIndex - 1] || null;
        const { low, high } = this.quantity || {};
        range.textContent = this.quantity ? `${low.toPrecision(4)} (dark) to ${high.toPrecision(4)} (light)` : "";
        if (this.quantity) this.loaded.amounts.data(Float32Array.from(numbersOf(this.quantity), (k) => k / 65534));
      };
      list.selectedIndex = 1;
      choose();
      add("colours", list, "change", choose);
      row.append(range);
    }
    if (row.childNodes.length > 0) this.said.after(row);
  }

  rows(side) {
    return side.flat ? FLAT : looking(side.points === "image" ? [0, 1, 0] : this.data.up, side.azimuth, side.elevation);
  }

  // Where a side lies: its middle, and the pixels of its unit.
  frame(k) {
    const { clientWidth: w, clientHeight: h } = this.canvas;
    const width = w / this.sides.length;
    const side = this.sides[k];
    const radius = 0.46 * Math.min(width, h) * side.zoom;
    return { x: width * (k + 0.5) + side.move[0], y: h / 2 + side.move[1], radius, width };
  }

  // The number of the side under an event, and the event's place in its units.
  under(event) {
    const box = this.canvas.getBoundingClientRect();
    const [x, y] = [event.clientX - box.left, event.clientY - box.top];
    const k = Math.min(this.sides.length - 1, Math.max(0, Math.floor((x * this.sides.length) / box.width)));
    const { x: cx, y: cy, radius } = this.frame(k);
    return { k, at: [(x - cx) / radius, (cy - y) / radius] };
  }

  grab(event) {
    this.held = { side: this.sides[this.under(event).k], x: event.clientX, y: event.clientY };
    try { this.canvas.setPointerCapture(event.pointerId); } catch { /* the pointer is gone already */ }
    this.point(event);
  }

  moved(event) {
    if (!this.held) return this.point(event);
    const { side } = this.held;
    const [dx, dy] = [event.clientX - this.held.x, event.clientY - this.held.y];
    Object.assign(this.held, { x: event.clientX, y: event.clientY });
    if (side.flat) {
      side.move = [side.move[0] + dx, side.move[1] + dy];
    } else {
      side.azimuth -= TURN * dx;
      side.elevation = Math.max(-1.57, Math.min(1.57, side.elevation + TURN * dy));
    }
    this.ask();
  }

  wheel(event) {
    event.preventDefault();
    const { k, at } = this.under(event);
    const before = this.frame(k).radius;
    const side = this.sides[k];
    side.zoom = Math.min(200, Math.max(0.5, side.zoom * Math.exp(-0.0015 * event.deltaY)));
    const grown = this.frame(k).radius - before;
    side.move = [side.move[0] - at[0] * grown, side.move[1] + at[1] * grown];
    this.ask();
  }

  point(event) {
    const { k, at } = this.under(event);
    const side = this.sides[k];
    this.pick = picked(this.shape[side.points], this.shape.corners, this.rows(side), at);
    this.ask();
  }

  // Draw before the next frame, once.
  ask() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => { this.asked = false; this.draw(); });
  }

  draw() {
    const { canvas, painter } = this;
    const { clientWidth: w, clientHeight: h } = canvas;
    if (w === 0 || h === 0) return;
    const dense = window.devicePixelRatio || 1;
    const [width, height] = [Math.round(w * dense), Math.round(h * dense)];
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    painter.begin(width, height);
    this.sides.forEach((side, k) => {
      const { x, y, radius, width: part } = this.frame(k);
      painter.draw(this.loaded, side.points, {
        rows: this.rows(side),
        scale: [(2 * radius) / w, (2 * radius) / h],
        shift: [(2 * x) / w - 1, 1 - (2 * y) / h],
        box: [Math.round(k * part * dense), 0, Math.ceil(part * dense), height],
        checks: this.checks,
        colored: this.quantity ? 1 : 0,
        seams: this.seams,
        lit: side.flat ? 0 : this.data.flat || !this.data.image ? 1 : 2,
      });
    });
    const pen = canvas.getContext("2d");
    pen.drawImage(painter.canvas, 0, 0);
    pen.setTransform(dense, 0, 0, dense, 0, 0);
    this.mark(pen);
    pen.setTransform(1, 0, 0, 1, 0, 0);
    canvas.dataset.drawn = Number(canvas.dataset.drawn || 0) + 1;
  }

  // The quantity at a picked place.
  valueAt({ face, weights }) {
    const { low, high } = this.quantity;
    const k = weights.map((_, c) => numbersOf(this.quantity)[this.shape.corners[face + c]]);
    return k.includes(65535) ? NaN : low + ((high - low) / 65534) * weights.reduce((sum, w, c) => sum + w * k[c], 0);
  }

  // The picked place on both sides: a ring where the surface hides it.
  mark(pen) {
    const { surface, image } = this.data;
    this.canvas.dataset.marks = this.pick ? this.sides.length : 0;
    if (!this.pick) { this.said.textContent = ""; return; }
    this.sides.forEach((side, k) => {
      const rows = this.rows(side);
      const points = this.shape[side.points];
      const at = placed(points, this.shape.corners, this.pick, rows);
      const { x, y, radius } = this.frame(k);
      const seen = picked(points, this.shape.corners, rows, at);
      pen.beginPath();
      pen.arc(x + radius * at[0], y - radius * at[1], 6, 0, 7);
      pen.lineWidth = 2.5;
      pen.strokeStyle = "#d40000";
      pen.fillStyle = "#ffee00";
      if (!seen || seen.depth < at[2] + 1e-3 || side.flat) pen.fill();
      pen.stroke();
    });
    const where = (points) => {
      const k = numbersOf(points);
      return [0, 1, 2].map((j) => {
        const sum = this.pick.weights.reduce((s, w, c) => s + w * k[3 * this.shape.corners[this.pick.face + c] + j], 0);
        return (points.from[j] + points.step * sum).toPrecision(5);
      });
    };
    const place = `(${where(surface).join(", ")})`;
    const value = this.quantity && this.valueAt(this.pick);
    const told = this.quantity ? `; ${this.quantity.name} ${Number.isFinite(value) ? value.toPrecision(5) : "is no number here"}` : "";
    const beside = image ? ` on the surface, (${where(image).slice(0, this.data.flat ? 2 : 3).join(", ")}) beside it` : "";
    this.said.textContent = `${place}${beside}${told}`;
  }
}

// Numbers are decoded once.
const decoded = new WeakMap();
function numbersOf(points) {
  if (!decoded.has(points)) decoded.set(points, numbers(points.data));
  return decoded.get(points);
}

// Views are made when they come near the window.
function start() {
  const views = JSON.parse(document.getElementById("views").textContent);
  let painter = null;
  const open = (entries, watch) => {
    for (const { target, isIntersecting } of entries) {
      if (!isIntersecting) continue;
      watch.unobserve(target);
      try {
        painter = painter || new Painter();
        new View(target, views[target.dataset.view], painter).ask();
      } catch (error) {
        const trouble = document.getElementById("trouble");
        Object.assign(trouble, { hidden: false, textContent: error.message });
        watch.disconnect();
        return;
      }
    }
  };
  const watch = new IntersectionObserver(open, { rootMargin: "200px" });
  document.querySelectorAll("canvas[data-view]").forEach((canvas) => watch.observe(canvas));
}

start();
