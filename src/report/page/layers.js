/* What is drawn, in layers that either renderer understands:

   positions   three numbers per point
   indices     points of triangles, or of lines where `lines` is set
   values      a number per point, coloured by `table` over `range`; else `colour`
   alpha       below one: seen through
   shade       darker where a facet turns away
   closed      the surface of a body, its triangles seen from outside
   clip        cut by the section */

const PAPER = [226, 232, 238];
const EDGE = [74, 88, 102];
const RIGID = [196, 200, 205];
const PRESSED = [170, 68, 153];

/* Parts of the extent: the highest bar of a diagram, and the ribbon that shows where contacts are. */
const BAR = 0.11;
const RIBBON = 0.014;

class Scene {
  constructor(model) {
    this.model = model;
    this.shape = { state: null, scale: NaN, positions: model.positions };
  }

  /* Positions of all points with displacements enlarged. */
  deformed(state, scale) {
    if (this.shape.state !== state || this.shape.scale !== scale) {
      const [x, u] = [this.model.positions, state.displacement];
      const positions = new Float32Array(x.length);
      for (let i = 0; i < x.length; i++) positions[i] = x[i] + scale * u[i];
      this.shape = { state, scale, positions };
    }
    return this.shape.positions;
  }

  layers(look) {
    const positions = this.deformed(look.state, look.scale);
    const colours = { table: look.table, range: look.range };
    const layers = this.obstacles(look);
    if (look.undeformed) {
      for (const body of this.shown(look)) {
        layers.push({ positions: this.model.positions, indices: body.outline, lines: true, colour: [150, 160, 170], alpha: 1, clip: true });
      }
    }
    // In space the bodies hide their contact: they are seen through while it is looked at.
    const ghost = look.field.contact && this.model.dimension === 3;
    const values = look.field.contact ? null : look.field.values(look.state);
    for (const body of this.shown(look)) {
      layers.push({
        positions, indices: body.triangles, values, ...colours, colour: PAPER, alpha: ghost ? 0.09 : 1,
        shade: this.model.dimension === 3, closed: this.model.dimension === 3 && !ghost, clip: true,
      });
      const lines = ghost && look.edges === "mesh" ? body.outline : { mesh: body.lines, outline: body.outline }[look.edges];
      if (lines) {
        const soft = look.edges === "mesh" && !ghost && look.edges !== "outline";
        layers.push({ positions, indices: lines, lines: true, colour: EDGE, alpha: soft ? 0.35 : 0.8, clip: true });
        if (soft) layers.push({ positions, indices: body.outline, lines: true, colour: EDGE, alpha: 0.9, clip: true });
      }
    }
    if (this.model.dimension === 3 && look.field.contact) layers.push(...this.contactFaces(look, positions));
    if (this.model.dimension === 2) layers.push(...this.contactBars(look, positions));
    return layers;
  }

  shown(look) {
    return this.model.bodies.filter((body) => !look.hidden.has(body.name));
  }

  /* The state of most of each facet's contacts, of two alike the one that holds more; none behind contacts. */
  facetStates(state) {
    return state.once("facet states", () => {
      const { corners } = this.model.surface;
      const found = new Float32Array(corners.length / 4).fill(BLANK);
      const states = state.contact("state");
      for (let facet = 0; facet < found.length; facet++) {
        const counts = [0, 0, 0];
        for (let k = 0; k < 4; k++) {
          const contact = corners[4 * facet + k];
          if (contact !== NOWHERE) counts[states[contact]] += 1;
        }
        const most = Math.max(...counts);
        if (most > 0) found[facet] = counts.lastIndexOf(most);
      }
      return found;
    });
  }

  /* A contact field at the points of the surface; blank where a contact is missing. */
  onSurface(field, state) {
    return state.once(`surface ${field.id}`, () => {
      const { contacts, shares, point } = this.model.surface;
      const values = field.values(state);
      return Float32Array.from({ length: point.length }, (_, p) => {
        let sum = 0;
        for (let k = 4 * p; k < 4 * p + 4; k++) {
          if (Math.abs(shares[k]) < 1e-6) continue;
          const value = contacts[k] === NOWHERE ? NaN : values[contacts[k]];
          sum += shares[k] * value;
        }
        return Number.isNaN(sum) ? BLANK : sum;
      });
    });
  }

