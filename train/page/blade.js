// The blade in three dimensions, on a canvas: the farthest faces first, those turned away left out.

function unpacked(text) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return new Float32Array(bytes.buffer);
}

const plus = (a, b, times = 1) => [a[0] + times * b[0], a[1] + times * b[1], a[2] + times * b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => plus([0, 0, 0], a, 1 / (Math.hypot(...a) || 1));
const middleOf = (points) => points.reduce((sum, point) => plus(sum, point, 1 / points.length), [0, 0, 0]);

function readBlade(content) {
  const blade = { ...content, stations: unpacked(content.stations), shapes: unpacked(content.shapes) };
  for (const name of ["station", "along", "across", "angle"]) blade[name] = unpacked(content.vertices[name]);
  for (const each of blade.recordings) {
    for (const name of ["amplitudes", "tip", "load", "volts", "outputs"]) each[name] = unpacked(each[name]);
  }
  blade.frames = blade.recordings[0].tip.length / 2;
  blade.rest = vertices(blade, null, 0, 0);
  blade.extremes = extremes(blade);
  blade.faces = blade.bodies.flatMap((body) => bodyFaces(body, blade));
  return blade;
}

// [[lag, flap, span], …], m: the vertices at a frame of a recording, so many times larger than life.

function vertices(blade, recording, frame, magnification) {
  const count = blade.stations.length;
  const moved = new Float64Array(3 * count);
  const rank = recording ? blade.shapes.length / (3 * count) : 0;
  for (let k = 0; k < rank; k++) {
    const amplitude = magnification * recording.amplitudes[frame * rank + k];
    for (let i = 0; i < 3 * count; i++) moved[i] += amplitude * blade.shapes[k * 3 * count + i];
  }
  const found = [];
  for (let v = 0; v < blade.station.length; v++) {
    const s = blade.station[v];
    const turn = blade.angle[v] + moved[2 * count + s];
    const [c, n] = [Math.cos(turn), Math.sin(turn)];
    const [x, y] = [blade.along[v], blade.across[v]];
    found.push([c * x - n * y + moved[s], n * x + c * y + moved[count + s], blade.stations[s]]);
  }
  return found;
}

// The faces of a body by the places of their corners, counter-clockwise from outside; some with a rib at their far end.

function bodyFaces({ first, stations, corners }, blade) {
  const ribs = new Set(blade.even.filter((_, index) => index && index % blade.ribs === 0));
  const faces = [];
  for (let s = 0; s + 1 < stations; s++) {
    for (let k = 0; k < corners; k++) {
      const [a, b] = [first + s * corners + k, first + s * corners + ((k + 1) % corners)];
      faces.push({ corners: [b, b + corners, a + corners, a], ribbed: ribs.has(s + 1) });
    }
  }
  const last = first + (stations - 1) * corners;
  faces.push({ corners: Array.from({ length: corners }, (_, k) => last + k), ribbed: false });
  return faces;
}

// An eye in space, upright, that sees all of the points in a frame of so many pixels.

function facing(points, camera, distance, width, height) {
  const [a, e] = [camera.azimuth, camera.elevation];
  const forward = [-Math.cos(e) * Math.sin(a), -Math.sin(e), -Math.cos(e) * Math.cos(a)];
  const right = unit(cross(forward, [0, 1, 0]));
  const down = cross(forward, right);
  const low = [0, 1, 2].map((axis) => Math.min(...points.map((point) => point[axis])));
  const high = [0, 1, 2].map((axis) => Math.max(...points.map((point) => point[axis])));
  const eye = plus(middleOf([low, high]), forward, -distance);
  const plain = (point) => {
    const seen = plus(point, eye, -1);
    const depth = dot(seen, forward);
    return [dot(seen, right) / depth, dot(seen, down) / depth, depth];
  };
  const flat = points.map(plain);
  const span = [0, 1].map((axis) => [Math.min(...flat.map((each) => each[axis])), Math.max(...flat.map((each) => each[axis]))]);
  const scale = camera.zoom * Math.min(width / (span[0][1] - span[0][0]), height / (span[1][1] - span[1][0]));
  const middle = span.map(([from, to]) => (from + to) / 2);
  const project = (point) => {
    const [x, y, depth] = plain(point);
    const [left, top] = [width * (0.5 + camera.shift[0]), height * (0.5 + camera.shift[1])];
    return [left + scale * (x - middle[0]), top + scale * (y - middle[1]), depth];
  };
  return { project, eye, right, down };
}

// Whether a polygon on the screen turns its outside to the eye.

function turned(polygon) {
  let area = 0;
  polygon.forEach(([x, y], k) => {
    const [nextX, nextY] = polygon[(k + 1) % polygon.length];
    area += x * nextY - y * nextX;
  });
  return area < 0;
}

function shade(corners, [dark, lit], light) {
  let normal = [0, 0, 0];
  corners.forEach((corner, k) => { normal = plus(normal, cross(corner, corners[(k + 1) % corners.length])); });
  const bright = 0.5 + 0.5 * dot(unit(normal), light);
  return dark.map((part, k) => Math.round(part + bright * (lit[k] - part)));
}

// The colour of a value from −1 to 1.

function coloured(scale, value) {
  const at = ((Math.max(-1, Math.min(1, value || 0)) + 1) / 2) * (scale.length - 1);
  const low = Math.min(Math.floor(at), scale.length - 2);
  return scale[low].map((part, k) => Math.round(part + (at - low) * (scale[low + 1][k] - part)));
}

const css = (colour) => `rgb(${colour.join(" ")})`;

function polygon(pen, corners, fill, edge = fill, width = 0.7) {
  pen.beginPath();
  for (const [x, y] of corners) pen.lineTo(x, y);
  pen.closePath();
  pen.fillStyle = fill;
  pen.fill();
  pen.strokeStyle = edge;
  pen.lineWidth = width;
  pen.stroke();
}

function line(pen, points, colour, width = 1) {
  pen.beginPath();
  for (const [x, y] of points) pen.lineTo(x, y);
  pen.strokeStyle = colour;
  pen.lineWidth = width;
  pen.stroke();
}

// What must fit into the picture, whatever the blade does.

function extremes(blade) {
  const dropped = blade.sensors.flatMap((first) => [0, 1, 2, 3].map((k) => plus(blade.rest[first + k], [0, -blade.drop, 0])));
  const tips = blade.bodies.flatMap(({ first, stations, corners }) => {
    const last = first + (stations - 1) * corners;
    return blade.rest.slice(last, last + corners).flatMap((point) => [-1, 1].map((side) => plus(point, [0, side * blade.shownDeflection, 0])));
  });
  const tails = blade.recordings[0].load.length ? [0, 1].flatMap((axis) => furthestTails(blade, axis)) : [];
  return [...blade.rest, ...dropped, ...tips, ...tails, ...blade.hub.flat()];
}

// Where the longest arrows of the load begin, those to either side along an axis, while the blade is at rest.

function furthestTails(blade, axis) {
  const { load } = blade.recordings[0];
  let [low, high] = [0, 0];
  for (let k = axis; k < load.length; k += 2) [low, high] = [Math.min(low, load[k]), Math.max(high, load[k])];
  return [low, high].map((value) => arrow(blade, blade.rest, axis ? [0, value] : [value, 0])[0]);
}

function drawBlade(canvas, blade, recording, frame, magnification, camera, theme) {
  const ratio = window.devicePixelRatio || 1;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  if (!width || !height) return;
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  const pen = canvas.getContext("2d");
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.lineJoin = "round";
  const margin = 12;
  pen.translate(margin, margin);
  const view = facing(blade.extremes, camera, blade.distance, width - 2 * margin, height - 2 * margin);
  const points = vertices(blade, recording, frame, magnification);
  const volts = (k) => recording.volts[frame * blade.actuators.length + k] / blade.limit;
  const channels = recording.outputs.length / blade.frames;
  const output = (channel) => (channel < 0 || channel >= channels ? 0 : recording.outputs[frame * channels + channel]);
  const dead = new Set(recording.dead[frame]);
  const deadReading = (channel) => dead.has(blade.actuators.length + channel);
  const below = view.eye[1] < points[points.length - 1][1] - blade.drop;
  const steps = [
    () => drawRest(pen, blade, view, theme),
    () => drawSensors(pen, blade, view, points, output, deadReading, theme),
    () => drawFaces(pen, blade.faces.map((face) => ({ ...face, at: face.corners.map((k) => points[k]) })), theme.body, blade.light, view),
    () => blade.actuators.forEach((first, k) => drawPatch(pen, view, patchAt(points, first), k, blade.scales.voltage, volts(k), dead.has(k), theme)),
    () => drawPoints(pen, blade, view, points, output, deadReading, theme),
  ];
  if (below) steps.push(steps.splice(1, 1)[0]);
  const hub = () => drawFaces(pen, blade.hub.map((at) => ({ at })), theme.hub, blade.light, view);
  if (view.eye[2] < 0) steps.push(hub);
  else steps.unshift(hub);
  for (const step of steps) step();
  drawLoad(pen, view, arrow(blade, points, recording.load.slice(2 * frame, 2 * frame + 2)), blade.arrow, theme);
  const held = view.project(blade.hub[0][0])[0];
  drawAxes(pen, view, [held < width / 2 ? width - 2 * margin - 60 : 60, height - 2 * margin - 30], theme);
}

// Dashed edges of the blade at rest.

function drawRest(pen, blade, { project }, theme) {
  for (const { first, corners, edges, stations } of blade.bodies) {
    for (const edge of edges) {
      const at = blade.even.map((s) => project(blade.rest[first + s * corners + edge]));
      for (let k = 0; k + 1 < at.length; k += 2) line(pen, [at[k], at[k + 1]], theme.rest);
    }
    const last = first + (stations - 1) * corners;
    const end = blade.rest.slice(last, last + corners).map(project);
    line(pen, [...end, end[0]], theme.rest);
  }
}

function drawFaces(pen, faces, colours, light, { project }) {
  const seen = [];
  for (const { at, ribbed } of faces) {
    const flat = at.map(project);
    if (turned(flat)) seen.push({ at, flat, ribbed, depth: flat.reduce((sum, point) => sum + point[2], 0) / flat.length });
  }
  seen.sort((one, other) => other.depth - one.depth);
  for (const { at, flat, ribbed } of seen) {
    const colour = shade(at, colours, light);
    polygon(pen, flat, css(colour));
    if (ribbed) line(pen, flat.slice(1, 3), css(colour.map((part) => Math.round(0.9 * part))));
  }
}

const patchAt = (points, first) => [0, 2, 3, 1].map((k) => points[first + k]);

// A patch with its number, where there is room for it; an actuator only where its outer side is seen.

function drawPatch(pen, { project }, at, index, scale, value, dead, theme, both = false) {
  const flat = at.map(project);
  if (!both && !turned(flat)) return;
  polygon(pen, flat, css(coloured(scale, value)), theme.outline, 1);
  if (dead) return crossOut(pen, flat, theme);
  const room = Math.min(Math.hypot(flat[3][0] - flat[0][0], flat[3][1] - flat[0][1]), Math.hypot(flat[1][0] - flat[0][0], flat[1][1] - flat[0][1]));
  if (room < 7) return;
  const [x, y] = middleOf(flat);
  pen.font = `${Math.min(13, Math.max(9, 0.8 * room))}px system-ui, sans-serif`;
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  pen.fillStyle = Math.abs(value) > 0.7 ? "#ffffff" : "#1f2933";
  pen.fillText(String(index + 1), x, y);
}

// What is dead is crossed out.

function crossOut(pen, [a, b, c, d], theme) {
  line(pen, [a, c], theme.outline, 2);
  line(pen, [b, d], theme.outline, 2);
}

// Sensor patches are drawn below the wall they lie in: nobody could see them there.

function drawSensors(pen, blade, view, points, output, dead, theme) {
  blade.sensors.forEach((first, k) => {
    const there = patchAt(points, first);
    const at = there.map((point) => plus(point, [0, -blade.drop, 0]));
    line(pen, [middleOf(there), middleOf(at)].map(view.project), theme.rest);
    const channel = blade.readBy.sensors[k];
    drawPatch(pen, view, at, k, blade.scales.output, output(channel), dead(channel), theme, true);
  });
}

function drawPoints(pen, blade, { project }, points, output, dead, theme) {
  blade.points.forEach((place, k) => {
    const [x, y] = project(points[place]);
    const diamond = [[5, 0], [0, 5], [-5, 0], [0, -5]].map(([right, down]) => [x + right, y + down]);
    const channel = blade.readBy.points[k];
    polygon(pen, diamond, css(coloured(blade.scales.output, output(channel))), theme.outline, 1);
    if (dead(channel)) crossOut(pen, diamond, theme);
  });
}

// Tail and head of the arrow of a line load (lag, flap): it ends in the middle of the blade near its tip.

function arrow(blade, points, load) {
  const { station, length, largest } = blade.arrow;
  const head = middleOf(blade.bodies.map(({ first, corners }) => middleOf(points.slice(first + station * corners, first + (station + 1) * corners))));
  return [plus(head, [load[0], load[1], 0], largest ? -length / largest : 0), head];
}

function drawLoad(pen, { project }, ends, { head, shaft, shortest }, theme) {
  const [from, to] = ends.map(project);
  const [right, down] = [to[0] - from[0], to[1] - from[1]];
  const size = Math.hypot(right, down);
  if (!(size > shortest)) return;
  const [x, y] = [right / size, down / size];
  const part = Math.min(head, size);
  const back = [to[0] - part * x, to[1] - part * y];
  line(pen, [from, back], theme.load, shaft);
  polygon(pen, [to, [back[0] - 0.45 * part * y, back[1] + 0.45 * part * x], [back[0] + 0.45 * part * y, back[1] - 0.45 * part * x]], theme.load);
}

// Which way lag, flap and span are.

function drawAxes(pen, { right, down }, origin, theme) {
  const size = 26;
  pen.font = "12px system-ui, sans-serif";
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  for (const [name, axis] of Object.entries({ lag: [1, 0, 0], flap: [0, 1, 0], span: [0, 0, 1] })) {
    const way = [dot(axis, right), dot(axis, down)];
    const length = Math.hypot(...way);
    if (length < 0.15) continue;
    line(pen, [origin, [origin[0] + size * way[0], origin[1] + size * way[1]]], theme.ink, 1.2);
    const away = size * length + 12;
    pen.fillStyle = theme.ink;
    pen.fillText(name, origin[0] + (away * way[0]) / length, origin[1] + (away * way[1]) / length);
  }
}
