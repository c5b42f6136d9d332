"use strict";
/* Tracks and time histories to move about in. A payload is what motions.py packed. */
const Motions = (() => {
  const root = document.documentElement;
  const make = (tag, properties = {}, ...children) => {
    const element = document.createElement(tag);
    for (const [key, value] of Object.entries(properties)) {
      if (key in element && key !== "list" && key !== "form") element[key] = value;
      else element.setAttribute(key, value);
    }
    element.append(...children);
    return element;
  };

  function decoded(column) {
    if (!("d" in column)) return Float64Array.from({ length: column.n }, (_, k) => column.o + k * column.s);
    const text = atob(column.d), found = new Float64Array(text.length / 2);
    for (let k = 0; k < found.length; k++) {
      const code = text.charCodeAt(2 * k) + 256 * text.charCodeAt(2 * k + 1);
      found[k] = code === 65535 ? NaN : column.o + code * column.s;
    }
    return found;
  }

  const motionOf = (columns) => Object.fromEntries(Object.entries(columns).map(([name, column]) => [name, decoded(column)]));

  /* Index of the last sample at or before a time. */
  function before(t, at) {
    let low = 0, high = t.length - 1;
    while (low < high) { const middle = (low + high + 1) >> 1; if (t[middle] <= at) low = middle; else high = middle - 1; }
    return low;
  }

  function valueAt(motion, name, at) {
    const { t } = motion, values = motion[name];
    if (!values || !t.length || at < t[0] - 1e-9 || at > t[t.length - 1] + 1e-9) return NaN;
    const k = before(t, at);
    if (k === t.length - 1 || t[k + 1] === t[k]) return values[k];
    const share = (at - t[k]) / (t[k + 1] - t[k]);
    return values[k] + share * (values[k + 1] - values[k]);
  }

  /* Round numbers from low to high, and with how many decimals they are written. */
  function rounded(low, high, most) {
    const raw = (high - low) / Math.max(most, 1), power = 10 ** Math.floor(Math.log10(raw));
    const step = power * ([1, 2, 2.5, 5, 10].find((factor) => factor * power >= raw * (1 - 1e-9)) || 10);
    const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9) + (Math.abs(step / power - 2.5) < 1e-6 ? 1 : 0));
    const places = [];
    for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) places.push(k * step);
    return { places, text: (value) => words(value, decimals) };
  }

  function words(value, decimals) {
    if (!Number.isFinite(value)) return "–";
    const text = value.toFixed(decimals);
    return (Number(text) === 0 ? text.replace("-", "") : text).replace("-", "−");
  }

  const decimalsOf = (channel) => ({ "m/s": 2, "deg": 1, "deg/s": 3, "rpm": 1 })[channel.unit] ?? 1;

  class Viewer {
    constructor(holder, plan) {
      this.holder = holder;
      this.plan = plan;
      this.shown = new Set(plan.runs.map((run) => run.key));
      this.range = null;
      this.frame = null;
      this.differences = false;
      this.build();
      this.choose(Number(holder.dataset.selected) || 0);
      new ResizeObserver(() => this.soon()).observe(holder);
      new ResizeObserver(() => {
        const more = this.beside.scrollWidth > this.beside.clientWidth + 2;
        this.beside.classList.toggle("more", more);
        if (more) this.beside.tabIndex = 0; else this.beside.removeAttribute("tabindex");
      }).observe(this.readout);
      for (const query of ["(prefers-color-scheme: dark)", "(max-width: 760px)"]) {
        matchMedia(query).addEventListener("change", () => this.soon());
      }
    }

    build() {
      const { plan } = this;
      this.select = make("select", { onchange: () => this.choose(this.select.selectedIndex) },
        ...plan.names.map((name) => make("option", { textContent: name })));
      const step = (by) => () => {
        this.select.selectedIndex = (this.select.selectedIndex + by + plan.names.length) % plan.names.length;
        this.choose(this.select.selectedIndex);
      };
      const bar = make("div", { className: "bar" });
      if (plan.names.length > 1) {
        bar.append(make("label", { className: "pick" }, "Manoeuvre ", this.select),
          make("span", { className: "group" },
            make("button", { type: "button", textContent: "‹", ariaLabel: "Manoeuvre before", onclick: step(-1) }),
            make("button", { type: "button", textContent: "›", ariaLabel: "Next manoeuvre", onclick: step(1) })));
      }
      this.toggles = make("fieldset", { className: "group", ariaLabel: "What is drawn" });
      bar.append(this.toggles);
      if (plan.L) {
        this.outlines = make("select", { className: "outlines", onchange: () => this.draw() },
          ...[["auto", "often enough"], ["1", "every length"], ["2", "every 2 lengths"], ["5", "every 5 lengths"], ["10", "every 10 lengths"], ["0", "none"]]
            .map(([value, text]) => make("option", { value, textContent: text })));
        bar.append(make("label", {}, "Ships ", this.outlines));
      }
      /* Of the whole manoeuvre, whatever is shown of it. */
      bar.append(make("button", { type: "button", className: "save", textContent: "Save as CSV", onclick: () => this.save() }));
      this.canvas = make("canvas", { ariaHidden: "true" });
      this.tip = make("div", { className: "tip", hidden: true });
      const button = (text, label, act) => make("button", { type: "button", textContent: text, ariaLabel: label, title: label, onclick: act });
      this.track = make("div", { className: "track", tabIndex: 0, role: "group",
        ariaLabel: "Track, north up. Plus and minus zoom, arrow keys move, 0 shows all." }, this.canvas,
        make("div", { className: "zoom" }, button("+", "Zoom in", () => this.zoom(1.5)),
          button("−", "Zoom out", () => this.zoom(1 / 1.5)), button("Whole", "Show the whole track", () => this.whole())), this.tip);
      this.readout = make("table", { className: "readout" });
      this.beside = make("div", { className: "readout-holder" }, this.readout);
      this.side = make("div", { className: "side" }, this.beside);
      this.slider = make("input", { type: "range", min: 0, max: 1000, step: 1, value: 0, oninput: () => this.at(this.fromSlider()) });
      this.clock = make("output");
      this.time = make("div", { className: "time" }, make("label", { textContent: "Time", htmlFor: "" }), this.slider, this.clock);
      this.slider.id = `${this.holder.parentElement.id}-time`;
      this.time.firstChild.htmlFor = this.slider.id;
      this.from = make("input", { type: "number", step: "any", className: "from", inputMode: "decimal", onchange: () => this.typed() });
      this.to = make("input", { type: "number", step: "any", className: "to", inputMode: "decimal", onchange: () => this.typed() });
      this.difference = make("input", { type: "checkbox", className: "differences", onchange: () => { this.differences = this.difference.checked; this.panels(); } });
      /* Of all histories: above the first of them. */
      this.ruling = make("div", { className: "bar ruling", role: "group", ariaLabel: "All histories" }, make("label", {}, "Histories from ", this.from, " s"), make("label", {}, "to ", this.to, " s"),
        make("button", { type: "button", className: "all", textContent: "Whole time", onclick: () => this.rescale(null) }));
      if (plan.runs.some((run) => run.truth) && plan.runs.length > 1) this.ruling.append(make("label", {}, this.difference, " simulated minus measured"));
      this.grid = make("div", { className: "grid" });
      this.few = make("div");
      this.side.append(this.ruling, this.few);
      this.note = make("p", { className: "hint note" });
      this.holder.append(bar, make("div", { className: "stage" }, make("div", { className: "left" }, this.track, this.time), this.side), this.note,
        make("p", { className: "hint wide", textContent: "Point at a track or a history for the state there. Drag a track to move it, Ctrl and wheel or the buttons zoom; drag across a history to see that time alone." }),
        this.grid);
      this.listen();
    }

    choose(index) {
      this.index = index;
      this.select.selectedIndex = index;
      const found = this.plan.manoeuvres[index];
      this.motions = Object.fromEntries(Object.entries(found.runs).map(([key, columns]) => [key, motionOf(columns)]));
      this.regions = found.regions;
      this.runs = this.plan.runs.filter((run) => run.key in this.motions);
      this.truth = this.runs.find((run) => run.truth);
      const times = this.runs.flatMap((run) => { const { t } = this.motions[run.key]; return [t[0], t[t.length - 1]]; }).filter(Number.isFinite);
      this.span = times.length ? [Math.min(...times), Math.max(...times)] : [0, 1];
      if (this.span[1] <= this.span[0]) this.span[1] = this.span[0] + 1;
      this.range = null;
      this.frame = null;
      this.note.textContent = found.note || "";
      this.note.hidden = !found.note;
      this.now = this.span[0] + 0.4 * (this.span[1] - this.span[0]);
      for (const run of this.runs) this.measure(this.motions[run.key]);
      this.legend();
      this.panels();
    }

    /* Speed, drift and the way made good along a motion. */
    measure(motion) {
      const { t, x, y, u, v_m } = motion;
      motion.way = new Float64Array(t.length);
      for (let k = 1; k < t.length; k++) {
        const step = Math.hypot(x[k] - x[k - 1], y[k] - y[k - 1]);
        motion.way[k] = motion.way[k - 1] + (Number.isFinite(step) ? step : 0);
      }
      if (u && v_m) motion.speed = u.map((value, k) => Math.hypot(value, v_m[k]));
    }

    legend() {
      this.toggles.replaceChildren(...this.runs.map((run) => {
        const box = make("input", { type: "checkbox", checked: this.shown.has(run.key), onchange: () => {
          if (box.checked) this.shown.add(run.key); else this.shown.delete(run.key);
          this.draw();
        } });
        const swatch = make("canvas", { className: "swatch", width: 60, height: 24, ariaHidden: "true" });
        swatch.dataset.run = run.key;
        return make("label", {}, box, swatch, run.words);
      }));
    }

    panels() {
      const own = (channel) => this.runs.some((run) => channel.name in this.motions[run.key]);
      const channels = this.plan.channels.filter(own);
      const panel = (channel, holder, difference) => {
        const canvas = make("canvas", { ariaHidden: "true" });
        const title = difference ? `${channel.words}, simulated − measured [${channel.unit}]` : `${channel.words} [${channel.unit}]`;
        const box = make("div", { className: "small" }, make("h3", { textContent: title, title }), canvas);
        holder.append(box);
        const made = { channel, canvas, box, difference };
        this.pointing(made);
        return made;
      };
      this.few.replaceChildren();
      this.grid.replaceChildren();
      const driven = channels.filter((channel) => channel.group !== "state");
      const states = channels.filter((channel) => channel.group === "state");
      const beside = new Set([...driven, ...states].slice(0, Math.max(5 - Math.floor(this.runs.length / 4), 3)));
      this.drawn = driven.map((channel) => panel(channel, beside.has(channel) ? this.few : this.grid, false));
      if (this.truth && this.runs.length > 1) {
        this.drawn.push(panel({ name: "off", words: "distance off the measured track", unit: "m", group: "off" }, this.grid, false));
      }
      for (const channel of states) this.drawn.push(panel(channel, beside.has(channel) ? this.few : this.grid, this.differences));
      this.draw();
    }

    color(name) { return getComputedStyle(document.body).getPropertyValue("--" + name).trim() || "#000"; }

    soon() {
      if (this.waiting) return;
      this.waiting = requestAnimationFrame(() => { this.waiting = 0; this.draw(); });
    }

    prepared(canvas) {
      const ratio = devicePixelRatio || 1, { clientWidth: width, clientHeight: height } = canvas;
      if (canvas.width !== Math.round(width * ratio)) canvas.width = Math.round(width * ratio);
      if (canvas.height !== Math.round(height * ratio)) canvas.height = Math.round(height * ratio);
      const pen = canvas.getContext("2d");
      pen.setTransform(ratio, 0, 0, ratio, 0, 0);
      pen.clearRect(0, 0, width, height);
      pen.font = "12px system-ui, sans-serif";
      pen.lineJoin = "round";
      return { pen, width, height };
    }

    visible() { return this.runs.filter((run) => this.shown.has(run.key)); }

    draw() {
      const names = ["ink", "muted", "grid", "paper", "raised", "before", "after", "flag", "third", "good", "box"];
      this.paint = Object.fromEntries(names.map((name) => [name, this.color(name)]));
      for (const swatch of this.toggles.querySelectorAll("canvas")) {
        const run = this.runs.find((one) => one.key === swatch.dataset.run), pen = swatch.getContext("2d");
        pen.setTransform(2, 0, 0, 2, 0, 0);
        pen.clearRect(0, 0, 30, 12);
        this.stroke(pen, run, 2);
        pen.beginPath(); pen.moveTo(0, 6); pen.lineTo(30, 6); pen.stroke();
      }
      this.drawTrack();
      for (const panel of this.drawn) this.drawPanel(panel);
      this.read();
      root.dataset.ready = "1";
    }

    stroke(pen, run, width) {
      pen.strokeStyle = this.paint[run.color];
      pen.fillStyle = this.paint[run.color];
      pen.lineWidth = width;
      pen.setLineDash(run.dash ? run.dash.split(" ").map(Number) : []);
    }

    /* Pixels at the top that the buttons over the track take, where it would run below them. */
    get above() { return 36; }

    /* What of the water is seen: middle and metres to a pixel. */
    view(width, height) {
      if (this.frame) return this.frame;
      let west = Infinity, east = -Infinity, south = Infinity, north = -Infinity;
      for (const run of this.visible()) {
        const { x, y } = this.motions[run.key];
        for (let k = 0; k < x.length; k++) {
          if (!Number.isFinite(x[k]) || !Number.isFinite(y[k])) continue;
          south = Math.min(south, x[k]); north = Math.max(north, x[k]); west = Math.min(west, y[k]); east = Math.max(east, y[k]);
        }
      }
      if (!Number.isFinite(west)) [west, east, south, north] = [0, 1, 0, 1];
      const room = 1.12 * Math.max((east - west) / (width - 60), (north - south) / (height - 46 - this.above), (this.plan.L || 0) / 150, 1e-6);
      return { x: 0.5 * (south + north), y: 0.5 * (west + east), scale: room };
    }

    places(width, height) {
      const view = this.view(width, height), midX = 30 + width / 2, midY = (height - 22 + this.above) / 2;
      return {
        view,
        across: (east) => midX + (east - view.y) / view.scale,
        up: (north) => midY - (north - view.x) / view.scale,
        east: (px) => view.y + (px - midX) * view.scale,
        north: (py) => view.x - (py - midY) * view.scale,
      };
    }

    drawTrack() {
      const { pen, width, height } = this.prepared(this.canvas), place = this.places(width, height);
      this.place = place;
      const east = rounded(place.east(52), place.east(width), width / 90), north = rounded(place.north(height - 22), place.north(0), height / 70);
      pen.strokeStyle = this.paint.grid; pen.lineWidth = 1; pen.fillStyle = this.paint.muted;
      pen.textAlign = "center";
      for (const at of east.places) {
        const px = place.across(at);
        pen.beginPath(); pen.moveTo(px, 0); pen.lineTo(px, height - 20); pen.stroke();
        if (px > 70 && px < width - 20) pen.fillText(east.text(at), px, height - 6);
      }
      pen.textAlign = "right";
      for (const at of north.places) {
        const py = place.up(at);
        pen.beginPath(); pen.moveTo(50, py); pen.lineTo(width, py); pen.stroke();
        if (py > 26 && py < height - 26) pen.fillText(north.text(at), 46, py + 4);
      }
      pen.textAlign = "left";
      pen.fillText("north [m]", 6, 14);
      pen.textAlign = "right";
      pen.fillText("east [m]", width - 8, height - 26);
      pen.save();
      pen.beginPath(); pen.rect(50, 0, width - 50, height - 20); pen.clip();
      this.drawRegions(pen, place);
      for (const run of this.visible()) this.drawWay(pen, place, run);
      this.drawNow(pen, place);
      pen.restore();
    }

    drawRegions(pen, place) {
      pen.fillStyle = this.paint.after;
      pen.globalAlpha = 0.1;
      pen.beginPath();
      const between = [];
      this.regions.forEach((one, k) => {
        const next = this.regions[k + 1];
        for (let part = 0; part < (next ? 4 : 1); part++) between.push(next ? one.map((value, j) => value + part / 4 * (next[j] - value)) : one);
      });
      for (const [, x, y, xx, xy, yy] of between) {
        const mean = 0.5 * (xx + yy), rest = Math.hypot(0.5 * (xx - yy), xy), turn = 0.5 * Math.atan2(2 * xy, yy - xx);
        const [long, short] = [mean + rest, Math.max(mean - rest, 0)].map((value) => 2.146 * Math.sqrt(value) / place.view.scale);
        pen.moveTo(place.across(y) + long * Math.cos(turn), place.up(x) - long * Math.sin(turn));
        pen.ellipse(place.across(y), place.up(x), Math.max(long, 0.5), Math.max(short, 0.5), -turn, 0, 2 * Math.PI);
      }
      pen.fill("nonzero");
      pen.globalAlpha = 1;
    }

    drawWay(pen, place, run) {
      const motion = this.motions[run.key], { x, y, t } = motion;
      this.stroke(pen, run, run.truth ? 2.2 : 2);
      pen.beginPath();
      let open = false;
      for (let k = 0; k < t.length; k++) {
        if (!Number.isFinite(x[k]) || !Number.isFinite(y[k])) { open = false; continue; }
        const px = place.across(y[k]), py = place.up(x[k]);
        if (open) pen.lineTo(px, py); else pen.moveTo(px, py);
        open = true;
      }
      pen.stroke();
      pen.setLineDash([]);
      const every = this.every(motion);
      pen.lineWidth = 1;
      pen.globalAlpha = 0.5;
      if (every) for (let at = 0, k = 0; k < t.length; k++) if (motion.way[k] >= at) { this.ship(pen, place, motion, t[k], false); at += every; }
      pen.globalAlpha = 1;
    }

    /* Metres between two outlines. */
    every(motion) {
      if (!this.plan.L) return 0;
      const chosen = this.outlines.value, { L } = this.plan;
      if (chosen !== "auto") return Number(chosen) * L;
      const least = Math.max(46 * this.place.view.scale, L), way = motion.way[motion.way.length - 1];
      return Math.max([1, 2, 5, 10, 20, 50, 100, 200, 500].find((n) => n * L >= least && way / (n * L) < 40) * L || way, 1e-9);
    }

    ship(pen, place, motion, at, filled) {
      const x = valueAt(motion, "x", at), y = valueAt(motion, "y", at), psi = valueAt(motion, "psi", at) * Math.PI / 180;
      if (!(Number.isFinite(x) && Number.isFinite(y) && Number.isFinite(psi))) return;
      const half = 0.5 * this.plan.L, beam = this.plan.L / 12, cos = Math.cos(psi), sin = Math.sin(psi);
      const small = 2 * half / place.view.scale < 5;
      pen.beginPath();
      if (small) pen.arc(place.across(y), place.up(x), filled ? 4 : 2, 0, 2 * Math.PI);
      else for (const [ahead, abeam] of [[half, 0], [0.6 * half, beam], [-half, beam], [-half, -beam], [0.6 * half, -beam]]) {
        pen.lineTo(place.across(y + ahead * sin + abeam * cos), place.up(x + ahead * cos - abeam * sin));
      }
      pen.closePath();
      if (filled) { pen.globalAlpha = 0.85; pen.fill(); pen.globalAlpha = 1; }
      pen.stroke();
    }

    drawNow(pen, place) {
      for (const run of this.visible()) {
        const motion = this.motions[run.key];
        this.stroke(pen, run, 1.2);
        pen.setLineDash([]);
        if (this.plan.L) this.ship(pen, place, motion, this.now, true);
        else {
          const x = valueAt(motion, "x", this.now), y = valueAt(motion, "y", this.now);
          if (Number.isFinite(x)) { pen.beginPath(); pen.arc(place.across(y), place.up(x), 5, 0, 2 * Math.PI); pen.fill(); }
        }
      }
    }

    /* Times and values of a run in a panel. */
    curve(panel, run) {
      const motion = this.motions[run.key], { name } = panel.channel;
      if (name === "off" || panel.difference) {
        if (run.truth) return null;
        const truth = this.motions[this.truth.key];
        const values = Array.from(truth.t, (at, k) => name === "off"
          ? Math.hypot(valueAt(motion, "x", at) - truth.x[k], valueAt(motion, "y", at) - truth.y[k])
          : valueAt(motion, name, at) - (truth[name] ? truth[name][k] : NaN));
        return { t: truth.t, values };
      }
      if (!(name in motion)) return null;
      if (panel.channel.group === "input" && !run.truth && this.truth && name in this.motions[this.truth.key]) return null;
      return { t: motion.t, values: motion[name], low: motion[name + "<"], high: motion[name + ">"] };
    }

    drawPanel(panel) {
      const { pen, width, height } = this.prepared(panel.canvas), [first, last] = this.range || this.span;
      const curves = this.visible().map((run) => ({ run, ...this.curve(panel, run) })).filter((one) => one.t);
      let low = Infinity, high = -Infinity;
      for (const { t, values, low: below, high: above } of curves) {
        for (let k = 0; k < t.length; k++) {
          if (t[k] < first || t[k] > last) continue;
          for (const value of [values[k], below ? below[k] : NaN, above ? above[k] : NaN]) {
            if (Number.isFinite(value)) { low = Math.min(low, value); high = Math.max(high, value); }
          }
        }
      }
      if (!Number.isFinite(low)) [low, high] = [0, 1];
      if (panel.channel.name === "off") low = 0;
      const least = { "m/s": 0.1, deg: 1, "deg/s": 0.02, rpm: 2, m: 1 }[panel.channel.unit] ?? 1e-6;
      if (high - low < least) { const middle = 0.5 * (low + high); low = panel.channel.name === "off" ? 0 : middle - 0.5 * least; high = low + least; }
      const room = 0.06 * (high - low);
      low -= panel.channel.name === "off" ? 0 : room; high += room;
      const vertical = rounded(low, high, height / 32), horizontal = rounded(first, last, width / 80);
      const left = 10 + Math.max(...vertical.places.map((at) => pen.measureText(vertical.text(at)).width), 12);
      const across = (t) => left + (t - first) / (last - first) * (width - left - 8), up = (value) => height - 20 - (value - low) / (high - low) * (height - 26);
      panel.back = (px) => first + (px - left) / (width - left - 8) * (last - first);
      pen.strokeStyle = this.paint.grid; pen.fillStyle = this.paint.muted; pen.lineWidth = 1;
      pen.textAlign = "right";
      for (const at of vertical.places) { const py = up(at); pen.beginPath(); pen.moveTo(left, py); pen.lineTo(width - 8, py); pen.stroke(); pen.fillText(vertical.text(at), left - 5, py + 4); }
      pen.textAlign = "center";
      for (const at of horizontal.places) { const px = across(at); if (px < width - 34) pen.fillText(horizontal.text(at), px, height - 5); }
      pen.textAlign = "right"; pen.fillText("s", width - 8, height - 5);
      pen.save();
      pen.beginPath(); pen.rect(left, 0, width - left - 7, height - 18); pen.clip();
      if (low < 0 && high > 0) { pen.strokeStyle = this.paint.muted; pen.globalAlpha = 0.5; pen.beginPath(); pen.moveTo(left, up(0)); pen.lineTo(width, up(0)); pen.stroke(); pen.globalAlpha = 1; }
      for (const { run, t, values, low: below, high: above } of curves) {
        this.stroke(pen, run, 1.7);
        if (below && above) {
          pen.globalAlpha = 0.18;
          pen.beginPath();
          for (let k = 0; k < t.length; k++) if (Number.isFinite(above[k])) pen.lineTo(across(t[k]), up(above[k]));
          for (let k = t.length - 1; k >= 0; k--) if (Number.isFinite(below[k])) pen.lineTo(across(t[k]), up(below[k]));
          pen.fill();
          pen.globalAlpha = 1;
        }
        pen.beginPath();
        let open = false;
        for (let k = 0; k < t.length; k++) {
          if (!Number.isFinite(values[k]) || !Number.isFinite(t[k])) { open = false; continue; }
          if (open) pen.lineTo(across(t[k]), up(values[k])); else pen.moveTo(across(t[k]), up(values[k]));
          open = true;
        }
        pen.stroke();
        if (t.length === 1) { pen.beginPath(); pen.arc(across(t[0]), up(values[0]), 3, 0, 7); pen.fill(); }
      }
      pen.setLineDash([]);
      pen.strokeStyle = this.paint.ink; pen.lineWidth = 1;
      pen.beginPath(); pen.moveTo(across(this.now), 0); pen.lineTo(across(this.now), height - 20); pen.stroke();
      if (this.dragged && this.dragged.panel === panel) {
        pen.fillStyle = this.paint.after; pen.globalAlpha = 0.15;
        pen.fillRect(across(this.dragged.from), 0, across(this.dragged.to) - across(this.dragged.from), height - 20);
        pen.globalAlpha = 1;
      }
      pen.restore();
    }

    read() {
      const rows = [["speed", "m/s", (m) => valueAt(m, "speed", this.now), 2], ["heading", "deg", (m) => valueAt(m, "psi", this.now), 1],
        ["yaw rate", "deg/s", (m) => valueAt(m, "r", this.now), 3]];
      if (this.truth && this.runs.length > 1) {
        const truth = this.motions[this.truth.key];
        rows.push(["off track", "m", (m) => m === truth ? NaN : Math.hypot(valueAt(m, "x", this.now) - valueAt(truth, "x", this.now), valueAt(m, "y", this.now) - valueAt(truth, "y", this.now)), 1]);
      }
      const runs = this.visible();
      const head = make("tr", {}, make("th", { scope: "col", textContent: `at ${words(this.now, this.now < 100 ? 1 : 0)} s` }),
        ...runs.map((run) => make("th", { scope: "col", className: "number", textContent: run.words.replace(/[\/_]/g, "$&\u200b") })));
      const body = rows.map(([name, unit, of, decimals]) => make("tr", {}, make("th", { scope: "row", textContent: `${name} [${unit}]` }),
        ...runs.map((run) => make("td", { className: "number", textContent: words(of(this.motions[run.key]), decimals) }))));
      for (const channel of this.plan.channels.filter((one) => one.group === "input")) {
        body.push(make("tr", {}, make("th", { scope: "row", textContent: `${channel.words} [${channel.unit}]` }),
          ...runs.map((run) => make("td", { className: "number", textContent: words(valueAt(this.motions[run.key], channel.name, this.now), decimalsOf(channel)) }))));
      }
      this.readout.replaceChildren(make("thead", {}, head), make("tbody", {}, ...body));
      const text = `${words(this.now, this.now < 100 ? 1 : 0)} s`;
      this.clock.textContent = text;
      this.slider.value = Math.round(1000 * (this.now - this.span[0]) / (this.span[1] - this.span[0]));
      this.slider.setAttribute("aria-valuetext", text);
      Object.assign(this.holder.dataset, { now: this.now.toFixed(2), from: (this.range || this.span)[0].toFixed(2),
        to: (this.range || this.span)[1].toFixed(2), scale: this.place.view.scale.toPrecision(5) });
    }

    at(t) {
      this.now = Math.min(Math.max(t, this.span[0]), this.span[1]);
      this.soon();
    }

    fromSlider() { return this.span[0] + this.slider.value / 1000 * (this.span[1] - this.span[0]); }

    rescale(range) {
      this.range = range && range[1] - range[0] > 1e-6 ? [Math.max(range[0], this.span[0]), Math.min(range[1], this.span[1])] : null;
      this.from.value = this.range ? +this.range[0].toFixed(2) : "";
      this.to.value = this.range ? +this.range[1].toFixed(2) : "";
      this.soon();
    }

    typed() {
      const ends = [this.from, this.to].map((input, k) => input.value === "" ? this.span[k] : Number(input.value));
      if (ends[0] < ends[1]) this.rescale(ends);
    }

    whole() { this.frame = null; this.soon(); }

    zoom(factor, px, py) {
      const { clientWidth: width, clientHeight: height } = this.canvas, place = this.places(width, height);
      const east = px === undefined ? place.view.y : place.east(px), north = py === undefined ? place.view.x : place.north(py);
      this.frame = { scale: place.view.scale / factor, y: east + (place.view.y - east) / factor, x: north + (place.view.x - north) / factor };
      this.soon();
    }

    move(px, py) {
      const { clientWidth: width, clientHeight: height } = this.canvas, { view } = this.places(width, height);
      this.frame = { scale: view.scale, y: view.y - px * view.scale, x: view.x + py * view.scale };
      this.soon();
    }

    /* The sample of a visible track nearest to a place on the canvas. */
    nearest(px, py) {
      let best = null, least = 28;
      for (const run of this.visible()) {
        const { x, y, t } = this.motions[run.key];
        for (let k = 0; k < t.length; k++) {
          const off = Math.hypot(this.place.across(y[k]) - px, this.place.up(x[k]) - py);
          if (off < least) { least = off; best = { run, k, t: t[k] }; }
        }
      }
      return best;
    }

    listen() {
      const { track } = this;
      let last = null;
      track.addEventListener("pointerdown", (event) => { if (event.target === this.canvas && event.pointerType === "mouse") { last = [event.clientX, event.clientY]; track.setPointerCapture(event.pointerId); } });
      track.addEventListener("pointerup", () => { last = null; });
      track.addEventListener("pointermove", (event) => {
        if (last) {
          this.move(event.clientX - last[0], event.clientY - last[1]);
          last = [event.clientX, event.clientY];
          this.tip.hidden = true;
        } else if (event.target === this.canvas) this.pointed(event);
      });
      track.addEventListener("click", (event) => { if (event.target === this.canvas) this.pointed(event); });
      track.addEventListener("pointerleave", () => { this.tip.hidden = true; });
      track.addEventListener("dblclick", (event) => { if (event.target === this.canvas) this.whole(); });
      track.addEventListener("wheel", (event) => {
        if (!event.ctrlKey && !event.metaKey) return;
        event.preventDefault();
        this.zoom(Math.exp(-0.003 * event.deltaY), event.offsetX, event.offsetY);
      }, { passive: false });
      track.addEventListener("keydown", (event) => {
        const act = { "+": () => this.zoom(1.5), "=": () => this.zoom(1.5), "-": () => this.zoom(1 / 1.5), "0": () => this.whole(),
          ArrowLeft: () => this.move(40, 0), ArrowRight: () => this.move(-40, 0), ArrowUp: () => this.move(0, 40), ArrowDown: () => this.move(0, -40) }[event.key];
        if (act && event.target === track) { event.preventDefault(); act(); }
      });
    }

    pointed(event) {
      const found = this.nearest(event.offsetX, event.offsetY);
      this.tip.hidden = !found;
      if (!found) return;
      const motion = this.motions[found.run.key], lines = [found.run.words, `${words(found.t, found.t < 100 ? 1 : 0)} s`];
      if (motion.speed) lines.push(`${words(motion.speed[found.k], 2)} m/s`);
      for (const channel of this.plan.channels) {
        if (channel.group === "input") {
          const source = channel.name in motion ? motion : this.truth && this.motions[this.truth.key];
          const value = source ? valueAt(source, channel.name, found.t) : NaN;
          if (Number.isFinite(value)) lines.push(`${channel.words} ${words(value, decimalsOf(channel))} ${channel.unit}`);
        }
      }
      this.tip.textContent = lines.join("\n");
      const right = event.offsetX > this.canvas.clientWidth - 190;
      this.tip.style.left = right ? "" : `${event.offsetX + 14}px`;
      this.tip.style.right = right ? `${this.canvas.clientWidth - event.offsetX + 14}px` : "";
      this.tip.style.top = `${Math.min(event.offsetY + 10, this.canvas.clientHeight - 110)}px`;
      this.at(found.t);
    }

    /* A history answers to pointing and to dragging across it. */
    pointing(panel) {
      const place = (event) => panel.back ? panel.back(event.clientX - panel.canvas.getBoundingClientRect().left) : NaN;
      panel.canvas.addEventListener("pointerdown", (event) => {
        if (event.pointerType !== "mouse") return;
        this.dragged = { panel, from: place(event), to: place(event) };
        panel.canvas.setPointerCapture(event.pointerId);
      });
      panel.canvas.addEventListener("pointermove", (event) => {
        if (this.dragged) { this.dragged.to = place(event); this.soon(); } else this.at(place(event));
      });
      panel.canvas.addEventListener("pointerup", () => {
        if (!this.dragged) return;
        const ends = [this.dragged.from, this.dragged.to].sort((a, b) => a - b), [first, last] = this.range || this.span;
        this.dragged = null;
        if (ends[1] - ends[0] > 0.01 * (last - first)) this.rescale(ends); else this.soon();
      });
      panel.canvas.addEventListener("click", (event) => this.at(place(event)));
      panel.canvas.addEventListener("dblclick", () => this.rescale(null));
    }

    save() {
      const lines = ["motion,quantity,unit,t_s,value"], quote = (text) => `"${text.replaceAll('"', '""')}"`;
      const channels = [{ name: "x", words: "position north", unit: "m" }, { name: "y", words: "position east", unit: "m" }, ...this.plan.channels];
      for (const run of this.runs) {
        const motion = this.motions[run.key];
        for (const channel of channels) {
          if (!(channel.name in motion)) continue;
          motion.t.forEach((t, k) => lines.push([quote(run.words), quote(channel.words), channel.unit, +t.toFixed(3),
            Number.isFinite(motion[channel.name][k]) ? +motion[channel.name][k].toPrecision(7) : ""].join(",")));
        }
      }
      const link = make("a", { href: URL.createObjectURL(new Blob([lines.join("\n") + "\n"], { type: "text/csv" })), download: `manoeuvre-${this.index + 1}.csv` });
      link.click();
      URL.revokeObjectURL(link.href);
    }
  }

  return { Viewer, make };
})();
