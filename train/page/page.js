"use strict";

const templates = JSON.parse(document.getElementById("templates").textContent);
const figures = [...document.querySelectorAll(".figure")];

// Themes: the system's, until the button is pressed.

const system = matchMedia("(prefers-color-scheme: dark)");
const toggle = document.getElementById("theme");
const theme = () => document.documentElement.dataset.theme ?? (system.matches ? "dark" : "light");

function nameToggle() {
  toggle.textContent = theme() === "dark" ? "Light" : "Dark";
}

function applyTheme() {
  nameToggle();
  for (const figure of figures) Plotly.relayout(figure, { template: templates[theme()] });
}

toggle.addEventListener("click", () => {
  document.documentElement.dataset.theme = theme() === "dark" ? "light" : "dark";
  applyTheme();
});
system.addEventListener("change", applyTheme);
nameToggle();

// Figures.

const config = {
  responsive: true,
  displaylogo: false,
  showSendToCloud: false,
  modeBarButtonsToRemove: [
    ...["toImage", "select2d", "lasso2d", "zoomIn2d", "zoomOut2d", "autoScale2d"],
    ...["zoom3d", "pan3d", "orbitRotation", "tableRotation", "resetCameraLastSave3d"],
  ],
};

function draw(figure) {
  const { data, layout, frames } = JSON.parse(document.querySelector(`[data-figure="${figure.id}"]`).textContent);
  return Plotly.newPlot(figure, { data, layout: { ...layout, template: templates[theme()] }, frames, config });
}

// The table: numbers by their value, what has none last.

function sortBy(table, column) {
  const heading = table.tHead.rows[0].cells[column];
  const descending = heading.ariaSort === "ascending";
  const number = (row) => Number(row.cells[column].dataset.value ?? NaN);
  const order = (one, other) => {
    const [a, b] = [number(one), number(other)];
    if (Number.isFinite(a) && Number.isFinite(b)) return descending ? b - a : a - b;
    if (Number.isFinite(a) !== Number.isFinite(b)) return Number.isFinite(a) ? -1 : 1;
    const byText = one.cells[column].textContent.localeCompare(other.cells[column].textContent);
    return descending ? -byText : byText;
  };
  for (const each of table.tHead.rows[0].cells) each.ariaSort = null;
  heading.ariaSort = descending ? "descending" : "ascending";
  table.tBodies[0].append(...[...table.tBodies[0].rows].sort(order));
}

for (const table of document.querySelectorAll(".sortable")) {
  [...table.tHead.rows[0].cells].forEach((heading, column) => heading.addEventListener("click", () => sortBy(table, column)));
}

// The blade: one slider and one camera for both, and the instant marked in the time series.

function linkBlades(pair) {
  const slider = document.getElementById("instant");
  const clock = document.getElementById("clock");
  const play = document.getElementById("play");
  const series = document.getElementById("time-series");
  const times = JSON.parse(slider.dataset.times);
  const still = { mode: "immediate", transition: { duration: 0 }, frame: { duration: 0, redraw: true } };
  const perFrame = 50;
  let shown = null;
  let busy = false;
  let timer = null;

  async function show() {
    clock.textContent = `t = ${times[slider.valueAsNumber].toFixed(1)} ms`;
    if (busy) return;
    busy = true;
    while (shown !== slider.valueAsNumber) {
      shown = slider.valueAsNumber;
      const instant = times[shown];
      await Promise.all(pair.map((blade) => Plotly.animate(blade, [String(shown)], still)));
      await Plotly.relayout(series, { "shapes[0].x0": instant, "shapes[0].x1": instant });
    }
    busy = false;
  }

  function stop() {
    clearInterval(timer);
    timer = null;
    play.textContent = "Play";
  }

  function advance() {
    if (busy) return;
    if (slider.valueAsNumber >= times.length - 1) return stop();
    slider.valueAsNumber += 1;
    show();
  }

  slider.addEventListener("input", () => { stop(); show(); });
  play.addEventListener("click", () => {
    if (timer !== null) return stop();
    if (slider.valueAsNumber >= times.length - 1) slider.valueAsNumber = 0;
    play.textContent = "Pause";
    timer = setInterval(advance, perFrame);
  });
  series.on("plotly_click", ({ points }) => {
    const distance = times.map((time) => Math.abs(time - points[0].x));
    slider.valueAsNumber = distance.indexOf(Math.min(...distance));
    stop();
    show();
  });

  pair.forEach((blade, index) => {
    const other = pair[1 - index];
    const follow = (change) => {
      const camera = change["scene.camera"];
      if (camera && JSON.stringify(other.layout.scene.camera) !== JSON.stringify(camera)) {
        Plotly.relayout(other, { "scene.camera": structuredClone(camera) });
      }
    };
    blade.on("plotly_relayouting", follow);
    blade.on("plotly_relayout", follow);
  });
  return show();
}

Promise.all(figures.map(draw)).then(async () => {
  const pair = [...document.querySelectorAll(".pair .figure")];
  if (pair.length === 2) await linkBlades(pair);
  document.documentElement.dataset.drawn = "yes";
});
