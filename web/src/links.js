// Downloads made on the spot.

export function save(name, type, content) {
  const link = document.createElement("a");
  link.download = name;
  link.href = URL.createObjectURL(content instanceof Blob ? content : new Blob([content], { type }));
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

export function offer(figure, label, action) {
  const button = document.createElement("button");
  button.type = "button";
  button.textContent = label;
  button.addEventListener("click", action);
  figure.querySelector(".links")?.append(button);
}

/// The printed form, black on white, as its own file.
export function offerDrawing(figure) {
  const svg = figure.querySelector(".drawing svg");
  if (!svg) return;
  offer(figure, "svg", () => {
    const twin = svg.cloneNode(true);
    twin.setAttribute("color", "#000");
    twin.setAttribute("style", "background:#fff");
    save(`${figure.id}.svg`, "image/svg+xml", new XMLSerializer().serializeToString(twin));
  });
}
