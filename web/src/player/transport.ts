// The bar under the picture: play, single frames, timeline, speed.
import { h } from "../dom";
import { icon, setIcon, type Icon } from "./icons";

export const SPEEDS = [0.05, 0.1, 0.25, 0.5, 1, 2, 4];

export interface Transport {
  element: HTMLElement;
  back: HTMLButtonElement;
  play: HTMLButtonElement;
  forward: HTMLButtonElement;
  slider: HTMLInputElement;
  speed: HTMLSelectElement;
  loop: HTMLButtonElement;
  time: HTMLElement;
  frame: HTMLElement;
}

export function iconButton(name: Icon, label: string, key: string): HTMLButtonElement {
  const button = h("button", { type: "button", class: "icon", "aria-label": label, title: `${label} (${key})` });
  button.append(icon(name));
  return button;
}

export function showPlaying(transport: Transport, isPlaying: boolean): void {
  setIcon(transport.play, isPlaying ? "pause" : "play");
  const label = isPlaying ? "Pause" : "Play";
  transport.play.setAttribute("aria-label", label);
  transport.play.title = `${label} (space)`;
}

export function makeTransport(): Transport {
  const transport = {
    back: iconButton("back", "One frame back", "left arrow"),
    play: iconButton("play", "Play", "space"),
    forward: iconButton("forward", "One frame forward", "right arrow"),
    slider: h("input", { type: "range", min: 0, max: 0, step: 1, value: 0, "aria-label": "Time", title: "Time (drag)" }),
    speed: h(
      "select",
      { "aria-label": "Speed", title: "Speed ([ and ])" },
      SPEEDS.map((speed) => h("option", { value: speed, selected: speed === 1 }, `${speed}\u00d7`)),
    ),
    loop: iconButton("loop", "Start again at the end", "L"),
    time: h("span", { class: "time" }, "t\u00a0=\u00a00\u00a0s"),
    frame: h("span", { class: "frame-number muted small" }),
  };
  transport.play.classList.add("play");
  transport.loop.setAttribute("aria-pressed", "false");
  const element = h(
    "div",
    { class: "transport", role: "group", "aria-label": "Playback" },
    h("div", { class: "buttons" }, transport.back, transport.play, transport.forward),
    transport.slider,
    h("div", { class: "clock" }, transport.time, transport.frame),
    h("div", { class: "pace" }, transport.speed, transport.loop),
  );
  return { element, ...transport };
}