  /* The contact surface in space, small triangle by small triangle. */
  contactFaces(look, positions) {
    const { point, pieces, facet } = this.model.surface;
    const values = look.field.discrete ? null : this.onSurface(look.field, look.state);
    const states = look.field.discrete ? this.facetStates(look.state) : null;
    const places = new Float32Array(3 * pieces.length);
    const of = new Float32Array(pieces.length);
    for (let i = 0; i < pieces.length; i++) {
      for (let k = 0; k < 3; k++) places[3 * i + k] = positions[3 * point[pieces[i]] + k];
      of[i] = values ? values[pieces[i]] : states[facet[Math.floor(i / 3)]];
    }
    const indices = Uint32Array.from(of, (_, i) => i);
    const look3 = { table: look.table, range: look.range, alpha: 1, clip: true, colour: PAPER };
    const layers = [{ positions: places, indices, values: of, shade: !states, ...look3 }];
    if (look.edges === "mesh") {
      layers.push({ positions, indices: this.facetLines(), lines: true, colour: EDGE, alpha: 0.6, clip: true });
    }
    return layers;
  }

  /* Edges of the contact facets: those of their small triangles that one triangle of the facet has. */
  facetLines() {
    if (this.linesOfFacets) return this.linesOfFacets;
    const { point, pieces, facet } = this.model.surface;
    const found = [];
    let sides = new Map();
    for (let i = 0; i < pieces.length; i += 3) {
      for (let k = 0; k < 3; k++) {
        const ends = [point[pieces[i + k]], point[pieces[i + ((k + 1) % 3)]]].sort((a, b) => a - b);
        const key = ends.join(" ");
        if (sides.has(key)) sides.delete(key);
        else sides.set(key, ends);
      }
      if (facet[i / 3 + 1] !== facet[i / 3]) {
        for (const ends of sides.values()) found.push(...ends);
        sides = new Map();
      }
    }
    this.linesOfFacets = Uint32Array.from(found);
    return this.linesOfFacets;
  }

  /* Where the contact field stands above the surface of plane bodies, along the contacts' normals. */
  contactBars(look, positions) {
    const field = look.field.contact ? look.field : look.diagram;
    if (!field) return [];
    const { point, pieces, facet, contacts, shares } = this.model.surface;
    const { normals } = this.model.contacts;
    const values = field.discrete ? null : this.onSurface(field, look.state);
    const states = field.discrete ? this.facetStates(look.state) : null;
    const range = field === look.field ? look.range : rangeOf(field, look.states);
    const largest = Math.max(Math.abs(range[0]), Math.abs(range[1])) || 1;
    const least = field === look.field ? RIBBON : 0;
    const lift = 0.02 * this.model.extent; // in front of the bodies
    const places = new Float32Array(6 * pieces.length);
    const of = new Float32Array(2 * pieces.length);
    for (let i = 0; i < pieces.length; i++) {
      const p = pieces[i];
      // Where a corner is no contact, the normal is that of the other one.
      const n = [0, 0];
      for (let k = 4 * p; k < 4 * p + 4; k++) {
        if (contacts[k] === NOWHERE) continue;
        for (let axis = 0; axis < 2; axis++) n[axis] += (shares[k] + 1e-6) * normals[3 * contacts[k] + axis];
      }
      const length = Math.hypot(...n) || 1;
      const value = values ? values[p] : states[facet[Math.floor(i / 2)]];
      const part = values && value > BLANK ? Math.min(Math.abs(value) / largest, 1) : 0;
      const height = this.model.extent * (least + BAR * part);
      for (let axis = 0; axis < 2; axis++) {
        const foot = positions[3 * point[p] + axis];
        places[6 * i + axis] = foot;
        places[6 * i + 3 + axis] = foot + (height * n[axis]) / length;
      }
      places[6 * i + 2] = places[6 * i + 5] = lift;
      of[2 * i] = of[2 * i + 1] = value;
    }
    // Every piece is two points with their tips: 2i, 2i + 1 and 2i + 2, 2i + 3.
    const [indices, lines] = [[], []];
    for (let i = 0; i < pieces.length; i += 2) {
      const [a, b] = [2 * i, 2 * i + 2];
      indices.push(a, a + 1, b + 1, a, b + 1, b);
      const stands = (at) => places[3 * at] !== places[3 * at + 3] || places[3 * at + 1] !== places[3 * at + 4];
      if (!stands(a) && !stands(b)) continue;
      lines.push(a + 1, b + 1);
      if (facet[i / 2 - 1] !== facet[i / 2]) lines.push(a, a + 1);
      if (facet[i / 2 + 1] !== facet[i / 2]) lines.push(b, b + 1);
    }
    const own = field === look.field;
    const shared = { positions: places, alpha: own ? 1 : 0.45, colour: PRESSED };
    return [
      { ...shared, indices: Uint32Array.from(indices), values: own ? of : null, table: look.table, range: look.range },
      { ...shared, indices: Uint32Array.from(lines), lines: true, colour: own ? EDGE : [120, 40, 105], alpha: own ? 0.5 : 0.8 },
    ];
  }

