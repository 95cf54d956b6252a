"use strict";
// the one player: moves and plots a scene in the elements of this document, and returns what ends that, for another one;
// it begins as the address says, or as `begin` does, { at, playing }, and then leaves the address alone
function playScene(data, begin = null) {
  const find = (id) => document.getElementById(id);
  const root = document.documentElement;
  const ended = new AbortController();
  const until = { signal: ended.signal };
  if (data.drawing) find("stage").querySelector("figure").innerHTML = data.drawing;
  if ("note" in data) find("stage").querySelector(".note").textContent = data.note;
  const drawing = find("drawing");
  const N = data.steps;
  // what the mechanism runs over, from 0 to `most`: a turn, after which it begins again, or a travel, to and fro
  const { most: M, closed, unit: inputUnit, name: inputName, noun, key, pace } = data.input;
  const cycle = closed ? M : 2 * M;
  const wrapped = (value) => (closed ? ((value % M) + M) % M : Math.min(Math.max(value, 0), M));
  const withUnit = (value, digits) => value.toFixed(digits) + (inputUnit === "°" ? "°" : ` ${inputUnit}`);

  // --- numbers ------------------------------------------------------------------------------------------------------

  // a packed row: a constant, plain numbers with holes, or differences in units of the last digit
  function unpacked(row) {
    if ("c" in row) return null;
    if ("n" in row) return row.n;
    const scale = 10 ** row.d;
    let sum = 0;
    return row.v.map((step) => (sum += step) / scale);
  }

  // a function of the step x in [0, N]: cubic between values, which join over a turn; a leap is not smoothed
  function curve(row) {
    const v = unpacked(row);
    if (v === null) return () => row.c;
    const turn = v[N] - v[0];
    const beyond = (i) => (i < 0 ? 2 * v[0] - v[1] : 2 * v[N] - v[N - 1]);
    const around = (i) => (i < 0 ? v[i + N] - turn : v[i - N] + turn);
    const get = (i) => (i >= 0 && i <= N ? v[i] : closed ? around(i) : beyond(i));
    return (x) => {
      const i = Math.min(Math.max(Math.floor(x), 0), N - 1);
      const t = x - i;
      const [p, a, b, q] = [get(i - 1), v[i], v[i + 1], get(i + 2)];
      if (a === null || b === null) return NaN;
      if (p === null || q === null) return a + t * (b - a);
      const leap = Math.abs(b - a) > 6 * (Math.abs(a - p) + Math.abs(q - b));
      if (leap) return t < 0.5 ? a : b;
      const m = 0.5 * (b - p);
      const n = 0.5 * (q - a);
      return a + t * (m + t * (3 * (b - a) - 2 * m - n + t * (m + n - 2 * (b - a))));
    };
  }

  // a value with its unit, to some ten-thousandth of `span`, the range of its plot, or of itself; 0 without digits; where
  // the unit is empty a count
  function tidy(value, unit, span = 0) {
    if (!Number.isFinite(value)) return "–";
    if (unit === "") return value.toFixed(0);
    const size = span || Math.abs(value) || 1;
    const digits = Math.min(Math.max(3 - Math.floor(Math.log10(size)), 0), 12);
    const fixed = value.toFixed(digits);
    const text = Number(fixed) === 0 ? "0" : fixed;
    return text.replace("-", "−") + (unit === "°" ? "°" : unit ? " " + unit : "");
  }

  // --- state --------------------------------------------------------------------------------------------------------

  const relative = curve(data.relative);
  const bodies = data.bodies.map((rows, i) => ({
    group: find(`body-${i}`),
    x: curve(rows[0]),
    y: curve(rows[1]),
    angle: curve(rows[2]),
    moves: rows.some((row) => !("c" in row)),
  }));
  const letters = [...drawing.querySelectorAll(".letters text")].map((text) => {
    const [x, y] = text.dataset.at.split(" ").map(Number);
    return { text, x, y, body: bodies[Number(text.dataset.body)] };
  });
  const [scale, left, top, beside] = data.view;
  const space = drawing.namespaceURI;
  const marks = data.marks.map(({ kind, x, y, text }) => {
    const mark = made("circle", { class: `mark ${kind}`, cx: x, cy: y }, drawing.querySelector(".cam"));
    made("title", {}, mark).textContent = text;
    return mark;
  });
  let px = 1; // units of the drawing that one px of the screen is
  let at = 0; // of the input
  let phase = 0; // of a cycle, in the same unit
  let playing = false;
  let last = 0;
  let frame = 0; // that is asked for
  const followers = []; // what else moves with the angle
  // another design that is kept beside this one: outlines that move along, in the same scale
  const kept = data.beside ? keptBodies(data.beside) : [];
  function keptBodies({ drawing: other, bodies: rows, factor, reach, player, room: [x0, y0, x1, y1] }) {
    drawing.setAttribute("viewBox", [scale * (x0 - left), scale * (top - y1), scale * (x1 - x0), scale * (y1 - y0)].join(" "));
    const held = document.createElement("template");
    held.innerHTML = other;
    const share = () => (closed ? at % reach : Math.min(at, reach)) / reach; // of its own turn or travel
    if (player) followers.push(played(player, held.content, share));
    const outlines = made("g", { class: "kept", "aria-hidden": "true" });
    drawing.querySelector("g").append(outlines);
    return rows.flatMap((row, i) => {
      const group = held.content.getElementById(`body-${i}`);
      if (group.matches(".contacts, .forces, .overlays")) return [];
      for (const part of group.querySelectorAll("title, .other")) part.remove();
      group.removeAttribute("id");
      group.setAttribute("class", "");
      outlines.append(group);
      return [{ group, factor, share, x: curve(row[0]), y: curve(row[1]), angle: curve(row[2]) }];
    });
  }
  // what a function of another script moves besides, by the share of the turn or of the travel
  function played({ name, data: given }, among, share) {
    const move = globalThis[name](given, among);
    return () => move(share());
  }
  if (data.player) followers.push(played(data.player, null, () => at / M));

  function show() {
    const x = (at / M) * N;
    for (const body of bodies) {
      body.at = [body.x(x), body.y(x), (body.angle(x) * Math.PI) / 180];
      if (body.moves) {
        const [bx, by] = body.at;
        body.group.setAttribute("transform", `translate(${bx.toFixed(6)} ${by.toFixed(6)}) rotate(${body.angle(x).toFixed(5)})`);
      }
    }
    for (const body of kept) {
      const x = body.share() * N;
      const place = `translate(${(body.factor * body.x(x)).toFixed(6)} ${(body.factor * body.y(x)).toFixed(6)})`;
      body.group.setAttribute("transform", `${place} rotate(${body.angle(x).toFixed(5)}) scale(${body.factor})`);
    }
    for (const letter of letters) {
      const [bx, by, angle] = letter.body.at;
      const c = Math.cos(angle);
      const s = Math.sin(angle);
      const lx = scale * (bx + letter.x * c - letter.y * s - left) + beside * px;
      const ly = scale * (top - by - letter.x * s - letter.y * c) - beside * px;
      letter.text.setAttribute("x", lx.toFixed(1));
      letter.text.setAttribute("y", ly.toFixed(1));
    }
    for (const follow of followers) follow(x);
    find("slider").value = at;
    find("slider").setAttribute("aria-valuetext", `${at.toFixed(1)} ${inputUnit === "°" ? "degrees" : inputUnit}`);
    root.dataset.at = at.toFixed(4);
    root.dataset.key = key;
  }

  function turnTo(next) {
    at = next >= 0 && next <= M ? next : wrapped(next);
    show();
  }

  // a page that nobody sees stands still
  function next() {
    cancelAnimationFrame(frame);
    if (!playing || document.hidden) return;
    last = performance.now();
    frame = requestAnimationFrame(tick);
  }
  document.addEventListener("visibilitychange", next, until);

  function tick(now) {
    if (!playing || document.hidden) return;
    const rpm = Number(find("speed").value);
    phase = (phase + (Math.min(now - last, 100) * rpm * cycle) / 60000) % cycle;
    turnTo(phase > M ? cycle - phase : phase);
    last = now;
    frame = requestAnimationFrame(tick);
  }

  function play(on) {
    playing = on;
    root.dataset.playing = on;
    const button = find("play");
    button.textContent = on ? "Pause" : "Play";
    button.setAttribute("aria-pressed", String(on));
    phase = at;
    next();
  }

  const calm = window.matchMedia("(prefers-reduced-motion: reduce)");
  calm.addEventListener("change", () => calm.matches && playing && play(false), until);

  // the address follows the angle at rest, so that it can be kept or passed on; browsers allow a few changes a second
  let later = 0;
  function noted() {
    if (begin) return;
    clearTimeout(later);
    later = setTimeout(() => {
      try {
        history.replaceState(null, "", `#${key}=${Number(at.toFixed(2))}`);
      } catch {
        // a frame without an origin has no address of its own
      }
    }, 250);
  }

  function held(next) {
    play(false);
    turnTo(next);
    noted();
  }

  function turned() {
    play(!playing);
    if (!playing) noted();
  }

  // shaft angle at which the relative angle has this value; it rises with the shaft's, by a turn
  function shaftAt(wanted) {
    let [low, high] = [0, N];
    const goal = relative(0) + ((((wanted - relative(0)) % 360) + 360) % 360);
    for (let i = 0; i < 40; i++) {
      const middle = 0.5 * (low + high);
      if (relative(middle) < goal) low = middle;
      else high = middle;
    }
    return (0.5 * M * (low + high)) / N;
  }

  // --- plots --------------------------------------------------------------------------------------------------------

  function made(name, attributes, parent) {
    const element = document.createElementNS(space, name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    if (parent) parent.append(element);
    return element;
  }

  function html(name, className, parent, text) {
    const element = document.createElement(name);
    if (className) element.className = className;
    if (text) element.textContent = text;
    if (parent) parent.append(element);
    return element;
  }

  // round steps that give about `count` of them
  function ticks(low, high, count) {
    const rough = (high - low) / count;
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = power * [1, 2, 5, 10].find((m) => m * power >= rough * 0.999);
    const found = [];
    for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) found.push(k * step);
    return { found, digits: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
  }

  // the thousandfold in which great and small values are counted, with its name
  function thousands(size) {
    const power = size >= 1e5 || size < 1e-3 ? 3 * Math.floor(Math.log10(size) / 3 + 1e-9) : 0;
    const raised = String(power).replace(/./g, (sign) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[sign] || "⁻");
    return power ? [10 ** power, `10${raised} `] : [1, ""];
  }

  // indices of values in runs without a hole
  function runs(values) {
    const found = [];
    values.forEach((value, i) => {
      if (value === null) return;
      if (i && values[i - 1] !== null && found.length) found.at(-1).push(i);
      else found.push([i]);
    });
    return found;
  }

  const HEIGHT = 166;
  const LEFT = 62;
  const RIGHT = 8;
  const TOP = 8;
  const BOTTOM = 36;
  const [HEAD, SAVED] = [40, 560]; // px of a saved plot: above it for its title, and its width
  const LETTERS = 22; // that fit along the upright axis; of more the name is drawn narrower
  const FAR = 3; // spans of the curves: a limit that is farther from them is named below, not drawn
  const KEPT = ["fill", "stroke", "stroke-width", "stroke-dasharray", "font-size", "paint-order"]; // of a style, in a saved plot

  class Plot {
    constructor(plot) {
      this.plot = plot;
      this.over = plot.over === "relative" ? relative : (x) => (M * x) / N;
      this.rows = plot.series.map((series) => ({
        name: series.name,
        at: curve(series),
        values: unpacked(series) || Array(series.high ? N : N + 1).fill(series.c),
        high: series.high && (unpacked(series.high) || Array(N).fill(series.high.c)),
      }));
      const kept = (plot.beside || []).filter((series) => !series.high);
      this.kept = kept.map((series) => (unpacked(series) || Array(N + 1).fill(series.c)).filter((_, i) => (i * data.beside.reach) / N <= M));
      this.range();
      this.figure = html("figure", "plot", find("plots"));
      const caption = html("figcaption", "", this.figure);
      const title = plot.title;
      const words = html("div", "", caption);
      html("b", "", words, title);
      this.value = html("span", "value", words);
      this.spans = this.rows.map((row, i) => html("span", i ? "second-text" : "first-text", this.value));
      const told = this.rows.map((row) => `${row.name} from ${tidy(row.least)} to ${tidy(row.most)}`).join(", ");
      const save = html("button", "save", caption, "SVG");
      save.type = "button";
      save.title = "save this plot as SVG";
      save.setAttribute("aria-label", `save ${title} as SVG`);
      save.addEventListener("click", () => this.save());
      this.svg = made("svg", { role: "img", "aria-label": `${title}, ${plot.unit}: ${told}` }, this.figure);
      if (this.note) html("small", "", this.figure, this.note);
      this.svg.addEventListener("pointerdown", (event) => {
        this.svg.setPointerCapture(event.pointerId);
        this.drag(event);
      });
      this.svg.addEventListener("pointermove", (event) => event.buttons && this.drag(event));
      followers.push((x) => this.follow(x));
    }

    range() {
      let [low, high] = [Infinity, -Infinity];
      for (const row of this.rows) {
        const good = row.values.concat(row.high || []).filter((v) => v !== null);
        row.least = Math.min(...good);
        row.most = Math.max(...good);
        [low, high] = [Math.min(low, row.least), Math.max(high, row.most)];
      }
      for (const value of this.kept.flat()) if (value !== null) [low, high] = [Math.min(low, value), Math.max(high, value)];
      for (const value of this.plot.holds) [low, high] = [Math.min(low, value), Math.max(high, value)];
      const span = high - low || Math.abs(high) || 1;
      const near = ([value]) => value > low - FAR * span && value < high + FAR * span;
      this.limits = this.plot.limits.filter(near);
      const far = this.plot.limits.filter((limit) => limit[1] && !near(limit)).map(([, name]) => `${name} lies beyond this plot`);
      this.note = [this.plot.note, ...new Set(far)].filter(Boolean).join("; ");
      for (const [value] of this.limits) [low, high] = [Math.min(low, value), Math.max(high, value)];
      if (high - low < 1e-12 * Math.abs(high) || high === low) [low, high] = [low - 0.5 * span, high + 0.5 * span];
      const margin = 0.06 * (high - low);
      const foot = low === 0 && this.plot.holds.includes(0); // of forces, whose axis begins at 0
      [this.low, this.high] = this.plot.frame || [foot ? 0 : low - margin, high + margin]; // a frame is kept as given
    }

    x(angle) {
      return LEFT + (angle / M) * (this.width - LEFT - RIGHT);
    }

    y(value) {
      return TOP + ((this.high - value) / (this.high - this.low)) * (HEIGHT - TOP - BOTTOM);
    }

    draw(width = Math.max(180, this.figure.clientWidth)) {
      this.width = width;
      this.svg.replaceChildren();
      this.svg.setAttribute("viewBox", `0 0 ${this.width} ${HEIGHT}`);
      this.svg.dataset.frame = JSON.stringify([LEFT, RIGHT, TOP, BOTTOM, this.low, this.high]);
      const line = (name, x1, y1, x2, y2) => made("line", { class: name, x1, y1, x2, y2 }, this.svg);
      if (this.plot.rests) {
        for (const [start, length] of data.rests) {
          for (const from of closed ? [start, start - M] : [start]) {
            const [a, b] = [Math.max(from, 0), Math.min(from + length, M)];
            if (b <= a) continue;
            const place = { class: "rest", x: this.x(a), y: TOP, width: this.x(b) - this.x(a) };
            made("rect", { ...place, height: HEIGHT - TOP - BOTTOM }, this.svg);
          }
        }
      }
      const [unit, counted] = thousands(Math.max(Math.abs(this.low), Math.abs(this.high)));
      const { found, digits } = ticks(this.low / unit, this.high / unit, 5);
      for (const value of found) {
        const y = this.y(value * unit);
        const zero = Math.abs(value * unit) < 1e-12 * (this.high - this.low);
        line(zero ? "zero" : "grid", LEFT, y, this.width - RIGHT, y);
        const told = zero ? (0).toFixed(Math.min(digits, 4)) : value.toFixed(digits);
        const few = Math.max(0, digits + Math.floor(Math.log10(Math.abs(value) || 1))); // those of the step
        const text = (told.length > 8 ? value.toExponential(few) : told).replace("-", "−");
        const narrow = text.length > 6 ? { textLength: 40, lengthAdjust: "spacingAndGlyphs" } : {};
        made("text", { x: LEFT - 5, y: y + 4, "text-anchor": "end", ...narrow }, this.svg).textContent = text;
      }
      const upright = [this.plot.axis, counted + this.plot.unit].filter(Boolean).join(", ");
      const middle = [0.5 * (LEFT + this.width - RIGHT), 0.5 * (TOP + HEIGHT - BOTTOM)];
      const axis = (text, place) => (made("text", { ...place, "text-anchor": "middle" }, this.svg).textContent = text);
      const narrow = upright.length > LETTERS ? { textLength: HEIGHT - TOP - BOTTOM, lengthAdjust: "spacingAndGlyphs" } : {};
      axis(upright, { class: "axis", transform: `translate(11 ${middle[1]}) rotate(-90)`, ...narrow });
      axis(`${this.plot.over === "relative" ? "relative angle" : inputName}, ${inputUnit}`, { class: "axis", x: middle[0], y: HEIGHT - 5 });
      const steps = closed ? { found: [0, 1, 2, 3, 4].map((k) => (k * M) / 4), digits: 0 } : ticks(0, M, 5);
      for (const angle of steps.found) {
        line("grid", this.x(angle), TOP, this.x(angle), HEIGHT - BOTTOM);
        const last = angle > 0.98 * M;
        const place = { x: this.x(angle) + (last ? 7 : 0), y: HEIGHT - BOTTOM + 14 };
        place["text-anchor"] = last ? "end" : "middle";
        made("text", place, this.svg).textContent = angle.toFixed(steps.digits) + (inputUnit === "°" ? "°" : "");
      }
      const names = [];
      for (const [value, name] of this.limits) {
        line("limit", LEFT, this.y(value), this.width - RIGHT, this.y(value));
        const below = value > 0.5 * (this.low + this.high);
        const place = { x: this.width - RIGHT - 2, y: this.y(value) + (below ? 11 : -4), "text-anchor": "end" };
        if (name) names.push([{ class: "named", ...place }, name]);
      }
      for (const values of this.kept) made("path", { class: "line kept", d: this.path(values, data.beside.reach) }, this.svg);
      this.rows.forEach((row, i) => {
        const d = row.high ? this.band(row) : this.path(row.values);
        made("path", { class: `${row.high ? "band" : "line"}${i ? " second" : ""}`, d }, this.svg);
      });
      for (const [place, name] of names) made("text", place, this.svg).textContent = name;
      this.cursor = line("cursor", 0, TOP, 0, HEIGHT - BOTTOM);
      this.dots = this.rows.map((row, i) => made("circle", { class: `dot${i ? " second" : ""}`, r: 3.5 }, this.svg));
    }

    path(values, reach = M) {
      let text = "";
      let pen = "M";
      values.forEach((value, i) => {
        if (value === null) {
          pen = "M";
          return;
        }
        text += `${pen}${this.x((reach * i) / N).toFixed(1)} ${this.y(value).toFixed(1)}`;
        pen = "L";
      });
      return text;
    }

    band(row) {
      const side = (values, run) =>
        run.map((i) => `${this.x((M * (i + 0.5)) / N).toFixed(1)} ${this.y(values[i]).toFixed(1)}`);
      const outline = (run) => `M${side(row.high, run).concat(side(row.values, run).reverse()).join("L")}Z`;
      return runs(row.values).map(outline).join("");
    }

    follow(x) {
      const angle = this.over(x) % (M + 1e-7);
      const step = (angle / M) * N;
      const place = this.x(angle);
      this.cursor.setAttribute("x1", place);
      this.cursor.setAttribute("x2", place);
      this.rows.forEach((row, i) => {
        const value = row.high ? row.high[Math.min(Math.floor(step), N - 1)] : row.at(step);
        const good = Number.isFinite(value) && value !== null;
        this.dots[i].setAttribute("visibility", good ? "visible" : "hidden");
        if (good) {
          this.dots[i].setAttribute("cx", place);
          this.dots[i].setAttribute("cy", this.y(Math.min(Math.max(value, this.low), this.high)));
        }
        const name = this.rows.length > 1 ? `${row.name.replace(/ angle$/, "")} ` : "";
        this.spans[i].textContent = (i ? ", " : "") + name + tidy(value === null ? NaN : value, this.plot.unit, this.high - this.low);
      });
    }

    // the plot as a picture by itself, what the style sheet says written into it
    picture() {
      this.draw(SAVED);
      const copy = this.svg.cloneNode(true);
      const parts = [...copy.querySelectorAll("*")];
      [...this.svg.querySelectorAll("*")].forEach((part, i) => {
        const style = getComputedStyle(part);
        for (const name of KEPT) parts[i].setAttribute(name, style.getPropertyValue(name));
      });
      for (const part of [this.cursor, ...this.dots]) parts[[...this.svg.querySelectorAll("*")].indexOf(part)].remove();
      for (const part of parts) part.removeAttribute("class");
      const high = HEIGHT + HEAD;
      const place = { width: this.width, height: high, viewBox: `0 ${-HEAD} ${this.width} ${high}` };
      for (const [key, value] of Object.entries({ ...place, "font-family": "sans-serif" })) copy.setAttribute(key, value);
      const style = getComputedStyle(root);
      const colour = (name) => style.getPropertyValue(name).trim();
      const title = made("text", { x: 6, y: 17 - HEAD, "font-size": "13px", fill: colour("--ink") });
      title.textContent = `${data.name}: ${this.plot.title}`;
      const note = made("text", { x: 6, y: 32 - HEAD, "font-size": "11px", fill: colour("--quiet") });
      note.textContent = this.note;
      copy.prepend(made("rect", { y: -HEAD, width: SAVED, height: high, fill: colour("--panel") }), title, note);
      this.draw();
      show();
      return new XMLSerializer().serializeToString(copy);
    }

    save() {
      const link = html("a");
      link.href = URL.createObjectURL(new Blob([this.picture()], { type: "image/svg+xml" }));
      link.download = `${data.name}-${this.plot.title.toLowerCase().replace(/[^a-z0-9.]+/g, "-")}.svg`;
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    }

    drag(event) {
      const box = this.svg.getBoundingClientRect();
      const share = (((event.clientX - box.left) / box.width) * this.width - LEFT) / (this.width - LEFT - RIGHT);
      const angle = M * Math.min(Math.max(share, 0), 1);
      held(this.plot.over === "relative" ? shaftAt(angle) : angle);
    }
  }

  const micro = data.unit === "mm" ? ["µm", 1e3] : ["µin", 1e6];
  const scaled = (row, by) =>
    "c" in row ? { c: row.c * by } : "n" in row ? { n: row.n.map((v) => v && v * by) } : { d: row.d - Math.log10(by), v: row.v };
  const over = data.linked ? "relative" : "shaft";
  const lines = (most) => [[most, `tolerance ${Number(most.toPrecision(4))}`], [-most, ""]];
  const errors = data.errors.map(({ file, low, high, tolerance }) => ({
    title: `Error of ${file}`,
    unit: micro[0],
    axis: "error",
    series: [{ name: file, ...scaled(low, micro[1]), high: scaled(high, micro[1]) }],
    limits: lines(tolerance * micro[1]),
    holds: [tolerance * micro[1], -tolerance * micro[1]],
    note: "distance outside the exact contour, negative inside",
    over,
  }));
  const plots = [...data.plots, ...errors].map((plot) => new Plot(plot));
  const rests = find("rests");
  data.rests.forEach(([start, length, name], i) => {
    if (!i) html("span", "rest-key", rests).setAttribute("aria-hidden", "true");
    rests.append(`${i ? "; " : " "}${name}, from ${withUnit(start, 2)} to ${withUnit(closed ? (start + length) % M : start + length, 2)}`);
  });
  find("plots").append(rests);

  // --- the line under the drawing -----------------------------------------------------------------------------------

  const now = find("now");
  const told = [[noun, (x) => withUnit((M * x) / N, 1), closed ? "4.2em" : "6.2em"]];
  if (data.linked) told.push(["relative", (x) => withUnit(wrapped(relative(x)), 1), "4.2em"]);
  for (const plot of plots.slice(0, 1)) {
    const span = plot.high - plot.low;
    told.push([plot.plot.title.toLowerCase(), (x) => tidy(plot.rows[0].at(x), plot.plot.unit, span), "6.2em"]);
  }
  for (const [name, text, width] of told) {
    const span = html("span", "", now, `${name} `);
    const value = html("b", "", span);
    value.style.minWidth = width;
    followers.push((x) => (value.textContent = text(x)));
  }

  // --- the error round the contour ----------------------------------------------------------------------------------

  const ring = find("ring");
  const chosen = find("error-file");
  find("errors").hidden = !data.errors.length;
  if (data.errors.length) {
    const full = (row) => unpacked(row) || Array(N).fill(row.c);
    const contours = {}; // by the name of the surface
    for (const [name, rows] of Object.entries(data.contours)) {
      const [x, up, nx, ny] = rows.map(full);
      contours[name] = { x, y: up.map((y) => -y), nx, ny };
    }
    const all = Object.values(contours);
    const [xs, ys] = [all.flatMap(({ x }) => x), all.flatMap(({ y }) => y)];
    const [lowX, highX, lowY, highY] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
    const extent = Math.max(highX - lowX, highY - lowY);
    const pad = 0.16 * extent;
    const view = [lowX - pad, lowY - pad, highX - lowX + 2 * pad, highY - lowY + 2 * pad];
    const svg = made("svg", { viewBox: view.join(" "), role: "img" }, ring);
    const exact = made("path", { class: "exact" }, svg);
    const limits = [1, -1].map((side) => [side, made("path", { class: "limit" }, svg)]);
    const band = made("path", { class: "band" }, svg);
    const place = made("circle", { class: "place", r: 0.012 * extent }, svg);
    let round = all[0]; // the contour of the error that is chosen
    const point = (i, off) =>
      `${(round.x[i] + round.nx[i] * off).toPrecision(7)} ${(round.y[i] - round.ny[i] * off).toPrecision(7)}`;
    const along = (off) => `M${round.x.map((_, i) => point(i, off)).join("L")}${closed ? "Z" : ""}`;
    for (const { file } of data.errors) chosen.append(new Option(file, file));
    const rows = data.errors.map(({ low, high }) => [low, high].map(full));
    const redraw = () => {
      const [low, high] = rows[Math.max(chosen.selectedIndex, 0)];
      const { file, surface, tolerance } = data.errors[Math.max(chosen.selectedIndex, 0)];
      round = contours[surface];
      exact.setAttribute("d", along(0));
      const worst = Math.max(...low.concat(high).filter((v) => v !== null).map(Math.abs));
      const natural = (0.1 * extent) / Math.max(worst, tolerance);
      const wanted = natural * 10 ** ((Number(find("magnify").value) - 50) / 50);
      const power = 10 ** Math.floor(Math.log10(wanted));
      const by = Math.round((wanted / power) * 10) * power / 10;
      const outline = (run) => {
        const steps = closed && run.length === N ? [...run, 0] : run;
        const there = steps.map((i) => point(i, by * high[i]));
        const back = steps.map((i) => point(i, by * low[i])).reverse();
        return `M${there.concat(back).join("L")}Z`;
      };
      band.setAttribute("d", runs(low).map(outline).join(""));
      for (const [side, path] of limits) path.setAttribute("d", along(side * by * tolerance));
      const most = worst ? `up to ${tidy(worst * micro[1], micro[0])} off` : "but for rounding on";
      const within = `tolerance of ${Number((tolerance * micro[1]).toPrecision(4))} ${micro[0]} (dashed)`;
      find("error-note").textContent =
        `${file}, ${most} the exact contour (the thin line), and its ${within}, drawn ${Number(by.toPrecision(3))} times as large.`;
      svg.setAttribute("aria-label", find("error-note").textContent);
      follow((at / M) * N);
    };
    const follow = (x) => {
      const i = Math.floor(data.linked ? (wrapped(relative(x)) / M) * N : x) % N;
      place.setAttribute("cx", round.x[i]);
      place.setAttribute("cy", round.y[i]);
    };
    chosen.addEventListener("change", redraw, until);
    find("magnify").addEventListener("input", redraw, until);
    followers.push(follow);
    redraw();
  }

  // --- controls -----------------------------------------------------------------------------------------------------

  const slider = { max: M, step: M / 3600, "aria-label": `${inputName} in ${inputUnit === "°" ? "degrees" : inputUnit}` };
  for (const [name, value] of Object.entries(slider)) find("slider").setAttribute(name, value);
  for (const option of find("speed").options) option.textContent = `${option.value} ${pace}`;
  find("play").addEventListener("click", turned, until);
  find("slider").addEventListener("input", (event) => held(Number(event.target.value)), until);
  for (const kind of ["contacts", "forces", "overlays"]) {
    find(kind).addEventListener("change", (event) => drawing.classList.toggle(`hide-${kind}`, !event.target.checked), until);
  }
  for (const kind of ["contacts", "forces", "overlays"]) find(`${kind}-label`).hidden = !drawing.querySelector(`.${kind}`);
  find("grip").hidden = !drawing.querySelector(".cam");
  const contours = [...drawing.querySelectorAll(".cam .metal")];
  const named = (path) => path.querySelector("title").textContent;
  const names = [...new Set(contours.map(named))]; // each disc has a contour by each name
  names.forEach((name) => find("contour").append(new Option(name, name)));
  find("contour-label").hidden = names.length < 2;
  find("contour").addEventListener("change", (event) => {
    for (const path of contours) path.classList.toggle("other", named(path) !== event.target.value);
  }, until);
  for (const button of document.querySelectorAll(".go")) {
    button.addEventListener("click", () => {
      const wanted = Number(button.dataset.at);
      held(button.dataset.over === "relative" ? shaftAt(wanted) : wrapped(wanted));
    }, until);
  }

  document.addEventListener("keydown", (event) => {
    const on = event.target;
    const own = on.closest("select, button, summary, a, textarea") || (on.tagName === "INPUT" && on.id !== "slider");
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const step = ((event.shiftKey ? 10 : 1) * M) / 360;
    const keys = {
      " ": turned,
      ArrowLeft: () => held(at - step),
      ArrowRight: () => held(at + step),
      Home: () => held(0),
      End: () => held(M),
    };
    if (own || !(event.key in keys)) return;
    event.preventDefault();
    keys[event.key]();
  }, until);

  // drag the cam about its shaft, or along its travel
  let grip = null;
  const gripped = (event) => {
    const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(drawing.getScreenCTM().inverse());
    const x = point.x + scale * left;
    const y = point.y - scale * top;
    return closed ? (Math.atan2(-y, x) * 180) / Math.PI : x / scale;
  };
  for (const disk of drawing.querySelectorAll(".cam")) {
    disk.addEventListener("pointerdown", (event) => {
      grip = gripped(event);
      disk.setPointerCapture(event.pointerId);
      find("stage").classList.add("dragged");
      play(false);
      event.preventDefault();
    });
    disk.addEventListener("pointermove", (event) => {
      if (grip === null) return;
      const next = gripped(event);
      const step = closed ? ((next - grip + 540) % 360) - 180 : next - grip;
      grip = next;
      held(wrapped(at + data.sense * step));
    });
    for (const name of ["pointerup", "pointercancel"]) {
      disk.addEventListener(name, () => {
        grip = null;
        find("stage").classList.remove("dragged");
      });
    }
  }

  // --- begin --------------------------------------------------------------------------------------------------------

  function fit() {
    px = 1 / (drawing.getScreenCTM()?.a || 1);
    drawing.style.setProperty("--px", px.toFixed(4));
    for (const mark of marks) mark.setAttribute("r", ((5 * px) / scale).toPrecision(4));
    for (const plot of plots) plot.draw();
    show();
  }
  let width = 0;
  const observer = new ResizeObserver(() => {
    if (document.body.clientWidth === width) return;
    width = document.body.clientWidth;
    fit();
  });
  observer.observe(document.body);
  // what is folded up on a screen stands open on paper
  let folded = [];
  window.addEventListener("beforeprint", () => {
    folded = [...document.querySelectorAll("details:not([open])")];
    for (const one of folded) one.open = true;
    fit();
  }, until);
  window.addEventListener("afterprint", () => {
    for (const one of folded) one.open = false;
    fit();
  }, until);
  fit();
  // #deg=90 goes there and stands still, #deg=90&play turns on from there
  function addressed() {
    const place = /^#([a-z]+)=(-?[0-9.]+)(&play)?$/.exec(location.hash);
    if (!place || place[1] !== key) return false;
    turnTo(Number(place[2]));
    play(Boolean(place[3]));
    return true;
  }
  if (begin) {
    turnTo(begin.at);
    play(begin.playing);
  } else {
    window.addEventListener("hashchange", addressed, until);
  }
  if (!begin && !addressed()) play(!calm.matches);
  root.dataset.ready = "true";

  return () => {
    play(false);
    clearTimeout(later);
    ended.abort();
    observer.disconnect();
    for (const part of [rests, now, chosen, ring, find("contour")]) part.replaceChildren();
    find("plots").replaceChildren(rests);
  };
}
