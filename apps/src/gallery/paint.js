// Drawing by WebGL 2. A browser allows few contexts, so that all views share one, whose picture is copied to the canvas of each.

const VERTEX = `#version 300 es
in vec3 point;
in vec3 image;
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
    this.gl = gl;
    this.program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(this.program, shader);
    }
    gl.linkProgram(this.program);
    if (!gl.getProgramParameter(this.program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(this.program));
    gl.useProgram(this.program);
    gl.enable(gl.DEPTH_TEST);
    gl.clearColor(1, 1, 1, 1);
  }

  // An array on the graphics card.
  buffer(target, data) {
    const { gl } = this;
    const buffer = gl.createBuffer();
    gl.bindBuffer(target, buffer);
    gl.bufferData(target, data, gl.STATIC_DRAW);
    return buffer;
  }

  load(shape) {
    const { gl } = this;
    return {
      surface: this.buffer(gl.ARRAY_BUFFER, shape.surface),
      image: this.buffer(gl.ARRAY_BUFFER, shape.image || shape.surface),
      corners: this.buffer(gl.ELEMENT_ARRAY_BUFFER, shape.corners),
      count: shape.corners.length,
    };
  }

  begin(width, height) {
    const { gl } = this;
    this.canvas.width = width;
    this.canvas.height = height;
    gl.viewport(0, 0, width, height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  }

  // One side: `points` is "surface" or "image".
  draw(loaded, points, side) {
    const { gl, program } = this;
    const uniform = (name) => gl.getUniformLocation(program, name);
    for (const [name, buffer] of [["point", loaded[points]], ["image", loaded.image]]) {
      const at = gl.getAttribLocation(program, name);
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, 3, gl.FLOAT, false, 0, 0);
    }
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, loaded.corners);
    gl.uniformMatrix3fv(uniform("turn"), true, side.rows.flat());
    gl.uniform2fv(uniform("scale"), side.scale);
    gl.uniform2fv(uniform("shift"), side.shift);
    gl.uniform1f(uniform("checks"), side.checks);
    gl.uniform1f(uniform("lit"), side.lit);
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(...side.box);
    gl.drawElements(gl.TRIANGLES, loaded.count, gl.UNSIGNED_SHORT, 0);
    gl.disable(gl.SCISSOR_TEST);
  }
}
