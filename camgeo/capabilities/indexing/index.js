// What turns with the page's player: the cam, and the rollers on the development. It returns what shows them at a share
// of the turn. Of a cam that is kept beside another, whose drawing is in `kept`, that is the rib on the blank.
function playIndexer(data, kept = null) {
  const cam = (kept || document).querySelector("#drawing .indexer");
  if (kept) for (const path of cam.querySelectorAll("path:not(.metal)")) path.remove();
  const paths = [...cam.querySelectorAll("path")];
  const lines = [...document.querySelectorAll("#drawing .contacts path")];
  const TURN = 2 * Math.PI;
  const HALF = 0.5 * Math.PI;
  const { sense, places, length, upright } = data;

  function unpacked(row) {
    if ("c" in row) return null;
    if ("n" in row) return row.n;
    const scale = 10 ** row.d;
    let sum = 0;
    return row.v.map((step) => (sum += step) / scale);
  }

  // a function that is straight between values at whole numbers
  function along(row) {
    const v = unpacked(row);
    if (v === null) return () => row.c;
    return (x) => {
      const i = Math.min(Math.max(Math.floor(x), 0), v.length - 2);
      if (v[i] === null || v[i + 1] === null) return NaN; // there is none
      return v[i] + Math.min(Math.max(x - i, 0), 1) * (v[i + 1] - v[i]);
    };
  }

  const layers = data.layers.map(({ radius, first, last, bottom, top, share }) => {
    const [out, low, high] = [along(radius), along(bottom), along(top)];
    return {
      first,
      last,
      share,
      out: (z) => out((z * data.rise) / length),
      bottom: (place) => low(place - first),
      top: (place) => high(place - first),
    };
  });
  const contacts = data.contacts.map((own) => own.map((line) => line.map(along)));
  const rollers = data.rollers.map(({ beside, z }) => ({ beside: along(beside), z: along(z) }));
  // none beyond those that it has: a picture comes before its development, beside that of another cam
  const developed = [...document.querySelectorAll("#development .roller-at")].slice(0, 3 * rollers.length);
  const scale = places / TURN;

  // whole turns in which the rib passes between two places, and between which places of the unrolled turn
  function spans(layer, low, high) {
    const found = [];
    const most = Math.ceil((layer.last - low) / places);
    for (let turn = Math.floor((layer.first - high) / places); turn <= most; turn++) {
      const begin = Math.max(low + turn * places, layer.first);
      const end = Math.min(high + turn * places, layer.last);
      if (end > begin || (low === high && end === begin)) found.push([turn, begin, end]);
    }
    return found;
  }

  const steps = (begin, end, from, to) =>
    Array.from({ length: to - from }, (_, k) => begin + ((end - begin) * (from + k)) / upright);

  // outlines of the rib in a layer between two angles to the right of the viewer
  function seen(layer, turn, low, high) {
    const [from, to] = [turn + sense * low, turn + sense * high].sort((a, b) => a - b);
    return spans(layer, from * scale, to * scale).map(([whole, begin, end]) => {
      const at = [begin];
      for (let place = Math.floor(begin) + 1; place < Math.ceil(end); place++) at.push(place);
      at.push(end);
      const below = at.map((place) => [place, layer.bottom(place)]);
      const above = at.map((place) => [place, layer.top(place)]).reverse();
      const right = steps(below.at(-1)[1], above[0][1], 1, upright).map((z) => [end, z]);
      const left = steps(above.at(-1)[1], below[0][1], 1, upright).map((z) => [begin, z]);
      return [...below, ...right, ...above, ...left].map(([place, z]) => [
        layer.out(z) * Math.sin(sense * ((place - whole * places) / scale - turn)),
        z,
      ]);
    });
  }

  const near = (layer, turn) => seen(layer, turn, -HALF, HALF);

  function far(layer, turn) {
    const edge = Math.PI - Math.asin(Math.min(layer.share, 1));
    return [...seen(layer, turn, HALF, edge), ...seen(layer, turn, -edge, -HALF)];
  }

  function rims(turn) {
    return [-1, 1].flatMap((side) => {
      const at = (turn + sense * side * HALF) * scale;
      const turns = layers.map((layer) => spans(layer, at, at).map(([whole]) => whole));
      const common = turns[0].filter((whole) => turns.every((own) => own.includes(whole)));
      return common.map((whole) => {
        const [bottom, top] = ["bottom", "top"].map((name) => layers.map((layer) => layer[name](at + whole * places)));
        const points = (heights, own = null) => heights.map((z, k) => [side * (own || layers[k]).out(z), z]);
        const outer = steps(bottom.at(-1), top.at(-1), 0, upright + 1);
        const inner = steps(top[0], bottom[0], 0, upright + 1);
        return [...points(bottom), ...points(outer, layers.at(-1)), ...points(top).reverse(), ...points(inner, layers[0])];
      });
    });
  }

  const path = (points) => points.map(([x, y], i) => `${i ? "L" : "M"}${x.toFixed(data.digits)} ${y.toFixed(data.digits)}`).join("");
  const closed = (outlines) => outlines.map((points) => `${path(points)}Z`).join("");
  const faced = (share) => share * TURN + sense * data.facing;

  function showKept(share) {
    paths[0].setAttribute("d", closed(near(layers.at(-1), faced(share))));
  }
  if (kept) return showKept;

  function show(share) {
    const turn = faced(share);
    const n = layers.length;
    layers.forEach((layer, k) => {
      paths[n - 1 - k].setAttribute("d", closed(far(layer, turn)));
      paths[k < n - 1 ? n + 1 + k : 2 * n + 1].setAttribute("d", closed(near(layer, turn)));
    });
    paths[2 * n].setAttribute("d", closed(rims(turn)));
    contacts.forEach((own, k) => {
      const ends = own.map((line) => line.map((value) => value(share * data.parts)));
      const there = ends.filter((line) => line.every(Number.isFinite));
      lines[k].setAttribute("d", there.map(([x, y, x1, y1]) => path([[x, y], [x1, y1]])).join(""));
    });
    const [px, width, height, left, top] = data.flat;
    developed.forEach((group, i) => {
      const roller = rollers[Math.floor(i / 3)];
      const own = share + roller.beside(share * data.parts);
      const x = left + width * ((sense > 0 ? own : 1 - own) + (i % 3) - 1);
      group.setAttribute("transform", `translate(${x.toFixed(2)} ${(top + height - px * roller.z(share * data.parts)).toFixed(2)})`);
    });
  }

  // the cam is dragged round as its near side goes
  let grip = null;
  cam.addEventListener("pointerdown", (event) => {
    grip = event.clientX;
    cam.setPointerCapture(event.pointerId);
    event.preventDefault();
  });
  cam.addEventListener("pointermove", (event) => {
    if (grip === null) return;
    const radius = layers.at(-1).out(0) * cam.getScreenCTM().a;
    const next = Number(document.documentElement.dataset.at) - (sense * (event.clientX - grip) * 180) / (Math.PI * radius);
    grip = event.clientX;
    const slider = document.getElementById("slider");
    slider.value = ((next % 360) + 360) % 360;
    slider.dispatchEvent(new Event("input"));
  });
  for (const name of ["pointerup", "pointercancel"]) cam.addEventListener(name, () => (grip = null));
  return show;
}
