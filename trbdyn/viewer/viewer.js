"use strict";
/* The 3-D view: builds the scene from the meshes, draws a moment of the record, and answers the controls.
 * Lengths are drawn in millimetres. What it shows at any time is in `state`; `trbView` gives tests the same handles as a person. */
(async function () {
  const byId = (id) => document.getElementById(id);
  const message = byId("message");
  const head = JSON.parse(byId("head").textContent);
  const MM = 1000;

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
  const time = array(head.time), turns = array(head.turns), pose = {};
  for (const name in head.pose) pose[name] = array(head.pose[name]);
  const Z = head.rollers, N = head.frames, slots = head.slots;
  const quantities = {};
  for (const q of head.quantities) quantities[q.name] = { ...q, low: q.values.low, high: q.values.high, step: q.values.step,
    from: q.range[0], to: q.range[1],
    data: array(q.values), width: q.values.shape.slice(1).reduce((a, b) => a * b, 1), depth: q.values.shape[2] || 1 };
  const valueAt = (q, frame, column) => q.low + q.step * q.data[frame * q.width + column];

  // ---- what is shown ----

  const modes = head.quantities.map((q) => q.name);
  const state = { place: 0, playing: false, speed: 1, mode: modes.includes("outer_load") ? "outer_load" : modes[0], factor: head.factor,
    follow: false, arrows: false, trail: true, section: false, outer: true, inner: true, rollers: true, cage: true, picked: null, camera: "free" };

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
  const scene = new THREE.Scene(), world = new THREE.Group();
  scene.add(world);
  scene.add(new THREE.HemisphereLight(0xffffff, 0x707c88, 0.5));
  const sun = new THREE.DirectionalLight(0xffffff, 0.5);
  const size = head.geometry.outer_radius * MM;
  const camera = new THREE.PerspectiveCamera(35, 1, size / 100, size * 40);
  camera.add(sun);
  sun.position.set(0.4, 0.7, 1);
  scene.add(camera);
  const controls = new THREE.OrbitControls(camera, canvas);
  controls.addEventListener("change", () => { dirty = true; });

  const seen = (hex) => new THREE.Color(hex).convertSRGBToLinear(); // so that a colour is drawn as the legend shows it
  const stretched = [];
  function geometryOf(mesh) {
    const geometry = new THREE.BufferGeometry();
    const base = array(mesh.position).map((x) => x * MM);
    geometry.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(base), 3));
    geometry.setAttribute("normal", new THREE.BufferAttribute(Float32Array.from(array(mesh.normal)), 3));
    geometry.setIndex(new THREE.BufferAttribute(Uint32Array.from(array(mesh.index)), 1));
    if (mesh.shift) stretched.push({ geometry, base, shift: array(mesh.shift) });
    return geometry;
  }
  const material = (options) => new THREE.MeshLambertMaterial({ side: THREE.DoubleSide, ...options });
  const ringMaterial = material({ color: 0xaab4be }), innerMaterial = material({ color: 0x9aa8b5 });
  const outer = new THREE.Mesh(geometryOf(head.meshes.outer), ringMaterial);
  const outerGroup = new THREE.Group(), innerGroup = new THREE.Group();
  outerGroup.add(outer);
  innerGroup.add(new THREE.Mesh(geometryOf(head.meshes.inner), innerMaterial));
  // a mark on the cone's end face, so that its turn is seen
  const boreMark = new THREE.Mesh(new THREE.BoxGeometry(size * 0.02, size * 0.1, size * 0.012), material({ color: 0xd55e00 }));
  { const p = array(head.meshes.inner.position); let z = -1e9, r = 1e9;
    for (let i = 0; i < p.length; i += 3) { z = Math.max(z, p[i + 2]); r = Math.min(r, Math.hypot(p[i], p[i + 1])); }
    boreMark.position.set(0, r * MM + size * 0.06, z * MM); }
  innerGroup.add(boreMark);
  world.add(outerGroup, innerGroup);

  const rollerGeometry = geometryOf(head.meshes.roller), markGeometry = geometryOf(head.meshes.mark);
  const rollers = [];
  for (let i = 0; i < Z; i++) {
    const own = rollerGeometry.clone();
    own.setAttribute("position", rollerGeometry.getAttribute("position"));
    own.setAttribute("normal", rollerGeometry.getAttribute("normal"));
    own.setIndex(rollerGeometry.getIndex());
    own.setAttribute("color", new THREE.BufferAttribute(new Float32Array(own.getAttribute("position").count * 3).fill(1), 3));
    const group = new THREE.Group(), body = new THREE.Mesh(own, material({ vertexColors: true }));
    body.userData.pick = { kind: "roller", index: i };
    group.add(body, new THREE.Mesh(markGeometry, material({ color: 0x20262c })));
    group.matrixAutoUpdate = false;
    world.add(group);
    rollers.push({ group, body });
  }
  const cage = new THREE.Group();
  cage.matrixAutoUpdate = false;
  world.add(cage);
  const faces = [];
  if (head.has_cage) {
    const cageMaterial = material({ color: 0xc9a25b });
    cage.add(new THREE.Mesh(geometryOf(head.meshes.cage), cageMaterial));
    for (const face of head.faces) {
      const mesh = new THREE.Mesh(geometryOf(face.mesh), material({ color: 0xe3c78f, polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -2 }));
      mesh.userData.pick = { kind: "face", index: face.pocket, slot: face.slot };
      cage.add(mesh);
      faces.push({ ...face, mesh });
    }
  }
  // lands: that of the ring stands with the ring, the cage's guiding surface moves with the cage
  const landMaterial = material({ color: 0x5f7d95 });
  const land = head.meshes.land ? new THREE.Mesh(geometryOf(head.meshes.land), landMaterial) : null;
  if (land) (head.guidance === "inner_land" ? innerGroup : outerGroup).add(land);
  if (head.meshes.guide) cage.add(new THREE.Mesh(geometryOf(head.meshes.guide), material({ color: 0xb0862f })));

  // ---- orbit of the cage: the trail of its centre, with its radial play as a circle, in the bore and on a scale of its own ----

  const trail = new THREE.Group();
  let innermost = 1e9, front = -1e9;
  { const p = array(head.meshes.inner.position);
    for (let i = 0; i < p.length; i += 3) { innermost = Math.min(innermost, Math.hypot(p[i], p[i + 1])); front = Math.max(front, p[i + 2]); } }
  const trailFactor = (0.75 * innermost) / head.geometry.play_radial;
  trail.position.z = front * MM;
  function curve(points, colour) {
    const line = new THREE.Line(new THREE.BufferGeometry().setFromPoints(points), new THREE.LineBasicMaterial({ color: seen(colour) }));
    trail.add(line);
  }
  const onTrail = (x, y) => new THREE.Vector3(x, y, 0).multiplyScalar(trailFactor * MM);
  const circle = (radius) => [...Array(97).keys()].map((k) => onTrail(radius * Math.cos((2 * Math.PI * k) / 96), radius * Math.sin((2 * Math.PI * k) / 96)));
  curve(circle(head.geometry.play_radial), 0x30363c);
  curve([onTrail(-0.04 * head.geometry.play_radial, 0), onTrail(0.04 * head.geometry.play_radial, 0)], 0x30363c);
  curve([onTrail(0, -0.04 * head.geometry.play_radial), onTrail(0, 0.04 * head.geometry.play_radial)], 0x30363c);
  curve([...Array(N).keys()].map((k) => onTrail(pose.cage_x[k], pose.cage_y[k])), 0xd55e00);
  const centre = new THREE.Mesh(new THREE.SphereGeometry(0.025 * innermost * MM, 12, 12), new THREE.MeshBasicMaterial({ color: seen(0xb00020) }));
  trail.add(centre);
  world.add(trail);

  const outline = new THREE.Mesh(new THREE.SphereGeometry(1, 8, 8), new THREE.MeshBasicMaterial({ color: 0xd000a0 }));
  outline.visible = false;
  world.add(outline);

  // ---- arrows: forces on the rollers from the raceways, forces on the cage from the rollers ----

  const shaft = new THREE.CylinderGeometry(0.05, 0.05, 0.75, 8).translate(0, 0.375, 0);
  const tip = new THREE.ConeGeometry(0.13, 0.25, 12).translate(0, 0.875, 0);
  const UP = new THREE.Vector3(0, 1, 0);
  function arrow(colour, parent) {
    const group = new THREE.Group(), look = new THREE.MeshBasicMaterial({ color: seen(colour), depthTest: false, transparent: true });
    group.add(new THREE.Mesh(shaft, look), new THREE.Mesh(tip, look));
    group.renderOrder = 5;
    group.children.forEach((part) => { part.renderOrder = 5; });
    group.visible = false;
    parent.add(group);
    return group;
  }
  function aim(one, end, direction, length) { // an arrow of this length whose point is at `end`
    one.visible = state.arrows && length > 0.02 * head.geometry.diameter * MM;
    if (!one.visible) return;
    one.quaternion.setFromUnitVectors(UP, direction);
    one.position.copy(end).addScaledVector(direction, -length);
    const width = Math.min(length, 0.6 * head.geometry.diameter * MM);
    one.scale.set(width, length, width);
  }
  const loadArrows = ["outer_load", "inner_load"].filter((name) => quantities[name]).map((name) => (
    { name, list: rollers.map(() => arrow(name === "outer_load" ? 0xb00020 : 0x7b2fa0, world)) }));
  const pocketArrows = quantities.pocket_force ? faces.map((face) => arrow(0x0050b0, cage)) : [];

  // ---- a moment of the record ----

  function between(place) {
    const first = Math.min(Math.floor(place), N - 2), share = Math.min(Math.max(place - first, 0), 1);
    return { first, share, nearest: share < 0.5 ? first : first + 1 };
  }
  const scalar = (name, b) => pose[name][b.first] * (1 - b.share) + pose[name][b.first + 1] * b.share;
  const ofRoller = (name, b, i) => pose[name][b.first * Z + i] * (1 - b.share) + pose[name][(b.first + 1) * Z + i] * b.share;
  const tilted = new THREE.Matrix4(), work = new THREE.Matrix4(), work2 = new THREE.Matrix4(), axis = new THREE.Vector3();
  function small(x, y, target) { // rotation by a small vector (x, y, 0)
    const angle = Math.hypot(x, y);
    return angle > 0 ? target.makeRotationAxis(axis.set(x / angle, y / angle, 0), angle) : target.identity();
  }
  const inOrbit = [];
  function pose3d(b) {
    const e = state.factor, g = head.geometry;
    const cageAngle = scalar("cage_angle", b);
    world.rotation.z = state.follow ? -cageAngle : 0;
    innerGroup.position.set(e * MM * scalar("ring_x", b), e * MM * scalar("ring_y", b), e * MM * scalar("ring_z", b));
    small(e * scalar("ring_tilt_x", b), e * scalar("ring_tilt_y", b), tilted).multiply(work.makeRotationZ(scalar("shaft", b)));
    innerGroup.quaternion.setFromRotationMatrix(tilted);
    outerGroup.position.set(e * MM * scalar("cup_x", b), e * MM * scalar("cup_y", b), e * MM * scalar("cup_z", b));
    outerGroup.quaternion.setFromRotationMatrix(small(e * scalar("cup_tilt_x", b), e * scalar("cup_tilt_y", b), tilted));
    if (head.has_cage) {
      small(e * scalar("cage_tilt_x", b), e * scalar("cage_tilt_y", b), tilted).multiply(work.makeRotationZ(cageAngle));
      tilted.setPosition(e * MM * scalar("cage_x", b), e * MM * scalar("cage_y", b), e * MM * scalar("cage_z", b));
      cage.matrix.copy(tilted);
      cage.matrixWorldNeedsUpdate = true;
      centre.position.copy(onTrail(scalar("cage_x", b), scalar("cage_y", b)));
    }
    for (let i = 0; i < Z; i++) {
      const angle = cageAngle + (2 * Math.PI * i) / Z + e * ofRoller("psi", b, i);
      const r = MM * (g.centre_radius + e * ofRoller("r", b, i)), z = MM * (g.centre_height + e * ofRoller("z", b, i));
      work.makeRotationZ(angle).multiply(work2.makeRotationY(g.axis_angle + e * ofRoller("tilt", b, i)));
      work.multiply(work2.makeRotationX(-e * ofRoller("skew", b, i)));
      inOrbit[i] = { x: r * Math.cos(angle), y: r * Math.sin(angle), z, n: new THREE.Vector3(1, 0, 0).transformDirection(work), angle };
      work.multiply(work2.makeRotationZ(ofRoller("spin", b, i)));
      work.setPosition(inOrbit[i].x, inOrbit[i].y, z);
      rollers[i].group.matrix.copy(work);
      rollers[i].group.matrixWorldNeedsUpdate = true;
    }
  }
  const ramp = head.colours.map((c) => new THREE.Color(c[0], c[1], c[2]).convertSRGBToLinear()), found = new THREE.Color();
  function colour(share) {
    const x = Math.min(Math.max(share, 0), 1) * (ramp.length - 1), k = Math.min(Math.floor(x), ramp.length - 2);
    return found.copy(ramp[k]).lerp(ramp[k + 1], x - k);
  }
  const PLAIN = new THREE.Color(0xd7dde3).convertSRGBToLinear(), FACE = new THREE.Color(0xe3c78f).convertSRGBToLinear();
  const share = (q, value) => (q.to > q.from ? (value - q.from) / (q.to - q.from) : 0.5);
  function paint(b) {
    const q = quantities[state.mode];
    for (let i = 0; i < Z; i++) {
      const attribute = rollers[i].body.geometry.getAttribute("color"), to = attribute.array;
      let c = PLAIN;
      if (q && q.kind === "roller") c = colour(share(q, valueAt(q, b.nearest, i)));
      for (let k = 0; k < to.length; k += 3) { to[k] = c.r; to[k + 1] = c.g; to[k + 2] = c.b; }
      if (q && q.kind === "station") {
        for (let row = 0; row < head.roller_rows; row++) {
          const s = colour(share(q, valueAt(q, b.nearest, i * q.depth + Math.round((row * (q.depth - 1)) / (head.roller_rows - 1)))));
          for (let k = row * head.row_size; k < (row + 1) * head.row_size; k++) { to[3 * k] = s.r; to[3 * k + 1] = s.g; to[3 * k + 2] = s.b; }
        }
      }
      attribute.needsUpdate = true;
    }
    for (const face of faces) {
      const force = q && q.kind === "pocket" ? valueAt(q, b.nearest, face.pocket * slots + face.slot) : 0;
      face.mesh.material.color.copy(force > 0.5 * q?.step ? colour(share(q, force)) : FACE);
    }
  }
  // one scale for the loads at both raceways, one for the forces on the cage: the longest arrow is that of the largest force shown
  const LOAD_LENGTH = 1.1, POCKET_LENGTH = 1.6; // in diameters of a roller
  const loads = Math.max(0, ...loadArrows.map(({ name }) => quantities[name].high));
  const arrowLength = (largest, longest) => (largest > 0 ? (longest * head.geometry.diameter * MM) / largest : 0); // mm per N
  function force(b) {
    const d = head.geometry.diameter * MM;
    for (const { name, list } of loadArrows) {
      const q = quantities[name], side = name === "outer_load" ? -1 : 1;
      list.forEach((one, i) => {
        const n = inOrbit[i].n.clone(), from = new THREE.Vector3(inOrbit[i].x, inOrbit[i].y, inOrbit[i].z).addScaledVector(n, -side * 0.5 * d);
        aim(one, from, n.multiplyScalar(side), valueAt(q, b.nearest, i) * arrowLength(loads, LOAD_LENGTH));
      });
    }
    const q = quantities.pocket_force;
    pocketArrows.forEach((one, k) => {
      const face = faces[k], value = valueAt(q, b.nearest, face.pocket * slots + face.slot);
      const end = new THREE.Vector3(...face.centre).addScaledVector(new THREE.Vector3(...face.shift), state.factor - 1).multiplyScalar(MM);
      aim(one, end, new THREE.Vector3(...face.normal).multiplyScalar(-1), value * arrowLength(q.high, POCKET_LENGTH));
    });
  }
  function stretch() {
    for (const part of stretched) {
      const to = part.geometry.getAttribute("position");
      for (let k = 0; k < to.array.length; k++) to.array[k] = part.base[k] + (state.factor - 1) * MM * part.shift[k];
      to.needsUpdate = true;
    }
  }

  // ---- words and numbers ----

  const legend = [];
  const number = (x) => (x === 0 ? "0" : Math.abs(x) >= 1e5 || Math.abs(x) < 1e-3 ? x.toExponential(2) : String(+x.toPrecision(4)));
  const unit = (q) => (q.unit === "1" ? "" : " " + q.unit);
  byId("about").innerHTML = "<b></b><span></span>";
  byId("about").firstChild.textContent = head.title || head.bearing;
  byId("about").lastChild.textContent = `${head.bearing}, ${number(head.speed_rpm)} rpm, ${head.loads}; ${head.shown}; ${N} of their ${head.records} records`;
  { const swatch = (colour) => `<i style="background:#${colour.toString(16).padStart(6, "0")}"></i>`;
    const bar = (label, colours, largest, longest) => {
      if (largest > 0) legend.push(`<div>${colours.map(swatch).join("")} ${label}: an arrow as long as a roller is thick is ${number(largest / longest)} N, the longest ${number(largest)} N</div>`);
    };
    for (const { name } of loadArrows) legend.push(`<div>${swatch(name === "outer_load" ? 0xb00020 : 0x7b2fa0)} ${quantities[name].label}</div>`);
    bar("loads of the raceways on the rollers", [], loads, LOAD_LENGTH);
    if (quantities.pocket_force) bar("forces of the rollers on the cage", [0x0050b0], quantities.pocket_force.high, POCKET_LENGTH);
    if (head.has_cage) byId("trail-legend").textContent = `In the bore: path of the cage's centre, ${number(trailFactor)} times as large as it is; the circle is the radial play, ${number(head.geometry.play_radial * MM)} mm.`;
    byId("arrow-legend").innerHTML = "<b>Force arrows</b>" + legend.join(""); }
  function words() {
    byId("factor-note").textContent = state.factor > 1.0005
      ? `Motion and clearances of cage and rollers are drawn ${number(state.factor)} times as large as they are.` : "Motion and clearances are drawn true to scale.";
    byId("factor-value").textContent = number(state.factor);
    const q = quantities[state.mode];
    byId("scale").innerHTML = q ? `<div>${q.label}${q.unit === "1" ? "" : " (" + q.unit + ")"}</div><div class="bar"></div><div class="ends"><span>${number(q.from)}</span><span>${number(0.5 * (q.from + q.to))}</span><span>${number(q.to)}</span></div><div class="said">${q.said}</div>` : "";
    byId("trail-legend").hidden = !state.trail || !head.has_cage;
    byId("arrow-legend").hidden = !state.arrows || !legend.length;
    if (q) byId("scale").querySelector(".bar").style.background = "linear-gradient(90deg," +
      head.colours.map((c) => `rgb(${c.map((x) => Math.round(255 * x)).join()})`).join() + ")";
  }
  function series(q, pick) { // column of the picked roller or face in a quantity
    if (q.kind === "pocket") return pick.kind === "face" ? pick.index * slots + pick.slot : null;
    return q.kind === "roller" ? pick.index : null;
  }
  function describe(b) {
    const pick = state.picked, box = byId("picked");
    outline.visible = Boolean(pick);
    if (!pick) return;
    const where = pick.kind === "roller" ? `Roller ${pick.index + 1}` : `Pocket ${pick.index + 1}, ${head.slot_names[pick.slot]}`;
    if (box.dataset.shown !== JSON.stringify([pick, state.mode])) {
      box.dataset.shown = JSON.stringify([pick, state.mode]);
      const rows = [];
      for (const q of head.quantities) {
        const full = quantities[q.name];
        if (q.kind === "station") continue;
        if (q.kind === "pocket") {
          for (let s = 0; s < slots; s++) {
            if (pick.kind === "face" && s !== pick.slot) continue;
            rows.push({ q: full, column: pick.index * slots + s, label: `force, ${head.slot_names[s]}`, current: q.name === state.mode && pick.kind === "face" });
          }
        } else rows.push({ q: full, column: pick.index, label: q.label, current: q.name === state.mode });
      }
      box.rows = rows;
      box.innerHTML = `<h3>${where}</h3><canvas id="history"></canvas><p class="hint" id="history-note"></p><table>` + rows.map((r) => `<tr class="${r.current ? "current" : ""}"><td>${r.label}</td><td></td></tr>`).join("") +
        "</table>";
    }
    box.querySelectorAll("td:last-child").forEach((cell, k) => {
      cell.textContent = number(valueAt(box.rows[k].q, b.nearest, box.rows[k].column)) + unit(box.rows[k].q);
    });
    history(b, pick);
    const at = pick.kind === "roller" ? new THREE.Vector3(inOrbit[pick.index].x, inOrbit[pick.index].y, inOrbit[pick.index].z)
      .addScaledVector(new THREE.Vector3(0, 0, 1).applyMatrix4(work.extractRotation(rollers[pick.index].group.matrix)), 0.56 * head.geometry.length * MM)
      : new THREE.Vector3(...faces.find((f) => f.pocket === pick.index && f.slot === pick.slot).centre).multiplyScalar(MM).applyMatrix4(cage.matrix);
    outline.position.copy(at);
    outline.scale.setScalar(0.12 * head.geometry.diameter * MM);
  }
  function history(b, pick) {
    let q = quantities[state.mode], column = q && series(q, pick);
    if (column == null) { // the colour's quantity has no history of its own here
      q = quantities[pick.kind === "face" ? "pocket_force" : "outer_load"] || quantities.slip;
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
  for (const q of head.quantities) mode.add(new Option(q.label + (q.unit === "1" ? "" : ` (${q.unit})`), q.name));
  mode.value = state.mode;
  mode.addEventListener("change", () => { state.mode = mode.value; refresh(); });
  const factor = byId("factor"), largest = Math.log(Math.max(head.largest_factor, 1.0001));
  Object.assign(factor, { min: 0, max: 1, step: 0.001, value: Math.log(state.factor) / largest });
  factor.addEventListener("input", () => setFactor(Math.exp(factor.value * largest)));
  function setFactor(value) {
    state.factor = Math.min(Math.max(value, 1), head.largest_factor);
    if (state.factor < 1.01) state.factor = 1;
    factor.value = Math.log(state.factor) / largest;
    stretch();
    refresh();
  }
  const speeds = [0.05, 0.1, 0.25, 0.5, 1, 2];
  const rate = head.turns && turns[N - 1] > turns[0] ? (turns[N - 1] - turns[0]) / (time[N - 1] - time[0]) : 0;
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
    if (name === "pocket") { controls.target.set(size * 0.8, 0, 0); setSwitch("follow", follow); }
    camera.position.set(...place.map((x) => x * size));
    camera.up.set(0, 1, 0);
    controls.update();
    refresh();
  }
  const switches = { follow: "turn with the cage", arrows: "force arrows", trail: "orbit of the cage", section: "half section", outer: "cup", inner: "cone", rollers: "rollers", cage: "cage" };
  for (const name in switches) {
    if ((name === "cage" || name === "trail") && !head.has_cage) continue;
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
    outer.visible = state.outer;
    innerGroup.visible = state.inner;
    cage.visible = state.cage;
    trail.visible = state.trail && head.has_cage;
    if (land) land.visible = head.guidance === "inner_land" ? state.inner : state.outer;
    rollers.forEach((roller) => { roller.group.visible = state.rollers; });
    const planes = state.section ? [new THREE.Plane(new THREE.Vector3(-1, 0, 0), 0)] : [];
    renderer.localClippingEnabled = state.section;
    for (const look of [ringMaterial, innerMaterial, landMaterial]) look.clippingPlanes = planes;
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
    const things = [...rollers.filter(() => state.rollers).map((r) => r.body), ...(state.cage ? faces.map((f) => f.mesh) : [])];
    const hidden = [state.outer && outer, state.inner && innerGroup.children[0], state.cage && cage.children[0]].filter(Boolean);
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
    pose3d(b);
    paint(b);
    force(b);
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
        const seconds = Math.min((now - last) / 1000, 0.25), span = time[N - 1] - time[0];
        const moved = rate > 0 ? (seconds * state.speed) / rate : (seconds * span) / 10;
        state.place += (moved / span) * (N - 1);
        if (state.place > N - 1) state.place = 0;
      }
      last = now;
      dirty = true;
    }
    if (dirty) { dirty = false; draw(); }
    requestAnimationFrame(tick);
  }
  fit();
  stretch();
  setCamera("free");
  for (const part of new URLSearchParams(location.hash.slice(1))) { // a moment to start from, for instance #place=0.5&mode=pocket_force
    const [key, value] = part;
    if (key === "place") setPlace(Number(value) * (N - 1));
    else if (key === "mode" && quantities[value]) { state.mode = value; mode.value = value; }
    else if (key === "factor") setFactor(Number(value));
    else if (key === "camera" && cameras[value]) setCamera(value);
    else if (key === "roller") pick({ kind: "roller", index: Number(value) - 1 });
    else if (key === "pocket") pick({ kind: "face", index: Number(value.split(".")[0]) - 1, slot: Number(value.split(".")[1] || 0) });
    else if (key in switches) setSwitch(key, value === "1");
    else if (key === "play") setPlaying(true);
  }
  message.textContent = "";
  draw();
  const onScreen = (vector) => { const v = vector.clone().project(camera), box = canvas.getBoundingClientRect();
    return [box.left + ((v.x + 1) / 2) * box.width, box.top + ((1 - v.y) / 2) * box.height]; };
  window.trbView = { state, head, setPlace, setFactor, setCamera, setSwitch, pick, draw, drawn: () => drawn, cup: () => outerGroup.position.toArray(),
    whereIsRoller: (i) => onScreen(new THREE.Vector3().setFromMatrixPosition(rollers[i].group.matrix).applyMatrix4(world.matrixWorld)) };
  requestAnimationFrame(tick);
})();
