/* The page: menus, mouse and keys, legend, hover, tables. */

const $ = (id) => document.getElementById(id);

class Viewer {
  constructor(model, states) {
    Object.assign(this, { model, states });
    this.fields = fieldsOf(model);
    this.scene = new Scene(model);
    this.camera = new Camera(model.dimension);
    this.auto = roundScale(model, states);
    const many = model.bodies.reduce((sum, body) => sum + body.lines.length / 2, 0) > 40000;
    this.wish = {
      step: states.length - 1, field: "von_mises", map: "viridis", bands: false,
      range: states.length > 1 ? "all" : "step", low: NaN, high: NaN, scale: this.auto,
      edges: many ? "outline" : "mesh", undeformed: false, diagram: true,
      hidden: new Set(), section: "", at: 0.5, flip: false, renderer: "",
      along: Chart.abscissas(model)[0].id, profile: model.contacts.count ? "pressure" : "",
      line: model.dimension === 3, tab: "profile",
    };
    this.readAddress();
    this.drawing = $("drawing");
    this.overlay = $("overlay");
    const { renderer } = this.wish;
    this.renderer = (renderer !== "canvas" && WebglRenderer.on(this.drawing, renderer === "webgl")) || new RasterRenderer(this.drawing);
    this.probe = null; // what is pointed at
    // A card that is taken away leaves the canvas to go on with.
    this.drawing.addEventListener("webglcontextlost", () => {
      const canvas = make("canvas", "", { id: "drawing" });
      this.drawing.replaceWith(canvas);
      this.drawing = canvas;
      this.renderer = new RasterRenderer(canvas);
      this.refresh();
    });
  }

  get state() {
    return this.states[this.wish.step];
  }

  get field() {
    return this.fields.find((field) => field.id === this.wish.field) || this.fields[0];
  }

  /* Settings behind the # of the address, such as `#field=pressure&step=2`. */
  readAddress() {
    for (const [name, text] of new URLSearchParams(location.hash.slice(1))) {
      const now = this.wish[name];
      if (now === undefined) continue;
      if (typeof now === "number") this.wish[name] = Number(text);
      else if (typeof now === "boolean") this.wish[name] = text === "true";
      else if (now instanceof Set) this.wish[name] = new Set(text.split(","));
      else this.wish[name] = text;
    }
    this.wish.step = Math.max(0, Math.min(this.states.length - 1, Math.round(this.wish.step) || 0));
    if (!Number.isFinite(this.wish.scale)) this.wish.scale = this.auto;
  }

  /* Colours of the field, the same array as long as they are the same. */
  get colours() {
    const { wish, field } = this;
    const key = `${wish.map} ${wish.bands} ${field.discrete}`;
    if (this.coloursOf !== key) {
      this.coloursOf = key;
      this.table = field.discrete ? stateColours() : colours(wish.map, wish.bands);
    }
    return this.table;
  }

  /* What the layers follow from. */
  look() {
    const { wish, field, state } = this;
    return {
      state, states: this.states, field, table: this.colours, range: this.range(), scale: wish.scale, edges: wish.edges,
      undeformed: wish.undeformed, hidden: wish.hidden, diagram: wish.diagram && this.fields.find((one) => one.id === "pressure"),
    };
  }

  range() {
    const { wish, field } = this;
    if (wish.range === "given" && !field.discrete) return [wish.low, wish.high];
    return rangeOf(field, wish.range === "all" ? this.states : [this.state]);
  }

  /* Normal and distance of the section; null without. */
  section() {
    const axis = ["x", "y", "z"].indexOf(this.wish.section);
    if (axis < 0 || this.model.dimension === 2) return null;
    const sign = this.wish.flip ? -1 : 1;
    return [...[0, 1, 2].map((k) => (k === axis ? sign : 0)), sign * (this.sectionAt() - this.model.origin[axis])];
  }

  /* Where the section is along its axis. */
  sectionAt() {
    const axis = ["x", "y", "z"].indexOf(this.wish.section);
    const { low, high } = this.model.box;
    return low[axis] + this.wish.at * (high[axis] - low[axis]) + this.model.origin[axis];
  }

