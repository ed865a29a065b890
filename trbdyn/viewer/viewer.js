"use strict";
/* The 3-D view of one bearing, or of several on a shaft: builds the scene, draws a moment of the record, and answers the controls. Each bearing
 * is drawn in its own axes (bearing.js). What is shown at any time is in `state`; `trbView` gives tests the same handles as a person. */
(async function () {
  const byId = (id) => document.getElementById(id);
  const message = byId("message");
  const head = JSON.parse(byId("head").textContent);
  const { MM, LOAD_COLOURS, POCKET_COLOUR, material } = trbBearing;

  // ---- data ----

  async function unpack() {
    const text = atob(byId("data").textContent.trim());
    const packed = Uint8Array.from(text, (c) => c.charCodeAt(0));
    if (typeof DecompressionStream === "undefined") throw new Error("this browser is too old: it cannot unpack gzip data");
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
    return new Response(stream).arrayBuffer();
  }
  let buffer;
  try {
    buffer = await unpack();
  } catch (error) {
    message.textContent = "The data cannot be read: " + error.message;
    return;
  }
  const KINDS = { f4: Float32Array, u4: Uint32Array, u2: Uint16Array };
  const array = (place) => new KINDS[place.kind](buffer, place.at, place.count);
  const time = array(head.time), turns = array(head.turns), N = head.frames;

  // ---- what is shown ----

  // quantities of all bearings, with one range of colours for all of them
  const quantities = {};
  for (const part of head.bearings) for (const q of part.quantities) {
    const known = quantities[q.name] ||= { ...q, from: q.range[0], to: q.range[1], high: q.values.high };
    known.from = Math.min(known.from, q.range[0]);
    known.to = Math.max(known.to, q.range[1]);
    known.high = Math.max(known.high, q.values.high);
  }
  const modes = Object.keys(quantities), someCage = head.bearings.some((part) => part.has_cage);
  const state = { place: 0, playing: false, speed: 1, mode: modes.includes("outer_load") ? "outer_load" : modes[0], factor: head.factor,
    follow: false, arrows: false, trail: true, section: false, outer: true, inner: true, rollers: true, cage: true, shaft: true, picked: null, camera: "free" };

  // ---- scene ----

  const canvas = byId("canvas");
  let renderer;
  try {
    renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
  } catch (error) {
    message.textContent = "This browser draws no 3-D graphics (WebGL): " + error.message;
    return;
  }
  const sharpest = Math.min(window.devicePixelRatio || 1, 2);
  let sharpness = sharpest, slow = 0; // where drawing is slow, fewer pixels are drawn while the record plays
  renderer.setPixelRatio(sharpness);
  renderer.outputEncoding = THREE.sRGBEncoding;
  renderer.setClearColor(0xe6ebf0, 1);
  const scene = new THREE.Scene();
  scene.add(new THREE.HemisphereLight(0xffffff, 0x707c88, 0.5));
  const sun = new THREE.DirectionalLight(0xffffff, 0.5);
  const places = head.bearings.map((part) => part.place), span = Math.max(...places) - Math.min(...places);
  const widest = Math.max(...head.bearings.map((part) => part.geometry.outer_radius)), size = Math.max(widest, 0.7 * span) * MM;
  const camera = new THREE.PerspectiveCamera(35, 1, size / 100, size * 40);
  camera.add(sun);
  sun.position.set(0.4, 0.7, 1);
  scene.add(camera);
  const controls = new THREE.OrbitControls(camera, canvas);
  controls.addEventListener("change", () => { dirty = true; });

  const bearings = head.bearings.map((part, k) => {
    const one = trbBearing.make(part, array, state, N, head.colours), holder = new THREE.Group();
    holder.position.z = part.place * MM;
    holder.rotation.x = part.turned ? Math.PI : 0;
    holder.add(one.world);
    scene.add(holder);
    one.things().forEach((thing) => { thing.userData.pick.bearing = k; });
    return one;
  });
  let shaftBody = null; // it turns with the inner ring of the first bearing, in whose axes its ends are given
  if (head.shaft) {
    const { from, to } = head.shaft, radius = 0.98 * Math.min(...bearings.map((one) => one.bore));
    shaftBody = new THREE.Mesh(new THREE.CylinderGeometry(radius * MM, radius * MM, (to - from) * MM, 48).rotateX(Math.PI / 2),
      material({ color: 0x8593a0, transparent: true, opacity: 0.35, depthWrite: false }));
    shaftBody.position.z = 0.5 * (from + to) * MM;
    bearings[0].innerGroup.add(shaftBody);
  }

  const outline = new THREE.Mesh(new THREE.SphereGeometry(1, 8, 8), new THREE.MeshBasicMaterial({ color: 0xd000a0 }));
  outline.visible = false;
  scene.add(outline);

  // ---- a moment of the record ----

  function between(place) {
    const first = Math.min(Math.floor(place), N - 2), share = Math.min(Math.max(place - first, 0), 1);
    return { first, share, nearest: share < 0.5 ? first : first + 1 };
  }
  // one scale for the loads at both raceways, one for the forces on the cage: the longest arrow is that of the largest force shown
  const LOAD_LENGTH = 1.1, POCKET_LENGTH = 1.6; // in diameters of a roller
  const diameter = Math.max(...head.bearings.map((part) => part.geometry.diameter)) * MM;
  const loadNames = Object.keys(LOAD_COLOURS).filter((name) => quantities[name]), loads = Math.max(0, ...loadNames.map((name) => quantities[name].high));
  const arrowLength = (largest, longest) => (largest > 0 ? (longest * diameter) / largest : 0); // mm per N
  const scale = { load: arrowLength(loads, LOAD_LENGTH), pocket: arrowLength(quantities.pocket_force ? quantities.pocket_force.high : 0, POCKET_LENGTH) };

  // ---- words and numbers ----

  const legend = [];
  const number = (x) => (x === 0 ? "0" : Math.abs(x) >= 1e5 || Math.abs(x) < 1e-3 ? x.toExponential(2) : String(+x.toPrecision(4)));
  const unit = (q) => (q.unit === "1" ? "" : " " + q.unit);
  byId("about").innerHTML = "<b></b><span></span>";
  byId("about").firstChild.textContent = head.title;
  byId("about").lastChild.textContent = `${head.about}; ${head.shown}; ${N} of their ${head.records} records`;
  { const swatch = (colour) => `<i style="background:#${colour.toString(16).padStart(6, "0")}"></i>`;
    const bar = (label, colours, largest, longest) => {
      if (largest > 0) legend.push(`<div>${colours.map(swatch).join("")} ${label}: an arrow as long as a roller is thick is ${number(largest / longest)} N, the longest ${number(largest)} N</div>`);
    };
    for (const name of loadNames) legend.push(`<div>${swatch(LOAD_COLOURS[name])} ${quantities[name].label}</div>`);
    bar("loads of the raceways on the rollers", [], loads, LOAD_LENGTH);
    if (quantities.pocket_force) bar("forces of the rollers on the cage", [POCKET_COLOUR], quantities.pocket_force.high, POCKET_LENGTH);
    const drawn = bearings.filter((one) => one.part.has_cage).map(({ part, trailFactor }) => (
      `${part.name ? part.name + ": " : ""}${number(trailFactor)} times as large as it is; the circle is the radial play, ${number(part.geometry.play_radial * MM)} mm`));
    byId("trail-legend").textContent = `In the bore: path of the cage's centre, ${drawn.join("; ")}.`;
    byId("arrow-legend").innerHTML = "<b>Force arrows</b>" + legend.join(""); }
  function words() {
    byId("factor-note").textContent = state.factor > 1.0005
      ? `Motion and clearances of cage and rollers are drawn ${number(state.factor)} times as large as they are.` : "Motion and clearances are drawn true to scale.";
    byId("factor-value").textContent = number(state.factor);
    const q = quantities[state.mode];
    byId("scale").innerHTML = q ? `<div>${q.label}${q.unit === "1" ? "" : " (" + q.unit + ")"}</div><div class="bar"></div><div class="ends"><span>${number(q.from)}</span><span>${number(0.5 * (q.from + q.to))}</span><span>${number(q.to)}</span></div><div class="said">${bearings.length > 1 ? "" : q.said}</div>` : "";
    byId("trail-legend").hidden = !state.trail || !someCage;
    byId("arrow-legend").hidden = !state.arrows || !legend.length;
    if (q) byId("scale").querySelector(".bar").style.background = "linear-gradient(90deg," +
      head.colours.map((c) => `rgb(${c.map((x) => Math.round(255 * x)).join()})`).join() + ")";
  }
  function series(q, pick) { // column of the picked roller or face in a quantity of its bearing
    if (q.kind === "pocket") return pick.kind === "face" ? pick.index * head.bearings[pick.bearing].slots + pick.slot : null;
    return q.kind === "roller" ? pick.index : null;
  }
  function describe(b) {
    const pick = state.picked, box = byId("picked");
    outline.visible = Boolean(pick);
    if (!pick) return;
    const one = bearings[pick.bearing], { slots, slot_names, name } = one.part;
    const what = pick.kind === "roller" ? `Roller ${pick.index}` : `Pocket ${pick.index}, ${slot_names[pick.slot]}`;
    const where = name ? `${what} of ${name}` : what;
    if (box.dataset.shown !== JSON.stringify([pick, state.mode])) {
      box.dataset.shown = JSON.stringify([pick, state.mode]);
      const rows = [];
      for (const q of Object.values(one.quantities)) {
        if (q.kind === "station") continue;
        if (q.kind === "pocket") {
          for (let s = 0; s < slots; s++) {
            if (pick.kind === "face" && s !== pick.slot) continue;
            rows.push({ q, column: pick.index * slots + s, label: `force, ${slot_names[s]}`, current: q.name === state.mode && pick.kind === "face" });
          }
        } else rows.push({ q, column: pick.index, label: q.label, current: q.name === state.mode });
      }
      box.rows = rows;
      box.innerHTML = '<h3></h3><canvas id="history"></canvas><p class="hint" id="history-note"></p><table>' +
        rows.map((r) => `<tr class="${r.current ? "current" : ""}"><td></td><td></td></tr>`).join("") + "</table>";
      box.querySelector("h3").textContent = where; // names of bearings and faces are what a user wrote
      box.querySelectorAll("td:first-child").forEach((cell, k) => { cell.textContent = rows[k].label; });
    }
    box.querySelectorAll("td:last-child").forEach((cell, k) => {
      cell.textContent = number(one.valueAt(box.rows[k].q, b.nearest, box.rows[k].column)) + unit(box.rows[k].q);
    });
    history(b, pick);
    outline.position.copy(one.whereIs(pick));
    outline.scale.setScalar(0.12 * one.part.geometry.diameter * MM);
  }
  function history(b, pick) {
    const { quantities: own, valueAt } = bearings[pick.bearing];
    let q = own[state.mode], column = q && series(q, pick);
    if (column == null) { // the colour's quantity has no history of its own here
      q = own[pick.kind === "face" ? "pocket_force" : "outer_load"] || own.slip;
      column = series(q, pick);
    }
    const paper = byId("history"), wide = paper.clientWidth * 2, high = paper.clientHeight * 2;
    if (paper.width !== wide) { paper.width = wide; paper.height = high; }
    const ink = paper.getContext("2d"), left = 8, bottom = 8;
    ink.clearRect(0, 0, wide, high);
    let low = Infinity, top = -Infinity;
    for (let k = 0; k < N; k++) { const v = valueAt(q, k, column); low = Math.min(low, v); top = Math.max(top, v); }
    const spread = top - low || 1, x = (k) => left + ((wide - 2 * left) * k) / (N - 1), y = (v) => high - bottom - ((high - 40 - bottom) * (v - low)) / spread;
    ink.strokeStyle = "#0072b2"; ink.lineWidth = 2.5; ink.beginPath();
    for (let k = 0; k < N; k++) ink.lineTo(x(k), y(valueAt(q, k, column)));
    ink.stroke();
    ink.strokeStyle = "#d55e00"; ink.beginPath(); ink.moveTo(x(state.place), 30); ink.lineTo(x(state.place), high); ink.stroke();
    ink.fillStyle = "#1b1f24"; ink.font = "22px sans-serif";
    ink.fillText(`${number(low)} to ${number(top)}${unit(q)}, turns ${number(turns[0])} to ${number(turns[N - 1])}`, left, 22);
    byId("history-note").textContent = `${q.label}; each point is the value ${q.note}.`;
  }

  // ---- controls ----

  const mode = byId("mode");
  for (const q of Object.values(quantities)) mode.add(new Option(q.label + (q.unit === "1" ? "" : ` (${q.unit})`), q.name));
  mode.value = state.mode;
  mode.addEventListener("change", () => { state.mode = mode.value; refresh(); });
  const factor = byId("factor"), largest = Math.log(Math.max(head.largest_factor, 1.0001));
  Object.assign(factor, { min: 0, max: 1, step: 0.001, value: Math.log(state.factor) / largest });
  factor.addEventListener("input", () => setFactor(Math.exp(factor.value * largest)));
  function setFactor(value) {
    state.factor = Math.min(Math.max(value, 1), head.largest_factor);
    if (state.factor < 1.01) state.factor = 1;
    factor.value = Math.log(state.factor) / largest;
    bearings.forEach((one) => one.stretch());
    refresh();
  }
  const speeds = [0.05, 0.1, 0.25, 0.5, 1, 2];
  const rate = turns[N - 1] > turns[0] ? (turns[N - 1] - turns[0]) / (time[N - 1] - time[0]) : 0;
  for (const s of speeds) byId("speed").add(new Option(rate > 0 ? `${s} turns of the ${head.turning} a second (slowed ${number(rate / s)} times)` : `${s}`, s));
  state.speed = 0.25;
  byId("speed").value = String(state.speed);
  byId("speed").addEventListener("change", (event) => { state.speed = Number(event.target.value); });
  const slider = byId("time");
  slider.max = N - 1;
  slider.addEventListener("input", () => setPlace(Number(slider.value)));
  function setPlace(place) { state.place = Math.min(Math.max(place, 0), N - 1); refresh(); }
  byId("play").addEventListener("click", () => setPlaying(!state.playing));
  function setPlaying(on) { state.playing = on; byId("play").textContent = on ? "Pause" : "Play"; last = null; setSharpness(sharpest); }
  function setSharpness(value) {
    slow = 0;
    if (value === sharpness) return;
    sharpness = value;
    renderer.setPixelRatio(sharpness);
    fit();
  }
  window.addEventListener("keydown", (event) => {
    if (["SELECT", "INPUT", "BUTTON"].includes(event.target.tagName)) return;
    if (event.code === "Space") { setPlaying(!state.playing); event.preventDefault(); }
    if (event.code === "ArrowRight") setPlace(state.place + 1);
    if (event.code === "ArrowLeft") setPlace(state.place - 1);
  });
  const cameras = {
    "free": ["Oblique", [2.3, 0.9, 2.9], false], "axis": ["Along the axis", [0, 0, 4.1], false], "side": ["From the side", [4.0, 0, 0.001], false],
    "back": ["Small ends", [2.2, 0.9, -3.0], false], "pocket": ["One pocket", [2.1, 0.1, 0.5], true],
  };
  for (const name in cameras) {
    const button = document.createElement("button");
    button.textContent = cameras[name][0];
    button.addEventListener("click", () => setCamera(name));
    button.dataset.camera = name;
    byId("cameras").append(button);
  }
  function setCamera(name) {
    const [, place, follow] = cameras[name];
    state.camera = name;
    controls.target.set(0, 0, 0);
    const near = name === "pocket", scaled = near ? widest * MM : size, middle = near ? head.bearings[0].place * MM : 0;
    if (near) { controls.target.set(0.8 * scaled, 0, middle); setSwitch("follow", follow); }
    camera.position.set(...place.map((x) => x * scaled));
    if (name === "side" && head.shaft) camera.position.x *= -1; // so that the shaft goes to the right
    camera.position.z += middle;
    camera.up.set(0, 1, 0);
    controls.update();
    refresh();
  }
  const switches = { follow: "turn with the cage", arrows: "force arrows", trail: "orbit of the cage", section: "half section", outer: "cup", inner: "cone", rollers: "rollers", cage: "cage", shaft: "shaft" };
  for (const name in switches) {
    if (((name === "cage" || name === "trail") && !someCage) || (name === "shaft" && !shaftBody)) continue;
    const label = document.createElement("label"), box = document.createElement("input");
    Object.assign(box, { type: "checkbox", id: "switch-" + name, checked: state[name] });
    box.addEventListener("change", () => setSwitch(name, box.checked));
    label.append(box, " " + switches[name]);
    byId("switches").append(label);
  }
  function setSwitch(name, on) {
    state[name] = on;
    const box = byId("switch-" + name);
    if (box) box.checked = on;
    bearings.forEach((one) => one.show());
    if (shaftBody) shaftBody.visible = state.shaft;
    renderer.localClippingEnabled = state.section;
    refresh();
  }
  const caster = new THREE.Raycaster(), spot = new THREE.Vector2();
  let down = null;
  canvas.addEventListener("pointerdown", (event) => { down = [event.clientX, event.clientY]; });
  canvas.addEventListener("pointerup", (event) => {
    if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 4) return;
    const box = canvas.getBoundingClientRect();
    spot.set(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2);
    caster.setFromCamera(spot, camera);
    const things = bearings.flatMap((one) => one.things()), hidden = bearings.flatMap((one) => one.hides());
    const hit = caster.intersectObjects([...things, ...hidden], false).find((h) => !(state.section && hidden.includes(h.object) && h.point.x > 0));
    pick(hit && hit.object.userData.pick ? hit.object.userData.pick : null);
  });
  function pick(what) {
    state.picked = what;
    if (!what) { byId("picked").dataset.shown = ""; byId("picked").innerHTML = '<p class="hint">Click a roller or a face of a pocket to see its numbers.</p>'; }
    refresh();
  }

  // ---- drawing ----

  let dirty = true, last = null, drawn = 0;
  function refresh() { dirty = true; }
  function draw() {
    const b = between(state.place);
    for (const one of bearings) {
      one.stand(b);
      one.paint(b, quantities[state.mode] || { from: 0, to: 0 });
      one.force(b, scale);
    }
    scene.updateMatrixWorld();
    words();
    describe(b);
    slider.value = state.place;
    const at = (list) => list[b.first] * (1 - b.share) + list[b.first + 1] * b.share;
    byId("clock").textContent = `${(head.time.start + at(time)).toFixed(5)} s, turn ${at(turns).toFixed(2)} of the ${head.turning}`;
    renderer.render(scene, camera);
    drawn++;
  }
  function fit() {
    const box = canvas.getBoundingClientRect(); // on a phone the captions stand above and below it
    renderer.setSize(box.width, box.height, false);
    camera.aspect = box.width / Math.max(box.height, 1);
    camera.updateProjectionMatrix();
    dirty = true;
  }
  const watcher = new ResizeObserver(fit);
  watcher.observe(byId("view"));
  watcher.observe(canvas);
  function tick(now) {
    if (state.playing) {
      if (last !== null) {
        slow = now - last > 120 ? slow + 1 : 0;
        if (slow >= 4 && sharpness > 0.45) setSharpness(0.7 * sharpness);
        const seconds = Math.min((now - last) / 1000, 0.25), whole = time[N - 1] - time[0];
        const moved = rate > 0 ? (seconds * state.speed) / rate : (seconds * whole) / 10;
        state.place += (moved / whole) * (N - 1);
        if (state.place > N - 1) state.place = 0;
      }
      last = now;
      dirty = true;
    }
    if (dirty) { dirty = false; draw(); }
    requestAnimationFrame(tick);
  }
  fit();
  bearings.forEach((one) => one.stretch());
  setCamera("free");
  for (const part of new URLSearchParams(location.hash.slice(1))) { // a moment to start from, for instance #place=0.5&mode=pocket_force
    const [key, value] = part;
    if (key === "place") setPlace(Number(value) * (N - 1));
    else if (key === "mode" && quantities[value]) { state.mode = value; mode.value = value; }
    else if (key === "factor") setFactor(Number(value));
    else if (key === "camera" && cameras[value]) setCamera(value);
    else if (key === "roller") pick({ bearing: 0, kind: "roller", index: Number(value) - 1 });
    else if (key === "pocket") pick({ bearing: 0, kind: "face", index: Number(value.split(".")[0]) - 1, slot: Number(value.split(".")[1] || 0) });
    else if (key in switches) setSwitch(key, value === "1");
    else if (key === "play") setPlaying(true);
  }
  message.textContent = "";
  draw();
  const onScreen = (vector) => { const v = vector.clone().project(camera), box = canvas.getBoundingClientRect();
    return [box.left + ((v.x + 1) / 2) * box.width, box.top + ((1 - v.y) / 2) * box.height]; };
  window.trbView = { state, head, setPlace, setFactor, setCamera, setSwitch, pick, draw, drawn: () => drawn, cup: () => bearings[0].outerGroup.position.toArray(),
    placeOfRoller: (i, bearing = 0) => bearings[bearing].whereIsRoller(i).toArray(), whereIsRoller: (i) => onScreen(bearings[0].whereIsRoller(i)) };
  requestAnimationFrame(tick);
})();
