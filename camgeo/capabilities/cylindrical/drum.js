// What turns with the page's player: the drum, its lines of contact, the roller on the development, the map's cursor.
// It returns what shows them at a share of the turn. Of a drum that is kept beside another, whose drawing is in `kept`,
// that is what stands on the blank.
function playDrum(data, kept = null) {
  const drum = (kept || document).querySelector("#drawing .drum");
  if (kept) for (const path of drum.querySelectorAll("path:not(.metal)")) path.remove();
  const paths = [...drum.querySelectorAll("path")];
  const arcs = [...document.querySelectorAll("#drawing .contacts path")];
  const cursor = document.querySelector("#map .cursor");
  const TURN = 2 * Math.PI;

  function unpacked(row) {
    if ("c" in row) return null;
    if ("n" in row) return row.n;
    const scale = 10 ** row.d;
    let sum = 0;
    return row.v.map((step) => (sum += step) / scale);
  }

  // a function of the share of a turn: straight between values, which close over the turn or have their end
  function along(row, count) {
    const v = unpacked(row);
    if (v === null) return () => row.c;
    return (share) => {
      const x = (share - Math.floor(share)) * count;
      const near = Math.round(x);
      if (Math.abs(x - near) < 1e-9) return v[near % v.length] ?? NaN; // at a value it counts alone
      const i = Math.floor(x);
      const [a, b] = [v[i % v.length], v[(i + 1) % v.length]];
      return a === null || b === null ? NaN : a + (x - i) * (b - a);
    };
  }

  const shells = data.shells.map((shell) => ({
    radius: shell.radius,
    bands: shell.bands.map((band) => band.map((row) => along(row, data.places))),
  }));
  const over = (rows) => Object.fromEntries(Object.entries(rows).map(([name, row]) => [name, along(row, data.parts)]));
  const lines = data.lines.map(over);
  const rollers = data.rollers.map(over);
  // none beyond those that it has: a picture comes before its development, beside that of another cam
  const developed = [...document.querySelectorAll("#development .roller-at")].slice(0, 3 * rollers.length);

  // outlines of the bands of a shell between two angles to the right of the viewer
  function seen(shell, turn, low, high, chords) {
    return shell.bands.flatMap((band) => {
      const found = []; // runs of places at which the band is
      let run = null;
      for (let k = 0; k <= chords; k++) {
        const psi = low + (high - low) * (chords ? k / chords : 0);
        const [x, bottom, top] = [shell.radius * Math.sin(psi), ...band.map((z) => z((psi + turn) / TURN))];
        if (!Number.isFinite(bottom + top)) {
          run = null;
          continue;
        }
        if (!run) found.push((run = [[], []]));
        run[0].push([x, bottom]);
        run[1].unshift([x, top]);
      }
      return found.map(([below, above]) => below.concat(above));
    });
  }

  const path = (points) => points.map(([x, y], i) => `${i ? "L" : "M"}${x.toFixed(data.digits)} ${y.toFixed(data.digits)}`).join("");
  const closed = (outlines) => outlines.map((points) => `${path(points)}Z`).join("");

  function far(shell, turn) {
    const beside = Math.PI - Math.asin(Math.min(data.core / shell.radius, 1));
    const ends = [[0.5 * Math.PI, beside], [TURN - beside, 1.5 * Math.PI]];
    return ends.flatMap(([low, high]) => seen(shell, turn, low, high, data.rim));
  }

  const near = (shell, turn) => seen(shell, turn, -0.5 * Math.PI, 0.5 * Math.PI, data.face);

  function rims(turn) {
    return [-0.5 * Math.PI, 0.5 * Math.PI].flatMap((at) => {
      const ends = shells.map((shell) => seen(shell, turn, at, at, 0));
      if (ends.some((end) => end.length !== ends[0].length)) return []; // beside the point of a band
      for (const end of ends) end.sort((a, b) => a[0][1] - b[0][1]);
      return ends[0].map((_, band) => ends.map((end) => end[band][0]).concat(ends.map((end) => end[band].at(-1)).reverse()));
    });
  }

  function showKept(share) {
    paths[0].setAttribute("d", closed(near(shells.at(-1), data.sense * share * data.turns * TURN)));
  }
  if (kept) return showKept;

  function show(share) {
    const turn = data.sense * share * data.turns * TURN;
    const n = shells.length;
    shells.forEach((shell, k) => {
      paths[n - 1 - k].setAttribute("d", closed(far(shell, turn)));
      paths[k < n - 1 ? n + 1 + k : 2 * n + 1].setAttribute("d", closed(near(shell, turn)));
    });
    paths[2 * n].setAttribute("d", closed(rims(turn)));
    lines.forEach((line, i) => {
      const [low, high, near, far] = [line.low(share), line.high(share), line.near(share), line.far(share)];
      const place = (_, k) => {
        const [a, reach] = [low + ((high - low) * k) / 12, near + ((far - near) * k) / 12];
        return [-data.sense * reach * Math.sin(a), reach * Math.cos(a)];
      };
      arcs[i].setAttribute("d", Number.isFinite(low) ? path(Array.from({ length: 13 }, place)) : "");
    });
    const [scale, width, height, left, top] = data.flat;
    const own = (share * data.turns) % 1;
    const at = data.sense > 0 ? own : 1 - own;
    developed.forEach((group, i) => {
      const roller = rollers[Math.floor(i / 3)];
      const x = left + width * (at + data.sense * roller.beside(share) + (i % 3) - 1);
      const turned = roller.turn ? ` rotate(${(-roller.turn(share)).toFixed(2)})` : "";
      group.setAttribute("transform", `translate(${x.toFixed(2)} ${(top + height - scale * roller.z(share)).toFixed(2)})${turned}`);
    });
    cursor?.setAttribute("transform", `translate(${(data.map[0] + data.map[1] * share).toFixed(2)} 0)`);
  }

  // the drum is dragged round as its near side goes
  let grip = null;
  drum.addEventListener("pointerdown", (event) => {
    grip = event.clientX;
    drum.setPointerCapture(event.pointerId);
    event.preventDefault();
  });
  drum.addEventListener("pointermove", (event) => {
    if (grip === null) return;
    const radius = shells.at(-1).radius * drum.getScreenCTM().a;
    const next = Number(document.documentElement.dataset.at) - (data.sense * (event.clientX - grip) * 180) / (Math.PI * radius);
    grip = event.clientX;
    const slider = document.getElementById("slider");
    const whole = 360 * data.turns;
    slider.value = ((next % whole) + whole) % whole;
    slider.dispatchEvent(new Event("input"));
  });
  for (const name of ["pointerup", "pointercancel"]) drum.addEventListener(name, () => (grip = null));
  return show;
}
