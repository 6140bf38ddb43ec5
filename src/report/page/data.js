/* What the page holds: bodies, contacts and states, out of base64. */

const NOWHERE = 0xffffffff;

function unpack(text, Kind) {
  if (Uint8Array.fromBase64) return new Kind(Uint8Array.fromBase64(text).buffer);
  const letters = atob(text);
  const bytes = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; i++) bytes[i] = letters.charCodeAt(i);
  return new Kind(bytes.buffer);
}

/* Vectors of `axes` components as such of three. */
function inSpace(values, axes) {
  if (axes === 3) return values;
  const count = values.length / axes;
  const padded = new Float32Array(3 * count);
  for (let i = 0; i < count; i++) {
    for (let k = 0; k < axes; k++) padded[3 * i + k] = values[axes * i + k];
  }
  return padded;
}

function joined(arrays, Kind) {
  const all = new Kind(arrays.reduce((sum, array) => sum + array.length, 0));
  let at = 0;
  for (const array of arrays) {
    all.set(array, at);
    at += array.length;
  }
  return all;
}

/* What stays from state to state. All bodies share one array of points. */
class Model {
  constructor(scene) {
    Object.assign(this, {
      title: scene.title, units: scene.units, symbols: scene.symbols,
      dimension: scene.dimension, axes: scene.axes, origin: scene.origin, pairs: scene.pairs,
    });
    let first = 0;
    const positions = [];
    const nodes = [];
    this.bodies = scene.bodies.map((body) => {
      const own = unpack(body.positions, Float32Array);
      positions.push(own);
      nodes.push(unpack(body.nodes, Uint32Array));
      const moved = (text) => unpack(text, Uint32Array).map((point) => point + first);
      const made = {
        name: body.name, first, count: own.length / 3,
        triangles: moved(body.triangles), lines: moved(body.lines), outline: moved(body.outline),
      };
      first += made.count;
      return made;
    });
    this.positions = joined(positions, Float32Array);
    this.nodes = joined(nodes, Uint32Array);
    this.points = first;
    this.box = boxAround(this.positions);
    this.extent = Math.hypot(...[0, 1, 2].map((k) => this.box.high[k] - this.box.low[k])) || 1;
    this.readContacts(scene.contacts, scene.surface);
  }

  readContacts(stored, surface) {
    const integers = (text) => unpack(text, Uint32Array);
    const reals = (text) => unpack(text, Float32Array);
    this.contacts = {
      body: integers(stored.body), node: integers(stored.node), pair: integers(stored.pair),
      positions: reals(stored.positions), normals: reals(stored.normals),
      chain: integers(stored.chain), arc: reals(stored.arc),
    };
    this.contacts.count = this.contacts.body.length;
    const body = integers(surface.body);
    this.surface = {
      // Points of the surface as points of all bodies.
      point: integers(surface.point).map((point, at) => point + this.bodies[body[at]].first),
      contacts: integers(surface.contacts), shares: reals(surface.shares),
      pieces: integers(surface.pieces), facet: integers(surface.facet), corners: integers(surface.corners),
    };
    // The drawn point at each contact, to follow its displacement.
    const points = this.bodies.map(() => new Map());
    this.contacts.body.forEach((body, i) => points[body].set(this.contacts.node[i], NOWHERE));
    this.bodies.forEach((body, index) => {
      for (let p = body.first; p < body.first + body.count; p++) {
        if (points[index].has(this.nodes[p])) points[index].set(this.nodes[p], p);
      }
    });
    this.contacts.point = this.contacts.node.map((node, i) => points[this.contacts.body[i]].get(node));
  }

  bodyOf(point) {
    return this.bodies.find((body) => point < body.first + body.count);
  }
}

/* A solved state; arrays are read when they are first asked for. */
class State {
  constructor(model, stored) {
    this.model = model;
    this.stored = stored;
    this.known = new Map();
  }

  /* What `make` gives, computed once. */
  once(name, make) {
    if (!this.known.has(name)) this.known.set(name, make());
    return this.known.get(name);
  }

  get displacement() {
    return this.once("displacement", () => {
      const own = this.stored.bodies.map((body) => unpack(body.displacement, Float32Array));
      return inSpace(joined(own, Float32Array), this.model.dimension);
    });
  }

  /* xx, yy, zz, xy, and in 3D yz, xz. */
  get stress() {
    return this.once("stress", () => joined(this.stored.bodies.map((body) => unpack(body.stress, Float32Array)), Float32Array));
  }

  contact(name) {
    const kind = name === "state" ? Uint32Array : Float32Array;
    return this.once(`contact ${name}`, () => {
      const values = unpack(this.stored.contacts[name], kind);
      return name === "friction" || name === "slip" ? inSpace(values, this.model.dimension) : values;
    });
  }

  get label() {
    return this.stored.step === undefined ? "" : `${this.stored.step} at ${shortNumber(this.stored.at)}`;
  }
}

function boxAround(positions) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < positions.length; i += 3) {
    for (let k = 0; k < 3; k++) {
      const x = positions[i + k];
      if (x < low[k]) low[k] = x;
      if (x > high[k]) high[k] = x;
    }
  }
  return { low, high };
}

/* Reads the page's own elements; a state that was cut off while it was written is left out. */
function readPage() {
  const read = (element) => {
    const data = JSON.parse(element.textContent);
    element.textContent = "";
    return data;
  };
  const model = new Model(read(document.querySelector("script.scene")));
  const states = [];
  for (const element of document.querySelectorAll("script.state")) {
    try {
      states.push(new State(model, read(element)));
    } catch {
      break;
    }
  }
  return { model, states };
}

/* The largest round factor on displacements for which bodies still look like themselves: below a twelfth
   of their extent, and without drawing contacts through each other by more than a hundredth of it. */
function roundScale(model, states) {
  let most = Infinity;
  for (const state of states) {
    let largest = 0;
    const u = state.displacement;
    for (let i = 0; i < u.length; i += 3) largest = Math.max(largest, u[i] ** 2 + u[i + 1] ** 2 + u[i + 2] ** 2);
    if (largest > 0) most = Math.min(most, model.extent / 12 / Math.sqrt(largest));
    // Where bodies touch, the distance before loading is drawn over as often as the factor says.
    const [gap, initial, pressure] = ["gap", "initial_gap", "pressure"].map((name) => state.contact(name));
    for (let i = 0; i < gap.length; i++) {
      const closed = pressure[i] > 0 ? Math.abs(initial[i]) : initial[i] - gap[i];
      if (closed > 0) most = Math.min(most, (0.01 * model.extent + Math.abs(initial[i])) / closed);
    }
  }
  if (!(most > 1) || most === Infinity) return 1;
  const power = 10 ** Math.floor(Math.log10(most));
  return [5, 2, 1].map((m) => m * power).find((factor) => factor <= most * (1 + 1e-9));
}
