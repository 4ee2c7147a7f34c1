const templates = JSON.parse(document.getElementById("templates").textContent);
const figures = [...document.querySelectorAll(".figure")];

// Themes: the system's, until the button is pressed.

const system = matchMedia("(prefers-color-scheme: dark)");
const toggle = document.getElementById("theme");
const theme = () => document.documentElement.dataset.theme ?? (system.matches ? "dark" : "light");

function nameToggle() {
  const other = theme() === "dark" ? "light" : "dark";
  toggle.textContent = other === "light" ? "Light" : "Dark";
  toggle.setAttribute("aria-label", `Show the page in ${other} colours`);
}

function applyTheme() {
  nameToggle();
  for (const figure of figures) Plotly.relayout(figure, { template: templates[theme()] });
  document.dispatchEvent(new Event("themed"));
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
  ],
};

const contents = new Map();
const narrow = 600;
const entry = 22;

function asShown(figure) {
  const { data, layout } = contents.get(figure);
  const found = layout.meta?.whose ? arranged({ data, layout }, picked()) : { data, layout, panels: 0 };
  const slim = figure.parentElement.clientWidth < narrow;
  const entries = found.data.filter((trace) => trace.showlegend).length;
  const height = Number(figure.dataset.height) + found.panels * Number(figure.dataset.panel ?? 0);
  figure.style.height = `${height + (slim ? entry * entries : 0)}px`;
  return { data: found.data, layout: { ...(slim ? slimmed(found.layout) : found.layout), template: templates[theme()] }, config };
}

// On a telephone: one entry of the legend a line, and every other tick where ticks are given one by one.

function slimmed(layout) {
  const { ticktext } = layout.xaxis ?? {};
  const zero = ticktext?.indexOf("0");
  const xaxis = ticktext ? { ...layout.xaxis, tickangle: 0, ticktext: ticktext.map((text, k) => ((k - zero) % 2 ? "" : text)) } : layout.xaxis;
  return { ...layout, xaxis, legend: { ...layout.legend, orientation: "v" } };
}

function draw(figure) {
  contents.set(figure, JSON.parse(document.querySelector(`[data-figure="${figure.id}"]`).textContent));
  return Plotly.newPlot(figure, asShown(figure));
}

function redraw(figure) {
  return Plotly.react(figure, asShown(figure));
}

// What is wider than the screen says so, and fades where it is cut.

const sideways = "Wider than the screen: scroll sideways for the rest.";

function hint(region) {
  const note = document.createElement("p");
  note.className = "more";
  note.textContent = sideways;
  region.before(note);
  const check = () => {
    const rest = region.scrollWidth - region.clientWidth;
    note.hidden = rest < 2;
    region.classList.toggle("cut", region.scrollLeft < rest - 1);
  };
  region.addEventListener("scroll", check, { passive: true });
  const watcher = new ResizeObserver(check);
  for (const each of [region, ...region.children]) watcher.observe(each);
}

document.querySelectorAll(".scroll").forEach(hint);

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
  for (const each of table.tHead.rows[0].cells) each.ariaSort = "none";
  heading.ariaSort = descending ? "descending" : "ascending";
  table.tBodies[0].append(...[...table.tBodies[0].rows].sort(order));
}

for (const table of document.querySelectorAll(".sortable")) {
  [...table.tHead.rows[0].cells].forEach((heading, column) => heading.addEventListener("click", () => sortBy(table, column)));
}

for (const select of document.querySelectorAll(".chooser select")) {
  select.addEventListener("change", async () => {
    await Promise.all(figures.filter((figure) => contents.get(figure)?.layout.meta?.whose).map(redraw));
    document.dispatchEvent(new Event("picked"));
  });
}

// On paper: light, and as wide as it.

const paper = 690;

function fit(figure, printed) {
  const size = printed ? { width: paper, autosize: false } : { width: null, autosize: true };
  Plotly.relayout(figure, { ...size, template: templates[printed ? "light" : theme()] });
}

addEventListener("beforeprint", () => figures.forEach((figure) => fit(figure, true)));
addEventListener("afterprint", () => figures.forEach((figure) => fit(figure, false)));

Promise.all(figures.map(draw)).then(() => {
  buildWhenSeen();
  document.documentElement.dataset.drawn = "yes";
});
