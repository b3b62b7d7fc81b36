// SPDX-License-Identifier: GPL-3.0-or-later
"use strict";
// The fleet's report: units by time as coloured cells, values of each effect over units and over time. Zoomed by dragging.

function fleetReport() {
  const data = JSON.parse(document.getElementById("fleet-data").textContent);
  const style = getComputedStyle(document.documentElement);
  const ink = style.getPropertyValue("--soft"), rule = style.getPropertyValue("--rule"), accent = style.getPropertyValue("--accent");
  const sizes = ["#2e9e62", "#b9a11f", "#e09a1a", "#e0661f", "#d4322a"];
  const bounds = [1.1, 2, 5, 20];
  const colourOf = (gap) => (gap === null ? "#5b6770" : sizes[bounds.filter((b) => gap > b).length]);
  const floats = (text) => unpack(text, Float32Array), numbers = (text) => unpack(text, Float64Array);
  const axis = (extra) => Object.assign({ stroke: ink, grid: { stroke: rule }, ticks: { stroke: rule } }, extra);
  const day = (s) => new Date(s * 1000).toISOString().slice(0, 10);
  const dates = (u, v) => v.map((s) => (s === null ? "" : day(s)));
  const numerals = (u, v) => v.map((x) => (Math.abs(x) < 1e-12 ? "0" : String(Number(x.toPrecision(4)))));
  let chosen = -1;
  const plots = [];

  function plot(figure, height, xs, low, high, axes, drawing, say, down) {
    const tell = figure.querySelector(".tell");
    const options = {
      width: figure.clientWidth, height, legend: { show: false },
      cursor: { drag: { x: true, y: true, uni: 20 }, points: { show: false } },
      scales: { x: { time: false }, y: { dir: down ? -1 : 1, range: (u, min, max) => (u.zoomed ? [min, max] : [low, high]) } },
      axes, series: [{}, { paths: () => null, points: { show: false } }],
      hooks: {
        draw: [(u) => { const c = u.ctx; c.save(); c.beginPath(); c.rect(u.bbox.left, u.bbox.top, u.bbox.width, u.bbox.height); c.clip(); drawing(u, c); c.restore(); }],
        setSelect: [(u) => { u.zoomed = u.select.width > 0; }],
        setCursor: [(u) => { if (u.cursor.left >= 0) tell.textContent = say(u.posToVal(u.cursor.left, "x"), u.posToVal(u.cursor.top, "y")) || ""; }],
      },
    };
    const u = new uPlot(options, [xs, xs.map((_, i) => (i % 2 ? high : low))], figure);
    u.over.addEventListener("dblclick", () => { u.zoomed = false; u.setScale("y", { min: low, max: high }); });
    addEventListener("resize", () => u.setSize({ width: figure.clientWidth, height }));
    plots.push(u);
    return u;
  }
  const redraw = () => plots.forEach((u) => u.redraw(false));
  const choose = (unit) => { chosen = chosen === unit ? -1 : unit; redraw(); };

  function heat() {
    const figure = document.getElementById("fleet-heat");
    const row = numbers(data.heat.unit), time = numbers(data.heat.time), gap = floats(data.heat.gap);
    if (!time.length) return;
    const ends = [Math.min(...time) - data.step / 2, Math.max(...time) + data.step / 2];
    const count = data.units.length;
    const u = plot(figure, Math.min(620, Math.max(160, 60 + count * 14)), ends, -0.5, count - 0.5,
      [axis({ values: dates, space: 90 }), axis({ size: 110, values: (p, v) => v.map((k) => (Number.isInteger(k) && data.units[k]) || "") , incrs: [1, 2, 5, 10, 20, 50, 100, 200, 500] })],
      (p, c) => {
        const w = Math.max(1, Math.abs(p.valToPos(ends[0] + data.step, "x", true) - p.valToPos(ends[0], "x", true)) * 0.92);
        const h = Math.max(1, Math.abs(p.valToPos(1, "y", true) - p.valToPos(0, "y", true)) * (count > 200 ? 1 : 0.86));
        for (let i = 0; i < row.length; i += 1) {
          c.fillStyle = colourOf(gap[i]);
          c.globalAlpha = chosen < 0 || chosen === row[i] ? 0.9 : 0.25;
          c.fillRect(p.valToPos(time[i], "x", true) - w / 2, p.valToPos(row[i], "y", true) - h / 2, w, h);
        }
        c.globalAlpha = 1;
      },
      (x, y) => {
        const k = Math.round(y);
        let best = -1;
        for (let i = 0; i < row.length; i += 1)
          if (row[i] === k && Math.abs(time[i] - x) < data.step / 2 + 1 && (best < 0 || Math.abs(time[i] - x) < Math.abs(time[best] - x))) best = i;
        if (best < 0) return data.units[k];
        return `${data.units[k]}, ${day(time[best])}: ${gap[best] === null ? "failed" : "gap " + gap[best].toFixed(2) + " floors"}`;
      }, true);
    u.over.addEventListener("click", (event) => { if (u.select.width < 4) choose(Math.round(u.posToVal(event.offsetY, "y"))); });
  }

  function effect(spec, index) {
    const range = (values, errors) => {
      let low = Math.min(spec.rig, ...values.map((v, i) => v - (errors[i] || 0))), high = Math.max(spec.rig, ...values.map((v, i) => v + (errors[i] || 0)));
      const margin = 0.05 * (high - low || 1);
      return [low - margin, high + margin];
    };
    const level = (p, c, value, colour) => { c.strokeStyle = colour; c.setLineDash([6, 4]); c.beginPath(); const y = p.valToPos(value, "y", true); c.moveTo(p.bbox.left, y); c.lineTo(p.bbox.left + p.bbox.width, y); c.stroke(); c.setLineDash([]); };
    const own = floats(spec.own), error = floats(spec.error), pooled = floats(spec.pooled), unit = numbers(spec.units), odd = numbers(spec.odd);
    const [low, high] = range(own, error);
    const over = document.getElementById(`effect-units-${index}`);
    const u = plot(over, 260, [-0.5, own.length - 0.5], low, high, [axis({ values: (p, v) => v.map((k) => (Number.isInteger(k) && unit[k] !== undefined ? data.units[unit[k]] : "")), space: 80, incrs: [1, 2, 5, 10, 20, 50, 100, 200, 500] }), axis({ size: 76, values: numerals })],
      (p, c) => {
        c.fillStyle = accent; c.globalAlpha = 0.12;
        const a = p.valToPos(spec.mean + 1.96 * spec.spread, "y", true), b = p.valToPos(spec.mean - 1.96 * spec.spread, "y", true);
        c.fillRect(p.bbox.left, a, p.bbox.width, Math.max(1, b - a)); c.globalAlpha = 1;
        level(p, c, spec.rig, ink); level(p, c, spec.mean, accent);
        own.forEach((v, k) => {
          const x = p.valToPos(k, "x", true), mine = unit[k] === chosen;
          c.strokeStyle = c.fillStyle = mine ? "#d4322a" : odd[k] ? "#d9730d" : "#2f7fc4";
          c.globalAlpha = mine || odd[k] ? 1 : 0.7;
          c.lineWidth = mine ? 2.5 : 1;
          c.beginPath(); c.moveTo(x, p.valToPos(v - error[k], "y", true)); c.lineTo(x, p.valToPos(v + error[k], "y", true)); c.stroke();
          const r = mine ? 4 : 2.5; c.fillRect(x - r, p.valToPos(pooled[k], "y", true) - r, 2 * r, 2 * r);
        });
        c.globalAlpha = 1; c.lineWidth = 1;
      },
      (x) => { const k = Math.round(x); return own[k] === undefined ? "" : `${data.units[unit[k]]}: ${own[k].toPrecision(4)} \u00b1 ${error[k].toPrecision(2)} by itself, ${pooled[k].toPrecision(4)} given the fleet ${spec.unit}`; });
    u.over.addEventListener("click", (event) => { if (u.select.width < 4) choose(unit[Math.round(u.posToVal(event.offsetX, "x"))]); });

    const when = numbers(spec.time), value = floats(spec.value), std = floats(spec.std), whose = numbers(spec.whose);
    const through = document.getElementById(`effect-time-${index}`);
    if (!when.length) { through.hidden = true; return; }
    const [bottom, top] = range(value, std);
    const marks = spec.marks;
    plot(through, 260, [Math.min(...when) - data.step / 2, Math.max(...when) + data.step / 2], bottom, top, [axis({ values: dates, space: 90 }), axis({ size: 76, values: numerals })],
      (p, c) => {
        level(p, c, spec.rig, ink);
        for (const [from, to] of marks) {
          const a = p.valToPos(from, "x", true), b = p.valToPos(to, "x", true);
          c.fillStyle = "rgba(210,50,40,.16)"; c.fillRect(a, p.bbox.top, Math.max(2, b - a), p.bbox.height);
        }
        const shown = new Set(spec.changed.concat(chosen < 0 ? [] : [chosen]));
        for (let pass = 0; pass < 2; pass += 1)
          for (let i = 0; i < when.length; i += 1) {
            const bold = chosen < 0 ? shown.has(whose[i]) : whose[i] === chosen;
            if (bold !== (pass === 1)) continue;
            const x = p.valToPos(when[i], "x", true), y = p.valToPos(value[i], "y", true);
            c.fillStyle = c.strokeStyle = bold ? "#d4322a" : "#2f7fc4"; c.globalAlpha = bold ? 1 : 0.35;
            if (bold) { c.beginPath(); c.moveTo(x, p.valToPos(value[i] - std[i], "y", true)); c.lineTo(x, p.valToPos(value[i] + std[i], "y", true)); c.stroke(); }
            const r = bold ? 3 : 1.6; c.fillRect(x - r, y - r, 2 * r, 2 * r);
            if (bold && i > 0 && whose[i - 1] === whose[i]) { c.beginPath(); c.moveTo(p.valToPos(when[i - 1], "x", true), p.valToPos(value[i - 1], "y", true)); c.lineTo(x, y); c.stroke(); }
          }
        c.globalAlpha = 1;
      },
      (x, y) => {
        let best = -1, near = Infinity;
        for (let i = 0; i < when.length; i += 1) { const d = ((when[i] - x) / data.step) ** 2 + ((value[i] - y) / (top - bottom) * 30) ** 2; if (d < near) { near = d; best = i; } }
        return near > 4 ? "" : `${data.units[whose[best]]}, ${day(when[best])}: ${value[best].toPrecision(4)} \u00b1 ${std[best].toPrecision(2)} ${spec.unit}`;
      });
  }

  heat();
  // One after the other, so that the page answers meanwhile.
  const later = (k) => { if (k < data.effects.length) setTimeout(() => { effect(data.effects[k], k); later(k + 1); }, 0); };
  later(0);
}

addEventListener("DOMContentLoaded", fleetReport);