  fit() {
    const margins = this.overlay.clientWidth > 600 ? [150, 36, 40, 40] : [24, 24, 24, 24];
    const bars = this.model.dimension === 2 ? this.scene.contactBars(this.look(), this.scene.deformed(this.state, this.wish.scale)) : [];
    const shown = [this.scene.deformed(this.state, this.wish.scale), ...bars.map((layer) => layer.positions)];
    this.camera.fit(boxAround(joined(shown, Float32Array)), margins);
    this.refresh();
  }

  /* Draws before the next frame. `changed`: the layers are no longer those of the last one. */
  refresh(changed = false) {
    if (changed) this.layers = null;
    if (this.waiting) return;
    this.waiting = requestAnimationFrame(() => {
      this.waiting = 0;
      this.draw();
    });
  }

  draw() {
    const { drawing, overlay, camera } = this;
    const [width, height] = [overlay.clientWidth, overlay.clientHeight];
    const dense = this.renderer.name === "canvas" ? 1 : window.devicePixelRatio || 1;
    const resize = (canvas, by) => {
      const [w, h] = [Math.max(1, Math.round(width * by)), Math.max(1, Math.round(height * by))];
      if (canvas.width !== w || canvas.height !== h) [canvas.width, canvas.height] = [w, h];
    };
    resize(drawing, dense);
    resize(overlay, window.devicePixelRatio || 1);
    if (camera.size[0] !== width || camera.size[1] !== height) {
      const first = camera.size[0] === 1;
      camera.size = [width, height];
      if (first) {
        this.fit();
      }
    }
    if (!this.layers) this.layers = this.scene.layers(this.look());
    this.renderer.draw(this.layers, camera, 4 * this.model.extent, this.section());
    this.places = null;
    this.drawOverlay();
  }

  drawOverlay() {
    const dense = window.devicePixelRatio || 1;
    const pen = this.overlay.getContext("2d");
    pen.setTransform(dense, 0, 0, dense, 0, 0);
    pen.clearRect(0, 0, this.overlay.clientWidth, this.overlay.clientHeight);
    if (this.model.dimension === 2) this.drawMarks(pen);
    this.drawLegend(pen);
    this.drawAxes(pen);
    this.drawProbe(pen);
  }

  /* Contacts of plane bodies as dots in the colours of their states. */
  drawMarks(pen) {
    const { contacts } = this.model;
    if (contacts.count > 300 || !(this.field.contact || this.wish.diagram)) return;
    const states = this.state.contact("state");
    pen.lineWidth = 0.8;
    pen.strokeStyle = "#1c2733";
    for (let i = 0; i < contacts.count; i++) {
      const [x, y] = this.placeOf(i);
      pen.fillStyle = css(STATES[states[i]].colour);
      pen.beginPath();
      pen.arc(x, y, 2.6, 0, 7);
      pen.fill();
      pen.stroke();
    }
  }

  /* Where a contact is on the screen. */
  placeOf(contact) {
    const { contacts } = this.model;
    const [point, positions] = [contacts.point[contact], this.scene.shape.positions];
    const array = point === NOWHERE ? contacts.positions : positions;
    const at = point === NOWHERE ? contact : point;
    return this.camera.place([array[3 * at], array[3 * at + 1], array[3 * at + 2]]);
  }

