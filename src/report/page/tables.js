/* Below the picture: the profile, and the tables. */

Object.assign(Viewer.prototype, {
  makeTabs() {
    const tabs = [["profile", "Profile"], ["totals", "Totals"], ["certificate", "Certificate"]];
    if (!this.model.contacts.count) tabs.shift();
    if (this.states.length > 1) tabs.push(["steps", "Steps"]);
    if (this.states.some((state) => state.stored.notes.length)) tabs.push(["notes", "Notes"]);
    if (!tabs.some(([id]) => id === this.wish.tab)) this.wish.tab = tabs[0][0];
    for (const [id, word] of tabs) {
      const tab = make("button", word, { type: "button", id: `tab-${id}` });
      tab.setAttribute("role", "tab");
      tab.setAttribute("aria-controls", `panel-${id}`);
      tab.addEventListener("click", () => {
        this.wish.tab = id;
        this.showTab();
      });
      $("tabs").append(tab);
      const panel = make("div", "", { id: `panel-${id}`, tabIndex: 0 });
      panel.setAttribute("role", "tabpanel");
      panel.setAttribute("aria-labelledby", tab.id);
      $("panels").append(panel);
    }
    $("tabs").addEventListener("keydown", (event) => {
      const by = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      if (!by) return;
      const all = [...$("tabs").children];
      const next = all[(all.indexOf(document.activeElement) + by + all.length) % all.length];
      next.focus();
      next.click();
    });
    if ($("panel-profile")) this.makeProfile($("panel-profile"));
  },

  makeProfile(panel) {
    panel.className = "plot";
    const row = make("div", "", { className: "row" });
    const choice = (words, options, wish) => {
      const label = make("label", words);
      const select = make("select");
      select.setAttribute("aria-label", `Profile: ${words}`);
      select.id = `profile-${wish}`;
      label.htmlFor = select.id;
      select.append(...options.map(({ id, label: word }) => make("option", word, { value: id })));
      select.value = this.wish[wish];
      select.addEventListener("change", () => {
        this.wish[wish] = select.value;
        this.showTab();
      });
      row.append(label, select);
    };
    choice("Value", this.fields.filter((field) => field.contact), "profile");
    choice("along", Chart.abscissas(this.model), "along");
    if (this.model.dimension === 3) {
      const label = make("label", "", { className: "check" });
      const box = make("input", "", { type: "checkbox", checked: this.wish.line, id: "profile-line" });
      box.addEventListener("change", () => {
        this.wish.line = box.checked;
        this.showTab();
      });
      label.append(box, "on a line through the highest");
      row.append(label);
    }
    const space = make("div", "", { className: "space" });
    const canvas = make("canvas", "", { id: "chart" });
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", "A contact field along the contact");
    space.append(canvas);
    panel.append(row, space);
    this.chart = new Chart(canvas, this.model);
    canvas.addEventListener("pointermove", (event) => {
      const found = this.chart.nearest(event.offsetX, event.offsetY);
      const [x, y] = found ? this.placeOf(found.contact) : [0, 0];
      this.showTip(found && { contact: found.contact }, x, y);
    });
    canvas.addEventListener("pointerleave", () => this.showTip(null));
  },

  showTab() {
    const { tab } = this.wish;
    for (const button of $("tabs").children) {
      const own = button.id === `tab-${tab}`;
      button.setAttribute("aria-selected", own);
      button.tabIndex = own ? 0 : -1;
      $(button.getAttribute("aria-controls")).hidden = !own;
    }
    const { stored } = this.state;
    if (tab === "profile") this.showProfile();
    if (tab === "totals") this.fill("totals", "columns", table(stored.totals.map((row) => [row.name, row.value]), null, [1]));
    if (tab === "certificate") {
      const words = stored.words.map((sentence) => make("p", sentence.replace(/e-(\d)/g, "e−$1")));
      const laws = stored.laws.map((law) => [law.law, law.size, law.scaled, law.place]);
      this.fill("certificate", "", ...words, table(laws, ["what must hold", "worst violation", "relative", "where"], [1, 2]));
    }
    if (tab === "notes") this.fill("notes", "", ...stored.notes.map((note) => make("p", note)));
    if (tab === "steps") this.showSteps();
  },

  fill(id, className, ...content) {
    const panel = $(`panel-${id}`);
    panel.className = className;
    panel.replaceChildren(...content);
  },

  showProfile() {
    const field = this.fields.find((one) => one.id === this.wish.profile) || this.fields.find((one) => one.contact);
    const abscissas = Chart.abscissas(this.model);
    const along = abscissas.find((one) => one.id === this.wish.along) || abscissas[0];
    const line = this.wish.line && this.model.dimension === 3 && along.axis !== undefined;
    $("profile-profile").value = field.id;
    $("profile-along").value = along.id;
    this.chart.show(field, this.state, along, line);
  },

  /* Totals step by step; a row leads to its step. */
  showSteps() {
    const names = ["stick / slip / open", "normal force", "friction force", "peak pressure", "largest displacement", "largest von Mises stress", "dissipated by friction"];
    const value = (state, name) => (state.stored.totals.find((row) => row.name === name) || { value: "–" }).value;
    const rows = this.states.map(({ stored }, k) => [
      String(stored.step), shortNumber(stored.at), stored.status.replaceAll("_", " "), ...names.map((name) => value(this.states[k], name)),
    ]);
    const made = table(rows, ["step", "at", "status", ...names], [0, 1, 3, 4, 5, 6, 7, 8, 9]);
    [...made.rows].slice(1).forEach((row, k) => {
      row.tabIndex = 0;
      row.className = k === this.wish.step ? "current" : "";
      row.addEventListener("click", () => this.goTo(k));
      row.addEventListener("keydown", (event) => event.key === "Enter" && this.goTo(k));
    });
    this.fill("steps", "", made);
  },
});

document.addEventListener("DOMContentLoaded", () => {
  const { model, states } = readPage();
  window.viewer = new Viewer(model, states);
  window.viewer.start();
});
