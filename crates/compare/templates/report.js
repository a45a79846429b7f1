"use strict";
{
for (const controls of document.querySelectorAll(".controls")) controls.hidden = false;

// Sorting: a button in each heading; numbers by the key of their cell, what has none last.
for (const table of document.querySelectorAll("table.sortable")) {
  const body = table.tBodies[0];
  const heads = [...table.tHead.rows[0].cells];
  heads.forEach((head, column) => {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = head.textContent;
    head.replaceChildren(button);
    button.addEventListener("click", () => {
      const down = head.getAttribute("aria-sort") === "ascending";
      for (const other of heads) other.removeAttribute("aria-sort");
      head.setAttribute("aria-sort", down ? "descending" : "ascending");
      const sign = down ? -1 : 1;
      const rows = [...body.rows].map(row => {
        const cell = row.cells[column];
        const key = cell.dataset.key === undefined ? NaN : Number(cell.dataset.key);
        return { row, key, text: cell.textContent, last: row.classList.contains("last") };
      });
      rows.sort((a, b) => {
        if (a.last !== b.last) return a.last ? 1 : -1;
        const [x, y] = [Number.isNaN(a.key), Number.isNaN(b.key)];
        if (x !== y) return x ? 1 : -1;
        return sign * (x ? a.text.localeCompare(b.text, "en", { numeric: true }) : a.key - b.key);
      });
      body.append(...rows.map(entry => entry.row));
    });
  });
}

// The scatter plot: its axes are the same for all, only marks and names change.
const data = JSON.parse(document.getElementById("data").textContent);
const figure = document.getElementById("scatter");
if (figure) {
  const svg = figure.querySelector("svg");
  const points = svg.querySelector(".points");
  const names = svg.querySelectorAll(".name");
  const chosen = ["scatter-x", "scatter-y"].map(id => document.getElementById(id));
  const element = name => document.createElementNS("http://www.w3.org/2000/svg", name);
  const draw = () => {
    const [x, y] = chosen.map(select => data.contestants[Number(select.value)]);
    points.replaceChildren();
    let faster = [0, 0], shown = 0;
    data.instances.forEach((instance, i) => {
      if (x.at[i] === null || y.at[i] === null) return;
      shown += 1;
      if (x.answer[i] !== 2 && x.at[i] < y.at[i]) faster[0] += 1;
      if (y.answer[i] !== 2 && y.at[i] < x.at[i]) faster[1] += 1;
      const agreed = x.answer[i] === y.answer[i] ? x.answer[i] : 2;
      const kind = data.kinds[agreed];
      const point = element("path");
      point.setAttribute("d", kind.outline);
      point.setAttribute("class", kind.class);
      point.setAttribute("fill", "none");
      point.setAttribute("stroke-width", "1.5");
      point.setAttribute("transform", `translate(${data.origin[0] + x.at[i]} ${data.origin[1] - y.at[i]})`);
      const title = element("title");
      title.textContent = `${instance}: ${x.words[i]}, ${y.words[i]}`;
      point.append(title);
      points.append(point);
    });
    [x, y].forEach((contestant, i) => { names[i].textContent = `${contestant.name}, seconds`; });
    svg.setAttribute("aria-label", `Wall time of ${x.name} against ${y.name}`);
    document.getElementById("scatter-count").textContent =
      `Of ${shown}, ${x.name} was better on ${faster[0]}, ${y.name} on ${faster[1]}.`;
  };
  for (const select of chosen) select.addEventListener("change", draw);
  draw();
}

// Instances: only rows with all the words.
const filter = document.getElementById("filter");
filter.addEventListener("input", () => {
  const words = filter.value.toLowerCase().split(/[\s,]+/).filter(word => word);
  const rows = [...document.getElementById("instances").tBodies[0].rows];
  let shown = 0;
  for (const row of rows) {
    const text = row.textContent.toLowerCase();
    row.hidden = !words.every(word => text.includes(word));
    shown += row.hidden ? 0 : 1;
  }
  document.getElementById("filter-count").textContent = `${shown} of ${rows.length}`;
});
}