  /* Rigid obstacles, as much of them as is near the bodies. */
  obstacles(look) {
    const layers = [];
    this.model.pairs.forEach((pair, index) => {
      if (!pair.obstacle) return;
      const made = this.drawn(pair.obstacle);
      const positions = carried(made.positions, look.state.stored.obstacles[index], look.scale);
      const solid = this.model.dimension === 2 ? 1 : 0.35;
      const hidden = this.model.dimension === 3 && look.field.contact;
      if (!hidden) layers.push({ positions, indices: made.indices, colour: RIGID, alpha: solid, shade: this.model.dimension === 3 });
      layers.push({ positions, indices: made.border, lines: true, colour: [120, 126, 133], alpha: 0.9 });
    });
    return layers;
  }

  /* Rows and triangles are drawn as they come, other shapes near the bodies. */
  drawn(obstacle) {
    if (obstacle.rows) return grid(obstacle.rows, 8);
    if (obstacle.triangles) {
      const edges = obstacle.triangles.flatMap(([a, b, c]) => [a, b, b, c, c, a]);
      const [indices, border] = [Uint32Array.from(obstacle.triangles.flat()), Uint32Array.from(edges)];
      return { positions: Float32Array.from(obstacle.points.flat()), indices, border };
    }
    return this.model.dimension === 2 ? this.strip(obstacle) : this.patch(obstacle);
  }

  /* A plane obstacle's rim, and a tenth of the extent behind it. */
  strip({ point, direction, radius }) {
    const [rim, inner] = [[], []];
    const depth = 0.07 * this.model.extent;
    if (radius) {
      const half = Math.min(Math.PI, (0.8 * this.model.extent) / radius);
      const middle = Math.atan2(-point[1], -point[0]);
      const count = 120;
      for (let i = 0; i <= count; i++) {
        const angle = middle + half * ((2 * i) / count - 1);
        const at = (r) => [point[0] + r * Math.cos(angle), point[1] + r * Math.sin(angle)];
        rim.push(at(radius));
        inner.push(at(Math.max(0, radius - depth)));
      }
    } else {
      const length = Math.hypot(direction[0], direction[1]);
      const n = [direction[0] / length, direction[1] / length];
      const along = point[0] * n[0] + point[1] * n[1];
      for (const t of [-0.75 * this.model.extent, 0.75 * this.model.extent]) {
        const foot = [along * n[0] - t * n[1], along * n[1] + t * n[0]];
        rim.push(foot);
        inner.push([foot[0] - depth * n[0], foot[1] - depth * n[1]]);
      }
    }
    const behind = -0.05 * this.model.extent;
    return grid([rim, inner].map((row) => row.map(([x, y]) => [x, y, behind])), 1);
  }

