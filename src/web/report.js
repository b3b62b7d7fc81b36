// SPDX-License-Identifier: GPL-3.0-or-later
"use strict";
// Behaviour of the reports: plots, filters of tables, images that enlarge. Everything else is plain HTML.

const colours = ["#2f7fc4", "#d9730d", "#3f9a5b", "#8a5bc0", "#b0457a"];
const tints = { good: "rgba(30,150,85,.10)", bad: "rgba(210,50,40,.16)", unsure: "rgba(220,150,20,.16)", neutral: "rgba(120,130,140,.10)" };

function unpack(text, Type) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  return Array.from(new Type(bytes.buffer), (v) => (Number.isNaN(v) ? null : v));
}

function shade(spans) {
  return (u) => {
    const { ctx, bbox } = u;
    ctx.save();
    for (const [from, to, label, kind] of spans) {
      const a = Math.max(u.valToPos(from, "x", true), bbox.left);
      const b = Math.min(u.valToPos(to, "x", true), bbox.left + bbox.width);
      if (b <= a) continue;
      ctx.fillStyle = tints[kind] || tints.neutral;
      ctx.fillRect(a, bbox.top, b - a - 1, bbox.height);
      if (b - a > 26 * devicePixelRatio) {
        ctx.fillStyle = "#8a949b";
        ctx.font = `${11 * devicePixelRatio}px sans-serif`;
        ctx.fillText(label, a + 4 * devicePixelRatio, bbox.top + 12 * devicePixelRatio);
      }
    }
    ctx.restore();
  };
}

function drawPlots() {
  const axes = {};
  for (const script of document.querySelectorAll("script[data-axis]")) {
    const data = JSON.parse(script.textContent);
    axes[script.dataset.axis] = { spans: data.spans, time: unpack(data.time, Float64Array), plots: [] };
  }
  const style = getComputedStyle(document.documentElement);
  const ink = style.getPropertyValue("--soft"), rule = style.getPropertyValue("--rule");
  for (const script of document.querySelectorAll("script[data-traces]")) {
    const spec = JSON.parse(script.textContent);
    const axis = axes[spec.group];
    const coloured = spec.traces.filter((t) => !t.faint);
    const figure = document.querySelector(`figure[data-plot="${script.dataset.traces}"]`);
    const follow = (u, key) => {
      if (key !== "x" || axis.busy) return;
      axis.busy = true;
      for (const other of axis.plots) if (other !== u) other.setScale("x", { min: u.scales.x.min, max: u.scales.x.max });
      axis.busy = false;
    };
    const options = {
      width: figure.clientWidth, height: spec.height,
      cursor: { sync: { key: spec.group, setSeries: false }, drag: { x: true, y: false } },
      scales: { x: { time: false } },
      axes: [{ stroke: ink, grid: { stroke: rule }, ticks: { stroke: rule }, values: (u, v) => v.map((s) => s + " s") },
        { stroke: ink, grid: { stroke: rule }, ticks: { stroke: rule }, size: 64 }],
      series: [{ label: "time", value: (u, v) => (v === null ? "–" : v.toFixed(3) + " s") }].concat(spec.traces.map((t) => ({
        label: t.label, stroke: t.faint ? "#9aa6ae" : colours[coloured.indexOf(t) % colours.length], width: 1.4, points: { show: false },
        paths: t.stepped ? uPlot.paths.stepped({ align: 1 }) : undefined,
        value: (u, v) => (v === null ? "–" : v.toFixed(t.digits) + " " + spec.unit) }))),
      hooks: { drawClear: [shade(axis.spans)], setScale: [follow] },
    };
    const plot = new uPlot(options, [axis.time].concat(spec.traces.map((t) => unpack(t.data, Float32Array))), figure);
    axis.plots.push(plot);
    addEventListener("resize", () => plot.setSize({ width: figure.clientWidth, height: spec.height }));
  }
}

function filterTables() {
  for (const form of document.querySelectorAll("form.filters[data-table]")) {
    const rows = Array.from(document.querySelectorAll(`#${form.dataset.table} tbody tr`));
    const count = form.querySelector("output");
    const apply = () => {
      let shown = 0;
      const wanted = Object.fromEntries(Array.from(new FormData(form)));
      for (const row of rows) {
        const fits = Object.entries(wanted).every(([key, value]) => !value ||
          (key === "text" ? row.textContent.toLowerCase().includes(value.toLowerCase()) : row.dataset[key] === value));
        row.hidden = !fits;
        shown += fits;
      }
      if (count) count.textContent = `${shown} of ${rows.length}`;
    };
    form.addEventListener("input", apply);
    form.addEventListener("submit", (event) => event.preventDefault());
    apply();
  }
}

function enlargeImages() {
  const dialog = document.createElement("dialog");
  document.body.append(dialog);
  dialog.addEventListener("click", () => dialog.close());
  for (const shot of document.querySelectorAll("button.shot"))
    shot.addEventListener("click", () => {
      const copy = shot.cloneNode(true);
      dialog.replaceChildren(copy);
      dialog.showModal();
    });
  const toggle = document.getElementById("overlay-toggle");
  if (toggle) toggle.addEventListener("change", () => document.body.classList.toggle("no-overlay", !toggle.checked));
}

drawPlots();
filterTables();
enlargeImages();
