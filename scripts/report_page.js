"use strict";
const all = (selector, from = document) => [...from.querySelectorAll(selector)];
const put = (name, attributes, into) => {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (into) into.append(made);
  return made;
};
const words = (value) => value.toLocaleString("en-US", { maximumSignificantDigits: 4 });

// Theme: what the system says, or one of the two, kept where the browser lets it.
const themes = ["system", "light", "dark"];
const system = matchMedia("(prefers-color-scheme: dark)");
let theme = "system";
try { theme = localStorage.getItem("theme") || theme; } catch { /* a page without storage */ }
function showTheme() {
  const dark = theme === "dark" || (theme === "system" && system.matches);
  document.documentElement.dataset.theme = dark ? "dark" : "light";
  document.getElementById("theme").textContent = `theme: ${theme}`;
}
document.getElementById("theme").onclick = () => {
  theme = themes[(themes.indexOf(theme) + 1) % themes.length];
  try { localStorage.setItem("theme", theme); } catch { /* as above */ }
  showTheme();
};
system.addEventListener("change", showTheme);
showTheme();

// Tabs: arrow keys, Home and End; the address names the one that is open.
const tabs = all("[role=tab]");
function open(at, focus) {
  tabs.forEach((tab, i) => {
    tab.setAttribute("aria-selected", i === at);
    tab.tabIndex = i === at ? 0 : -1;
    document.getElementById(tab.getAttribute("aria-controls")).hidden = i !== at;
  });
  if (focus) tabs[at].focus();
  dispatchEvent(new Event("resize"));  // what was hidden has a width now
}
tabs.forEach((tab, at) => {
  tab.onclick = () => { open(at); history.replaceState(null, "", `#${tab.id}`); };
  tab.onkeydown = (event) => {
    const to = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: tabs.length - 1 }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    open((to + tabs.length) % tabs.length, true);
  };
});
if (tabs.length) open(Math.max(0, tabs.findIndex((tab) => `#${tab.id}` === location.hash)));

// Frame and another picture with an edge between them.
for (const compare of all(".compare")) {
  const stage = compare.querySelector(".stage"), range = compare.querySelector("[type=range]");
  if (!range) continue;
  const show = () => stage.style.setProperty("--split", `${range.value}%`);
  range.oninput = show;
  const drag = (event) => {
    const box = stage.getBoundingClientRect();
    range.value = Math.round(100 * (event.clientX - box.left) / box.width);
    show();
  };
  stage.onpointerdown = (event) => { stage.setPointerCapture(event.pointerId); drag(event); };
  stage.onpointermove = (event) => { if (event.buttons) drag(event); };
  for (const radio of all("[type=radio]", compare)) {
    radio.onchange = () => {
      for (const layer of all(".layer", compare)) layer.hidden = layer.dataset.what !== radio.value;
      compare.querySelector(".other").textContent = radio.value;
      compare.querySelector(".legend-of-error").hidden = radio.value === "reference";
    };
  }
}

// Values under the pointer, or by arrow keys.
for (const figure of all("[data-heat]")) {
  const { values, columns, group, unit } = JSON.parse(figure.dataset.heat);
  const svg = figure.querySelector("svg"), mark = figure.querySelector(".mark");
  const [, , width, height] = svg.getAttribute("viewBox").split(" ").map(Number);
  let at = -1;
  const show = (to) => {
    at = to;
    const column = at % columns, row = Math.floor(at / columns);
    mark.removeAttribute("hidden");
    mark.setAttribute("x", column * group[0]);
    mark.setAttribute("y", row * group[1]);
    mark.setAttribute("width", Math.min(group[0], width - column * group[0]));
    mark.setAttribute("height", Math.min(group[1], height - row * group[1]));
    figure.querySelector("output").textContent =
      `group ${at}, at ${column * group[0]}, ${row * group[1]} px: ${words(values[at])} ${unit}`;
  };
  svg.onpointermove = (event) => {
    const box = svg.getBoundingClientRect();
    const column = Math.floor((event.clientX - box.left) / box.width * width / group[0]);
    const row = Math.floor((event.clientY - box.top) / box.height * height / group[1]);
    const to = row * columns + column;
    if (column >= 0 && column < columns && to >= 0 && to < values.length) show(to);
  };
  svg.onkeydown = (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1, ArrowDown: columns, ArrowUp: -columns }[event.key];
    if (step === undefined) return;
    event.preventDefault();
    const to = at < 0 ? 0 : at + step;
    if (to >= 0 && to < values.length) show(to);
  };
}

