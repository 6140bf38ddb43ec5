/* Layers drawn by the graphics card. */

const VERTEX = `#version 300 es
in vec3 position;
in float value;
uniform mat4 view;
uniform vec3 rows[3];
uniform float nearer;
out vec3 world;
out vec3 eye;
out float shown;
void main() {
  world = position;
  eye = vec3(dot(rows[0], position), dot(rows[1], position), dot(rows[2], position));
  shown = value;
  gl_Position = view * vec4(position, 1.0);
  gl_Position.z -= nearer;
}`;

const FRAGMENT = `#version 300 es
precision highp float;
in vec3 world;
in vec3 eye;
in float shown;
uniform sampler2D table;
uniform vec2 range;
uniform vec4 colour;
uniform vec4 section;
uniform vec3 blank;
uniform bool coloured;
uniform bool shade;
uniform bool closed;
out vec4 painted;
void main() {
  if (dot(section.xyz, world) > section.w) discard;
  vec3 paint = colour.rgb;
  if (coloured) {
    float part = clamp((shown - range.x) / max(range.y - range.x, 1e-37), 0.0, 1.0);
    // A blank corner leaves its whole facet blank, however little of it is left.
    paint = shown < -1e30 ? blank : texture(table, vec2((255.0 * part + 0.5) / 256.0, 0.5)).rgb;
  }
  if (shade) {
    vec3 normal = cross(dFdx(eye), dFdy(eye));
    paint *= 0.58 + 0.42 * abs(normal.z) / max(length(normal), 1e-37);
    // The inside of a body that is cut open.
    if (closed && !gl_FrontFacing) paint *= 0.72;
  }
  painted = vec4(paint * colour.a, colour.a);
}`;

const NO_SECTION = [0, 0, 0, 1];

class WebglRenderer {
  /* Null where there is no WebGL 2, or unless `anyhow` where a program stands in for the graphics card: it is
     slower than the canvas. */
  static on(canvas, anyhow) {
    if (!anyhow && !WebglRenderer.hasCard()) return null;
    const gl = canvas.getContext("webgl2", { antialias: true, alpha: true });
    return gl ? new WebglRenderer(canvas, gl) : null;
  }

  static hasCard() {
    const gl = document.createElement("canvas").getContext("webgl2", { failIfMajorPerformanceCaveat: true });
    if (!gl) return false;
    const named = gl.getExtension("WEBGL_debug_renderer_info");
    const card = named ? gl.getParameter(named.UNMASKED_RENDERER_WEBGL) : gl.getParameter(gl.RENDERER);
    const lose = gl.getExtension("WEBGL_lose_context");
    if (lose) lose.loseContext();
    return !/swiftshader|llvmpipe|softpipe|software|basic render/i.test(card);
  }

  constructor(canvas, gl) {
    this.name = "WebGL";
    this.canvas = canvas;
    this.gl = gl;
    this.program = this.build();
    this.at = Object.fromEntries(
      ["view", "rows", "nearer", "table", "range", "colour", "section", "blank", "coloured", "shade", "closed"].map((name) => [name, gl.getUniformLocation(this.program, name)]),
    );
    this.position = gl.getAttribLocation(this.program, "position");
    this.value = gl.getAttribLocation(this.program, "value");
    this.buffers = new Map(); // typed array → its copy on the card
    this.texture = gl.createTexture();
    this.loaded = null;
  }

  build() {
    const gl = this.gl;
    const program = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    return program;
  }

  buffer(array, target) {
    let found = this.buffers.get(array);
    if (!found) {
      found = { buffer: this.gl.createBuffer() };
      this.buffers.set(array, found);
      this.gl.bindBuffer(target, found.buffer);
      this.gl.bufferData(target, array, this.gl.STATIC_DRAW);
    }
    this.gl.bindBuffer(target, found.buffer);
    found.used = true;
  }

  attribute(place, array, size) {
    this.buffer(array, this.gl.ARRAY_BUFFER);
    this.gl.enableVertexAttribArray(place);
    this.gl.vertexAttribPointer(place, size, this.gl.FLOAT, false, 0, 0);
  }

  load(table) {
    const gl = this.gl;
    if (this.loaded === table) return;
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB, 256, 1, 0, gl.RGB, gl.UNSIGNED_BYTE, table);
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    this.loaded = table;
  }

  draw(layers, camera, depth, section) {
    const gl = this.gl;
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.useProgram(this.program);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.uniformMatrix4fv(this.at.view, false, camera.matrix(depth));
    const s = camera.scale;
    gl.uniform3fv(this.at.rows, [camera.right, camera.up, camera.toward].flat().map((x) => x * s));
    gl.uniform3fv(this.at.blank, GREY.map((x) => x / 255));
    for (const found of this.buffers.values()) found.used = false;
    // What is seen through comes last, and hides nothing.
    const solid = (layer) => layer.lines || layer.alpha === 1;
    for (const layer of [...layers.filter(solid), ...layers.filter((layer) => !solid(layer))]) {
      gl.depthMask(solid(layer));
      // Facets give way to lines on them, and what is seen through to what is not.
      gl.polygonOffset(...(solid(layer) ? [1, 2] : [4, 16]));
      gl.uniform1f(this.at.nearer, layer.lines ? 2 / (s * depth) : 0);
      this.drawLayer(layer, section);
    }
    gl.depthMask(true);
    for (const [array, found] of this.buffers) {
      if (found.used) continue;
      gl.deleteBuffer(found.buffer);
      this.buffers.delete(array);
    }
  }

  drawLayer(layer, section) {
    const gl = this.gl;
    if (layer.indices.length === 0) return;
    this.attribute(this.position, layer.positions, 3);
    if (layer.values) {
      this.attribute(this.value, layer.values, 1);
      this.load(layer.table);
      gl.uniform2fv(this.at.range, layer.range);
    } else {
      gl.disableVertexAttribArray(this.value);
    }
    gl.uniform1i(this.at.coloured, layer.values ? 1 : 0);
    gl.uniform1i(this.at.shade, layer.shade ? 1 : 0);
    gl.uniform1i(this.at.closed, layer.closed ? 1 : 0);
    gl.uniform4fv(this.at.colour, [...layer.colour.map((x) => x / 255), layer.alpha]);
    gl.uniform4fv(this.at.section, layer.clip && section ? section : NO_SECTION);
    // From outside, what turns away is behind what does not, unless a section opens the view.
    if (layer.closed && !section) gl.enable(gl.CULL_FACE);
    else gl.disable(gl.CULL_FACE);
    this.buffer(layer.indices, gl.ELEMENT_ARRAY_BUFFER);
    gl.drawElements(layer.lines ? gl.LINES : gl.TRIANGLES, layer.indices.length, gl.UNSIGNED_INT, 0);
  }
}
