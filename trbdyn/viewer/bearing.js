"use strict";
/* One bearing of the 3-D view, in its own axes: its meshes, how they stand at a moment of the record, their colours and force arrows.
 * `part` is its entry of the page's head, `array` gives an array of the data, `state` is what the page shows. */
const trbBearing = (function () {
  const MM = 1000; // lengths are drawn in millimetres
  const UP = new THREE.Vector3(0, 1, 0);
  const shaft = new THREE.CylinderGeometry(0.05, 0.05, 0.75, 8).translate(0, 0.375, 0);
  const tip = new THREE.ConeGeometry(0.13, 0.25, 12).translate(0, 0.875, 0);
  const seen = (hex) => new THREE.Color(hex).convertSRGBToLinear(); // so that a colour is drawn as the legend shows it
  const material = (options) => new THREE.MeshLambertMaterial({ side: THREE.DoubleSide, ...options });
  const PLAIN = seen(0xd7dde3), FACE = seen(0xe3c78f);
  const LOAD_COLOURS = { outer_load: 0xb00020, inner_load: 0x7b2fa0 }, POCKET_COLOUR = 0x0050b0;
  const axis = new THREE.Vector3();

  function small(x, y, target) { // rotation by a small vector (x, y, 0)
    const angle = Math.hypot(x, y);
    return angle > 0 ? target.makeRotationAxis(axis.set(x / angle, y / angle, 0), angle) : target.identity();
  }
  function arrow(colour, parent) {
    const group = new THREE.Group(), look = new THREE.MeshBasicMaterial({ color: seen(colour), depthTest: false, transparent: true });
    group.add(new THREE.Mesh(shaft, look), new THREE.Mesh(tip, look));
    group.renderOrder = 5;
    group.children.forEach((one) => { one.renderOrder = 5; });
    group.visible = false;
    parent.add(group);
    return group;
  }

  function make(part, array, state, frames, colours) {
    const Z = part.rollers, g = part.geometry, slots = part.slots, N = frames, diameter = g.diameter * MM;
    const pose = {}, quantities = {};
    for (const name in part.pose) pose[name] = array(part.pose[name]);
    for (const q of part.quantities) quantities[q.name] = { ...q, low: q.values.low, high: q.values.high, step: q.values.step,
      from: q.range[0], to: q.range[1], data: array(q.values), width: q.values.shape.slice(1).reduce((a, b) => a * b, 1), depth: q.values.shape[2] || 1 };
    const valueAt = (q, frame, column) => q.low + q.step * q.data[frame * q.width + column];

    // ---- meshes ----

    const world = new THREE.Group(), stretched = [];
    function geometryOf(mesh) {
      const geometry = new THREE.BufferGeometry();
      const base = array(mesh.position).map((x) => x * MM);
      geometry.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(base), 3));
      geometry.setAttribute("normal", new THREE.BufferAttribute(Float32Array.from(array(mesh.normal)), 3));
      geometry.setIndex(new THREE.BufferAttribute(Uint32Array.from(array(mesh.index)), 1));
      if (mesh.shift) stretched.push({ geometry, base, shift: array(mesh.shift) });
      return geometry;
    }
    const ringMaterial = material({ color: 0xaab4be }), innerMaterial = material({ color: 0x9aa8b5 }), landMaterial = material({ color: 0x5f7d95 });
    const outer = new THREE.Mesh(geometryOf(part.meshes.outer), ringMaterial), inner = new THREE.Mesh(geometryOf(part.meshes.inner), innerMaterial);
    const outerGroup = new THREE.Group(), innerGroup = new THREE.Group();
    outerGroup.add(outer);
    innerGroup.add(inner);
    let bore = 1e9, front = -1e9; // of the inner ring
    { const p = array(part.meshes.inner.position);
      for (let i = 0; i < p.length; i += 3) { bore = Math.min(bore, Math.hypot(p[i], p[i + 1])); front = Math.max(front, p[i + 2]); } }
    // a mark on the cone's end face, so that its turn is seen
    const size = g.outer_radius * MM;
    const boreMark = new THREE.Mesh(new THREE.BoxGeometry(size * 0.02, size * 0.1, size * 0.012), material({ color: 0xd55e00 }));
    boreMark.position.set(0, bore * MM + size * 0.06, front * MM);
    innerGroup.add(boreMark);
    world.add(outerGroup, innerGroup);

    const rollerGeometry = geometryOf(part.meshes.roller), markGeometry = geometryOf(part.meshes.mark);
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
    const cage = new THREE.Group(), faces = [];
    cage.matrixAutoUpdate = false;
    world.add(cage);
    if (part.has_cage) {
      cage.add(new THREE.Mesh(geometryOf(part.meshes.cage), material({ color: 0xc9a25b })));
      for (const face of part.faces) {
        const mesh = new THREE.Mesh(geometryOf(face.mesh), material({ color: 0xe3c78f, polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -2 }));
        mesh.userData.pick = { kind: "face", index: face.pocket, slot: face.slot };
        cage.add(mesh);
        faces.push({ ...face, mesh });
      }
    }
    // lands: that of the ring stands with the ring, the cage's guiding surface moves with the cage
    const land = part.meshes.land ? new THREE.Mesh(geometryOf(part.meshes.land), landMaterial) : null;
    if (land) (part.guidance === "inner_land" ? innerGroup : outerGroup).add(land);
    if (part.meshes.guide) cage.add(new THREE.Mesh(geometryOf(part.meshes.guide), material({ color: 0xb0862f })));

    // ---- orbit of the cage: the trail of its centre, with its radial play as a circle, in the bore and on a scale of its own ----

    const trail = new THREE.Group(), trailFactor = (0.75 * bore) / g.play_radial;
    trail.position.z = front * MM;
    const curve = (points, colour) => trail.add(
      new THREE.Line(new THREE.BufferGeometry().setFromPoints(points), new THREE.LineBasicMaterial({ color: seen(colour) })));
    const onTrail = (x, y) => new THREE.Vector3(x, y, 0).multiplyScalar(trailFactor * MM);
    const round = (k) => [Math.cos((2 * Math.PI * k) / 96), Math.sin((2 * Math.PI * k) / 96)].map((x) => x * g.play_radial);
    curve([...Array(97).keys()].map((k) => onTrail(...round(k))), 0x30363c);
    curve([onTrail(-0.04 * g.play_radial, 0), onTrail(0.04 * g.play_radial, 0)], 0x30363c);
    curve([onTrail(0, -0.04 * g.play_radial), onTrail(0, 0.04 * g.play_radial)], 0x30363c);
    curve([...Array(N).keys()].map((k) => onTrail(pose.cage_x[k], pose.cage_y[k])), 0xd55e00);
    const centre = new THREE.Mesh(new THREE.SphereGeometry(0.025 * bore * MM, 12, 12), new THREE.MeshBasicMaterial({ color: seen(0xb00020) }));
    trail.add(centre);
    world.add(trail);

    // ---- arrows: forces on the rollers from the raceways, forces on the cage from the rollers ----

    const loadArrows = Object.keys(LOAD_COLOURS).filter((name) => quantities[name]).map((name) => (
      { name, list: rollers.map(() => arrow(LOAD_COLOURS[name], world)) }));
    const pocketArrows = quantities.pocket_force ? faces.map(() => arrow(POCKET_COLOUR, cage)) : [];
    function aim(one, end, direction, length) { // an arrow of this length whose point is at `end`
      one.visible = state.arrows && length > 0.02 * diameter;
      if (!one.visible) return;
      one.quaternion.setFromUnitVectors(UP, direction);
      one.position.copy(end).addScaledVector(direction, -length);
      const width = Math.min(length, 0.6 * diameter);
      one.scale.set(width, length, width);
    }
    function force(b, scale) { // scale: mm per N of loads and of forces on the cage
      for (const { name, list } of loadArrows) {
        const q = quantities[name], side = name === "outer_load" ? -1 : 1;
        list.forEach((one, i) => {
          const n = inOrbit[i].n.clone(), from = new THREE.Vector3(inOrbit[i].x, inOrbit[i].y, inOrbit[i].z).addScaledVector(n, -side * 0.5 * diameter);
          aim(one, from, n.multiplyScalar(side), valueAt(q, b.nearest, i) * scale.load);
        });
      }
      const q = quantities.pocket_force;
      pocketArrows.forEach((one, k) => {
        const face = faces[k], value = valueAt(q, b.nearest, face.pocket * slots + face.slot);
        const end = new THREE.Vector3(...face.centre).addScaledVector(new THREE.Vector3(...face.shift), state.factor - 1).multiplyScalar(MM);
        aim(one, end, new THREE.Vector3(...face.normal).multiplyScalar(-1), value * scale.pocket);
      });
    }

    // ---- a moment of the record ----

    const scalar = (name, b) => pose[name][b.first] * (1 - b.share) + pose[name][b.first + 1] * b.share;
    const ofRoller = (name, b, i) => pose[name][b.first * Z + i] * (1 - b.share) + pose[name][(b.first + 1) * Z + i] * b.share;
    const tilted = new THREE.Matrix4(), work = new THREE.Matrix4(), work2 = new THREE.Matrix4(), inOrbit = [];
    const placed = (name, b, target) => target.set(...["x", "y", "z"].map((along) => state.factor * MM * scalar(`${name}_${along}`, b)));
    const leaned = (name, b, target) => small(state.factor * scalar(`${name}_tilt_x`, b), state.factor * scalar(`${name}_tilt_y`, b), target);
    function stand(b) {
      const e = state.factor, cageAngle = scalar("cage_angle", b);
      world.rotation.z = state.follow ? -cageAngle : 0;
      placed("ring", b, innerGroup.position);
      innerGroup.quaternion.setFromRotationMatrix(leaned("ring", b, tilted).multiply(work.makeRotationZ(scalar("shaft", b))));
      placed("cup", b, outerGroup.position);
      outerGroup.quaternion.setFromRotationMatrix(leaned("cup", b, tilted));
      if (part.has_cage) {
        leaned("cage", b, tilted).multiply(work.makeRotationZ(cageAngle)).setPosition(placed("cage", b, axis));
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
    const ramp = colours.map((c) => new THREE.Color(c[0], c[1], c[2]).convertSRGBToLinear()), found = new THREE.Color();
    function colour(share) {
      const x = Math.min(Math.max(share, 0), 1) * (ramp.length - 1), k = Math.min(Math.floor(x), ramp.length - 2);
      return found.copy(ramp[k]).lerp(ramp[k + 1], x - k);
    }
    function paint(b, range) { // range: values at the ends of the colours
      const q = quantities[state.mode], share = (value) => (range.to > range.from ? (value - range.from) / (range.to - range.from) : 0.5);
      for (let i = 0; i < Z; i++) {
        const attribute = rollers[i].body.geometry.getAttribute("color"), to = attribute.array;
        let c = PLAIN;
        if (q && q.kind === "roller") c = colour(share(valueAt(q, b.nearest, i)));
        for (let k = 0; k < to.length; k += 3) { to[k] = c.r; to[k + 1] = c.g; to[k + 2] = c.b; }
        if (q && q.kind === "station") {
          for (let row = 0; row < part.roller_rows; row++) {
            const s = colour(share(valueAt(q, b.nearest, i * q.depth + Math.round((row * (q.depth - 1)) / (part.roller_rows - 1)))));
            for (let k = row * part.row_size; k < (row + 1) * part.row_size; k++) { to[3 * k] = s.r; to[3 * k + 1] = s.g; to[3 * k + 2] = s.b; }
          }
        }
        attribute.needsUpdate = true;
      }
      for (const face of faces) {
        const value = q && q.kind === "pocket" ? valueAt(q, b.nearest, face.pocket * slots + face.slot) : 0;
        face.mesh.material.color.copy(value > 0.5 * q?.step ? colour(share(value)) : FACE);
      }
    }
    function stretch() {
      for (const one of stretched) {
        const to = one.geometry.getAttribute("position");
        for (let k = 0; k < to.array.length; k++) to.array[k] = one.base[k] + (state.factor - 1) * MM * one.shift[k];
        to.needsUpdate = true;
      }
    }
    function show() {
      outer.visible = state.outer;
      innerGroup.visible = state.inner;
      cage.visible = state.cage;
      trail.visible = state.trail && part.has_cage;
      if (land) land.visible = part.guidance === "inner_land" ? state.inner : state.outer;
      rollers.forEach((roller) => { roller.group.visible = state.rollers; });
      const planes = state.section ? [new THREE.Plane(new THREE.Vector3(-1, 0, 0), 0)] : [];
      for (const look of [ringMaterial, innerMaterial, landMaterial]) look.clippingPlanes = planes;
    }
    // what may be picked, and what hides it
    const things = () => [...(state.rollers ? rollers.map((r) => r.body) : []), ...(state.cage ? faces.map((f) => f.mesh) : [])];
    const hides = () => [state.outer && outer, state.inner && inner, state.cage && cage.children[0]].filter(Boolean);
    function whereIs(pick) { // in the page's axes
      const at = pick.kind === "roller" ? new THREE.Vector3(0, 0, 0.56 * g.length * MM).applyMatrix4(rollers[pick.index].group.matrix)
        : new THREE.Vector3(...faces.find((f) => f.pocket === pick.index && f.slot === pick.slot).centre).multiplyScalar(MM).applyMatrix4(cage.matrix);
      return at.applyMatrix4(world.matrixWorld);
    }
    const whereIsRoller = (i) => new THREE.Vector3().setFromMatrixPosition(rollers[i].group.matrix).applyMatrix4(world.matrixWorld);
    return { part, world, innerGroup, outerGroup, bore, trailFactor, quantities, valueAt, stand, paint, force, stretch, show, things, hides, whereIs, whereIsRoller };
  }
  return { MM, LOAD_COLOURS, POCKET_COLOUR, material, make };
})();
