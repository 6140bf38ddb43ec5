/* A contact field along the contact: a curve per chain of facets, a mark per contact in the colour of its state. */

const CURVES = ["#0b63a5", "#aa4499", "#117733", "#994f00", "#44337a"];

class Chart {
  constructor(canvas, model) {
    this.canvas = canvas;
    this.model = model;
    this.points = []; // { x, y, contact, chain, bound }
  }

  /* What contacts can be put along: x of the chart. */
  static abscissas(model) {
    const axes = model.axes.slice(0, model.dimension).map((axis, k) => ({ id: axis, label: axis, axis: k }));
    if (model.dimension === 2) return [{ id: "arc", label: "arc length" }, ...axes];
    return [...axes, { id: "radius", label: "distance from the highest" }];
  }

  /* Takes up values per contact; `line` keeps those on a line through the highest value only. */
  show(field, state, abscissa, line) {
    this.field = field;
    this.abscissa = abscissa;
    const { contacts } = this.model;
    const values = field.values(state);
    this.states = state.contact("state");
    const highest = this.highest(values);
    const kept = line && highest !== null ? this.onLine(abscissa, highest) : () => true;
    const bound = field.id === "friction" ? state.contact("coefficient").map((mu, i) => mu * state.contact("pressure")[i]) : null;
    this.points = [];
    for (let i = 0; i < contacts.count; i++) {
      const x = this.abscissaOf(abscissa, i, highest);
      if (!kept(i) || Number.isNaN(x) || !Number.isFinite(values[i])) continue;
      const chain = this.model.dimension === 2 ? contacts.chain[i] : contacts.pair[i];
      this.points.push({ x, y: values[i], contact: i, chain, bound: bound ? bound[i] : NaN });
    }
    this.points.sort((a, b) => a.chain - b.chain || a.x - b.x || a.contact - b.contact);
    this.joined = this.model.dimension === 2 || line;
    this.draw();
  }

  highest(values) {
    let found = null;
    for (let i = 0; i < values.length; i++) {
      if (!Number.isNaN(values[i]) && (found === null || values[i] > values[found])) found = i;
    }
    return found;
  }

  abscissaOf(abscissa, contact, highest) {
    const { positions, arc } = this.model.contacts;
    if (abscissa.id === "arc") return arc[contact];
    if (abscissa.axis !== undefined) return positions[3 * contact + abscissa.axis] + this.model.origin[abscissa.axis];
    if (highest === null) return NaN;
    return Math.hypot(...[0, 1, 2].map((k) => positions[3 * contact + k] - positions[3 * highest + k]));
  }

  /* Contacts beside the line along an axis by less than most neighbours are. */
  onLine(abscissa, through) {
    const { positions, count } = this.model.contacts;
    const axis = abscissa.axis === undefined ? 0 : abscissa.axis;
    const beside = (i) => Math.hypot(...[0, 1, 2].filter((k) => k !== axis).map((k) => positions[3 * i + k] - positions[3 * through + k]));
    const others = Array.from({ length: count }, (_, i) => beside(i)).filter((d) => d > 1e-6 * this.model.extent);
    const nearest = others.length ? others.reduce((a, b) => Math.min(a, b)) : 1;
    return (i) => beside(i) < 0.5 * nearest;
  }

  /* The contact whose mark is nearest to a place on the canvas, within 30 pixels. */
  nearest(x, y) {
    let [found, best] = [null, 30];
    for (const point of this.points) {
      const distance = Math.hypot(this.across(point.x) - x, 0.5 * (this.upward(point.y) - y));
      if (distance < best) [found, best] = [point, distance];
    }
    return found;
  }

  across(x) {
    return this.frame[0] + ((x - this.xs[0]) / (this.xs[1] - this.xs[0])) * (this.frame[1] - this.frame[0]);
  }

  upward(y) {
    return this.frame[3] - ((y - this.ys[0]) / (this.ys[1] - this.ys[0])) * (this.frame[3] - this.frame[2]);
  }

