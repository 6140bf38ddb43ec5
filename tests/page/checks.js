/* Looks at a page that was drawn, works its menus and keys, and says in it what held and what did not. */

const found = { passed: 0, failed: [] };

function check(holds, words) {
  if (holds) found.passed += 1;
  else found.failed.push(words);
}

const close = (a, b) => Math.abs(a - b) <= 1e-5 * Math.max(1, Math.abs(a), Math.abs(b));

/* A pixel of the drawing: red, green, blue, alpha; from the top left. */
function pixel(viewer, x, y) {
  const canvas = viewer.drawing;
  const [px, py] = [x, y].map((at, k) => Math.round((at * [canvas.width, canvas.height][k]) / viewer.camera.size[k]));
  if (viewer.renderer.name === "canvas") return [...viewer.renderer.context.getImageData(px, py, 1, 1).data];
  const gl = viewer.renderer.gl;
  const bytes = new Uint8Array(4);
  gl.readPixels(px, canvas.height - 1 - py, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
  return [...bytes];
}

/* Works a control as a person does. */
function set(id, value) {
  const control = $(id);
  if (control.type === "checkbox") control.checked = value;
  else control.value = value;
  control.dispatchEvent(new Event(control.type === "range" ? "input" : "change", { bubbles: true }));
  window.viewer.draw();
}

function press(key) {
  $("overlay").dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
  window.viewer.draw();
}

/* Whether a colour is that of a value between the ends of the range. */
function coloured(viewer, [r, g, b], value, range) {
  const i = 3 * Math.round(255 * Math.max(0, Math.min(1, (value - range[0]) / (range[1] - range[0]))));
  const wanted = [...viewer.colours.slice(i, i + 3)];
  return [r, g, b].every((x, k) => Math.abs(x - wanted[k]) < 26);
}

function checkFields(viewer) {
  const menu = [...$("field").options].map((option) => option.value);
  check(JSON.stringify(menu) === JSON.stringify(EXPECTED.fields), `menu: ${menu}`);
  check(menu.every((id) => viewer.fields.some((field) => field.id === id)), "every entry of the menu is a field");
  for (const id of menu) {
    set("field", id);
    check(viewer.field.id === id, `${id} is shown`);
    check([...viewer.field.values(viewer.state)].some(Number.isFinite) || id === "friction_used", `${id} has values`);
    const wanted = EXPECTED.values[id];
    if (wanted !== undefined) {
      const values = [...viewer.field.values(viewer.state)];
      check(values.every((value) => close(value, wanted)), `${id}: ${values.slice(0, 4)} for ${wanted}`);
    }
  }
}

/* The colours of a field that runs from one end of the upright axis to the other. */
function checkGradient(viewer) {
  const { field, range } = EXPECTED.gradient;
  set("field", field);
  set("edges", "none");
  set("scale-number", "0");
  if (EXPECTED.plane) set("diagram", false);
  else viewer.camera.look(...DIRECTIONS["−y"]);
  viewer.fit();
  viewer.draw();
  check(viewer.range().every((end, k) => close(end, range[k])), `range ${viewer.range()}`);
  const up = EXPECTED.plane ? 1 : 2;
  const { low, high } = viewer.model.box;
  for (const part of [0.02, 0.25, 0.5, 0.75, 0.98]) {
    const at = [0, 1, 2].map((k) => (k === up ? low[k] + part * (high[k] - low[k]) : 0.3));
    const [x, y] = viewer.camera.place(at);
    const seen = pixel(viewer, x, y);
    check(seen[3] === 255 && coloured(viewer, seen, range[1] + part * (range[0] - range[1]), range), `${viewer.renderer.name}: ${seen} at ${part}`);
    const picked = viewer.pick(x, y);
    check(picked && picked.body.name === viewer.model.bodies[0].name, `a body under the mouse at ${part}`);
    const value = picked.points.reduce((sum, point, k) => sum + picked.shares[k] * viewer.field.values(viewer.state)[point], 0);
    check(Math.abs(value - part * range[0]) < 0.01 * Math.abs(range[0]), `value under the mouse: ${value} at ${part}`);
    viewer.showTip(picked, x, y);
    check(!$("tip").hidden && $("tip").textContent.includes(viewer.model.bodies[0].name), "the tip says where");
  }
  check(pixel(viewer, 3, 3)[3] === 0, "beside the bodies there is nothing");
  check(viewer.pick(3, 3) === null, "nor under the mouse");
  viewer.showTip(null);
}

/* Number of drawn pixels on a coarse raster. */
function covered(viewer) {
  let count = 0;
  for (let x = 5; x < viewer.camera.size[0]; x += 12) {
    for (let y = 5; y < viewer.camera.size[1]; y += 12) count += pixel(viewer, x, y)[3] > 200 ? 1 : 0;
  }
  return count;
}

function checkControls(viewer) {
  set("field", "von_mises");
  const all = covered(viewer);
  check(all > 50, `bodies cover ${all} places`);
  const box = $("bodies").querySelector("input");
  box.checked = false;
  box.dispatchEvent(new Event("change", { bubbles: true }));
  viewer.draw();
  check(viewer.pick(...viewer.camera.place([0, 0, 0])) === null, "a hidden body is not under the mouse");
  const rest = covered(viewer);
  check(rest < 0.6 * all, `hidden: ${rest} of ${all}`);
  box.checked = true;
  box.dispatchEvent(new Event("change", { bubbles: true }));
  viewer.draw();
  if (!EXPECTED.plane) {
    viewer.camera.look(...DIRECTIONS["−y"]);
    viewer.fit();
    set("section", "z");
    set("section-at", 500);
    const half = covered(viewer);
    set("section", "");
    const whole = covered(viewer);
    check(half < 0.75 * whole && half > 0.2 * whole, `section: ${half} of ${whole}`);
  }
  const scale = viewer.camera.scale;
  press("+");
  check(viewer.camera.scale > scale, "plus zooms in");
  const seen = EXPECTED.plane ? viewer.camera.centre[0] : viewer.camera.turn;
  press("ArrowLeft");
  check((EXPECTED.plane ? viewer.camera.centre[0] : viewer.camera.turn) !== seen, "an arrow moves or turns");
  press("0");
  check(Math.abs(viewer.camera.scale / scale - 1) < 0.6, "0 fits in");
  for (const tab of $("tabs").children) {
    tab.click();
    const panel = $(tab.getAttribute("aria-controls"));
    check(!panel.hidden && (panel.textContent.length > 20 || tab.id === "tab-notes"), `${tab.textContent} is shown`);
  }
  $("tab-certificate").click();
  check($("panel-certificate").textContent.includes("Bodies do not penetrate"), "the certificate is in words");
  $("tab-profile").click();
  check(viewer.chart.points.length > 0, "the profile has points");
  check(viewer.chart.points.every((point) => close(point.y, EXPECTED.values.pressure)), "the profile shows the pressure");
  check($("status").textContent === "certified", "the status is shown");
}

function checkSteps(viewer) {
  check(viewer.states.length === EXPECTED.states, `${viewer.states.length} states`);
  check($("of-steps").hidden === (EXPECTED.states === 1), "a slider where there are steps");
  if (EXPECTED.states === 1) return;
  const largest = () => rangeOf(viewer.field, [viewer.state])[1];
  set("field", "von_mises");
  const last = largest();
  set("step", 0);
  check(close(largest(), last / 2), `half the stress in the first step: ${largest()} of ${last}`);
  check(close(viewer.range()[1], last), "the range is that of all steps");
  set("range", "step");
  check(close(viewer.range()[1], last / 2), "or of the step");
  set("range", "given");
  set("high", "42");
  check(viewer.range()[1] === 42, "or given");
  set("range", "all");
  press("]");
  check(viewer.wish.step === 1, "a key goes to the next step");
  $("tab-steps").click();
  const rows = $("panel-steps").querySelectorAll("tr");
  check(rows.length === EXPECTED.states + 1, "a row per step");
  rows[1].click();
  check(viewer.wish.step === 0, "a row leads to its step");
  set("step", EXPECTED.states - 1);
}

function speed(viewer) {
  found.drawn = Number(document.documentElement.dataset.drawn);
  found.triangles = viewer.model.bodies.reduce((sum, body) => sum + body.triangles.length / 3, 0);
  const time = (count, act) => {
    const start = performance.now();
    for (let k = 0; k < count; k++) act(k);
    return (performance.now() - start) / count;
  };
  const turn = () => {
    viewer.camera.look(viewer.camera.turn + 0.05, viewer.camera.tilt);
    viewer.draw();
    pixel(viewer, 300, 300);
  };
  turn();
  found.renderer = viewer.renderer.name;
  found.frame = time(20, turn);
  found.pick = time(5, () => viewer.pick(400, 250));
}

/* A canvas in place of one whose context is another's. */
function freshCanvas() {
  const canvas = document.createElement("canvas");
  canvas.id = "drawing";
  $("drawing").replaceWith(canvas);
  return canvas;
}

document.addEventListener("DOMContentLoaded", () => {
  const viewer = window.viewer;
  try {
    if (EXPECTED.speed) {
      speed(viewer);
    } else {
      for (const make of [(canvas) => WebglRenderer.on(canvas, true), (canvas) => new RasterRenderer(canvas)]) {
        viewer.drawing = freshCanvas();
        viewer.renderer = make(viewer.drawing);
        viewer.draw();
        checkFields(viewer);
        checkGradient(viewer);
        checkControls(viewer);
        checkSteps(viewer);
      }
    }
  } catch (error) {
    found.failed.push(String(error.stack));
  }
  const words = document.createElement("pre");
  words.id = "checks";
  words.textContent = JSON.stringify(found);
  document.body.append(words);
});
