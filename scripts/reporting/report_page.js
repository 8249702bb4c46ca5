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

// Tables that are sorted by the column whose head is pressed.
for (const table of all("table.sortable")) {
  const heads = all("th", table.tHead), body = table.tBodies[0];
  heads.forEach((head, column) => {
    head.querySelector("button").onclick = () => {
      const down = head.getAttribute("aria-sort") === "ascending";
      const key = (row) => row.cells[column].textContent;
      const value = (row) => parseFloat(key(row).replaceAll(",", "").replace("inf", "Infinity"));
      const numbers = head.classList.contains("n");
      const rows = [...body.rows].sort((a, b) => numbers
        ? (value(a) || 0) - (value(b) || 0) : key(a).localeCompare(key(b)));
      body.replaceChildren(...(down ? rows.reverse() : rows));
      heads.forEach((other) => other.removeAttribute("aria-sort"));
      head.setAttribute("aria-sort", down ? "descending" : "ascending");
    };
  });
}

function copies(button) {
  button.onclick = () => {
    const code = button.previousElementSibling;
    getSelection().selectAllChildren(code);
    button.textContent = document.execCommand("copy") ? "copied" : "selected";
  };
}
all(".command button").forEach(copies);
