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
    if (!this.image || this.image.width !== width || this.image.height !== height) {
      this.image = this.context.createImageData(width, height);
      this.bytes = this.image.data;
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

  drawTriangles() {
    const { indices } = this.layer;
    for (let i = 0; i < indices.length; i += 3) this.triangle(indices[i], indices[i + 1], indices[i + 2]);
  }

  triangle(a, b, c) {
    const { layer, places, dense, depth } = this;
    const { width, height } = this.canvas;
    const [ax, ay, az] = [places[3 * a] * dense, places[3 * a + 1] * dense, places[3 * a + 2]];
    const [bx, by, bz] = [places[3 * b] * dense - ax, places[3 * b + 1] * dense - ay, places[3 * b + 2] - az];
    const [cx, cy, cz] = [places[3 * c] * dense - ax, places[3 * c + 1] * dense - ay, places[3 * c + 2] - az];
    const area = bx * cy - by * cx;
    if (Math.abs(area) < 1e-9) return;
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
    let light = 1;
    if (layer.shade) {
      const [nx, ny] = [(by * cz - bz * cy) / dense, (bz * cx - bx * cz) / dense];
      const nz = area / (dense * dense);
      light = 0.58 + (0.42 * Math.abs(nz)) / Math.hypot(nx, ny, nz);
    }
    // What is seen through gives way to what is not.
    const back = layer.alpha === 1 ? 0 : 2;
    const values = layer.values;
    const [va, vb, vc] = values ? [values[a], values[b], values[c]] : [0, 0, 0];
    const blank = va < -1e30 || vb < -1e30 || vc < -1e30;
    const [low, span] = values ? [layer.range[0], Math.max(layer.range[1] - layer.range[0], 1e-37)] : [0, 1];
    for (let y = top; y <= bottom; y++) {
      const py = y + 0.5 - ay;
      for (let x = left; x <= right; x++) {
        const px = x + 0.5 - ax;
        const u = (px * cy - py * cx) / area;
        const v = (bx * py - by * px) / area;
        if (u < 0 || v < 0 || u + v > 1) continue;
        if (far && far[0] + u * (far[1] - far[0]) + v * (far[2] - far[0]) > 0) continue;
        const z = az + u * bz + v * cz - back;
        const at = y * width + x;
        if (z < depth[at]) continue;
        let paint = layer.colour;
        let first = 0;
        if (blank) {
          paint = GREY;
        } else if (values) {
          const part = (va + u * (vb - va) + v * (vc - va) - low) / span;
          paint = layer.table;
          first = 3 * Math.round(255 * Math.max(0, Math.min(1, part)));
        }
        this.paint(at, paint, first, light, layer.alpha);
        if (layer.alpha === 1) depth[at] = z;
      }
    }
  }

  drawLines() {
    const { layer, places, dense, depth } = this;
    const { width, height } = this.canvas;
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