// Points of two columns of a table, as wide as the page has room.
const mostLabels = 24;
function ticks(low, high) {
  const rough = (high - low) / 5, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((k) => k * power).find((s) => s >= rough);
  const found = [];
  for (let k = Math.floor(low / step); (k - 1) * step < high; ++k) found.push(k * step);
  return found;
}
function scaled(values, from, to) {
  let low = Math.min(...values), high = Math.max(...values);
  if (low === high) { low -= Math.abs(low) / 2 || 1; high += Math.abs(high) / 2 || 1; }
  if (low > 0 && low < high / 3) low = 0;
  const at = ticks(low, high), first = at[0], last = at[at.length - 1];
  return { at, place: (v) => from + (to - from) * (v - first) / (last - first) };
}
function drawAxes(svg, box, x, y, across, up) {
  const text = (attributes, content) => { put("text", attributes, svg).textContent = content; };
  const every = Math.ceil(x.at.length * 70 / (box.right - box.left));
  x.at.forEach((v, i) => {
    put("line", { class: "axis", x1: x.place(v), x2: x.place(v), y1: box.top, y2: box.bottom }, svg);
    if (i % every === 0) text({ x: x.place(v), y: box.bottom + 19, "text-anchor": "middle" }, words(v));
  });
  for (const v of y.at) {
    put("line", { class: "axis", x1: box.left, x2: box.right, y1: y.place(v), y2: y.place(v) }, svg);
    text({ x: box.left - 8, y: y.place(v) + 4, "text-anchor": "end" }, words(v));
  }
  text({ x: (box.left + box.right) / 2, y: box.bottom + 42, "text-anchor": "middle" }, across);
  const middle = (box.top + box.bottom) / 2;
  text({ x: 14, y: middle, "text-anchor": "middle", transform: `rotate(-90 14 ${middle})` }, up);
}
// Beside their points, those that cover no other.
function drawLabels(svg, points, right) {
  const taken = points.map((p) => [p.cx - 6, p.cy - 6, p.cx + 6, p.cy + 6]);
  for (const p of points) {
    const label = put("text", { class: "label", y: p.cy + 4 }, svg);
    label.textContent = p.label;
    const width = label.getComputedTextLength();
    const free = [p.cx + 10, p.cx - 10 - width].filter((x) => x > 0 && x + width < right)
      .map((x) => [x, p.cy - 8, x + width, p.cy + 8])
      .find((a) => !taken.some((b) => a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]));
    if (free) {
      label.setAttribute("x", free[0]);
      taken.push(free);
    } else {
      label.remove();
    }
  }
}
function drawPoints(figure) {
  const { names, points, labels, best } = JSON.parse(figure.dataset.points);
  const svg = figure.querySelector("svg");
  const width = figure.clientWidth || 900, height = Math.max(280, Math.min(440, width / 2));
  const box = { left: 84, right: width - 24, top: 14, bottom: height - 52 };
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  svg.replaceChildren();
  const chosen = Object.fromEntries(all("select", figure).map((s) => [s.dataset.axis, +s.value]));
  const shown = points.map((values, i) => ({ x: values[chosen.across], y: values[chosen.up], i }))
    .filter((p) => p.x !== null && p.y !== null).sort((a, b) => a.x - b.x || a.y - b.y);
  if (!shown.length) return;
  const x = scaled(shown.map((p) => p.x), box.left, box.right);
  const y = scaled(shown.map((p) => p.y), box.bottom, box.top);
  drawAxes(svg, box, x, y, names[chosen.across], names[chosen.up]);
  const describe = (p) => `${labels[p.i] ? labels[p.i] + ": " : ""}${names[chosen.up]} ${words(p.y)}, ${names[chosen.across]} ${words(p.x)}`;
  for (const p of shown) Object.assign(p, { cx: x.place(p.x), cy: y.place(p.y), label: labels[p.i] });
  const dots = shown.map((p) => {
    const dot = put("circle", { cx: p.cx, cy: p.cy, r: 5, class: best[p.i] ? "best" : "" }, svg);
    put("title", {}, dot).textContent = describe(p);
    return dot;
  });
  if (shown.length <= mostLabels) drawLabels(svg, shown.filter((p) => p.label), width);
  let at = -1;
  svg.onkeydown = (event) => {
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    if (at >= 0) dots[at].classList.remove("at");
    at = Math.min(Math.max(at + step, 0), dots.length - 1);
    dots[at].classList.add("at");
    figure.querySelector("output").textContent = describe(shown[at]);
  };
}
const diagrams = all("[data-points]");
for (const figure of diagrams) {
  for (const select of all("select", figure)) select.onchange = () => drawPoints(figure);
}
let drawnAt = 0;
function drawDiagrams() {
  const width = diagrams.length ? diagrams[0].clientWidth : 0;
  if (width === drawnAt) return;
  drawnAt = width;
  diagrams.forEach(drawPoints);
}
addEventListener("resize", drawDiagrams);
drawDiagrams();

// Tables that are sorted by the column whose head is pressed.
for (const table of all("table.sortable")) {
  const heads = all("th", table.tHead), body = table.tBodies[0];
  heads.forEach((head, column) => {
    head.querySelector("button").onclick = () => {
      const down = head.getAttribute("aria-sort") === "ascending";
      const key = (row) => row.cells[column].textContent;
      const value = (row) => parseFloat(key(row).replaceAll(",", ""));
      const numbers = head.classList.contains("n");
      const rows = [...body.rows].sort((a, b) => numbers
        ? (value(a) || 0) - (value(b) || 0) : key(a).localeCompare(key(b)));
      body.replaceChildren(...(down ? rows.reverse() : rows));
      heads.forEach((other) => other.removeAttribute("aria-sort"));
      head.setAttribute("aria-sort", down ? "descending" : "ascending");
    };
  });
}

for (const button of all(".command button")) {
  button.onclick = () => {
    const code = button.previousElementSibling;
    getSelection().selectAllChildren(code);
    button.textContent = document.execCommand("copy") ? "copied" : "selected";
  };
}
