// Beside the picture: what is played, what is to be known about it, how it is drawn, energies, facts.
import { h } from "../dom";
import { formatNumber } from "../format";
import type { Exhibit } from "./exhibit";

export interface Panel {
  element: HTMLElement;
  colours: HTMLSelectElement;
  wires: HTMLInputElement;
  arrangement: HTMLSelectElement;
  reset: HTMLButtonElement;
  notes: HTMLElement;
  recordings: HTMLElement;
  energies: HTMLElement;
  energyState: HTMLElement;
  facts: HTMLElement;
}

function choice(label: string, control: HTMLElement): HTMLElement {
  return h("label", { class: "choice" }, h("span", { class: "muted small" }, label), control);
}

export function makePanel(plot: HTMLElement): Panel {
  const colours = h(
    "select",
    { title: "Colours (C)" },
    h("option", { value: "scene" }, "of the scene"),
    h("option", { value: "strain" }, "strain"),
  );
  const wires = h("input", { type: "checkbox", title: "Wireframe (W)" });
  const arrangement = h(
    "select",
    { title: "Several recordings (O)" },
    h("option", { value: "beside" }, "side by side"),
    h("option", { value: "over" }, "over one another"),
  );
  const reset = h("button", { type: "button", title: "View of the scene again (R)" }, "Reset view");
  const notes = h("div", { class: "notes", role: "status" });
  const recordings = h("fieldset", { class: "recordings", hidden: true });
  const energyState = h("p", { class: "muted small", role: "status" });
  const energies = h("section", { class: "card energies", "aria-label": "Energies" }, h("h2", {}, "Energy of the cloth"), plot, energyState);
  const facts = h("section", { class: "card facts-card", "aria-label": "Facts" });
  const element = h(
    "aside",
    { class: "panel", "aria-label": "View and facts" },
    notes,
    h(
      "section",
      { class: "card", "aria-label": "View" },
      recordings,
      h(
        "div",
        { class: "choices" },
        choice("Colours", colours),
        choice("Several recordings", arrangement),
        h("label", { class: "check" }, wires, "Wireframe"),
        reset,
      ),
    ),
    energies,
    facts,
  );
  return { element, colours, wires, arrangement, reset, notes, recordings, energies, energyState, facts };
}

/** A list of what the reader must know, each once. */
export function showNotes(panel: Panel, notes: { name: string; text: string; isError: boolean }[]): void {
  panel.notes.replaceChildren(
    ...notes.map(({ name, text, isError }) =>
      h("p", { class: isError ? "note error" : "note", role: isError ? "alert" : undefined }, h("b", {}, name), ` ${text}`),
    ),
  );
}

function fact(name: string, value: string): [HTMLElement, HTMLElement] {
  return [h("dt", {}, name), h("dd", {}, value)];
}

function factsOf(exhibit: Exhibit): HTMLElement {
  const { recording } = exhibit;
  const { times, bodies, meta } = recording;
  const cloths = bodies.filter((body) => body.isCloth);
  const nodes = cloths.reduce((sum, body) => sum + body.nodes, 0);
  const rounding =
    recording.positionError > 0
      ? `rounded by at most ${formatNumber(1e3 * recording.positionError)} mm`
      : `as computed (${meta.get("precision") ?? ""})`;
  const entries = [
    fact("Engine", recording.engine || "not recorded"),
    fact("Frames", `${times.length}, t = ${formatNumber(times[0] ?? 0)} s to ${formatNumber(times.at(-1) ?? 0, 4)} s`),
    fact("Cloth", `${cloths.length === 1 ? "1 cloth" : `${cloths.length} cloths`}, ${nodes} nodes`),
    fact("Positions", rounding),
    fact("Made by", ["weft " + (meta.get("provenance.weft") ?? ""), meta.get("provenance.bullet")].filter(Boolean).join("; ")),
    fact("Content hash", meta.get("content_hash") ?? "none"),
  ];
  return h("dl", { class: "fact-list" }, entries.flat());
}

export function showFacts(panel: Panel, exhibits: Exhibit[]): void {
  panel.facts.replaceChildren(
    ...exhibits.map((exhibit) =>
      h("details", { open: exhibits.length === 1 }, h("summary", {}, exhibit.recording.name), factsOf(exhibit)),
    ),
  );
}

/** One box for each recording, to hide and show it; change gets the hidden ones. */
export function showRecordings(
  panel: Panel,
  exhibits: Exhibit[],
  labels: string[],
  change: (hidden: Set<number>) => void,
): void {
  const several = exhibits.length > 1;
  panel.recordings.hidden = !several;
  (panel.arrangement.parentElement as HTMLElement).hidden = !several;
  const boxes = exhibits.map(() => h("input", { type: "checkbox", checked: true }));
  const rows = labels.map((label, i) => {
    const chip = h("span", { class: "chip", "aria-hidden": "true" });
    chip.style.background = `var(--series-${(i % 8) + 1})`;
    return h("label", { class: "check" }, boxes[i]!, chip, label);
  });
  panel.recordings.replaceChildren(h("legend", { class: "muted small" }, "Recordings"), ...rows);
  for (const box of boxes) {
    box.addEventListener("change", () => change(new Set(boxes.flatMap((other, i) => (other.checked ? [] : [i])))));
  }
}
