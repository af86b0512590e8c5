// Small pictures on buttons.
const PATHS = {
  play: "M7 4.5v15l12-7.5z",
  pause: "M6.5 4.5h4v15h-4zM13.5 4.5h4v15h-4z",
  back: "M17.5 5v14L9 12zM6 5h2.2v14H6z",
  forward: "M6.5 5v14l8.5-7zM15.8 5H18v14h-2.2z",
  loop: "M17 2.5 21 6.5l-4 4v-3H8a3.5 3.5 0 0 0-3.5 3.5v1h-2v-1A5.5 5.5 0 0 1 8 5.5h9zM7 21.5l-4-4 4-4v3h9a3.5 3.5 0 0 0 3.5-3.5v-1h2v1a5.5 5.5 0 0 1-5.5 5.5H7z",
  reset: "M4 4h6v2H7.4A8 8 0 1 1 4 12h2a6 6 0 1 0 2.8-5.1L10 8v2H4zM10.5 10.5h3v3h-3z",
};
export type Icon = keyof typeof PATHS;

const SVG = "http://www.w3.org/2000/svg";

export function icon(name: Icon): SVGElement {
  const svg = document.createElementNS(SVG, "svg");
  svg.setAttribute("viewBox", "0 0 24 24");
  svg.setAttribute("aria-hidden", "true");
  const path = document.createElementNS(SVG, "path");
  path.setAttribute("d", PATHS[name]);
  svg.append(path);
  return svg;
}

export function setIcon(button: HTMLElement, name: Icon): void {
  button.replaceChildren(icon(name));
}