  drawLegend(pen) {
    const { field } = this;
    const marks = this.model.dimension === 2 && this.wish.diagram && this.model.contacts.count > 0;
    const [top, height] = [42, Math.max(60, Math.min(260, this.overlay.clientHeight - (marks ? 238 : 160)))];
    pen.textBaseline = "middle";
    pen.textAlign = "left";
    pen.font = "600 13px system-ui, sans-serif";
    pen.fillStyle = "rgba(255, 255, 255, 0.7)";
    pen.fillRect(8, 8, Math.max(96, pen.measureText(titleOf(field)).width + 16), field.discrete ? 98 : top + height + (marks ? 78 : 6));
    pen.fillStyle = "#1c2733";
    pen.fillText(titleOf(field), 16, 22);
    pen.font = "12px system-ui, sans-serif";
    const swatches = (y) => STATES.slice().reverse().forEach(({ word, colour }, k) => {
      pen.fillStyle = css(colour);
      pen.strokeStyle = "#43505c";
      pen.fillRect(16, y + 22 * k, 18, 14);
      pen.strokeRect(16.5, y + 0.5 + 22 * k, 17, 13);
      pen.fillStyle = "#1c2733";
      pen.fillText(word, 42, y + 8 + 22 * k);
    });
    if (field.discrete) {
      swatches(40);
      return;
    }
    const [low, high] = this.range();
    for (let y = 0; y < height; y++) {
      const i = Math.max(0, Math.min(255, Math.floor(256 * (1 - (y + 0.5) / height))));
      pen.fillStyle = css(this.colours.slice(3 * i, 3 * i + 3));
      pen.fillRect(16, top + y, 18, 1.5);
    }
    pen.strokeStyle = "#43505c";
    pen.lineWidth = 1;
    pen.strokeRect(16.5, top + 0.5, 17, height);
    pen.fillStyle = "#1c2733";
    const count = this.wish.bands ? BANDS : 5;
    for (let k = 0; k <= count; k++) {
      const y = top + height * (1 - k / count);
      pen.fillRect(34, y, 4, 1);
      if (low < high || k === 0) pen.fillText(shortNumber(low + (k / count) * (high - low)), 42, y);
    }
    if (marks) swatches(top + height + 16);
  }

  drawAxes(pen) {
    const [x, y] = [44, this.overlay.clientHeight - 44];
    pen.font = "600 12px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.lineWidth = 2;
    const { right, up, toward } = this.camera;
    const axes = this.model.axes.slice(0, this.model.dimension).map((name, k) => ({ name, k, depth: toward[k] }));
    for (const { name, k } of axes.sort((a, b) => a.depth - b.depth)) {
      const [dx, dy] = [28 * right[k], -28 * up[k]];
      pen.strokeStyle = pen.fillStyle = ["#b2182b", "#2a7a2a", "#2166ac"][k];
      pen.beginPath();
      pen.moveTo(x, y);
      pen.lineTo(x + dx, y + dy);
      pen.stroke();
      if (Math.hypot(dx, dy) > 6) pen.fillText(name, x + 1.35 * dx, y + 1.35 * dy);
    }
  }

  drawProbe(pen) {
    if (!this.probe) return;
    const [x, y] = this.probe.contact === undefined ? this.probe.place : this.placeOf(this.probe.contact);
    for (const [colour, width] of [["#fff", 4], ["#1c2733", 2]]) {
      pen.strokeStyle = colour;
      pen.lineWidth = width;
      pen.beginPath();
      pen.arc(x, y, 6, 0, 7);
      pen.stroke();
    }
  }

  /* The contact or the place of a body under the mouse. */
  pick(x, y) {
    const places = this.screenPlaces();
    if (this.field.contact) return this.pickContact(x, y);
    const section = this.section();
    const positions = this.scene.shape.positions;
    let found = null;
    for (const body of this.scene.shown(this.look())) {
      const { triangles } = body;
      for (let i = 0; i < triangles.length; i += 3) {
        const a = 3 * triangles[i];
        const b = 3 * triangles[i + 1];
        const c = 3 * triangles[i + 2];
        const bx = places[b] - places[a];
        const by = places[b + 1] - places[a + 1];
        const cx = places[c] - places[a];
        const cy = places[c + 1] - places[a + 1];
        const area = bx * cy - by * cx;
        if (area === 0) continue;
        const px = x - places[a];
        const py = y - places[a + 1];
        const u = (px * cy - py * cx) / area;
        if (u < 0 || u > 1) continue;
        const v = (bx * py - by * px) / area;
        if (v < 0 || u + v > 1) continue;
        const shares = [1 - u - v, u, v];
        const between = (array, k) => shares[0] * array[a + k] + u * array[b + k] + v * array[c + k];
        const depth = between(places, 2);
        if (found && depth <= found.depth) continue;
        const at = [0, 1, 2].map((k) => between(positions, k));
        if (section && dot(section, at) > section[3]) continue;
        found = { body, points: [a / 3, b / 3, c / 3], shares, depth, place: [x, y] };
      }
    }
    return found;
  }

