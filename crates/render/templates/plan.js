"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const get = id => document.getElementById(id);
const make = (name, text, words = {}) => {
  const element = document.createElement(name);
  if (text !== undefined) element.textContent = text;
  for (const [key, value] of Object.entries(words)) element.setAttribute(key, value);
  return element;
};
const slider = get("time"), view = get("view"), menu = get("variant"), play = get("play");
// What of a map is the same in all pictures is in the first alone.
const areas = [...document.querySelectorAll("#picture g.areas")].map(group => [...group.childNodes]);
let time = 0, variant = data.variants[0], timer = null, movers = [];

/** A picture of the variant, of one path or of all, with what moves on it. */
function picture(only) {
  const figure = make("figure");
  figure.innerHTML = variant.svg;
  const svg = figure.querySelector("svg");
  svg.querySelectorAll("g.areas").forEach((group, i) => {
    if (!group.childNodes.length) group.append(...(areas[i] ?? []).map(node => node.cloneNode(true)));
  });
  const others = element => only && element.dataset.path !== only;
  for (const element of svg.querySelectorAll("[data-path]")) if (others(element)) element.classList.add("faint");
  for (const mover of variant.movers) {
    if (only && mover.path && mover.path !== only) continue;
    const group = document.createElementNS("http://www.w3.org/2000/svg", "g");
    group.innerHTML = mover.svg;
    group.classList.add("mover");
    svg.append(group);
    movers.push({ group, at: mover.at });
  }
  if (only) figure.append(make("figcaption", only));
  return figure;
}

function draw() {
  movers = [];
  const names = view?.value === "side" ? variant.paths.map(path => path.name) : [null];
  get("picture").replaceChildren(...names.map(picture));
}

const word = truth => truth === true ? "holds" : truth === false ? "does not hold" : "open";
const kind = truth => truth === true ? "yes" : truth === false ? "no" : "open";
const sign = truth => truth === true ? "✓ " : truth === false ? "✗ " : "? ";
const ended = (values, at) => values[Math.min(at, values.length - 1)];

/** Equal neighbours as one piece of a bar. */
function strip(values) {
  const bar = make("div", undefined, { class: "strip", "aria-hidden": "true" });
  for (let from = 0; from < values.length;) {
    let to = from + 1;
    while (to < values.length && values[to] === values[from]) to++;
    const piece = make("i", undefined, { class: kind(values[from]) });
    piece.style.flex = `${to - from} 0 0`;
    bar.append(piece);
    from = to;
  }
  bar.append(make("span", undefined, { class: "cursor" }));
  return bar;
}

function tables() {
  const parts = variant.parts.map(part => {
    const row = make("tr");
    const name = make("td", part.words);
    name.style.paddingLeft = `${.5 + 1.2 * part.depth}rem`;
    const decided = part.values.findIndex(value => value !== null);
    const last = ended(part.values, part.values.length - 1);
    const end = part.present ? "" : decided < 0 ? "open: it reads paths that are not given" : `${word(last)}, decided at time ${decided}`;
    const bar = make("td", undefined, { class: "bar" });
    bar.append(strip(part.values));
    row.append(name, make("td"), make("td", end, { class: part.present ? "" : kind(last) }), bar);
    return row;
  });
  get("parts").tBodies[0].replaceChildren(...parts);
  const head = make("tr"), columns = variant.paths.flatMap(path => path.columns.map(column => [path.name, column]));
  head.append(make("th", "time", { scope: "col" }), ...columns.map(([path, column]) => make("th", `${path}: ${column}`, { scope: "col", title: `${path}: ${column}` })));
  get("states").tHead.replaceChildren(head);
  const rows = [];
  for (let at = 0; at <= variant.last; at++) {
    const row = make("tr");
    row.append(make("th", at, { scope: "row" }));
    for (const path of variant.paths) {
      const values = path.rows[at] ?? path.columns.map(() => "");
      row.append(...values.map(value => make("td", value, { title: value })));
    }
    rows.push(row);
  }
  get("states").tBodies[0].replaceChildren(...rows);
}

/** What there is to see now, in words. */
function said() {
  const paths = variant.paths.map(path => {
    const values = path.rows[Math.min(time, path.rows.length - 1)];
    return `${path.name}: ${path.columns.map((column, i) => `${column} ${values[i]}`).join(", ")}`;
  });
  return `Time ${time} of ${variant.last}. ${paths.join(". ")}.${variant.same ? ` The observer sees ${variant.same[Math.min(time, variant.same.length - 1)] ? "the same of all paths" : "that paths differ"}.` : ""}`;
}

function show() {
  time = Math.max(0, Math.min(time, variant.last));
  slider.max = variant.last;
  slider.value = time;
  slider.setAttribute("aria-valuetext", `time ${time} of ${variant.last}`);
  get("now").textContent = `${time} of ${variant.last}`;
  for (const { group, at } of movers) {
    const [x, y] = ended(at, time);
    group.setAttribute("transform", `translate(${x} ${y})`);
  }
  [...get("parts").tBodies[0].rows].forEach((row, i) => {
    const truth = ended(variant.parts[i].values, time);
    row.cells[1].textContent = sign(truth) + word(truth);
    row.cells[1].className = kind(truth);
    const cursor = row.querySelector(".cursor");
    cursor.style.left = `${100 * (time + .5) / variant.parts[i].values.length}%`;
  });
  const rows = get("states").tBodies[0].rows;
  get("states").querySelector("tr.here")?.classList.remove("here");
  const here = rows[time];
  if (here) {
    here.classList.add("here");
    const tall = here.closest(".tall");
    tall.scrollTop = here.offsetTop - tall.clientHeight / 2;
  }
  get("said").textContent = timer === null ? said() : "";
}

const go = to => { time = to; show(); };

function stop() {
  clearInterval(timer);
  timer = null;
  play.textContent = "Play";
  play.setAttribute("aria-pressed", "false");
  show();
}

function start() {
  if (time >= variant.last) time = 0;
  play.textContent = "Stop";
  play.setAttribute("aria-pressed", "true");
  timer = setInterval(() => { if (time >= variant.last) stop(); else go(time + 1); }, Number(get("speed").value));
  show();
}

const toggle = () => timer === null ? start() : stop();

play.addEventListener("click", toggle);
get("first").addEventListener("click", () => go(0));
get("back").addEventListener("click", () => go(time - 1));
get("on").addEventListener("click", () => go(time + 1));
slider.addEventListener("input", () => go(Number(slider.value)));
get("speed").addEventListener("change", () => { if (timer !== null) { stop(); start(); } });
view?.addEventListener("change", () => { draw(); show(); });
menu?.addEventListener("change", () => {
  variant = data.variants[menu.selectedIndex];
  draw();
  tables();
  show();
});
document.addEventListener("keydown", event => {
  // Elements that have keys of their own keep them.
  if (event.ctrlKey || event.altKey || event.metaKey || event.target.closest("select, input, .wide")) return;
  const keys = {
    ArrowLeft: () => go(time - 1), ArrowRight: () => go(time + 1), Home: () => go(0), End: () => go(variant.last),
    " ": () => { if (event.target.closest("button")) return false; toggle(); },
  };
  if (keys[event.key] && keys[event.key]() !== false) event.preventDefault();
});
draw();
tables();
show();
