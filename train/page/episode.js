// One episode: two controllers side by side, one clock, one camera, and their curves below.

const picked = () => [...document.querySelectorAll(".chooser select")].map((select) => Number(select.value));

// The figure with the curves of no control and of the recordings picked, and none of the others' panels.

function arranged({ data, layout }, chosen) {
  const { whose, colours } = layout.meta;
  const shown = [...new Set([0, ...chosen])];
  const suffix = (row) => (row ? String(row + 1) : "");
  const rows = whose.map((_, row) => row).filter((row) => whose[row] < 0 || shown.slice(1).includes(whose[row]));
  const axes = new Set(rows.map((row) => `y${suffix(row)}`));
  const listed = new Set();
  const traces = data.filter((trace) => axes.has(trace.yaxis) && shown.includes(trace.meta.recording)).map((trace) => {
    const changed = { ...trace, showlegend: !listed.has(trace.legendgroup) };
    listed.add(trace.legendgroup);
    if (whose[Number(trace.yaxis.slice(1) || 1) - 1] < 0) {
      const place = shown.indexOf(trace.meta.recording);
      changed.line = { ...trace.line, color: colours[place], dash: place === 2 ? "dash" : "solid" };
    }
    return changed;
  });
  const kept = { ...layout, annotations: (layout.annotations ?? []).filter((note) => axes.has(note.yref.split(" ")[0])) };
  whose.forEach((_, row) => { if (!rows.includes(row)) delete kept[`yaxis${suffix(row)}`]; });
  if (layout.grid) kept.grid = { ...layout.grid, rows: rows.length, subplots: rows.map((row) => [`xy${suffix(row)}`]) };
  return { data: traces, layout: kept, panels: rows.length };
}

function magnified(deflection, drawn) {
  if (!(deflection > 0)) return 1;
  const wanted = drawn / deflection;
  const power = 10 ** Math.floor(Math.log10(wanted));
  return power * [5, 2, 1].find((digit) => digit * power <= wanted);
}

const minus = (text) => text.replace("-", "−");
const digits = (value) => minus(String(Number(value.toPrecision(3))));
const number = (value) => minus(Math.abs(value) < 0.5 ? "0" : value.toFixed(0));

function startBlade(content, toPrint) {
  const blade = readBlade(content);
  const canvases = [...document.querySelectorAll(".pair canvas")];
  const slider = document.getElementById("instant");
  const clock = document.getElementById("clock");
  const play = document.getElementById("play");
  const series = document.getElementById("time-series");
  const times = JSON.parse(slider.dataset.times);
  const camera = cameraTowards(blade.towards);
  const perFrame = 50;
  let timer = null;
  let asked = false;
  let busy = false;
  let printing = toPrint;

  const recordings = () => picked().map((place) => blade.recordings[place]);

  function told(recording, frame) {
    const lost = recording.failed !== null && times[frame] > recording.failed ? `, failed at ${number(recording.failed)} ms` : "";
    const [lag, flap] = recording.tip.slice(2 * frame, 2 * frame + 2);
    const load = [...recording.load.slice(2 * frame, 2 * frame + 2)].map(digits);
    const count = blade.actuators.length;
    const volts = [...recording.volts.slice(count * frame, count * (frame + 1))].map(number).join(", ");
    const dead = recording.dead[frame] ?? [];
    const broken = [...dead.filter((k) => k < count).map((k) => `actuator ${k + 1}`), ...dead.filter((k) => k >= count).map((k) => `sensor ${k - count + 1}`)];
    return `Tip: lag ${number(lag)} µm, flap ${number(flap)} µm${lost}. Load: lag ${load[0]} N/m, flap ${load[1]} N/m. Voltages: ${volts} V.${broken.length ? ` Dead: ${broken.join(", ")}.` : ""}`;
  }

  function paint() {
    asked = false;
    const frame = slider.valueAsNumber;
    const both = recordings();
    const factor = magnified(Math.max(...both.map((each) => each.largest)), blade.shownDeflection);
    const colours = blade.themes[printing ? "light" : theme()];
    document.getElementById("magnification").textContent = factor.toLocaleString("en");
    canvases.forEach((canvas, side) => {
      drawBlade(canvas, blade, both[side], frame, factor, camera, colours);
      const text = told(both[side], frame);
      const caption = canvas.nextElementSibling;
      caption.querySelector("strong").textContent = both[side].name;
      caption.querySelector("span").textContent = text;
      canvas.setAttribute("aria-label", `The blade under ${both[side].name} at ${times[frame].toFixed(1)} ms, in three dimensions`);
    });
    clock.textContent = `t = ${times[frame].toFixed(1)} ms`;
    const words = both.map((each) => `${each.name}: ${told(each, frame)}`);
    slider.setAttribute("aria-valuetext", `${times[frame].toFixed(1)} milliseconds. ${words.join(" ")}`);
    canvases[0].dataset.view = JSON.stringify({ frame, factor, ...camera });
  }

  async function mark() {
    if (busy || !series.layout) return;
    busy = true;
    let instant = null;
    while (instant !== times[slider.valueAsNumber]) {
      instant = times[slider.valueAsNumber];
      await Plotly.relayout(series, { "shapes[0].x0": instant, "shapes[0].x1": instant });
    }
    busy = false;
  }

  function show() {
    if (!asked) requestAnimationFrame(paint);
    asked = true;
    mark();
  }

  function stop() {
    clearInterval(timer);
    timer = null;
    play.textContent = "Play";
  }

  function advance() {
    if (slider.valueAsNumber >= times.length - 1) return stop();
    slider.valueAsNumber += 1;
    show();
  }

  function goTo(time) {
    const distance = times.map((each) => Math.abs(each - time));
    slider.valueAsNumber = distance.indexOf(Math.min(...distance));
    stop();
    show();
  }

  slider.addEventListener("input", () => { stop(); show(); });
  play.addEventListener("click", () => {
    if (timer !== null) return stop();
    if (slider.valueAsNumber >= times.length - 1) slider.valueAsNumber = 0;
    play.textContent = "Pause";
    timer = setInterval(advance, perFrame);
  });
  series.on("plotly_click", ({ points }) => goTo(points[0].x));
  document.getElementById("largest").addEventListener("click", () => goTo(times[largestFrame()]));

  function largestFrame() {
    const { tip } = recordings()[0];
    let best = 0;
    for (let k = 0; k < blade.frames; k++) {
      if (Math.hypot(tip[2 * k], tip[2 * k + 1]) > Math.hypot(tip[2 * best], tip[2 * best + 1])) best = k;
    }
    return best;
  }

  steer(canvases, camera, show);
  for (const canvas of canvases) new ResizeObserver(show).observe(canvas);
  document.addEventListener("themed", show);
  document.addEventListener("picked", show);
  for (const [name, begins] of [["beforeprint", true], ["afterprint", false]]) {
    addEventListener(name, () => { printing = begins; paint(); });
  }
  slider.valueAsNumber = largestFrame();
  paint();
  mark();
}

// The blade is built when it comes near the screen, or is to be printed.

function buildWhenSeen() {
  const home = document.getElementById("blade");
  if (!home) return;
  let built = false;
  const build = (toPrint) => {
    if (built) return;
    built = true;
    watcher.disconnect();
    startBlade(JSON.parse(document.getElementById("blade-content").textContent), toPrint);
    home.dataset.built = "yes";
  };
  const watcher = new IntersectionObserver((entries) => { if (entries.some((entry) => entry.isIntersecting)) build(false); }, { rootMargin: "200px" });
  watcher.observe(home);
  addEventListener("beforeprint", () => build(true));
}
