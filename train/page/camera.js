// One camera for both blades, by buttons, keys, the wheel, one finger or two.

function cameraTowards([x, y, z]) {
  return { azimuth: Math.atan2(x, z), elevation: Math.atan2(y, Math.hypot(x, z)), zoom: 1, shift: [0, 0] };
}

// Lets a reader move the camera; `show` draws what it sees then.

function steer(canvases, camera, show) {
  const home = structuredClone(camera);
  const moves = {
    left: () => { camera.azimuth -= 0.15; },
    right: () => { camera.azimuth += 0.15; },
    up: () => { camera.elevation += 0.15; },
    down: () => { camera.elevation -= 0.15; },
    nearer: () => { camera.zoom *= 1.2; },
    farther: () => { camera.zoom /= 1.2; },
    reset: () => Object.assign(camera, structuredClone(home)),
  };
  const keys = { ArrowLeft: "left", ArrowRight: "right", ArrowUp: "up", ArrowDown: "down", "+": "nearer", "=": "nearer", "-": "farther", 0: "reset" };

  function look(change) {
    change();
    camera.elevation = Math.max(-1.5, Math.min(1.5, camera.elevation));
    camera.zoom = Math.max(0.3, Math.min(20, camera.zoom));
    show();
  }

  for (const button of document.querySelectorAll("[data-move]")) button.addEventListener("click", () => look(moves[button.dataset.move]));
  for (const canvas of canvases) {
    canvas.addEventListener("keydown", (event) => {
      if (!(event.key in keys)) return;
      event.preventDefault();
      look(moves[keys[event.key]]);
    });
    canvas.addEventListener("wheel", (event) => {
      if (document.activeElement !== canvas && !event.ctrlKey) return;
      event.preventDefault();
      look(() => { camera.zoom *= Math.exp(-0.002 * event.deltaY); });
    }, { passive: false });
    drag(canvas, camera, look);
  }
}

// One pointer turns, with Shift it moves; two fingers zoom and move.

function drag(canvas, camera, look) {
  const pointers = new Map();
  const shiftBy = ([across, down]) => { camera.shift = [camera.shift[0] + across / canvas.clientWidth, camera.shift[1] + down / canvas.clientHeight]; };
  canvas.addEventListener("pointerdown", (event) => {
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!pointers.has(event.pointerId)) return;
    const before = pairOf(pointers);
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
    const after = pairOf(pointers);
    const moved = [0, 1].map((axis) => after.middle[axis] - before.middle[axis]);
    look(() => {
      if (pointers.size > 1) camera.zoom *= after.apart / before.apart;
      if (pointers.size > 1 || event.shiftKey) shiftBy(moved);
      else [camera.azimuth, camera.elevation] = [camera.azimuth - 0.01 * moved[0], camera.elevation + 0.01 * moved[1]];
    });
  });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (event) => { pointers.delete(event.pointerId); });
  canvas.addEventListener("touchmove", (event) => { if (event.touches.length > 1) event.preventDefault(); }, { passive: false });
}

// Middle and distance, px, of the first two pointers; of one alone itself and 1.

function pairOf(pointers) {
  const [one, other = one] = [...pointers.values()];
  const middle = [0, 1].map((axis) => (one[axis] + other[axis]) / 2);
  return { middle, apart: Math.hypot(one[0] - other[0], one[1] - other[1]) || 1 };
}
