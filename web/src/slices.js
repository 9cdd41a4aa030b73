// Walks through the stack: as recorded, cleaned, and with pores and cracks laid over.
import { offer, save } from "./links.js";

const titles = { raw: "as recorded", gray: "cleaned", phase: "pores and cracks" };

function element(tag, properties = {}, ...children) {
  const node = Object.assign(document.createElement(tag), properties);
  node.append(...children);
  return node;
}

async function pixels(base64) {
  const image = new Image();
  image.src = `data:image/png;base64,${base64}`;
  await image.decode();
  const canvas = new OffscreenCanvas(image.width, image.height);
  const context = canvas.getContext("2d", { willReadFrequently: true });
  context.drawImage(image, 0, 0);
  return context.getImageData(0, 0, image.width, image.height);
}

const channels = (colour) => [1, 3, 5].map((k) => parseInt(colour.slice(k, k + 2), 16));

/// Tints voxels of pores (0) and cracks (128); thin outlines would hide the image below, so the fill is see-through.
function overlay(gray, phase, strength, shown, tints) {
  const out = new ImageData(gray.width, gray.height);
  for (let k = 0; k < out.data.length; k += 4) {
    const label = phase.data[k] < 64 ? "pore" : phase.data[k] < 192 ? "crack" : null;
    const weight = label && shown[label] ? strength : 0;
    for (let c = 0; c < 3; ++c) out.data[k + c] = (1 - weight) * gray.data[k + c] + (weight ? weight * tints[label][c] : 0);
    out.data[k + 3] = 255;
  }
  return out;
}

function scaleBar(context, pixel, unit) {
  const width = context.canvas.width * pixel, most = 0.4 * width, base = 10 ** Math.floor(Math.log10(most));
  const length = most >= 5 * base ? 5 * base : most >= 2 * base ? 2 * base : base;
  const size = Math.max(10, context.canvas.width / 28), x = size * 0.7, y = context.canvas.height - size * 0.7;
  context.fillStyle = "#000a";
  context.fillRect(x - 6, y - size * 1.7, length / pixel + 12, size * 2.1);
  context.fillStyle = "#fff";
  context.fillRect(x, y - size * 0.2, length / pixel, size * 0.3);
  context.font = `${size}px system-ui, sans-serif`;
  context.fillText(`${length} ${unit}`, x, y - size * 0.45);
}

export async function showSlices(figure, data) {
  const tints = { pore: channels(data.pore), crack: channels(data.crack) };
  const shown = { pore: true, crack: true };
  const stage = element("div", { className: "stage" });
  const panes = element("div", { className: "panes" });
  const where = element("span", { className: "soft" });
  const plane = element("select", { ariaLabel: "plane" }, ...data.planes.map((p, k) => element("option", { value: k, textContent: `${p.across}${p.down} plane, across ${p.axis}` })));
  const slider = element("input", { type: "range", min: 0, step: 1, ariaLabel: "slice" });
  const strength = element("input", { type: "range", min: 0, max: 100, value: 70, ariaLabel: "strength of colours" });
  const names = Object.keys(titles).filter((name) => name in data.planes[0].layers);
  const bar = element("div", { className: "bar" }, plane, slider, where);
  stage.append(bar, panes);
  const canvases = {};
  for (const name of names) {
    canvases[name] = element("canvas");
    panes.append(element("div", {}, element("span", { textContent: titles[name] }), canvases[name]));
  }
  if ("phase" in canvases) {
    const toggle = (key, text) => {
      const box = element("input", { type: "checkbox", checked: true });
      box.addEventListener("change", () => ((shown[key] = box.checked), draw()));
      const swatch = element("span", { className: "swatch" });
      swatch.style.background = data[key];
      return element("label", {}, box, swatch, text);
    };
    stage.append(element("div", { className: "bar" }, toggle("pore", "pores"), toggle("crack", "cracks"), element("label", {}, "colour ", strength)));
  }

  let turn = 0;
  async function draw() {
    const mine = ++turn;
    const now = data.planes[plane.value], k = Number(slider.value);
    const images = {};
    for (const name of names) images[name] = await pixels(now.layers[name][k]);
    if (mine !== turn) return;
    for (const name of names) {
      const canvas = canvases[name], context = canvas.getContext("2d");
      canvas.width = now.width;
      canvas.height = now.height;
      context.putImageData(name === "phase" ? overlay(images.gray, images.phase, strength.value / 100, shown, tints) : images[name], 0, 0);
      if (name === names[0] && data.pixel > 0) scaleBar(context, data.pixel, data.unit);
    }
    const position = now.positions[k];
    where.textContent = `${now.axis} = ${position}` + (data.voxel > 0 ? ` (${((position + 0.5) * data.voxel).toPrecision(4)} ${data.unit})` : "");
    stage.dataset.slice = `${now.axis}${position}`;
  }
  const turnTo = () => {
    const count = data.planes[plane.value].positions.length;
    slider.max = count - 1;
    slider.value = count >> 1;
    return draw();
  };
  plane.addEventListener("change", turnTo);
  slider.addEventListener("input", draw);
  strength.addEventListener("input", draw);
  await turnTo();
  figure.prepend(stage);
  figure.classList.add("live");
  for (const name of names)
    offer(figure, `png: ${titles[name]}`, () => canvases[name].toBlob((blob) => save(`${name}_${stage.dataset.slice}.png`, "image/png", blob)));
}
