/* How positions become places on the screen: a parallel projection, turned about the upright axis. */

const DIRECTIONS = {
  iso: [-Math.PI / 5, Math.PI / 6.5],
  "+x": [Math.PI / 2, 0],
  "−x": [-Math.PI / 2, 0],
  "+y": [Math.PI, 0],
  "−y": [0, 0],
  "+z": [0, Math.PI / 2],
  "−z": [0, -Math.PI / 2],
};

class Camera {
  constructor(dimension) {
    this.plane = dimension === 2;
    this.centre = [0, 0, 0];
    this.scale = 1; // pixels per unit of length
    this.size = [1, 1]; // pixels
    this.look(...DIRECTIONS.iso);
  }

  /* From the side of an angle about the upright axis, and from above by another. */
  look(turn, tilt) {
    this.turn = turn;
    this.tilt = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, tilt));
    if (this.plane) {
      [this.right, this.up, this.toward] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
      return;
    }
    const [c, s] = [Math.cos(turn), Math.sin(turn)];
    const [ct, st] = [Math.cos(this.tilt), Math.sin(this.tilt)];
    this.right = [c, s, 0];
    this.toward = [ct * s, -ct * c, st];
    this.up = [-st * s, st * c, ct];
  }

  along(direction, position) {
    const c = this.centre;
    return direction[0] * (position[0] - c[0]) + direction[1] * (position[1] - c[1]) + direction[2] * (position[2] - c[2]);
  }

  /* Pixels from the left and from the top, and towards the viewer. */
  place(position) {
    return [
      this.size[0] / 2 + this.scale * this.along(this.right, position),
      this.size[1] / 2 - this.scale * this.along(this.up, position),
      this.scale * this.along(this.toward, position),
    ];
  }

  /* The same for three numbers per point. */
  places(positions, into) {
    const s = this.scale;
    const [rx, ry, rz] = this.right.map((x) => s * x);
    const [ux, uy, uz] = this.up.map((x) => s * x);
    const [tx, ty, tz] = this.toward.map((x) => s * x);
    const [cx, cy, cz] = this.centre;
    const [w, h] = [this.size[0] / 2, this.size[1] / 2];
    for (let i = 0; i < positions.length; i += 3) {
      const x = positions[i] - cx;
      const y = positions[i + 1] - cy;
      const z = positions[i + 2] - cz;
      into[i] = w + rx * x + ry * y + rz * z;
      into[i + 1] = h - (ux * x + uy * y + uz * z);
      into[i + 2] = tx * x + ty * y + tz * z;
    }
    return into;
  }

  /* By so many pixels. */
  move(x, y) {
    for (let k = 0; k < 3; k++) this.centre[k] -= (this.right[k] * x - this.up[k] * y) / this.scale;
  }

  /* About a place on the screen, which stays. */
  zoom(factor, x = this.size[0] / 2, y = this.size[1] / 2) {
    const [dx, dy] = [x - this.size[0] / 2, y - this.size[1] / 2];
    this.move(-dx, -dy);
    this.scale *= factor;
    this.move(dx, dy);
  }

  /* A box as large as it fits between margins: left, top, right, bottom. */
  fit(box, [left, top, right, bottom]) {
    const corners = [];
    for (let i = 0; i < 8; i++) corners.push([0, 1, 2].map((k) => ((i >> k) & 1 ? box.high : box.low)[k]));
    this.centre = [0, 1, 2].map((k) => (box.low[k] + box.high[k]) / 2);
    const span = (direction) => 2 * Math.max(...corners.map((corner) => this.along(direction, corner)));
    const [w, h] = [this.size[0] - left - right, this.size[1] - top - bottom];
    this.scale = Math.min(Math.max(w, 50) / span(this.right), Math.max(h, 50) / span(this.up));
    if (!Number.isFinite(this.scale)) this.scale = 1;
    this.move((left - right) / 2, (top - bottom) / 2);
  }

  /* To clip coordinates, column by column; `depth` is the half thickness of what is seen. */
  matrix(depth) {
    const [w, h] = this.size;
    const rows = [
      this.right.map((x) => (2 * this.scale * x) / w),
      this.up.map((x) => (2 * this.scale * x) / h),
      this.toward.map((x) => -x / depth),
    ];
    const shift = rows.map((row) => -(row[0] * this.centre[0] + row[1] * this.centre[1] + row[2] * this.centre[2]));
    const matrix = new Float32Array(16);
    for (let row = 0; row < 3; row++) {
      for (let k = 0; k < 3; k++) matrix[4 * k + row] = rows[row][k];
      matrix[12 + row] = shift[row];
    }
    matrix[15] = 1;
    return matrix;
  }
}
