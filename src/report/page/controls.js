/* Menus, sliders, mouse and keys. */

Object.assign(Viewer.prototype, {
  start() {
    this.fillMenus();
    this.listen();
    this.listenToMouse();
    this.overlay.addEventListener("keydown", (event) => this.key(event));
    this.makeTabs();
    this.show();
    new ResizeObserver(() => {
      this.draw();
      if (this.chart) this.chart.draw();
    }).observe($("view"));
    $("hint").textContent = this.model.dimension === 3
      ? "drag: turn · shift or right drag: move · wheel: zoom" : "drag: move · wheel: zoom";
    this.draw();
    document.documentElement.dataset.drawn = performance.now().toFixed(0);
    document.documentElement.dataset.states = this.states.length;
  },

  fillMenus() {
    const { model } = this;
    const groups = new Map();
    for (const field of this.fields) {
      if (!groups.has(field.group)) groups.set(field.group, make("optgroup", "", { label: field.group }));
      groups.get(field.group).append(make("option", field.label, { value: field.id }));
    }
    $("field").append(...groups.values());
    $("map").append(...Object.keys(MAPS).map((name) => make("option", name, { value: name })));
    $("units").textContent = model.units ? `units: ${model.units}` : "units: those of the scene";
    $("of-steps").hidden = this.states.length < 2;
    $("step").max = this.states.length - 1;
    if (this.states.length < 2) $("range").querySelector('[value="all"]').remove();
    const plane = model.dimension === 2;
    $("of-diagram").hidden = !plane || !model.contacts.count;
    $("directions").hidden = $("of-section").hidden = plane;
    $("directions").append(...Object.keys(DIRECTIONS).map((name) => make("button", name, { type: "button", value: name })));
    $("section").append(...["x", "y", "z"].map((axis) => make("option", `across ${axis}`, { value: axis })));
    for (const body of model.bodies) {
      const box = make("input", "", { type: "checkbox", checked: !this.wish.hidden.has(body.name), value: body.name });
      const label = make("label");
      label.append(box, body.name, make("small", `${body.triangles.length / 3} facets`));
      $("bodies").append(label);
    }
  },

  /* Brings controls, picture and tables up to the wishes. */
  show() {
    const { wish, state } = this;
    for (const id of ["field", "map", "range", "edges", "section"]) $(id).value = wish[id];
    for (const id of ["bands", "undeformed", "diagram"]) $(id).checked = wish[id];
    $("section-flip").checked = wish.flip;
    $("section-at").value = 1000 * wish.at;
    $("of-section-at").hidden = !wish.section;
    $("section-flip").disabled = !wish.section;
    $("section-words").textContent = wish.section && `${wish.section} = ${shortNumber(this.sectionAt())}`;
    $("step").value = wish.step;
    $("step-words").textContent = state.label;
    $("scale-number").value = String(Number(wish.scale.toPrecision(3)));
    $("scale").value = this.sliderOf(wish.scale);
    const fixed = this.field.discrete || wish.range !== "given";
    const [low, high] = this.range();
    for (const [id, value] of [["low", low], ["high", high]]) {
      $(id).disabled = fixed;
      if (document.activeElement !== $(id)) $(id).value = this.field.discrete ? "" : Number(value.toPrecision(4));
    }
    const good = state.stored.status === "certified";
    $("status").className = good ? "good" : "bad";
    $("status").textContent = state.stored.status.replaceAll("_", " ");
    this.showTip(null);
    this.showTab();
    this.refresh(true);
  },

  /* The slider goes by the cube, so that both small and large factors can be set. */
  sliderOf(scale) {
    const most = Math.max(4 * this.auto, 10);
    return 100 * Math.cbrt(Math.max(0, Math.min(1, scale / most)));
  },

  listen() {
    const { wish } = this;
    const on = (id, kind, act) => $(id).addEventListener(kind, (event) => {
      act(event.target);
      this.show();
    });
    for (const id of ["field", "map", "edges", "section"]) on(id, "change", (target) => (wish[id] = target.value));
    for (const id of ["bands", "undeformed", "diagram"]) on(id, "change", (target) => (wish[id] = target.checked));
    on("range", "change", (target) => {
      [wish.low, wish.high] = this.range();
      wish.range = target.value;
    });
    for (const id of ["low", "high"]) {
      on(id, "change", (target) => {
        if (target.value.trim() !== "" && Number.isFinite(Number(target.value))) wish[id] = Number(target.value);
      });
    }
    on("section-flip", "change", (target) => (wish.flip = target.checked));
    on("section-at", "input", (target) => (wish.at = target.value / 1000));
    on("step", "input", (target) => (wish.step = Number(target.value)));
    on("scale", "input", (target) => (wish.scale = Math.max(4 * this.auto, 10) * (target.value / 100) ** 3));
    on("scale-number", "change", (target) => {
      const value = Number(target.value);
      if (target.value.trim() !== "" && Number.isFinite(value)) wish.scale = value;
    });
    $("controls").addEventListener("submit", (event) => event.preventDefault());
    $("controls").addEventListener("click", ({ target }) => {
      if (target.dataset.scale) {
        wish.scale = target.dataset.scale === "auto" ? this.auto : Number(target.dataset.scale);
        this.show();
      } else if (DIRECTIONS[target.value]) {
        this.camera.look(...DIRECTIONS[target.value]);
        this.fit();
      }
    });
    on("bodies", "change", (box) => (box.checked ? wish.hidden.delete(box.value) : wish.hidden.add(box.value)));
    $("fit").addEventListener("click", () => this.fit());
    $("play").addEventListener("click", () => this.play());
    window.addEventListener("hashchange", () => {
      this.readAddress();
      this.show();
    });
  },

  play() {
    clearInterval(this.playing);
    if (this.playing) {
      this.playing = 0;
    } else {
      this.playing = setInterval(() => this.goTo((this.wish.step + 1) % this.states.length), 500);
    }
    $("play").textContent = this.playing ? "❚❚" : "▶";
  },

  goTo(step) {
    this.wish.step = Math.max(0, Math.min(this.states.length - 1, step));
    this.show();
  },

  listenToMouse() {
    const { overlay, camera } = this;
    const fingers = new Map();
    overlay.addEventListener("contextmenu", (event) => event.preventDefault());
    overlay.addEventListener("pointerdown", (event) => {
      overlay.setPointerCapture(event.pointerId);
      fingers.set(event.pointerId, [event.offsetX, event.offsetY]);
      this.showTip(null);
    });
    const lift = (event) => fingers.delete(event.pointerId);
    overlay.addEventListener("pointerup", lift);
    overlay.addEventListener("pointercancel", lift);
    overlay.addEventListener("pointerleave", () => this.showTip(null));
    overlay.addEventListener("pointermove", (event) => {
      const now = [event.offsetX, event.offsetY];
      const before = fingers.get(event.pointerId);
      if (!before) {
        this.hover(...now);
        return;
      }
      const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
      const others = [...fingers].filter(([id]) => id !== event.pointerId).map(([, place]) => place);
      fingers.set(event.pointerId, now);
      if (others.length) {
        const spread = (place) => Math.hypot(place[0] - others[0][0], place[1] - others[0][1]) || 1;
        camera.move(dx / 2, dy / 2);
        camera.zoom(spread(now) / spread(before), ...others[0]);
      } else if (camera.plane || event.shiftKey || event.buttons !== 1) {
        camera.move(dx, dy);
      } else {
        camera.look(camera.turn - 0.008 * dx, camera.tilt + 0.008 * dy);
      }
      this.refresh();
    });
    overlay.addEventListener("wheel", (event) => {
      event.preventDefault();
      camera.zoom(Math.exp(-0.0012 * event.deltaY), event.offsetX, event.offsetY);
      this.refresh();
    }, { passive: false });
    overlay.addEventListener("dblclick", () => this.fit());
  },

  /* At most once per frame. */
  hover(x, y) {
    this.pointer = [x, y];
    if (this.hovering) return;
    this.hovering = requestAnimationFrame(() => {
      this.hovering = 0;
      this.showTip(this.pick(...this.pointer), ...this.pointer);
    });
  },

  key(event) {
    const { camera } = this;
    const turn = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (turn && (camera.plane || event.shiftKey)) camera.move(30 * turn[0], 30 * turn[1]);
    else if (turn) camera.look(camera.turn - 0.1 * turn[0], camera.tilt - 0.1 * turn[1]);
    else if (event.key === "+" || event.key === "=") camera.zoom(1.2);
    else if (event.key === "-") camera.zoom(1 / 1.2);
    else if (event.key === "0") this.fit();
    else if (event.key === "]") this.goTo(this.wish.step + 1);
    else if (event.key === "[") this.goTo(this.wish.step - 1);
    else if (event.key === " " && this.states.length > 1) this.play();
    else return;
    event.preventDefault();
    this.refresh();
  },
});
