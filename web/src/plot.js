// Plots to explore: values under the pointer, zoom by dragging, back by double click.
import uPlot from "uplot";
import plotStyle from "uplot/dist/uPlot.min.css";

const height = 400;
const font = "13px system-ui, sans-serif";

function colours() {
  const style = getComputedStyle(document.documentElement);
  return { ink: style.getPropertyValue("--ink").trim(), soft: style.getPropertyValue("--soft").trim(), line: style.getPropertyValue("--line").trim() };
}

/// Ascending x is what the library needs; a curve that turns back (cycles) stays a drawing.
function ascending(series) {
  const { x, y, mark } = series;
  if (mark === "bars") return { x, y: [...y, y[y.length - 1]] };
  const rises = x.every((v, i) => i === 0 || v >= x[i - 1]);
  const falls = x.every((v, i) => i === 0 || v <= x[i - 1]);
  if (rises) return { x, y };
  if (falls) return { x: [...x].reverse(), y: [...y].reverse() };
  if (mark !== "points") return null;
  const order = x.map((_, i) => i).sort((a, b) => x[a] - x[b]);
  return { x: order.map((i) => x[i]), y: order.map((i) => y[i]) };
}

function lookOf(series, title) {
  const look = { pxAlign: 0, label: series.name || title, stroke: series.colour, width: 2, points: { show: false }, spanGaps: false };
  if (series.mark === "dashed") look.dash = [8, 5];
  if (series.mark === "bars") Object.assign(look, { paths: uPlot.paths.stepped({ align: 1 }), fill: series.colour + "55", width: 1, pxAlign: 1 });
  if (series.mark === "points") Object.assign(look, { paths: () => null, points: { show: true, size: 7, fill: series.colour, width: 0 } });
  look.value = (_, v) => (v == null ? "–" : String(Number(v.toPrecision(5))));
  return look;
}

/// Thresholds, bounds, printed numbers: dashed lines with their names.
function guidePlugin(guides, ink) {
  return {
    hooks: {
      draw: (u) => {
        const { ctx, bbox } = u, scale = devicePixelRatio;
        ctx.save();
        ctx.strokeStyle = ctx.fillStyle = ink;
        ctx.setLineDash([2 * scale, 3 * scale]);
        ctx.font = `${12 * scale}px system-ui, sans-serif`;
        let row = 15 * scale;
        for (const guide of [...guides].sort((a, b) => a.at - b.at)) {
          const at = Math.round(u.valToPos(guide.at, guide.upright ? "x" : "y", true));
          ctx.beginPath();
          if (guide.upright) {
            if (at < bbox.left || at > bbox.left + bbox.width) continue;
            ctx.moveTo(at, bbox.top);
            ctx.lineTo(at, bbox.top + bbox.height);
            const flip = at + ctx.measureText(guide.label).width + 8 * scale > bbox.left + bbox.width;
            ctx.textAlign = flip ? "right" : "left";
            ctx.fillText(guide.label, at + (flip ? -5 : 5) * scale, bbox.top + row);
            row += 15 * scale;
          } else {
            if (at < bbox.top || at > bbox.top + bbox.height) continue;
            ctx.moveTo(bbox.left, at);
            ctx.lineTo(bbox.left + bbox.width, at);
            ctx.textAlign = "right";
            ctx.fillText(guide.label, bbox.left + bbox.width - 5 * scale, at - 4 * scale);
          }
          ctx.stroke();
        }
        ctx.restore();
      },
    },
  };
}

function range(axis, guides, upright, bars) {
  return (_, least, most) => {
    for (const g of guides) if (g.upright === upright && Number.isFinite(g.at)) (least = Math.min(least ?? g.at, g.at)), (most = Math.max(most ?? g.at, g.at));
    if (bars && !axis.log) least = Math.min(least, 0);
    if (!(most > least)) (least -= Math.abs(least) * 0.1 || 1), (most += Math.abs(most) * 0.1 || 1);
    const margin = upright || axis.log ? 0 : 0.05 * (most - least);
    least = axis.least ?? (least === 0 ? 0 : least - margin);
    most = axis.most ?? (most === 0 ? 0 : most + margin);
    return [least, most];
  };
}

let styled = false;
function addStyle() {
  if (styled) return;
  styled = true;
  const style = document.createElement("style");
  style.textContent = plotStyle + ".u-legend{font-size:.84rem;text-align:left}.u-wrap{background:var(--paper)}.u-legend [hidden]{display:none}";
  document.head.append(style);
}

export function drawPlot(figure, data) {
  const parts = data.series.map(ascending);
  if (parts.some((p) => p === null)) return;
  addStyle();
  const stage = document.createElement("div");
  stage.className = "stage";
  figure.prepend(stage);
  figure.classList.add("live");

  let plot = null;
  const bars = data.series.some((s) => s.mark === "bars");
  const build = () => {
    plot?.destroy();
    const { ink, soft, line } = colours();
    const axis = (from, size) => ({
      label: from.title, labelFont: "14px system-ui, sans-serif", font, stroke: ink, labelSize: 24, size,
      grid: { stroke: line, width: 1 }, ticks: { stroke: line },
      values: (u, ticks) => ticks.map((v) => (v == null ? "" : String(Number(v.toPrecision(6))))),
    });
    const scale = (from, upright) => (from.log ? { time: false, distr: 3, log: 10 } : { time: false, range: range(from, data.guides, upright, bars && !upright) });
    plot = new uPlot(
      {
        width: stage.clientWidth, height, pxAlign: 0, scales: { x: scale(data.x, true), y: scale(data.y, false) },
        axes: [axis(data.x, 46), axis(data.y, 62)],
        series: [{ label: data.x.title, value: (_, v) => (v == null ? "–" : String(Number(v.toPrecision(5)))) }, ...data.series.map((s) => lookOf(s, data.y.title))],
        plugins: [guidePlugin(data.guides, soft)],
        cursor: { drag: { x: true, y: false }, focus: { prox: 30 } },
        legend: { live: true },
      },
      uPlot.join(parts.map((p) => [p.x, p.y])),
      stage,
    );
    // A second line of the same thing (a tangent) needs no line of its own in the legend.
    data.series.forEach((s, k) => {
      if (!s.name && data.series.length > 1) plot.root.querySelectorAll(".u-legend .u-series")[k + 1].hidden = true;
    });
  };
  build();
  new ResizeObserver(() => stage.clientWidth && plot.setSize({ width: stage.clientWidth, height })).observe(stage);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", build);
}