  screenPlaces() {
    if (!this.places) {
      this.scratch ||= new Float32Array(this.model.positions.length);
      this.places = this.camera.places(this.scene.shape.positions, this.scratch);
    }
    return this.places;
  }

  pickContact(x, y) {
    let [found, best] = [null, 24];
    const section = this.section();
    for (let i = 0; i < this.model.contacts.count; i++) {
      const [px, py] = this.placeOf(i);
      const distance = Math.hypot(px - x, py - y);
      const p = this.model.contacts.positions;
      if (distance < best && !(section && dot(section, [p[3 * i], p[3 * i + 1], p[3 * i + 2]]) > section[3])) [found, best] = [i, distance];
    }
    return found === null ? null : { contact: found };
  }

  /* Heading and rows of what is pointed at. */
  words(probe) {
    const { model, state } = this;
    const length = model.symbols.length && ` ${model.symbols.length}`;
    if (probe.contact !== undefined) {
      const i = probe.contact;
      const { contacts } = model;
      const body = model.bodies[contacts.body[i]];
      const rows = model.axes.slice(0, model.dimension).map((axis, k) => [axis, shortNumber(contacts.positions[3 * i + k] + model.origin[k]) + length]);
      for (const field of this.fields.filter((one) => one.contact)) {
        const value = field.values(state)[i];
        rows.push([field.label, field.discrete ? STATES[value].word : shortNumber(value) + (field.unit && ` ${field.unit}`)]);
      }
      return [`Contact ${i}: ${body.name}, node ${contacts.node[i]}`, rows];
    }
    const { points, shares } = probe;
    const mean = (values, width, k) => points.reduce((sum, point, j) => sum + shares[j] * values[width * point + k], 0);
    const corners = points.map((point, k) => [shares[k], model.nodes[point]]).filter(([, own]) => own !== NOWHERE);
    const node = corners.length ? corners.sort((a, b) => b[0] - a[0])[0][1] : NOWHERE;
    const rows = model.axes.slice(0, model.dimension).map((axis, k) => [axis, shortNumber(mean(model.positions, 3, k) + model.origin[k]) + length]);
    const shown = [this.field, ...["displacement", "von_mises"].map((id) => this.fields.find((one) => one.id === id))];
    for (const field of new Set(shown)) rows.push([field.label, shortNumber(mean(field.values(state), 1, 0)) + (field.unit && ` ${field.unit}`)]);
    return [node === NOWHERE ? probe.body.name : `${probe.body.name}, near node ${node}`, rows];
  }

  showTip(probe, x, y) {
    const tip = $("tip");
    this.probe = probe;
    tip.hidden = !probe;
    if (probe) {
      const [heading, rows] = this.words(probe);
      tip.replaceChildren(make("b", heading), table(rows));
      const room = this.overlay.clientWidth - tip.offsetWidth - 12;
      tip.style.left = `${Math.max(4, Math.min(x + 16, room))}px`;
      tip.style.top = `${Math.max(4, Math.min(y + 16, this.overlay.clientHeight - tip.offsetHeight - 8))}px`;
    }
    this.drawOverlay();
    if (this.chart && this.wish.tab === "profile") this.chart.draw(probe && probe.contact !== undefined ? probe.contact : null);
  }
}

/* An element with words in it. */
function make(tag, words = "", more = {}) {
  const element = Object.assign(document.createElement(tag), more);
  element.textContent = words;
  return element;
}

/* Rows of words; the first may be headings. */
function table(rows, heads = null, numbers = []) {
  const made = document.createElement("table");
  const line = (cells, tag) => {
    const row = make("tr");
    cells.forEach((cell, k) => row.append(make(tag, cell, numbers.includes(k) ? { className: "number" } : {})));
    return row;
  };
  if (heads) made.append(line(heads, "th"));
  for (const row of rows) made.append(line(row, "td"));
  return made;
}