  /* Draws all of it; `marked` is a contact to point out. */
  draw(marked = null) {
    const dense = window.devicePixelRatio || 1;
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height || !this.field) return;
    this.canvas.width = width * dense;
    this.canvas.height = height * dense;
    const pen = this.canvas.getContext("2d");
    pen.scale(dense, dense);
    pen.font = "12px system-ui, sans-serif";
    this.frame = [86, width - 20, 14, height - 38];
    const spread = (values) => {
      const [low, high] = values.reduce(([a, b], v) => [Math.min(a, v), Math.max(b, v)], [Infinity, -Infinity]);
      return low < high ? [low, high] : [low - (Math.abs(low) || 1) / 2, low + (Math.abs(low) || 1) / 2];
    };
    if (this.points.length === 0) {
      pen.fillStyle = "#5a6875";
      pen.fillText("no contact has this value", this.frame[0], 30);
      return;
    }
    this.xs = spread(this.points.map((point) => point.x));
    this.ys = spread([0, ...this.points.flatMap((point) => (Number.isFinite(point.bound) ? [point.y, point.bound] : [point.y]))]);
    if (this.field.discrete) this.ys = [0, 2];
    this.ys[1] += 0.04 * (this.ys[1] - this.ys[0]);
    this.drawAxes(pen);
    this.drawCurves(pen);
    const found = marked === null ? null : this.points.find((point) => point.contact === marked);
    if (found) {
      pen.strokeStyle = "#1c2733";
      pen.lineWidth = 2;
      pen.beginPath();
      pen.arc(this.across(found.x), this.upward(found.y), 7, 0, 7);
      pen.stroke();
    }
  }

  drawAxes(pen) {
    const [left, right, top, bottom] = this.frame;
    pen.lineWidth = 1;
    pen.strokeStyle = "#e1e7ec";
    pen.fillStyle = "#43505c";
    pen.textBaseline = "middle";
    pen.textAlign = "right";
    const rows = this.field.discrete ? [0, 1, 2] : ticks(this.ys[0], this.ys[1], Math.max(2, (bottom - top) / 34));
    for (const y of rows) {
      const at = Math.round(this.upward(y)) + 0.5;
      pen.beginPath();
      pen.moveTo(left, at);
      pen.lineTo(right, at);
      pen.stroke();
      pen.fillText(this.field.discrete ? STATES[y].word : shortNumber(y), left - 8, at);
    }
    pen.textAlign = "center";
    pen.textBaseline = "top";
    for (const x of ticks(this.xs[0], this.xs[1], Math.max(2, (right - left) / 90))) {
      const at = Math.round(this.across(x)) + 0.5;
      pen.beginPath();
      pen.moveTo(at, bottom);
      pen.lineTo(at, bottom + 5);
      pen.stroke();
      pen.fillText(shortNumber(x), at, bottom + 7);
    }
    pen.strokeStyle = "#8795a1";
    pen.strokeRect(left + 0.5, top + 0.5, right - left, bottom - top);
    pen.fillStyle = "#1c2733";
    const unit = this.model.symbols.length;
    pen.fillText(unit ? `${this.abscissa.label} [${unit}]` : this.abscissa.label, (left + right) / 2, bottom + 22);
    pen.save();
    pen.translate(6, this.canvas.clientHeight / 2);
    pen.rotate(-Math.PI / 2);
    pen.fillText(titleOf(this.field), 0, 0, this.canvas.clientHeight - 8);
    pen.restore();
  }

  drawCurves(pen) {
    const chains = new Map();
    for (const point of this.points) {
      if (!chains.has(point.chain)) chains.set(point.chain, []);
      chains.get(point.chain).push(point);
    }
    [...chains.values()].forEach((points, number) => {
      const path = (value, dashes) => {
        pen.setLineDash(dashes);
        pen.beginPath();
        points.forEach((point, k) => pen[k ? "lineTo" : "moveTo"](this.across(point.x), this.upward(value(point))));
        pen.stroke();
        pen.setLineDash([]);
      };
      pen.strokeStyle = CURVES[number % CURVES.length];
      pen.lineWidth = 1.6;
      if (this.joined && !this.field.discrete) path((point) => point.y, []);
      if (this.joined && points.some((point) => Number.isFinite(point.bound))) {
        pen.lineWidth = 1;
        path((point) => (Number.isFinite(point.bound) ? point.bound : 0), [5, 4]);
      }
      const size = points.length > 400 ? 1.6 : 3;
      pen.lineWidth = 0.8;
      for (const point of points) {
        pen.fillStyle = css(STATES[this.states[point.contact]].colour);
        pen.strokeStyle = "#1c2733";
        pen.beginPath();
        pen.arc(this.across(point.x), this.upward(point.y), size, 0, 7);
        pen.fill();
        if (size > 2) pen.stroke();
      }
    });
  }
}
