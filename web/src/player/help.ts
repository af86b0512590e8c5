// The list of keys.
import { h } from "../dom";

const KEYS: [string[], string][] = [
  [["Space"], "play or pause"],
  [["←", "→"], "one frame back, forward"],
  [["Home", "End"], "first, last frame"],
  [["[", "]"], "slower, faster"],
  [["L"], "start again at the end, or stop there"],
  [["C"], "colours of the scene, or strain"],
  [["W"], "wireframe"],
  [["O"], "several recordings: side by side, or over one another"],
  [["Shift", "←↑↓→"], "turn the view"],
  [["+", "−"], "nearer, farther"],
  [["R"], "view of the scene again"],
  [["?"], "this list"],
];

const MOUSE: [string, string][] = [
  ["Drag, one finger", "turn"],
  ["Wheel, two fingers", "nearer, farther"],
  ["Right drag, two fingers", "move"],
];

export function showHelp(): void {
  if (document.querySelector("dialog.help")) return;
  const close = h("button", { type: "button" }, "Close");
  const dialog = h(
    "dialog",
    { class: "help", "aria-labelledby": "help-title" },
    h("h2", { id: "help-title" }, "Keys"),
    h(
      "dl",
      {},
      KEYS.map(([keys, meaning]) => [h("dt", {}, keys.map((key) => h("kbd", {}, key))), h("dd", {}, meaning)]),
    ),
    h("h2", {}, "Mouse and touch"),
    h(
      "dl",
      {},
      MOUSE.map(([gesture, meaning]) => [h("dt", {}, gesture), h("dd", {}, meaning)]),
    ),
    close,
  );
  document.body.append(dialog);
  close.addEventListener("click", () => dialog.close());
  dialog.addEventListener("close", () => dialog.remove());
  dialog.showModal();
}
