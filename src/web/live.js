// SPDX-License-Identifier: GPL-3.0-or-later
"use strict";
const byId = (id) => document.getElementById(id);
const shownSeconds = 20;
const mood = { pass: "good", fail: "bad", not_decidable: "unsure", not_measured: "unsure", skipped: "unsure",
               deferred: "again", under_way: "current", waiting: "waiting" };

// Traces: time, carriage mm, macro V, platform mm, micro V; a plot for each stage.
const data = [[], [], [], [], []];
const style = getComputedStyle(document.documentElement);
const colour = (name) => style.getPropertyValue(name).trim();
function plot(title, series, columns) {
  const axis = { stroke: colour("--soft"), grid: { stroke: colour("--rule"), width: 1 } };
  const u = new uPlot({
    title, width: 400, height: 190, legend: { live: false }, cursor: { show: false },
    scales: { x: { time: false }, V: {} },
    axes: [{ ...axis, label: "s", labelSize: 18, size: 36 }, { ...axis, label: "mm", labelSize: 18, size: 52 },
           { ...axis, scale: "V", side: 1, label: "V", labelSize: 18, size: 44, grid: { show: false } }],
    series: [{}, { label: series[0], stroke: colour("--accent"), width: 1.6 },
             { label: series[1], stroke: colour("--unsure"), width: 1.2, scale: "V" }],
  }, [[], [], []], byId("plots"));
  u.columns = columns;
  return u;
}
const plots = [plot("macro stage", ["carriage, mm by the encoder", "motor command, V"], [1, 2]),
               plot("micro stage", ["platform, mm by the Hall sensor", "heater command, V"], [3, 4])];
function fit() {
  const width = byId("plots").clientWidth;
  const height = Math.max(150, (byId("picture").clientHeight - 110) / 2);
  for (const u of plots) u.setSize({ width, height });
}
addEventListener("resize", fit);

function takePoints(points) {
  for (const point of points) point.forEach((value, k) => data[k].push(value));
  if (!data[0].length) return;
  const end = data[0][data[0].length - 1];
  let first = 0;
  while (data[0][first] < end - shownSeconds || data[0][first] > end) ++first;
  if (first) for (const column of data) column.splice(0, first);
  for (const u of plots) u.setData([data[0], ...u.columns.map((k) => data[k])]);
  byId("clock").textContent = `${end.toFixed(1)} s`;
}

// The picture, and what was found in it.
const canvas = byId("picture");
const context = canvas.getContext("2d");
let drawing = false;
function takePicture(number, picture) {
  if (drawing) return;
  drawing = true;
  const image = new Image();
  image.onload = () => {
    canvas.height = canvas.width * picture.height / picture.width;
    context.drawImage(image, 0, 0, canvas.width, canvas.height);
    const scale = canvas.width / picture.width;
    context.lineWidth = 2.5;
    context.font = "600 17px system-ui, sans-serif";
    for (const tag of picture.tags) {
      context.strokeStyle = "#17d06f";
      context.beginPath();
      tag.corners.forEach(([u, v], k) => context[k ? "lineTo" : "moveTo"]((u + 0.5) * scale, (v + 0.5) * scale));
      context.closePath();
      context.stroke();
      const x = Math.min(...tag.corners.map((c) => c[0])) * scale, y = Math.min(...tag.corners.map((c) => c[1])) * scale;
      context.fillStyle = "#0a3d22";
      context.fillRect(x, y - 25, context.measureText(tag.id).width + 14, 23);
      context.fillStyle = "#fff";
      context.fillText(tag.id, x + 7, y - 8);
    }
    context.strokeStyle = "rgba(255, 80, 60, .9)";
    context.lineWidth = 1.5;
    const cx = canvas.width / 2, cy = canvas.height / 2;
    context.beginPath();
    context.moveTo(cx - 12, cy); context.lineTo(cx + 12, cy); context.moveTo(cx, cy - 12); context.lineTo(cx, cy + 12);
    context.stroke();
    byId("frame").textContent = picture.tags.length
      ? `tag ${picture.tags.map((t) => t.id).join(", ")}  ·  ${picture.time_s.toFixed(2)} s` : `no tag  ·  ${picture.time_s.toFixed(2)} s`;
    drawing = false;
  };
  image.onerror = () => { drawing = false; };
  image.src = `picture.jpg?${number}`;
}

// State, reason, sites.
let paused = false, over = false;
function svg(name, attributes, parent, text) {
  const node = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const key in attributes) node.setAttribute(key, attributes[key]);
  if (text !== undefined) node.textContent = text;
  return parent.appendChild(node);
}
function takeState(state) {
  document.title = `${state.activity} - fidservo live`;
  byId("run").textContent = `fidservo  ·  ${state.run}`;
  byId("activity").textContent = state.activity;
  byId("reason").textContent = state.reason;
  document.querySelector("header").className = state.reason ? "bad" : state.activity === "paused" ? "unsure" : "";
  const map = byId("sites");
  map.replaceChildren();
  const xs = state.sites.map((s) => s.x_mm), low = Math.min(...xs), high = Math.max(...xs);
  const place = (x) => high > low ? 40 + 920 * (x - low) / (high - low) : 500;
  svg("line", { x1: 20, x2: 980, y1: 34, y2: 34 }, map);
  for (const site of state.sites) {
    const group = svg("g", { class: mood[site.state] ?? "waiting" }, map);
    svg("title", {}, group, `site ${site.id} at ${site.x_mm} mm: ${site.state.replaceAll("_", " ")}`);
    svg("circle", { cx: place(site.x_mm), cy: 34, r: 11 }, group);
    svg("text", { x: place(site.x_mm), y: 65 }, group, site.id);
  }
  const done = state.sites.filter((s) => !["waiting", "under_way", "deferred"].includes(s.state)).length;
  byId("progress").textContent = `${done} of ${state.sites.length} done`;
}

const order = (what) => fetch(what, { method: "POST" });
function stop() {
  if (over) return;
  order("stop");
  byId("activity").textContent = "stopping";
}
byId("stop").onclick = stop;
addEventListener("keydown", (event) => { if (event.key === "Escape") stop(); });
byId("pause").onclick = () => {
  paused = !paused;
  order(paused ? "pause" : "go-on");
  byId("pause").textContent = paused ? "Go on" : "Pause";
};

const events = new EventSource("events");
events.onmessage = (event) => {
  const news = JSON.parse(event.data);
  if (news.state) takeState(news.state);
  if (news.picture) takePicture(news.number, news.picture);
  takePoints(news.points);
};
function end(text) {
  over = true;
  events.close();
  byId("stop").disabled = byId("pause").disabled = true;
  if (text) byId("activity").textContent = text;
}
events.addEventListener("end", () => end(""));
events.onerror = () => end("the run is gone");
fit();
