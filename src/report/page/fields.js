/* Fields by name: of bodies at points, of contacts, each with its unit and how it follows from the data. */

/* Principal values of a symmetric tensor, largest first (Smith, Comm. ACM 4 (1961) 168). */
function principal(xx, yy, zz, xy, yz, xz) {
  const mean = (xx + yy + zz) / 3;
  const off = xy * xy + yz * yz + xz * xz;
  const [a, b, c] = [xx - mean, yy - mean, zz - mean];
  const size = Math.sqrt((a * a + b * b + c * c + 2 * off) / 6);
  if (size === 0) return [mean, mean, mean];
  const det = a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz);
  const angle = Math.acos(Math.max(-1, Math.min(1, det / (2 * size ** 3)))) / 3;
  const first = mean + 2 * size * Math.cos(angle);
  const third = mean + 2 * size * Math.cos(angle + (2 * Math.PI) / 3);
  return [first, 3 * mean - first - third, third];
}

function vonMises(xx, yy, zz, xy, yz, xz) {
  const squares = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2;
  return Math.sqrt(0.5 * squares + 3 * (xy * xy + yz * yz + xz * xz));
}

function lengths(vectors) {
  const found = new Float32Array(vectors.length / 3);
  for (let i = 0; i < found.length; i++) found[i] = Math.sqrt(vectors[3 * i] ** 2 + vectors[3 * i + 1] ** 2 + vectors[3 * i + 2] ** 2);
  return found;
}

function component(vectors, axis) {
  return Float32Array.from({ length: vectors.length / 3 }, (_, i) => vectors[3 * i + axis]);
}

/* A function of the stress at every point. */
function ofStress(state, value) {
  const stress = state.stress;
  const width = state.model.dimension === 2 ? 4 : 6;
  const found = new Float32Array(stress.length / width);
  for (let i = 0; i < found.length; i++) {
    const at = width * i;
    const [yz, xz] = width === 6 ? [stress[at + 4], stress[at + 5]] : [0, 0];
    found[i] = value(stress[at], stress[at + 1], stress[at + 2], stress[at + 3], yz, xz);
  }
  return found;
}

/* Part of the friction that the pressure allows; none where nothing presses. */
function frictionUsed(state) {
  const [pressure, friction] = [state.contact("pressure"), lengths(state.contact("friction"))];
  const coefficient = state.contact("coefficient");
  return friction.map((size, i) => (coefficient[i] * pressure[i] > 0 ? size / (coefficient[i] * pressure[i]) : NaN));
}

/* All fields of a model, in the order of the menu. */
function fieldsOf(model) {
  const axes = model.axes.slice(0, model.dimension);
  const fields = [];
  const add = (group, id, label, unit, values, more = {}) => {
    fields.push({
      group, id, label, unit: unit && model.symbols[unit], contact: group === "Contact",
      values: (state) => state.once(`field ${id}`, () => values(state)), ...more,
    });
  };
  add("Displacement", "displacement", "Displacement", "length", (state) => lengths(state.displacement));
  axes.forEach((axis, k) => {
    add("Displacement", `displacement_${axis}`, `Displacement ${axis}`, "length", (state) => component(state.displacement, k));
  });
  add("Stress", "von_mises", "Von Mises stress", "stress", (state) => ofStress(state, vonMises));
  ["largest", "middle", "smallest"].forEach((word, k) => {
    const values = (state) => ofStress(state, (...s) => principal(...s)[k]);
    add("Stress", `principal_${k + 1}`, `Principal stress ${k + 1} (${word})`, "stress", values);
  });
  add("Stress", "tresca", "Tresca stress (1 − 3)", "stress", (state) => ofStress(state, (...s) => {
    const found = principal(...s);
    return found[0] - found[2];
  }));
  const [x, y, z] = model.axes;
  const names = [x + x, y + y, z + z, x + y, y + z, x + z];
  names.slice(0, model.dimension === 2 ? 4 : 6).forEach((name, k) => {
    add("Stress", `stress_${name}`, `Stress ${name}`, "stress", (state) => ofStress(state, (...s) => s[k]));
  });
  if (model.contacts.count > 0) {
    add("Contact", "pressure", "Contact pressure", "stress", (state) => state.contact("pressure"), { fromZero: true });
    add("Contact", "friction", "Friction traction", "stress", (state) => lengths(state.contact("friction")), { fromZero: true });
    add("Contact", "friction_used", "Friction / bound", "", frictionUsed, { fromZero: true });
    add("Contact", "gap", "Gap", "length", (state) => state.contact("gap"));
    add("Contact", "slip", "Slip of the step", "length", (state) => lengths(state.contact("slip")), { fromZero: true });
    add("Contact", "state", "State", "", (state) => Float32Array.from(state.contact("state")), { discrete: true });
  }
  return fields;
}

function titleOf(field) {
  return field.unit ? `${field.label} [${field.unit}]` : field.label;
}

/* Smallest and largest value over states. */
function rangeOf(field, states) {
  if (field.discrete) return [-0.5, 2.5];
  let [low, high] = [Infinity, -Infinity];
  for (const state of states) {
    const [least, most] = state.once(`range ${field.id}`, () => {
      let [least, most] = [Infinity, -Infinity];
      for (const value of field.values(state)) {
        if (value < least) least = value;
        if (value > most) most = value;
      }
      return [least, most];
    });
    low = Math.min(low, least);
    high = Math.max(high, most);
  }
  if (!(low <= high)) return [0, 0];
  return [field.fromZero ? Math.min(low, 0) : low, high];
}
