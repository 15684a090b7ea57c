// Drawing by WebGL 2 through PicoGL. A browser allows few contexts, so that all views share one, whose picture is copied to the canvas of each.

const VERTEX = `#version 300 es
layout(location = 0) in vec3 point;
layout(location = 1) in vec3 image;
uniform mat3 turn;
uniform vec2 scale;
uniform vec2 shift;
out vec3 place;
out vec3 pattern;
void main() {
  vec3 p = turn * point;
  place = p;
  pattern = image;
  gl_Position = vec4(p.xy * scale + shift, -0.1 * p.z, 1.0);
}`;

// Light from the eye's upper left, on the inside of a sheet weaker; checks of the image, blurred where they are finer than pixels.
const FRAGMENT = `#version 300 es
precision highp float;
in vec3 place;
in vec3 pattern;
uniform float checks;
uniform float lit;
out vec4 color;
float square(float x) {
  float w = max(fwidth(x), 1e-6);
  float s = clamp((abs(fract(x) - 0.5) - 0.25) / w + 0.5, 0.0, 1.0);
  return mix(2.0 * s - 1.0, 0.0, smoothstep(0.3, 1.0, w));
}
void main() {
  vec3 base = vec3(0.78, 0.80, 0.84);
  if (checks > 0.0) {
    vec3 tint = 0.5 + 0.45 * cos(vec3(0.0, 2.1, 4.2) + 2.2 * pattern.x + vec3(1.7, -1.7, 0.0) * pattern.y + 2.0 * pattern.z);
    vec3 q = 0.5 * checks * pattern;
    float parity = square(q.x) * square(q.y) * (lit > 1.5 ? square(q.z) : 1.0);
    base = mix(mix(tint, vec3(1.0), 0.72), mix(tint, vec3(0.1), 0.25), 0.5 + 0.5 * parity);
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
    const faces = app.createIndexBuffer(PicoGL.UNSIGNED_SHORT, corners);
    const call = (side) => {
      const arrays = app.createVertexArray().vertexAttributeBuffer(0, side).vertexAttributeBuffer(1, sides.image);
      return app.createDrawCall(this.program, arrays.indexBuffer(faces));
    };
    return { surface: call(sides.surface), image: call(sides.image) };
  }

  begin(width, height) {
    this.app.resize(width, height).clear();
  }

  // One side: `points` is "surface" or "image".
  draw(loaded, points, { rows, scale, shift, box, checks, lit }) {
    const columns = [0, 1, 2].flatMap((k) => rows.map((row) => row[k]));
    this.app.enable(PicoGL.SCISSOR_TEST).scissor(...box);
    loaded[points].uniform("turn", new Float32Array(columns)).uniform("scale", new Float32Array(scale))
      .uniform("shift", new Float32Array(shift)).uniform("checks", checks).uniform("lit", lit).draw();
    this.app.disable(PicoGL.SCISSOR_TEST);
  }
}
