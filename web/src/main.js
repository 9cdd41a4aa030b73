// Brings the report to life: each figure's drawing gives way to something that can be explored.
import { drawPlot } from "./plot.js";
import { showScene } from "./scene.js";
import { showSlices } from "./slices.js";
import { offerDrawing } from "./links.js";

const makers = [
  ["figure.plot", drawPlot],
  ["figure.slices", showSlices],
  ["figure.scene", showScene],
];

async function start() {
  for (const figure of document.querySelectorAll("figure.plot, figure.rose")) offerDrawing(figure);
  for (const [selector, make] of makers) {
    for (const figure of document.querySelectorAll(selector)) {
      const data = figure.querySelector("script[type='application/json']");
      try {
        await make(figure, JSON.parse(data.textContent));
      } catch (error) {
        figure.dataset.failed = error.message;
        console.warn(`${figure.id}: ${error.message}`);
      }
    }
  }
  document.documentElement.dataset.ready = "yes";
}

start();
