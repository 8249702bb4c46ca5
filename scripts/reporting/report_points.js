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
    const at = x.place(v);
    put("line", { class: "axis", x1: at, x2: at, y1: box.top, y2: box.bottom }, svg);
    if (i % every === 0) text({ x: at, y: box.bottom + 19, "text-anchor": "middle" }, words(v));
  });
  for (const v of y.at) {
    const at = y.place(v);
    put("line", { class: "axis", x1: box.left, x2: box.right, y1: at, y2: at }, svg);
    text({ x: box.left - 8, y: at + 4, "text-anchor": "end" }, words(v));
  }
  text({ x: (box.left + box.right) / 2, y: box.bottom + 42, "text-anchor": "middle" }, across);
  const middle = (box.top + box.bottom) / 2;
  text({ x: 14, y: middle, "text-anchor": "middle", transform: `rotate(-90 14 ${middle})` }, up);
}
// Beside their points, those that cover no other.
function drawLabels(svg, points, right) {
  const taken = points.map((p) => [p.cx - p.r - 1, p.cy - p.r - 1, p.cx + p.r + 1, p.cy + p.r + 1]);
  for (const p of points) {
    const label = put("text", { class: "label", y: p.cy + 4 }, svg);
    label.textContent = p.label;
    const width = label.getComputedTextLength();
    const free = [p.cx + p.r + 5, p.cx - p.r - 5 - width].filter((x) => x > 0 && x + width < right)
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
// Areas of the circles are as even as the values; none where there are none.
function radii(values) {
  const known = values.filter((v) => v !== null);
  const low = Math.min(...known), high = Math.max(...known);
  if (!known.length || low === high) return values.map(() => 5);
  return values.map((v) => v === null ? 3 : Math.sqrt(12 + 130 * (v - low) / (high - low)));
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
  const radius = radii(shown.map((p) => points[p.i][chosen.size] ?? null));
  const x = scaled(shown.map((p) => p.x), box.left, box.right);
  const y = scaled(shown.map((p) => p.y), box.bottom, box.top);
  drawAxes(svg, box, x, y, names[chosen.across], names[chosen.up]);
  const describe = (p) => {
    const told = ["up", "across", "size"].filter((axis) => chosen[axis] >= 0)
      .map((axis) => `${names[chosen[axis]]} ${words(points[p.i][chosen[axis]] ?? NaN)}`);
    return `${labels[p.i] ? labels[p.i] + ": " : ""}${told.join(", ")}`;
  };
  shown.forEach((p, k) => {
    Object.assign(p, { cx: x.place(p.x), cy: y.place(p.y), r: radius[k], label: labels[p.i] });
  });
  const open = (p) => figure.dispatchEvent(new CustomEvent("open", { bubbles: true, detail: p.i }));
  const dots = shown.map((p) => {
    const dot = put("circle", { cx: p.cx, cy: p.cy, r: p.r, class: best[p.i] ? "best" : "" });
    put("title", {}, dot).textContent = describe(p);
    dot.onclick = () => open(p);
    return dot;
  });
  // Small ones on top of large ones.
  const fromLarge = shown.map((p, k) => k).sort((a, b) => shown[b].r - shown[a].r);
  svg.append(...fromLarge.map((k) => dots[k]));
  if (shown.length <= mostLabels) drawLabels(svg, shown.filter((p) => p.label), width);
  let at = -1;
  svg.onkeydown = (event) => {
    if (event.key === "Enter" && at >= 0) open(shown[at]);
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
const drawnAt = new Map();
function drawDiagrams() {
  for (const figure of diagrams) {
    const width = figure.clientWidth;  // 0 in a tab that is not open
    if (!width || width === drawnAt.get(figure)) continue;
    drawnAt.set(figure, width);
    drawPoints(figure);
  }
}
addEventListener("resize", drawDiagrams);
drawDiagrams();

// The configuration of the point that was chosen in a table or diagram, and how to run it again.
function make(name, attributes, ...within) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...within);
  return made;
}
function keyTable(rows, name) {
  const cells = (row) => row.map((text) => make("td", {}, text));
  const body = rows.map((row) => make("tr", {}, ...cells(row)));
  const head = ["key", "value"].map((text) => make("th", {}, text));
  return make("table", { class: "plain", "aria-label": name },
    make("thead", {}, make("tr", {}, ...head)), make("tbody", {}, ...body));
}
for (const holder of all("[data-machines]")) {
  const { keys, first, differing, machines, names } = JSON.parse(holder.dataset.machines);
  const show = (at) => {
    const { commands, other } = machines[at];
    const row = (key) => [keys[key], (key in other ? other[key] : first[key]) ?? "not there"];
    const named = names[at] ? `Point ${at + 1}: ${names[at]}` : `Point ${at + 1}`;
    const title = make("h4", { tabindex: -1 }, named);
    const run = commands.map((text) => {
      const button = make("button", { type: "button" }, "copy");
      copies(button);
      return make("div", { class: "command" }, make("code", { tabindex: 0 }, text), button);
    });
    const every = make("details", {}, make("summary", {}, `all ${keys.length} keys that are known`),
      keyTable(keys.map((_, key) => row(key)), "configuration"));
    every.open = holder.querySelector("details")?.open ?? false;
    const differ = keyTable(differing.map(row), "keys that are not the same for all points");
    const remark = "To run it again, with --weigh-by, --drop-invalid and --technology "
      + "if the sweep had any of them:";
    holder.replaceChildren(title, make("p", {}, remark), ...run,
      ...(differing.length ? [differ] : []), every);
    return title;
  };
  const section = holder.closest("section");
  const open = (at) => show(at).focus();
  section.addEventListener("open", (event) => open(event.detail));
  section.addEventListener("click", (event) => {
    const button = event.target.closest("[data-open]");
    if (button) open(+button.dataset.open);
  });
  show(0);
}
