// Drawing by WebGL 2 through PicoGL. A browser allows few contexts, so that all views share one, whose picture is copied to the canvas of each.

const VERTEX = `#version 300 es
layout(location = 0) in vec3 point;
layout(location = 1) in vec3 image;
layout(location = 2) in float amount;
uniform mat3 turn;
uniform vec2 scale;
uniform vec2 shift;
uniform float lift;
out vec3 place;
out vec3 pattern;
out float share;
void main() {
  vec3 p = turn * point;
  place = p;
  pattern = image;
  share = amount;
  gl_Position = vec4(p.xy * scale + shift, -0.1 * p.z - lift, 1.0);
}`;

// Light from the eye's upper left, on the inside of a sheet weaker; checks of the image, blurred where they are finer than pixels; a quantity
// as a colour that grows lighter, grey where it is no number. Lines, which are lifted towards the eye, have one colour.
const FRAGMENT = `#version 300 es
precision highp float;
in vec3 place;
in vec3 pattern;
in float share;
uniform float checks;
uniform float lit;
uniform float lift;
uniform float colored;
out vec4 color;
vec3 ramp(float x) {
  vec3 a = mix(vec3(0.27, 0.0, 0.33), vec3(0.23, 0.32, 0.55), clamp(4.0 * x, 0.0, 1.0));
  a = mix(a, vec3(0.13, 0.57, 0.55), clamp(4.0 * x - 1.0, 0.0, 1.0));
  a = mix(a, vec3(0.37, 0.79, 0.38), clamp(4.0 * x - 2.0, 0.0, 1.0));
  return mix(a, vec3(0.99, 0.91, 0.14), clamp(4.0 * x - 3.0, 0.0, 1.0));
}
float square(float x) {
  float w = max(fwidth(x), 1e-6);
  float s = clamp((abs(fract(x) - 0.5) - 0.25) / w + 0.5, 0.0, 1.0);
  return mix(2.0 * s - 1.0, 0.0, smoothstep(0.3, 1.0, w));
}
void main() {
  if (lift > 0.0) { color = vec4(0.75, 0.0, 0.1, 1.0); return; }
  vec3 base = vec3(0.78, 0.80, 0.84);
  if (colored > 0.5) base = share > 1.0 ? vec3(0.6) : ramp(share);
  if (checks > 0.0) {
    vec3 tint = 0.5 + 0.45 * cos(vec3(0.0, 2.1, 4.2) + 2.2 * pattern.x + vec3(1.7, -1.7, 0.0) * pattern.y + 2.0 * pattern.z);
    vec3 q = 0.5 * checks * pattern;
    float parity = square(q.x) * square(q.y) * (lit > 1.5 ? square(q.z) : 1.0);
    vec3 light = colored > 0.5 ? base : mix(tint, vec3(1.0), 0.72);
    vec3 dark = colored > 0.5 ? 0.65 * base : mix(tint, vec3(0.1), 0.25);
    base = mix(light, dark, 0.5 + 0.5 * parity);
  }
  float light = 1.0;
  if (lit > 0.5) {
    vec3 n = normalize(cross(dFdx(place), dFdy(place)));
    light = 0.35 + 0.65 * abs(dot(n, normalize(vec3(-0.4, 0.5, 0.9))));
    light *= gl_FrontFacing ? 1.0 : 0.6;
  }
  color = vec4(base * light, 1.0);
}`;

class Painter {
  constructor() {
    this.canvas = document.createElement("canvas");
    const gl = this.canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
    if (!gl) throw new Error("This browser has no WebGL 2: the pictures are here, the views that turn are not.");
    this.app = PicoGL.createApp(gl).clearColor(1, 1, 1, 1).enable(PicoGL.DEPTH_TEST);
    this.program = this.app.createProgram(VERTEX, FRAGMENT);
    if (!gl.getProgramParameter(this.program.program, gl.LINK_STATUS)) throw new Error("The shaders of the views do not compile here.");
  }

  // What draws each side of a shape.
  load({ surface, image, corners }) {
    const { app } = this;
    const points = (data) => app.createVertexBuffer(PicoGL.FLOAT, 3, data);
    const sides = { surface: points(surface), image: points(image || surface) };
    const amounts = app.createVertexBuffer(PicoGL.FLOAT, 1, new Float32Array(surface.length / 3));
    const kind = corners instanceof Uint32Array ? PicoGL.UNSIGNED_INT : PicoGL.UNSIGNED_SHORT;
    const call = (side, indices, primitive) => {
      const arrays = app.createVertexArray().vertexAttributeBuffer(0, side).vertexAttributeBuffer(1, sides.image)
        .vertexAttributeBuffer(2, amounts);
      return app.createDrawCall(this.program, arrays.indexBuffer(app.createIndexBuffer(kind, indices))).primitive(primitive);
    };
    const both = (indices, primitive) => ({
      surface: call(sides.surface, indices, primitive),
      image: call(sides.image, indices, primitive),
    });
    // The lines are searched for when they are first asked for.
    let lines = null;
    const rim = () => { lines = lines || both(new corners.constructor(rims(corners)), PicoGL.LINES); return lines; };
    return { ...both(corners, PicoGL.TRIANGLES), amounts, rim };
  }

  begin(width, height) {
    this.app.resize(width, height).clear();
  }

  // One side: `points` is "surface" or "image"; `seams`: with lines where it is cut open.
  draw(loaded, points, { rows, scale, shift, box, checks, lit, colored, seams }) {
    const columns = [0, 1, 2].flatMap((k) => rows.map((row) => row[k]));
    this.app.enable(PicoGL.SCISSOR_TEST).scissor(...box);
    const drawn = (call, lift) => call.uniform("turn", new Float32Array(columns)).uniform("scale", new Float32Array(scale))
      .uniform("shift", new Float32Array(shift)).uniform("checks", checks).uniform("lit", lit).uniform("colored", colored)
      .uniform("lift", lift).draw();
    drawn(loaded[points], 0);
    if (seams) drawn(loaded.rim()[points], 0.002);
    this.app.disable(PicoGL.SCISSOR_TEST);
  }
}
