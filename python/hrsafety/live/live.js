"use strict";
(() => {
  const $ = (id) => document.getElementById(id), body = document.body;
  const scene = JSON.parse($("scene").textContent), token = new URLSearchParams(location.search).get("token");
  const floor = $("floor"), pen = floor.getContext("2d");
  const ROBOT = "#0072B2", PERSON = "#D55E00", WALL = "#3a3f46", GOAL = "#00795C", INK = "#1b1f24", CONTACT = "#c00000";
  const VERDICT = ["#8c959f", "#1a7f37", "#d9a800", "#8a3ffc", "#b42318"];
  const SHAPES = ["M3 9h14v2H3z", "M10 2a8 8 0 100 16 8 8 0 000-16z", "M10 2l9 16H1z", "M10 1l9 9-9 9-9-9z", "M6 1h8l5 5v8l-5 5H6l-5-5V6z"];
  const WORDS = { kept: [1, "Shield: kept"], changed: [2, "Shield: changed"], not_guaranteed: [3, "Not guaranteed"], braking: [4, "Shield: braking"], arrived: [1, "At the goal"] };
  const SLIDERS = [
    ["robot_speed", "Speed of the robot", "m/s", 0.05], ["people_speed", "Speeds of people", "times", 0.1],
    ["person_speed", "Shield reckons with people of", "m/s", 0.1], ["range", "Sight of the robot", "m", 0.5],
    ["noise", "Noise of places", "m", 0.01], ["delay", "Age of places", "s", 0.05],
  ];
  let state = null, wide = 1, high = 1, dense = 1, scale = 1, middle = [0, 0], chosen = null, dragged = null, waiting = null, sent = 0;
  const trail = [], arrivals = [];

  const sx = (x) => wide / 2 + (x - middle[0]) * scale, sy = (y) => high / 2 - (y - middle[1]) * scale;
  const back = (px, py) => [middle[0] + (px - wide / 2) / scale, middle[1] - (py - high / 2) / scale];

  function wish(what) {
    return fetch("/wishes?token=" + encodeURIComponent(token), { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(what) })
      .catch(() => ended());
  }

  // ---- picture ------------------------------------------------------------------------------

  function resize() {
    const [left, low, right, top] = scene.view, room = $("stage").clientWidth;
    const tall = Math.max(260, Math.min(innerHeight - 120, (room * (top - low)) / (right - left)));
    floor.style.height = tall + "px";
    dense = devicePixelRatio || 1;
    floor.width = Math.max(1, Math.round(room * dense));
    floor.height = Math.max(1, Math.round(tall * dense));
    wide = floor.width / dense;
    high = floor.height / dense;
    middle = [(left + right) / 2, (low + top) / 2];
    scale = Math.min(wide / (right - left), high / (top - low));
    draw();
  }

  function disc(x, y, radius, least = 3) {
    pen.beginPath();
    pen.arc(sx(x), sy(y), Math.max(radius * scale, least), 0, 2 * Math.PI);
  }

  function lines() {
    const step = [0.5, 1, 2, 5, 10, 20, 50, 100].find((each) => each * scale >= 50) || 200;
    pen.strokeStyle = "#e4e8ec";
    pen.lineWidth = 1;
    pen.beginPath();
    for (let x = Math.ceil(back(0, 0)[0] / step) * step; sx(x) < wide; x += step) { pen.moveTo(sx(x), 0); pen.lineTo(sx(x), high); }
    for (let y = Math.ceil(back(0, high)[1] / step) * step; sy(y) > 0; y += step) { pen.moveTo(0, sy(y)); pen.lineTo(wide, sy(y)); }
    pen.stroke();
    pen.fillStyle = "rgba(255,255,255,.85)";
    pen.fillRect(6, high - 34, step * scale + 12, 28);
    pen.strokeStyle = pen.fillStyle = INK;
    pen.lineWidth = 1.5;
    pen.beginPath();
    pen.moveTo(12, high - 17); pen.lineTo(12, high - 12); pen.lineTo(12 + step * scale, high - 12); pen.lineTo(12 + step * scale, high - 17);
    pen.stroke();
    pen.font = "12px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.fillText(step + " m", 12 + (step * scale) / 2, high - 18);
  }

  function walls() {
    pen.strokeStyle = pen.fillStyle = WALL;
    pen.lineCap = pen.lineJoin = "round";
    for (const [x, y, u, v, radius] of scene.walls) {
      pen.beginPath();
      pen.moveTo(sx(x), sy(y)); pen.lineTo(sx(u), sy(v));
      pen.lineWidth = Math.max(2 * radius * scale, 2.5);
      pen.stroke();
    }
    for (const outline of scene.polygons) { pen.beginPath(); outline.forEach(([x, y]) => pen.lineTo(sx(x), sy(y))); pen.fill(); }
    for (const [x, y, radius] of scene.discs) { disc(x, y, radius); pen.fill(); }
  }

  function star(x, y, size) {
    pen.beginPath();
    for (let k = 0; k < 10; k++) {
      const angle = -Math.PI / 2 + (k * Math.PI) / 5, far = k % 2 ? 0.45 * size : size;
      pen.lineTo(x + far * Math.cos(angle), y + far * Math.sin(angle));
    }
    pen.closePath();
  }

  function ring(x, y, radius) {
    disc(x, y, radius + 7 / scale);
    pen.setLineDash([5, 4]);
    pen.lineWidth = 2.5;
    pen.strokeStyle = INK;
    pen.stroke();
    pen.setLineDash([]);
  }

  function draw() {
    pen.setTransform(dense, 0, 0, dense, 0, 0);
    pen.fillStyle = "#fff";
    pen.fillRect(0, 0, wide, high);
    lines();
    walls();
    if (!state) return;
    const [gx, gy] = state.goal, [x, y, angle] = state.robot;
    disc(gx, gy, scene.tolerance);
    pen.fillStyle = "rgba(0,121,92,.18)";
    pen.fill();
    star(sx(gx), sy(gy), 12);
    pen.fillStyle = GOAL;
    pen.fill();
    if (chosen === "goal") ring(gx, gy, scene.tolerance);
    disc(x, y, state.settings.range);
    pen.setLineDash([3, 6]);
    pen.lineWidth = 1;
    pen.strokeStyle = "rgba(0,114,178,.55)";
    pen.stroke();
    pen.setLineDash([]);
    pen.beginPath();
    trail.forEach(([u, v], k) => (k ? pen.lineTo(sx(u), sy(v)) : pen.moveTo(sx(u), sy(v))));
    pen.lineWidth = 2;
    pen.strokeStyle = ROBOT + "90";
    pen.stroke();
    for (const [number, u, v, radius] of state.people) {
      disc(u, v, radius);
      pen.fillStyle = PERSON;
      pen.fill();
      pen.lineWidth = state.touching.includes(number) ? 4 : 1.2;
      pen.strokeStyle = state.touching.includes(number) ? CONTACT : "#fff";
      pen.stroke();
      if (chosen === number || state.held.includes(number)) ring(u, v, radius);
    }
    if (scene.footprint.length) {
      const c = Math.cos(angle), s = Math.sin(angle);
      pen.beginPath();
      scene.footprint.forEach(([a, b], k) => (k ? pen.lineTo(sx(x + c * a - s * b), sy(y + s * a + c * b)) : pen.moveTo(sx(x + c * a - s * b), sy(y + s * a + c * b))));
      pen.closePath();
    } else disc(x, y, scene.radius, 4);
    pen.fillStyle = ROBOT;
    pen.fill();
    pen.lineWidth = 2;
    pen.strokeStyle = "#fff";
    pen.stroke();
    if (scene.differential) {
      pen.beginPath();
      pen.moveTo(sx(x), sy(y));
      pen.lineTo(sx(x + 0.9 * scene.radius * Math.cos(angle)), sy(y + 0.9 * scene.radius * Math.sin(angle)));
      pen.lineWidth = Math.min(3, 0.3 * scene.radius * scale);
      pen.stroke();
    }
    disc(x, y, scene.radius + 5 / scale, 8);
    pen.lineWidth = 3;
    pen.strokeStyle = VERDICT[(WORDS[state.status] || [0])[0]];
    pen.stroke();
  }

  // ---- states -------------------------------------------------------------------------------

  function list(rows) {
    $("state").replaceChildren(...rows.flatMap(([term, value, bad]) => {
      const first = document.createElement("dt"), second = document.createElement("dd");
      first.textContent = term;
      second.textContent = value;
      if (bad) second.className = "bad";
      return [first, second];
    }));
  }

  function take(text) {
    const before = state;
    state = JSON.parse(text);
    if (before && state.time < before.time) trail.length = 0;
    trail.push(state.robot);
    if (trail.length > 400) trail.shift();
    const now = performance.now();
    arrivals.push(now);
    while (arrivals.length && now - arrivals[0] > 1000) arrivals.shift();
    const [code, word] = WORDS[state.status] || [0, "No shield"];
    $("verdict").className = "v" + code;
    $("shape").setAttribute("d", SHAPES[code]);
    $("word").textContent = word;
    $("time").textContent = state.time.toFixed(2);
    $("rate").textContent = arrivals.length;
    list([
      ["Speed", state.speed.toFixed(2) + " m/s"],
      ["Clearance", state.clearance === null ? "nobody near" : state.clearance.toFixed(2) + " m", state.clearance !== null && state.clearance < 0],
      ["Contacts", String(state.contacts), state.contacts > 0], ["People", String(state.people.length)],
      ...(state.doubts.length ? [["Refuted", state.doubts.join(", ").replaceAll("_", " "), true]] : []),
    ]);
    $("pause").textContent = state.paused ? "Go on" : "Pause";
    $("trouble").hidden = !state.refused;
    $("trouble").textContent = state.refused;
    settings();
    Object.assign(body.dataset, {
      state: "ready", time: state.time, robot: state.robot.slice(0, 2).join(","), goal: state.goal.join(","), people: state.people.length,
      rate: arrivals.length, status: state.status || "none", contacts: state.contacts, paused: state.paused ? "yes" : "no",
    });
    if (!before || Math.floor(before.time) !== Math.floor(state.time)) {
      $("now").textContent = "Robot at " + state.robot.slice(0, 2).map((each) => each.toFixed(1)).join(", ") + ", " + word + ", contacts " + state.contacts;
    }
    requestAnimationFrame(draw);
  }

  function settings() {
    const set = state.settings, active = document.activeElement;
    if (!$("law").options.length) {
      $("law").replaceChildren(...scene.laws.map((name) => new Option(name === "own" ? set.own.replaceAll("_", " ") + " (as given)" : name.replaceAll("_", " "), name)));
      $("sliders").replaceChildren(...SLIDERS.map(([name, words, unit, step]) => {
        const label = document.createElement("label"), title = document.createElement("span"), value = document.createElement("output"), input = document.createElement("input");
        label.className = "slider";
        title.textContent = words;
        value.id = name + "-value";
        [input.type, input.id, input.min, input.max, input.step] = ["range", name, scene.ranges[name][0], name === "robot_speed" ? scene.most : scene.ranges[name][1], step];
        input.setAttribute("aria-label", words + " in " + unit);
        input.addEventListener("input", () => wish({ kind: "setting", name, value: +input.value }));
        label.append(title, value, input);
        return label;
      }));
    }
    if (active !== $("law")) $("law").value = set.law;
    for (const name of ["shield", "yielding", "guide"]) $(name).checked = set[name];
    for (const [name, , unit] of SLIDERS) {
      if (active !== $(name)) $(name).value = set[name];
      $(name + "-value").textContent = (+set[name]).toFixed(2) + " " + unit;
    }
  }

  function ended() {
    body.dataset.state = "ended";
    $("trouble").hidden = false;
    $("trouble").textContent = "The world has ended. Start it again with hrsafety play.";
    $("word").textContent = "Ended";
    stream.close();
  }

  // ---- hands --------------------------------------------------------------------------------

  function nearest(px, py) {
    if (!state) return null;
    let best = null, least = 26;
    const [gx, gy] = state.goal, away = Math.hypot(sx(gx) - px, sy(gy) - py);
    if (away < least) [best, least] = ["goal", away];
    for (const [number, x, y, radius] of state.people) {
      const far = Math.max(Math.hypot(sx(x) - px, sy(y) - py) - radius * scale, 0);
      if (far < Math.min(least, 14)) [best, least] = [number, far];
    }
    return best;
  }

  function put(what, place) { return wish(what === "goal" ? { kind: "goal", place } : { kind: "person", number: what, place }); }

  // One wish is on its way at a time; of the places in between the last one counts.
  async function move() {
    if (sent || !waiting) return;
    sent = 1;
    const [what, place] = waiting;
    waiting = null;
    await put(what, place);
    sent = 0;
    move();
  }

  floor.addEventListener("pointerdown", (event) => {
    dragged = nearest(event.offsetX, event.offsetY);
    chosen = dragged;
    if (dragged === null) return;
    floor.setPointerCapture(event.pointerId);
    floor.style.cursor = "grabbing";
  });
  floor.addEventListener("pointermove", (event) => {
    if (dragged === null) return;
    waiting = [dragged, back(event.offsetX, event.offsetY)];
    move();
  });
  for (const kind of ["pointerup", "pointercancel"]) floor.addEventListener(kind, () => {
    if (dragged !== null && dragged !== "goal") { waiting = [dragged, null]; move(); }
    dragged = null;
    floor.style.cursor = "";
  });
  floor.addEventListener("keydown", (event) => {
    if (!state || event.ctrlKey || event.metaKey || event.altKey) return;
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key], key = event.key.toLowerCase();
    if (key === "g") chosen = "goal";
    else if (key === "n" && state.people.length) {
      const numbers = state.people.map((each) => each[0]);
      chosen = numbers[(numbers.indexOf(chosen) + 1) % numbers.length];
    } else if (way && chosen !== null) {
      const from = chosen === "goal" ? state.goal : (state.people.find((each) => each[0] === chosen) || []).slice(1, 3);
      if (from.length) { waiting = [chosen, [from[0] + 0.25 * way[0], from[1] + 0.25 * way[1]]]; move(); }
    } else if (event.key === "Enter" && chosen !== null && chosen !== "goal") put(chosen, null);
    else return;
    event.preventDefault();
    $("said").textContent = chosen === "goal" ? "Goal chosen" : "Person " + chosen + " chosen";
    draw();
  });
  addEventListener("keydown", (event) => {
    const tag = event.target.tagName;
    if (event.ctrlKey || event.metaKey || event.altKey || ["SELECT", "INPUT", "BUTTON", "A"].includes(tag)) return;
    if (event.key === " ") { event.preventDefault(); pause(); } else if (event.key.toLowerCase() === "r") wish({ kind: "restart" });
  });
  const pause = () => wish({ kind: "pause", on: !(state && state.paused) });
  $("pause").addEventListener("click", pause);
  $("restart").addEventListener("click", () => wish({ kind: "restart" }));
  $("law").addEventListener("change", (event) => wish({ kind: "setting", name: "law", value: event.target.value }));
  for (const name of ["shield", "yielding", "guide"]) $(name).addEventListener("change", (event) => wish({ kind: "setting", name, value: event.target.checked }));
  $("settings").addEventListener("submit", (event) => event.preventDefault());
  $("keep").href = "/player.html?token=" + encodeURIComponent(token);
  addEventListener("resize", resize);
  // A scroll bar that appears makes the floor narrower, too.
  new ResizeObserver(() => requestAnimationFrame(() => { if (Math.abs($("stage").clientWidth - wide) > 1) resize(); })).observe($("stage"));
  resize();
  const stream = new EventSource("/states?token=" + encodeURIComponent(token));
  stream.addEventListener("message", (event) => take(event.data));
  stream.addEventListener("end", ended);
  stream.addEventListener("error", () => { if (stream.readyState === EventSource.CLOSED) ended(); });
})();
