/* The same layers without a graphics card: triangles pixel by pixel, with a depth per pixel. */

class RasterRenderer {
  constructor(canvas) {
    this.name = "canvas";
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
    this.places = new Float32Array(0);
  }

  draw(layers, camera, depth, section) {
    const { width, height } = this.canvas;
    [this.width, this.height] = [width, height];
    if (!this.image || this.image.width !== width || this.image.height !== height) {
      this.image = this.context.createImageData(width, height);
      this.bytes = this.image.data;
      this.words = new Uint32Array(this.bytes.buffer);
      this.depth = new Float32Array(width * height);
    }
    this.bytes.fill(0);
    this.depth.fill(-Infinity);
    // Pixels of the canvas per pixel of the camera.
    this.dense = width / camera.size[0];
    const solid = (layer) => layer.lines || layer.alpha === 1;
    for (const layer of [...layers.filter(solid), ...layers.filter((layer) => !solid(layer))]) {
      this.section = layer.clip ? section : null;
      this.layer = layer;
      if (this.places.length < layer.positions.length) this.places = new Float32Array(layer.positions.length);
      camera.places(layer.positions, this.places);
      if (layer.lines) this.drawLines();
      else this.drawTriangles();
    }
    this.context.putImageData(this.image, 0, 0);
  }

  /* How far a position lies behind the section. */
  beyond(point) {
    const [s, x] = [this.section, this.layer.positions];
    return s[0] * x[3 * point] + s[1] * x[3 * point + 1] + s[2] * x[3 * point + 2] - s[3];
  }

  /* Most triangles of a large mesh cover a pixel or two: what is done per triangle is what counts. */
  drawTriangles() {
    const { layer, places, section } = this;
    const { indices } = layer;
    // From outside, what turns away is behind what does not, unless a section opens the view.
    const closed = layer.closed && !section;
    for (let i = 0; i < indices.length; i += 3) {
      const a = 3 * indices[i];
      const b = 3 * indices[i + 1];
      const c = 3 * indices[i + 2];
      const bx = places[b] - places[a];
      const by = places[b + 1] - places[a + 1];
      const cx = places[c] - places[a];
      const cy = places[c + 1] - places[a + 1];
      const area = bx * cy - by * cx;
      if (closed ? area >= 0 : area === 0) continue;
      this.triangle(indices[i], indices[i + 1], indices[i + 2]);
    }
  }

  triangle(a, b, c) {
    const { layer, places, dense, depth, words, width, height } = this;
    const ax = places[3 * a] * dense;
    const ay = places[3 * a + 1] * dense;
    const az = places[3 * a + 2];
    const bx = places[3 * b] * dense - ax;
    const by = places[3 * b + 1] * dense - ay;
    const bz = places[3 * b + 2] - az;
    const cx = places[3 * c] * dense - ax;
    const cy = places[3 * c + 1] * dense - ay;
    const cz = places[3 * c + 2] - az;
    const left = Math.max(0, Math.ceil(ax + Math.min(0, bx, cx) - 0.5));
    const right = Math.min(width - 1, Math.floor(ax + Math.max(0, bx, cx) - 0.5));
    const top = Math.max(0, Math.ceil(ay + Math.min(0, by, cy) - 0.5));
    const bottom = Math.min(height - 1, Math.floor(ay + Math.max(0, by, cy) - 0.5));
    if (left > right || top > bottom) return;
    let far = null;
    if (this.section) {
      far = [this.beyond(a), this.beyond(b), this.beyond(c)];
      if (far.every((d) => d > 0)) return;
      if (far.every((d) => d <= 0)) far = null;
    }
    const area = bx * cy - by * cx;
    let light = 1;
    if (layer.shade) {
      const nx = (by * cz - bz * cy) / dense;
      const ny = (bz * cx - bx * cz) / dense;
      const nz = area / (dense * dense);
      light = 0.58 + (0.42 * Math.abs(nz)) / Math.sqrt(nx * nx + ny * ny + nz * nz);
      // The inside of a body that is cut open.
      if (layer.closed && area > 0) light *= 0.72;
    }
    // What is seen through gives way to what is not.
    const solid = layer.alpha === 1;
    const start = solid ? az : az - 2;
    const values = layer.values;
    let table = layer.colour;
    let [va, vb, vc] = [0, 0, 0];
    if (values) {
      // Places in the table of colours.
      const to = 255 / Math.max(layer.range[1] - layer.range[0], 1e-37);
      va = (values[a] - layer.range[0]) * to;
      vb = (values[b] - layer.range[0]) * to - va;
      vc = (values[c] - layer.range[0]) * to - va;
      const blank = values[a] < -1e30 || values[b] < -1e30 || values[c] < -1e30;
      table = blank ? GREY : layer.table;
      if (blank) va = vb = vc = 0;
    }
    for (let y = top; y <= bottom; y++) {
      const py = y + 0.5 - ay;
      for (let x = left; x <= right; x++) {
        const px = x + 0.5 - ax;
        const u = (px * cy - py * cx) / area;
        const v = (bx * py - by * px) / area;
        if (u < 0 || v < 0 || u + v > 1) continue;
        if (far && far[0] + u * (far[1] - far[0]) + v * (far[2] - far[0]) > 0) continue;
        const z = start + u * bz + v * cz;
        const at = y * width + x;
        if (z < depth[at]) continue;
        const first = 3 * Math.max(0, Math.min(255, Math.round(va + u * vb + v * vc)));
        if (solid) {
          depth[at] = z;
          words[at] = 0xff000000 | ((table[first + 2] * light) << 16) | ((table[first + 1] * light) << 8) | (table[first] * light);
        } else {
          this.paint(at, table, first, light, layer.alpha);
        }
      }
    }
  }

  drawLines() {
    const { layer, places, dense, depth, width, height } = this;
    const { indices } = layer;
    for (let i = 0; i < indices.length; i += 2) {
      const [a, b] = [indices[i], indices[i + 1]];
      if (this.section && (this.beyond(a) > 0 || this.beyond(b) > 0)) continue;
      const [ax, ay] = [places[3 * a] * dense, places[3 * a + 1] * dense];
      const [dx, dy] = [places[3 * b] * dense - ax, places[3 * b + 1] * dense - ay];
      const [az, dz] = [places[3 * a + 2], places[3 * b + 2] - places[3 * a + 2]];
      const count = Math.ceil(Math.max(Math.abs(dx), Math.abs(dy), 1));
      if (count > 20000) continue;
      for (let k = 0; k <= count; k++) {
        const [x, y] = [Math.floor(ax + (k / count) * dx), Math.floor(ay + (k / count) * dy)];
        if (x < 0 || y < 0 || x >= width || y >= height) continue;
        const at = y * width + x;
        // A line on a facet is in front of it by two pixels.
        if (az + (k / count) * dz + 2 < depth[at]) continue;
        this.paint(at, layer.colour, 0, 1, layer.alpha);
      }
    }
  }

  /* Over what is there. */
  paint(at, colour, first, light, alpha) {
    const { bytes } = this;
    const under = 4 * at;
    const own = bytes[under + 3] / 255;
    const whole = alpha + own * (1 - alpha);
    for (let k = 0; k < 3; k++) {
      bytes[under + k] = (colour[first + k] * light * alpha + bytes[under + k] * own * (1 - alpha)) / whole;
    }
    bytes[under + 3] = 255 * whole;
  }
}
