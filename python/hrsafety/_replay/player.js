"use strict";
(() => {
  const $ = (id) => document.getElementById(id);
  const ABSENT = -32768, MOST = 32767;
  const ROBOTS = ["#0072B2", "#007A59", "#A04A86", "#000000", "#2A7FB8"];
  const KINDS = ["#D55E00", "#E69F00", "#CC79A7", "#6B3E00", "#882255", "#6A8030"];
  const VERDICT = ["#8c959f", "#1a7f37", "#d9a800", "#0757a8", "#b42318"];
  const SHAPES = ["M3 9h14v2H3z", "M10 2a8 8 0 100 16 8 8 0 000-16z", "M10 2l9 16H1z", "M10 1l9 9-9 9-9-9z", "M6 1h8l5 5v8l-5 5H6l-5-5V6z"];
  const WALL = "#3a3f46", GOAL = "#00795C", EXPECTED = "#6a3d9a", CONTACT = "#c00000", SCAN = "#1aa7ff", INK = "#1b1f24";
  const CELLS = [[0, 0, 0, 0], [255, 255, 255, 255], [95, 116, 143, 255], [230, 140, 60, 110]];
  const tint = ([red, green, blue, alpha]) => `rgba(${red},${green},${blue},${alpha / 255})`;
  const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
  const head = JSON.parse($("head").textContent);
  const data = {}, body = document.body;
  let time = 0, frame = 0, playing = false, last = 0, pace = 1, chosen = 0, follow = false, labels = false, shown = true, dirty = true;
  const view = { x: 0, y: 0, scale: 1, fitted: true };

  // ---- numbers ------------------------------------------------------------------------------

  async function unpacked(node) {
    const text = atob(node.textContent), packed = new Uint8Array(text.length);
    for (let i = 0; i < text.length; i++) packed[i] = text.charCodeAt(i);
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
    const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
    const rows = +node.dataset.rows, columns = +node.dataset.columns, kind = node.dataset.kind, many = rows * columns;
    const wide = kind !== "u8", mask = wide ? 0xffff : 0xff;
    if (bytes.length !== many * (wide ? 2 : 1)) throw new Error("the numbers of " + node.id + " are damaged");
    const values = kind === "i16" ? new Int16Array(many) : wide ? new Uint16Array(many) : new Uint8Array(many);
    for (let c = 0, k = 0; c < columns; c++) {
      for (let r = 0, sum = 0; r < rows; r++, k++) {
        sum = (sum + bytes[k] + (wide ? bytes[many + k] << 8 : 0)) & mask;
        values[r * columns + c] = sum;
      }
    }
    return { rows, columns, values };
  }

  const at = (name, row, column) => (data[name] ? data[name].values[row * data[name].columns + column] : ABSENT);
  const times = [];
  const end = () => times[times.length - 1];
  const meters = (name, value, axis) => { const scale = name === "people" ? head.people : head.own; return value * scale[0] + scale[1 + axis]; };

  function frameAt(instant) {
    let low = 0, high = times.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (times[middle] <= instant + 1e-7) low = middle; else high = middle - 1;
    }
    return low;
  }

  // Straight between two frames, but never over a gap or a jump.
  function place(name, who, row = frame, now = time) {
    const x = at(name, row, 2 * who), y = at(name, row, 2 * who + 1);
    if (x === ABSENT) return null;
    const here = [meters(name, x, 0), meters(name, y, 1)];
    if (row + 1 >= times.length || now <= times[row]) return here;
    const nextX = at(name, row + 1, 2 * who), span = times[row + 1] - times[row];
    if (nextX === ABSENT || span > 2) return here;
    const next = [meters(name, nextX, 0), meters(name, at(name, row + 1, 2 * who + 1), 1)];
    const way = Math.hypot(next[0] - here[0], next[1] - here[1]);
    if (way > Math.max(0.5, 12 * span)) return here;
    const share = (now - times[row]) / span;
    return [here[0] + share * (next[0] - here[0]), here[1] + share * (next[1] - here[1])];
  }

  const metric = (name, row) => {
    const value = at(name + chosen, row, 0);
    return value === ABSENT ? NaN : value >= MOST ? Infinity : value / 1000;
  };
  const words = (value, unit) => (Number.isNaN(value) ? "not known" : value === Infinity ? "nobody near" : value.toFixed(2) + " " + unit);
  const unjudged = (now) => head.notJudged.find(([from, to]) => from <= now + 1e-9 && now <= to + 1e-9);

  // ---- floor --------------------------------------------------------------------------------

  const floor = $("floor"), pen = floor.getContext("2d");
  let wide = 1, high = 1, dense = 1, hatch = null;
  const grids = [];
  const sx = (x) => wide / 2 + (x - view.x) * view.scale;
  const sy = (y) => high / 2 - (y - view.y) * view.scale;

  function hatching(color, back) {
    const tile = document.createElement("canvas"), ink = tile.getContext("2d");
    tile.width = tile.height = 10;
    ink.fillStyle = back;
    ink.fillRect(0, 0, 10, 10);
    ink.strokeStyle = color;
    ink.lineWidth = 1.2;
    ink.beginPath();
    for (const shift of [-10, 0, 10]) { ink.moveTo(shift, 10); ink.lineTo(shift + 10, 0); }
    ink.stroke();
    return pen.createPattern(tile, "repeat");
  }

  function makeGrids() {
    head.ground.grids.forEach(([rows, columns], k) => {
      const cells = data["grid" + k].values;
      const solid = document.createElement("canvas"), unseen = document.createElement("canvas");
      for (const [sheet, what, color] of [[solid, 1, [58, 63, 70]], [unseen, 2, [0, 0, 0]]]) {
        sheet.width = columns;
        sheet.height = rows;
        const ink = sheet.getContext("2d"), picture = ink.createImageData(columns, rows);
        for (let r = 0; r < rows; r++) {
          for (let c = 0; c < columns; c++) {
            if (cells[r * columns + c] === what) picture.data.set([...color, 255], 4 * ((rows - 1 - r) * columns + c));
          }
        }
        ink.putImageData(picture, 0, 0);
      }
      grids.push({ solid, unseen });
    });
  }

  function inGrid([rows, columns, side, x, y, yaw], paint) {
    pen.save();
    pen.translate(sx(x), sy(y));
    pen.rotate(-yaw);
    pen.scale(view.scale * side, view.scale * side);
    paint(columns, rows);
    pen.restore();
  }

  let layer = null;
  // Hatches the floor where something is painted on a sheet as large as it.
  function hatched(painted) {
    layer = layer || document.createElement("canvas");
    layer.width = floor.width;
    layer.height = floor.height;
    const own = layer.getContext("2d"), kept = pen;
    own.setTransform(dense, 0, 0, dense, 0, 0);
    own.imageSmoothingEnabled = false;
    painted(own, (grid, work) => {
      own.save();
      own.translate(sx(grid[3]), sy(grid[4]));
      own.rotate(-grid[5]);
      own.scale(view.scale * grid[2], view.scale * grid[2]);
      work(grid[1], grid[0]);
      own.restore();
    });
    own.globalCompositeOperation = "source-in";
    own.fillStyle = hatch;
    own.fillRect(0, 0, wide, high);
    own.globalCompositeOperation = "source-over";
    kept.save();
    kept.setTransform(1, 0, 0, 1, 0, 0);
    kept.drawImage(layer, 0, 0);
    kept.restore();
  }

  function unknownGround() {
    const all = head.ground.grids;
    if (!all.length) return;
    // Everywhere that nobody has seen: outside of the grids, and cells within them.
    hatched((own, paint) => {
      if (all.some((grid) => grid[6])) {
        own.fillRect(0, 0, wide, high);
        own.globalCompositeOperation = "destination-out";
        for (const grid of all) paint(grid, (columns, rows) => own.fillRect(0, -rows, columns, rows));
        own.globalCompositeOperation = "source-over";
      }
      all.forEach((grid, k) => paint(grid, (columns, rows) => own.drawImage(grids[k].unseen, 0, -rows, columns, rows)));
    });
  }

  // The cells of a robot at the frame, as a sheet: changes since the frame that it shows, from the first one to go back.
  const sheets = [];
  function cellsNow(k) {
    const { grid: [rows, columns] } = head.robots[k].cells, { values, rows: many } = data["cells" + k];
    if (!sheets[k]) {
      const sheet = document.createElement("canvas");
      sheet.width = columns;
      sheet.height = rows;
      const ink = sheet.getContext("2d"), picture = ink.createImageData(columns, rows);
      sheets[k] = { sheet, ink, picture, pixels: new Uint32Array(picture.data.buffer), colors: new Uint32Array(new Uint8Array(CELLS.flat()).buffer), frame: -1 };
    }
    const own = sheets[k];
    if (own.frame === frame) return own.sheet;
    if (own.frame < 0 || frame < own.frame) { own.pixels.fill(0); own.next = own.reached = 0; }
    own.frame = frame;
    for (let i = 5 * own.next; own.next < many && own.reached + values[i] <= frame; i += 5, own.next++) {
      const from = (rows - 1 - values[i + 1]) * columns + values[i + 2];
      own.reached += values[i];
      own.pixels.fill(own.colors[values[i + 4]], from, from + values[i + 3]);
    }
    own.ink.putImageData(own.picture, 0, 0);
    return own.sheet;
  }

  // What the law of the chosen robot knows of the floor; nothing at frames at which that was not recorded.
  function knownCells() {
    const { cells } = head.robots[chosen] || {};
    if (!shown || !cells || frame < cells.begin) return;
    const sheet = cellsNow(chosen);
    pen.imageSmoothingEnabled = false;
    inGrid(cells.grid, (columns, rows) => pen.drawImage(sheet, 0, -rows, columns, rows));
    if (cells.belief) {
      // Anybody can be outside, and come in.
      const [rows, columns, side, x, y] = cells.grid;
      pen.beginPath();
      pen.rect(0, 0, wide, high);
      pen.rect(sx(x), sy(y), columns * side * view.scale, -rows * side * view.scale);
      pen.fillStyle = tint(CELLS[3]);
      pen.fill("evenodd");
    } else {
      hatched((own, paint) => {
        own.fillRect(0, 0, wide, high);
        own.globalCompositeOperation = "destination-out";
        paint(cells.grid, (columns, rows) => own.drawImage(sheet, 0, -rows, columns, rows));
      });
    }
  }

  function lines() {
    const steps = [0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 1e4, 1e5];
    const step = steps.find((each) => each * view.scale >= 56) || 1e6;
    pen.strokeStyle = "#e4e8ec";
    pen.lineWidth = 1;
    pen.beginPath();
    for (let x = Math.ceil((view.x - wide / 2 / view.scale) / step) * step; sx(x) < wide; x += step) { pen.moveTo(sx(x), 0); pen.lineTo(sx(x), high); }
    for (let y = Math.ceil((view.y - high / 2 / view.scale) / step) * step; sy(y) > 0; y += step) { pen.moveTo(0, sy(y)); pen.lineTo(wide, sy(y)); }
    pen.stroke();
    return step;
  }

  function bar(step) {
    const long = step * view.scale, x = 12, y = high - 14;
    pen.fillStyle = "rgba(255,255,255,.85)";
    pen.fillRect(x - 6, y - 20, long + 12, 28);
    pen.strokeStyle = pen.fillStyle = INK;
    pen.lineWidth = 1.5;
    pen.beginPath();
    pen.moveTo(x, y - 5); pen.lineTo(x, y); pen.lineTo(x + long, y); pen.lineTo(x + long, y - 5);
    pen.stroke();
    pen.font = "12px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.textBaseline = "bottom";
    pen.fillText(step + " m", x + long / 2, y - 3);
  }

  function polyline(points, close) {
    pen.beginPath();
    points.forEach(([x, y], k) => (k ? pen.lineTo(sx(x), sy(y)) : pen.moveTo(sx(x), sy(y))));
    if (close) pen.closePath();
  }

  function disc(x, y, radius, least = 0.5) {
    pen.beginPath();
    pen.arc(sx(x), sy(y), Math.max(radius * view.scale, least), 0, 2 * Math.PI);
  }

  function solids() {
    pen.fillStyle = pen.strokeStyle = WALL;
    pen.lineCap = pen.lineJoin = "round";
    head.ground.polygons.forEach((outline) => { polyline(outline, true); pen.fill(); });
    head.ground.discs.forEach(([x, y, radius]) => { disc(x, y, radius); pen.fill(); });
    head.ground.walls.forEach(([points, radius]) => { polyline(points); pen.lineWidth = Math.max(2 * radius * view.scale, 2.5); pen.stroke(); });
    pen.imageSmoothingEnabled = false;
    head.ground.grids.forEach((grid, k) => inGrid(grid, (columns, rows) => pen.drawImage(grids[k].solid, 0, -rows, columns, rows)));
  }

  function ragged(name, k, row) {
    const lengths = data[name + "Length" + k];
    if (!lengths) return [];
    lengths.starts = lengths.starts || lengths.values.reduce((found, many) => (found.push(found[found.length - 1] + many), found), [0]);
    const line = [];
    for (let i = lengths.starts[row]; i < lengths.starts[row + 1]; i++) {
      if (at(name + k, i, 0) !== ABSENT) line.push([meters(name, at(name + k, i, 0), 0), meters(name, at(name + k, i, 1), 1)]);
    }
    return line;
  }

  function decided(k) {
    const robot = head.robots[k], row = frame, color = VERDICT[at("verdict" + k, row, 0)];
    const path = ragged("path", k, row), plan = ragged("plan", k, row), way = ragged("way", k, row);
    ragged("expected", k, row).forEach(([x, y]) => { disc(x, y, 2.5 / view.scale); pen.fillStyle = EXPECTED; pen.fill(); });
    if (way.length > 1) {
      polyline(way);
      pen.setLineDash([2, 4]);
      pen.lineWidth = 2.5;
      pen.strokeStyle = EXPECTED;
      pen.stroke();
      pen.setLineDash([]);
    }
    if (path.length > 1) {
      polyline(path);
      pen.setLineDash([7, 5]);
      pen.lineWidth = 2;
      pen.strokeStyle = GOAL;
      pen.stroke();
      pen.setLineDash([]);
    }
    if (data["reach" + k]) {
      for (let who = 0; who < head.radius.length; who++) {
        const reach = at("reach" + k, row, who), where = reach > 0 && reach < MOST ? place("people", who) : null;
        if (!where) continue;
        disc(where[0], where[1], head.radius[who] + reach / 100);
        pen.fillStyle = "rgba(213,94,0,.07)";
        pen.fill();
        pen.setLineDash([4, 4]);
        pen.lineWidth = 1;
        pen.strokeStyle = "rgba(170,70,0,.75)";
        pen.stroke();
        pen.setLineDash([]);
      }
    }
    if (plan.length) {
      const line = plan.length > 1 ? plan : [plan[0], plan[0]];
      pen.lineCap = pen.lineJoin = "round";
      pen.globalAlpha = 0.28;
      pen.strokeStyle = color;
      polyline(line);
      pen.lineWidth = 2 * robot.radius * view.scale;
      pen.stroke();
      pen.globalAlpha = 1;
      polyline(line);
      pen.lineWidth = 1.6;
      pen.stroke();
    }
  }

  function trail(name, who, seconds, color, width) {
    pen.beginPath();
    let down = false;
    for (let row = frameAt(Math.max(time - seconds, times[0])); row <= frame; row++) {
      const here = place(name, who, row, times[row]);
      if (!here) { down = false; continue; }
      if (down) pen.lineTo(sx(here[0]), sy(here[1])); else pen.moveTo(sx(here[0]), sy(here[1]));
      down = true;
    }
    const now = place(name, who);
    if (now && down) pen.lineTo(sx(now[0]), sy(now[1]));
    pen.strokeStyle = color;
    pen.lineWidth = width;
    pen.stroke();
  }

  function direction(name, who) {
    const from = Math.max(0, frame - 2), until = Math.min(times.length - 1, frame + 2);
    const first = place(name, who, from, times[from]), second = place(name, who, until, times[until]);
    if (!first || !second) return null;
    const x = second[0] - first[0], y = second[1] - first[1], way = Math.hypot(x, y);
    return way > 0.05 * Math.max(times[until] - times[from], 1e-3) && way < 12 * (times[until] - times[from]) + 0.5 ? Math.atan2(y, x) : null;
  }

  function nose(x, y, radius, angle, color) {
    const size = radius * view.scale;
    if (size < 4) return;
    pen.beginPath();
    for (const [turn, share] of [[0, 0.8], [2.5, 0.5], [-2.5, 0.5]]) {
      const px = sx(x) + share * size * Math.cos(angle + turn), py = sy(y) - share * size * Math.sin(angle + turn);
      if (turn) pen.lineTo(px, py); else pen.moveTo(px, py);
    }
    pen.closePath();
    pen.fillStyle = color;
    pen.fill();
  }

  function name(text, x, y, away) {
    pen.font = "600 12px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.textBaseline = "bottom";
    pen.lineWidth = 3.5;
    pen.lineJoin = "round";
    pen.strokeStyle = "rgba(255,255,255,.92)";
    pen.strokeText(text, sx(x), sy(y) - away);
    pen.fillStyle = INK;
    pen.fillText(text, sx(x), sy(y) - away);
  }

  function box(x, y, [long, broad, angle]) {
    const c = Math.cos(angle), s = Math.sin(angle);
    polyline([[1, 1], [-1, 1], [-1, -1], [1, -1]].map(([a, b]) => [x + (c * a * long - s * b * broad) / 2, y + (s * a * long + c * b * broad) / 2]), true);
  }

  function people() {
    const many = head.radius.length;
    if (many <= 150) for (let who = 0; who < many; who++) if (place("people", who)) trail("people", who, 2, KINDS[head.kind[who] % KINDS.length] + "66", 1.5);
    for (let who = 0; who < many; who++) {
      const here = place("people", who);
      if (!here) continue;
      const [x, y] = here, radius = head.radius[who], color = KINDS[head.kind[who] % KINDS.length];
      if (head.boxes[who]) box(x, y, head.boxes[who]); else disc(x, y, radius, 2.5);
      pen.fillStyle = color;
      pen.fill();
      if (radius * view.scale > 4) {
        pen.lineWidth = 1.2;
        pen.strokeStyle = "#fff";
        pen.stroke();
      }
      const angle = head.boxes[who] ? null : direction("people", who);
      if (angle !== null) nose(x, y, radius, angle, "rgba(255,255,255,.9)");
      if (labels) name(head.names[who], x, y, radius * view.scale + 2);
    }
  }

  function scans() {
    head.robots.forEach((robot, k) => {
      const here = place("robots", k), turned = at("heading" + k, frame, 0);
      if (!here || !robot.beams.length) return;
      pen.fillStyle = SCAN;
      robot.beams.forEach((angle, beam) => {
        const range = at("scan" + k, frame, beam), toward = angle + (turned === ABSENT ? 0 : turned / 1e4);
        if (range !== ABSENT) pen.fillRect(sx(here[0] + (range / 500) * Math.cos(toward)) - 2, sy(here[1] + (range / 500) * Math.sin(toward)) - 2, 4, 4);
      });
    });
  }

  function robots() {
    head.robots.forEach((robot, k) => {
      const color = ROBOTS[k % ROBOTS.length], here = place("robots", k);
      trail("robots", k, Infinity, color + "b0", 2);
      if (!here) return;
      const [x, y] = here, turned = at("heading" + k, frame, 0), angle = turned === ABSENT ? null : turned / 1e4;
      if (robot.footprint.length) {
        const c = Math.cos(angle || 0), s = Math.sin(angle || 0);
        polyline(robot.footprint.map(([a, b]) => [x + c * a - s * b, y + s * a + c * b]), true);
      } else disc(x, y, robot.radius, 4);
      pen.fillStyle = color;
      pen.fill();
      pen.lineWidth = 2;
      pen.strokeStyle = "#fff";
      pen.stroke();
      const look = angle === null ? direction("robots", k) : angle;
      if (look !== null) nose(x, y, (robot.footprint.length ? 0.45 : 1) * robot.radius, look, "#fff");
      if (robot.decided) {
        disc(x, y, robot.radius + 5 / view.scale, 8);
        pen.lineWidth = 3;
        pen.strokeStyle = VERDICT[at("verdict" + k, frame, 0)];
        pen.stroke();
      }
      if (labels || head.robots.length > 1) name(robot.name, x, y, robot.radius * view.scale + 8);
    });
  }

  function star(x, y, size) {
    pen.beginPath();
    for (let k = 0; k < 10; k++) {
      const angle = -Math.PI / 2 + (k * Math.PI) / 5, far = k % 2 ? 0.45 * size : size;
      pen.lineTo(x + far * Math.cos(angle), y + far * Math.sin(angle));
    }
    pen.closePath();
  }

  function goals() {
    head.robots.forEach((robot) => {
      if (!robot.goal) return;
      const [x, y] = robot.goal;
      disc(x, y, robot.tolerance);
      pen.fillStyle = "rgba(0,121,92,.2)";
      pen.fill();
      star(sx(x), sy(y), 9);
      pen.fillStyle = GOAL;
      pen.fill();
      pen.lineWidth = 1.2;
      pen.strokeStyle = "#fff";
      pen.stroke();
    });
  }

  function cross(ink, x, y, size, color) {
    for (const [width, tone] of [[5.5, "#fff"], [3, color]]) {
      ink.beginPath();
      ink.moveTo(x - size, y - size); ink.lineTo(x + size, y + size);
      ink.moveTo(x - size, y + size); ink.lineTo(x + size, y - size);
      ink.lineWidth = width;
      ink.lineCap = "round";
      ink.strokeStyle = tone;
      ink.stroke();
    }
  }

  const isContact = (kind) => kind === "contact" || kind === "fault";
  function contacts() {
    for (const [when, kind, , where] of head.events) {
      if (!isContact(kind) || !where || when > time + 1e-6) continue;
      cross(pen, sx(where[0]), sy(where[1]), 6, CONTACT);
      if (time - when < 1) {
        pen.beginPath();
        pen.arc(sx(where[0]), sy(where[1]), 20, 0, 2 * Math.PI);
        pen.lineWidth = 3;
        pen.strokeStyle = CONTACT;
        pen.stroke();
      }
    }
  }

  function draw() {
    if (follow && head.robots.length) {
      const here = place("robots", chosen);
      if (here) [view.x, view.y] = here;
    }
    pen.setTransform(dense, 0, 0, dense, 0, 0);
    pen.fillStyle = "#fff";
    pen.fillRect(0, 0, wide, high);
    knownCells();
    const step = lines();
    unknownGround();
    goals();
    head.robots.forEach((robot, k) => { if (robot.decided || robot.cells) decided(k); });
    solids();
    scans();
    people();
    robots();
    contacts();
    bar(step);
  }

  // ---- time strip ---------------------------------------------------------------------------

  const strip = $("strip"), brush = strip.getContext("2d");
  let band = null;
  const stripX = (now) => 8 + ((now - times[0]) / Math.max(end() - times[0], 1e-9)) * (strip.width / dense - 16);

  function makeBand() {
    band = document.createElement("canvas");
    band.width = strip.width;
    band.height = strip.height;
    const ink = band.getContext("2d"), w = strip.width / dense, h = strip.height / dense;
    ink.setTransform(dense, 0, 0, dense, 0, 0);
    ink.fillStyle = "#f3f5f7";
    ink.fillRect(0, 0, w, h);
    const robot = head.robots[chosen];
    if (robot && robot.decided) {
      for (let row = 0; row < times.length; row++) {
        const code = at("verdict" + chosen, row, 0), tall = [3, 5, 12, 12, 20][code];
        ink.fillStyle = VERDICT[code];
        ink.fillRect(stripX(times[row]), h - tall, stripX(times[Math.min(row + 1, times.length - 1)]) - stripX(times[row]) + 1, tall);
      }
    }
    for (const [from, to] of head.notJudged) {
      ink.fillStyle = hatch;
      ink.fillRect(stripX(Math.max(from, times[0])), 0, Math.max(stripX(Math.min(to, end())) - stripX(Math.max(from, times[0])), 3), h);
    }
    if (robot && data["clearance" + chosen]) {
      const top = 18, low = h - 24, reach = 2, y = (value) => low - (Math.max(Math.min(value, reach), -0.2) / reach) * (low - top);
      ink.strokeStyle = "#8c959f";
      ink.lineWidth = 1;
      ink.setLineDash([3, 3]);
      ink.beginPath();
      ink.moveTo(8, y(0)); ink.lineTo(w - 8, y(0));
      ink.stroke();
      ink.setLineDash([]);
      ink.beginPath();
      let down = false;
      for (let row = 0; row < times.length; row++) {
        const value = metric("clearance", row);
        if (Number.isNaN(value)) { down = false; continue; }
        if (down) ink.lineTo(stripX(times[row]), y(value)); else ink.moveTo(stripX(times[row]), y(value));
        down = true;
      }
      ink.strokeStyle = ROBOTS[chosen % ROBOTS.length];
      ink.lineWidth = 1.8;
      ink.lineJoin = "round";
      ink.stroke();
      ink.font = "11px system-ui, sans-serif";
      ink.fillStyle = "#57606a";
      ink.textBaseline = "top";
      ink.fillText("clearance, 0 to 2 m and more", 10, 3);
    }
    for (const [when, kind] of head.events) {
      const x = stripX(when);
      if (isContact(kind)) cross(ink, x, 12, 4, CONTACT);
      else {
        ink.fillStyle = kind === "arrival" ? GOAL : "#57606a";
        ink.beginPath();
        ink.moveTo(x - 5, 4); ink.lineTo(x + 5, 4); ink.lineTo(x, 13);
        ink.closePath();
        ink.fill();
      }
    }
  }

  function drawStrip() {
    if (!band) makeBand();
    brush.setTransform(1, 0, 0, 1, 0, 0);
    brush.drawImage(band, 0, 0);
    brush.setTransform(dense, 0, 0, dense, 0, 0);
    brush.fillStyle = INK;
    brush.fillRect(stripX(time) - 1, 0, 2, strip.height / dense);
  }

  // ---- words --------------------------------------------------------------------------------

  function list(node, rows) {
    const key = JSON.stringify(rows);
    if (node.dataset.key === key) return;
    node.dataset.key = key;
    node.replaceChildren(...rows.flatMap(([term, value, bad]) => {
      const first = document.createElement("dt"), second = document.createElement("dd");
      first.textContent = term;
      second.textContent = value;
      if (bad) second.className = "bad";
      return [first, second];
    }));
  }

  function tell() {
    const robot = head.robots[chosen], rows = [];
    let present = 0, said = "not recorded";
    for (let who = 0; who < head.radius.length; who++) if (at("people", frame, 2 * who) !== ABSENT) present++;
    if (robot) {
      const here = place("robots", chosen), gap = metric("clearance", frame);
      if (data["speed" + chosen]) rows.push(["Speed", words(metric("speed", frame), "m/s")]);
      if (data["clearance" + chosen]) rows.push(["Clearance", unjudged(time) ? "not judged" : words(gap, "m"), gap < 0]);
      if (robot.decided) rows.push(["Shield's margin", words(metric("margin", frame), "m")]);
      if (!here) rows.push(["Robot", "position not known", true]);
      if (robot.cells && frame < robot.cells.begin) rows.push([robot.cells.belief ? "Belief" : "Map", "not recorded"]);
      body.dataset.robot = here ? here.map((each) => (Math.round(each * 1000) / 1000 + 0).toFixed(3)).join(",") : "";
      const code = robot.decided ? at("verdict" + chosen, frame, 0) : 0;
      said = head.verdicts[code];
      $("verdict").className = "v" + code;
      $("shape").setAttribute("d", SHAPES[code]);
      $("word").textContent = !code ? "No verdict recorded" : code === 3 ? "Taken over" : "Shield: " + said;
    }
    if (head.radius.length) rows.push([head.kinds.every((kind) => /person/.test(kind)) ? "People" : "Others", String(present)]);
    list($("state"), rows);
    const part = unjudged(time);
    $("unjudged").hidden = !part;
    $("unjudged").textContent = part ? "Not judged here: " + part[2] : "";
    $("time").textContent = time.toFixed(2);
    $("seek").value = frame;
    $("seek").setAttribute("aria-valuetext", time.toFixed(2) + " s of " + end().toFixed(2) + " s");
    body.dataset.frame = frame;
    body.dataset.time = time.toFixed(3);
    if (!playing) $("now").textContent = time.toFixed(2) + " s: " + rows.map(([term, value]) => term + " " + value).join(", ") + (robot ? ", shield " + said : "") + (part ? ", not judged: " + part[2] : "");
  }

  // ---- playing ------------------------------------------------------------------------------

  function show() {
    dirty = false;
    draw();
    drawStrip();
    tell();
  }

  function loop(now) {
    if (playing) {
      time += Math.min(Math.max(now - last, 0) / 1000, 0.25) * pace;
      last = now;
      if (time >= end()) { time = end(); play(false); }
      frame = frameAt(time);
      dirty = true;
    }
    if (dirty) show();
    if (playing) requestAnimationFrame(loop);
  }

  function refresh() {
    if (!dirty && !playing) requestAnimationFrame(loop);
    dirty = true;
  }

  function play(on) {
    if (on === playing) return;
    if (on && time >= end()) { time = times[0]; frame = 0; }
    playing = on;
    $("does").textContent = on ? "Pause" : "Play";
    $("play").setAttribute("aria-label", on ? "Pause" : "Play");
    $("mark").setAttribute("d", on ? "M3 1h4v14H3zM9 1h4v14H9z" : "M4 1l10 7-10 7z");
    body.dataset.playing = on ? "yes" : "no";
    if (on) { last = performance.now(); requestAnimationFrame(loop); } else { remember(); refresh(); }
  }

  function seek(now, whole) {
    time = Math.min(Math.max(now, times[0]), end());
    frame = frameAt(time);
    if (whole) time = times[frame];
    show();
    if (!playing) remember();
  }

  function remember() {
    // A frame of another page may not change its address.
    try { if (location.protocol !== "about:") history.replaceState(null, "", "#t=" + time.toFixed(2)); } catch (refused) { return; }
  }

  const step = (many) => { play(false); time = times[Math.min(Math.max(frame + (many < 0 && time > times[frame] + 1e-6 ? many + 1 : many), 0), times.length - 1)]; seek(time); };

  const marks = () => [...new Set([...head.events.map((each) => each[0]), ...head.notJudged.map((each) => Math.max(each[0], times[0]))])].sort((a, b) => a - b);
  function jump(forward) {
    const found = forward ? marks().find((each) => each > time + 1e-3) : marks().reverse().find((each) => each < time - 1e-3);
    if (found === undefined) { $("said").textContent = forward ? "No later event" : "No earlier event"; return; }
    play(false);
    seek(found);
    const told = head.events.filter((each) => Math.abs(each[0] - found) < 1e-6).map((each) => each[2]);
    $("said").textContent = found.toFixed(2) + " s: " + (told.join(", ") || "not judged from here");
  }

  function toggle(node, on) { node.setAttribute("aria-pressed", on ? "true" : "false"); refresh(); }
  const setFollow = () => { follow = !follow; toggle($("follow"), follow); };
  const setLabels = () => { labels = !labels; toggle($("labels"), labels); };
  const setKnown = () => { shown = !shown; toggle($("known"), shown); };
  function setPace(by) {
    const select = $("pace");
    select.selectedIndex = Math.min(Math.max(select.selectedIndex + by, 0), select.options.length - 1);
    pace = +select.value;
    $("said").textContent = "Speed times " + select.value;
  }
  function help() { const keys = $("keys"); if (!keys.open) keys.showModal(); else { keys.close(); document.activeElement.blur(); } }

  // ---- view ---------------------------------------------------------------------------------

  function fit() {
    const [left, low, right, top] = head.view;
    view.x = (left + right) / 2;
    view.y = (low + top) / 2;
    view.scale = Math.min(wide / Math.max(right - left, 1), high / Math.max(top - low, 1));
    view.fitted = true;
    refresh();
  }

  function zoom(by, px = wide / 2, py = high / 2) {
    const x = view.x + (px - wide / 2) / view.scale, y = view.y - (py - high / 2) / view.scale;
    view.scale = Math.min(Math.max(view.scale * by, 1e-4), 2000);
    view.x = x - (px - wide / 2) / view.scale;
    view.y = y + (py - high / 2) / view.scale;
    view.fitted = false;
    refresh();
  }

  function resize() {
    dense = window.devicePixelRatio || 1;
    const [left, low, right, top] = head.view, room = $("stage").clientWidth;
    $("stage").style.height = "";
    const most = $("stage").clientHeight;
    $("stage").style.height = Math.max(240, Math.min(most, (room * Math.max(top - low, 1)) / Math.max(right - left, 1))) + "px";
    for (const sheet of [floor, strip]) {
      const size = sheet.getBoundingClientRect();
      sheet.width = Math.max(1, Math.round(size.width * dense));
      sheet.height = Math.max(1, Math.round(size.height * dense));
    }
    wide = floor.width / dense;
    high = floor.height / dense;
    band = null;
    if (view.fitted) fit();
    show();
  }

  const fingers = new Map();
  const spread = () => { const [a, b] = [...fingers.values()]; return [Math.hypot(a[0] - b[0], a[1] - b[1]), (a[0] + b[0]) / 2, (a[1] + b[1]) / 2]; };
  floor.addEventListener("pointerdown", (event) => { floor.setPointerCapture(event.pointerId); fingers.set(event.pointerId, [event.offsetX, event.offsetY]); });
  floor.addEventListener("pointermove", (event) => {
    if (!fingers.has(event.pointerId)) return;
    const [x, y] = fingers.get(event.pointerId), before = fingers.size === 2 ? spread() : null;
    fingers.set(event.pointerId, [event.offsetX, event.offsetY]);
    if (before) { const now = spread(); if (before[0] > 0) zoom(now[0] / before[0], now[1], now[2]); return; }
    if (follow) setFollow();
    view.x -= (event.offsetX - x) / view.scale;
    view.y += (event.offsetY - y) / view.scale;
    view.fitted = false;
    refresh();
  });
  for (const kind of ["pointerup", "pointercancel"]) floor.addEventListener(kind, (event) => fingers.delete(event.pointerId));
  floor.addEventListener("dblclick", fit);
  floor.addEventListener("wheel", (event) => {
    if (!event.ctrlKey && document.activeElement !== floor) return;
    event.preventDefault();
    zoom(Math.exp(-event.deltaY * 0.0015), event.offsetX, event.offsetY);
  }, { passive: false });
  const scrub = (event) => { if (event.buttons || event.type === "pointerdown") seek(times[0] + ((event.offsetX - 8) / (strip.width / dense - 16)) * (end() - times[0])); };
  strip.addEventListener("pointerdown", (event) => { strip.setPointerCapture(event.pointerId); scrub(event); });
  strip.addEventListener("pointermove", scrub);

  // ---- keys and buttons ---------------------------------------------------------------------

  const actions = {
    first: () => { play(false); seek(times[0]); }, last: () => { play(false); seek(end()); },
    back: () => step(-1), on: () => step(1), before: () => jump(false), after: () => jump(true),
    play: () => play(!playing), in: () => zoom(1.4), out: () => zoom(1 / 1.4), fit, follow: setFollow, labels: setLabels, known: setKnown, help,
  };
  for (const [id, act] of Object.entries(actions)) $(id).addEventListener("click", act);
  $("seek").addEventListener("input", (event) => { play(false); seek(times[+event.target.value]); });
  $("pace").addEventListener("change", (event) => { pace = +event.target.value; });
  $("robot").addEventListener("change", (event) => { chosen = +event.target.value; band = null; refresh(); });
  const keys = {
    " ": actions.play, Home: actions.first, End: actions.last, n: actions.after, p: actions.before, "+": actions.in, "=": actions.in,
    "-": actions.out, "0": fit, f: setFollow, l: setLabels, m: setKnown, "?": help, "[": () => setPace(-1), "]": () => setPace(1),
    ArrowLeft: () => step(-1), ArrowRight: () => step(1), ArrowDown: () => step(-1), ArrowUp: () => step(1),
  };
  addEventListener("keydown", (event) => {
    const node = event.target, tag = node.tagName;
    if (event.ctrlKey || event.metaKey || event.altKey || tag === "SELECT" || ($("keys").open && event.key !== "?")) return;
    if ((event.key === " " || event.key === "Enter") && (tag === "BUTTON" || tag === "SUMMARY")) return;
    if ((event.key === "ArrowUp" || event.key === "ArrowDown") && tag !== "INPUT") return;
    const shifted = event.shiftKey && { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    const act = shifted ? () => { play(false); seek(time + shifted); } : keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!act || body.dataset.state !== "ready") return;
    event.preventDefault();
    act();
  });
  addEventListener("hashchange", fromAddress);
  addEventListener("beforeprint", () => { play(false); show(); });
  document.addEventListener("visibilitychange", () => { if (document.hidden) play(false); });

  function fromAddress() {
    const found = /^#t=(\d+(?:\.\d*)?|\.\d+)$/.exec(location.hash);
    if (found) { play(false); seek(+found[1]); }
  }

  const keep = (belief) => head.robots.some(({ cells }) => cells && cells.belief === belief);

  function legend() {
    const items = [], entry = (text, paint) => items.push([text, paint]);
    const dot = (color) => (ink) => { ink.beginPath(); ink.arc(13, 9, 6.5, 0, 7); ink.fillStyle = color; ink.fill(); };
    const line = (color, dash, width = 2.5) => (ink) => { ink.setLineDash(dash); ink.lineWidth = width; ink.strokeStyle = color; ink.beginPath(); ink.moveTo(2, 9); ink.lineTo(24, 9); ink.stroke(); };
    head.robots.slice(0, ROBOTS.length).forEach((robot, k) => entry(robot.name, dot(ROBOTS[k])));
    head.kinds.forEach((kind, k) => entry(kind, dot(KINDS[k % KINDS.length])));
    const some = (name) => head.robots.some((robot, k) => data[name + k]);
    const square = (...colors) => (ink) => colors.forEach((color) => { ink.fillStyle = color; ink.fillRect(2, 1, 22, 16); });
    const ground = head.ground;
    if (ground.walls.length || ground.polygons.length || ground.discs.length || ground.grids.length) entry("what stands", line(WALL, [], 5));
    if (ground.grids.length) entry("not seen by anybody", square(hatch));
    if (keep(false)) { entry("not seen by the robot", square(hatch)); entry("seen as occupied", square(tint(CELLS[2]))); }
    if (keep(true)) entry("where an unseen person may be", square("#fff", tint(CELLS[3])));
    if (head.robots.some((robot) => robot.goal)) entry("goal", (ink) => { ink.translate(13, 9); ink.fillStyle = GOAL; ink.beginPath(); for (let k = 0; k < 10; k++) { const far = k % 2 ? 3.5 : 8, a = -Math.PI / 2 + (k * Math.PI) / 5; ink.lineTo(far * Math.cos(a), far * Math.sin(a)); } ink.fill(); });
    if (some("scan")) entry("scan", (ink) => { ink.fillStyle = SCAN; for (const [x, y] of [[4, 12], [9, 9], [14, 7], [19, 6]]) ink.fillRect(x, y, 3, 3); });
    if (some("plan")) entry("verified area", (ink) => { ink.globalAlpha = 0.35; line(VERDICT[1], [], 12)(ink); ink.globalAlpha = 1; line(VERDICT[1], [], 1.5)(ink); });
    if (some("reach")) entry("where people can be", (ink) => { ink.setLineDash([3, 3]); ink.beginPath(); ink.arc(13, 9, 7.5, 0, 7); ink.fillStyle = "rgba(213,94,0,.12)"; ink.fill(); ink.strokeStyle = "#aa4600"; ink.stroke(); });
    if (some("way")) entry("way that is expected", line(EXPECTED, [2, 4]));
    if (some("expected")) entry("where people are expected", (ink) => { ink.fillStyle = EXPECTED; for (const x of [5, 13, 21]) { ink.beginPath(); ink.arc(x, 9, 2.5, 0, 7); ink.fill(); } });
    if (some("path")) entry("guide's path", line(GOAL, [6, 4]));
    if (head.events.some((each) => isContact(each[1]))) entry("contact", (ink) => cross(ink, 13, 9, 5, CONTACT));
    $("legend").replaceChildren(...items.map(([text, paint]) => {
      const item = document.createElement("li"), sheet = document.createElement("canvas"), words = document.createElement("span");
      sheet.width = 26 * dense;
      sheet.height = 18 * dense;
      const ink = sheet.getContext("2d");
      ink.setTransform(dense, 0, 0, dense, 0, 0);
      paint(ink);
      words.textContent = text;
      item.append(sheet, words);
      return item;
    }));
  }

  function tables() {
    for (const row of document.querySelectorAll("table.events tbody tr")) {
      const cell = row.cells[0], when = parseFloat(cell.textContent), button = document.createElement("button");
      button.type = "button";
      button.textContent = cell.textContent + " s";
      button.addEventListener("click", () => { play(false); seek(when); $("player").scrollIntoView({ block: "start", behavior: still ? "auto" : "smooth" }); });
      cell.replaceChildren(button);
    }
  }

  async function start() {
    if (typeof DecompressionStream === "undefined") throw new Error("this browser cannot unpack the picture");
    const nodes = [...document.querySelectorAll("script[id^='block-']")];
    const found = await Promise.all(nodes.map(unpacked));
    nodes.forEach((node, k) => { data[node.id.slice(6)] = found[k]; });
    for (const tick of data.time.values) times.push(tick);
    for (let row = 1; row < times.length; row++) times[row] += times[row - 1];
    times.forEach((ticks, row) => { times[row] = head.start + ticks * head.tick; });
    time = times[0];
    hatch = hatching("#8c959f", "#eef1f4");
    makeGrids();
    $("seek").max = times.length - 1;
    $("whole").textContent = end().toFixed(2);
    $("which").hidden = head.robots.length < 2;
    $("verdict").hidden = !head.robots.length;
    strip.hidden = !head.robots.length && !head.events.length && !head.notJudged.length;
    $("follow").disabled = !head.robots.length;
    for (const id of ["known", "knownKey"]) $(id).hidden = !keep(false) && !keep(true);
    if (!keep(false)) $("known").textContent = "Belief";
    $("robot").replaceChildren(...head.robots.map((robot, k) => new Option(robot.name, k)));
    $("player").hidden = false;
    resize();
    legend();
    tables();
    addEventListener("resize", resize);
    // A scroll bar that appears makes the floor narrower, too.
    new ResizeObserver(() => requestAnimationFrame(() => { if (Math.abs(floor.clientWidth - wide) > 1) resize(); })).observe($("stage"));
    fromAddress();
    show();
    body.dataset.playing = "no";
    body.dataset.state = "ready";
  }

  start().catch((error) => {
    body.dataset.state = "table";
    $("trouble").textContent = "The picture cannot be shown: " + error.message + ". What happened stands in the tables below.";
    $("trouble").hidden = false;
    document.querySelectorAll("details").forEach((each) => { each.open = true; });
  });
})();