  /* A patch of an obstacle in space. */
  patch({ point, direction, radius }) {
    const reach = 0.5 * this.model.extent;
    const axes = direction ? axesAround(direction) : null;
    const rows = [];
    if (!radius) {
      const along = dot(point, axes[2]);
      const at = (a, b) => [0, 1, 2].map((k) => along * axes[2][k] + a * axes[0][k] + b * axes[1][k]);
      for (const b of [-reach, reach]) rows.push([-reach, reach].map((a) => at(a, b)));
      return grid(rows, 1);
    }
    const half = Math.min(Math.PI, reach / radius);
    const count = 32;
    const steps = Array.from({ length: count + 1 }, (_, i) => half * ((2 * i) / count - 1));
    if (direction) {
      // Lengthwise about the middle of the bodies, around from the side that looks at them.
      const start = -dot(point, axes[2]);
      const outward = [-dot(point, axes[0]), -dot(point, axes[1])];
      const middle = Math.atan2(outward[1], outward[0]);
      for (const z of [-reach, reach]) {
        rows.push(steps.map((angle) => [0, 1, 2].map((k) => point[k] + (start + z) * axes[2][k]
          + radius * (Math.cos(middle + angle) * axes[0][k] + Math.sin(middle + angle) * axes[1][k]))));
      }
      return grid(rows, 1);
    }
    const toward = axesAround(point.map((x) => -x || 1e-30));
    for (const a of steps.map((s) => Math.abs(s) < Math.PI / 2 ? s : (Math.sign(s) * Math.PI) / 2)) {
      rows.push(steps.map((b) => {
        const on = [Math.sin(b) * Math.cos(a), Math.sin(a), Math.cos(a) * Math.cos(b)];
        return [0, 1, 2].map((k) => point[k] + radius * (on[0] * toward[0][k] + on[1] * toward[1][k] + on[2] * toward[2][k]));
      }));
    }
    return grid(rows, 8);
  }
}

function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Three orthonormal vectors, the last along a direction. */
function axesAround(direction) {
  const length = Math.hypot(...direction);
  const n = direction.map((x) => x / length);
  const least = n.map(Math.abs).indexOf(Math.min(...n.map(Math.abs)));
  const across = [0, 1, 2].map((k) => (k === least ? 1 : 0) - n[least] * n[k]);
  const size = Math.hypot(...across);
  const a = across.map((x) => x / size);
  return [a, [n[1] * a[2] - n[2] * a[1], n[2] * a[0] - n[0] * a[2], n[0] * a[1] - n[1] * a[0]], n];
}

/* Rows of positions as triangles, with lines along every so many rows and columns and along the border. */
function grid(rows, every) {
  const width = rows[0].length;
  const [indices, border] = [[], []];
  const line = (at) => at % every === 0;
  rows.forEach((row, j) => row.forEach((_, i) => {
    const at = j * width + i;
    if (i + 1 < width && (line(j) || j === rows.length - 1)) border.push(at, at + 1);
    if (j + 1 < rows.length && ((every > 1 && line(i)) || i === 0 || i === width - 1)) border.push(at, at + width);
    if (i + 1 < width && j + 1 < rows.length) indices.push(at, at + 1, at + width + 1, at, at + width + 1, at + width);
  }));
  return { positions: Float32Array.from(rows.flat(2)), indices: Uint32Array.from(indices), border: Uint32Array.from(border) };
}

/* Positions that a rigid body carries along, its displacement and angle enlarged. */
function carried(positions, motion, scale) {
  if (!motion) return positions;
  const { translation, rotation, about } = motion;
  const angle = scale * Math.hypot(...rotation);
  const axis = rotation.map((w) => (angle ? (scale * w) / angle : 0));
  const [sine, cosine] = [Math.sin(angle), Math.cos(angle)];
  const made = new Float32Array(positions.length);
  for (let i = 0; i < positions.length; i += 3) {
    const arm = about.map((c, k) => positions[i + k] - c);
    const along = (1 - cosine) * arm.reduce((sum, x, k) => sum + x * axis[k], 0);
    for (let k = 0; k < 3; k++) {
      const [l, m] = [(k + 1) % 3, (k + 2) % 3];
      const turned = cosine * arm[k] + sine * (axis[l] * arm[m] - axis[m] * arm[l]) + along * axis[k];
      made[i + k] = about[k] + turned + scale * translation[k];
    }
  }
  return made;
}
