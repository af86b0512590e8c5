// The player: what is shown, at which time, and how.
import { Color } from "three";

import { h } from "../dom";
import { formatNumber } from "../format";
import { keepTimeInAddress, timeInAddress } from "./address";
import { Clock } from "./clock";
import type { Look } from "./drawing/cloth_view";
import { engines } from "./files/engines";
import { EnergyPlot } from "./energy_plot";
import { makeExhibit, startEnergies, type Exhibit } from "./exhibit";
import type { GivenFile } from "./files/sources";
import { makeLayout } from "./layout";
import { makePanel, showFacts, showNotes, showRecordings } from "./panel";
import { Recording, type Metric } from "./files/recording";
import { Stage } from "./drawing/stage";
import { makeTransport, showPlaying, SPEEDS } from "./transport";
import { makeRenderer, Viewer } from "./drawing/viewer";

interface Note {
  name: string;
  text: string;
  isError: boolean;
}

function variable(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

export class Player {
  readonly transport = makeTransport();
  readonly plot = new EnergyPlot((time) => this.seek(time));
  readonly panel = makePanel(this.plot.element);
  readonly layout;
  readonly viewer: Viewer | null;
  exhibits: Exhibit[] = [];
  /** [ms] from the drop, or the first byte of a page with recordings, to the first picture. */
  openingTime = NaN;
  /** What is to be said about recordings that grow; empty: none does. */
  following = "";
  private stages: Stage[] = [];
  private range = 0;
  private stopEnergies: (() => void)[] = [];
  private readonly clock = new Clock(
    () => this.span(),
    (time) => this.showTime(time),
    () => this.playingChanged(),
  );

  constructor(page: HTMLElement) {
    this.layout = makeLayout(page, this.transport.element, this.panel.element);
    const renderer = makeRenderer(this.layout.canvas);
    this.viewer = renderer && new Viewer(this.layout.canvas, renderer);
    this.connect();
    this.update([], [], []);
  }

  /** began: when the opening did, as performance.now() counts [ms]. Shows these in place of what is shown; what cannot be read is said, and does not keep others from being shown. False if all stays as it was. */
  async open(files: GivenFile[], began = performance.now()): Promise<boolean> {
    this.clock.pause();
    const notes: Note[] = [];
    const exhibits: Exhibit[] = [];
    const stages: Stage[] = [];
    const tools = await engines();
    for (const { name, main, log, problem } of files) {
      if (problem !== undefined) notes.push({ name, text: problem, isError: true });
      if (problem !== undefined) continue;
      let recording: Recording | null = null;
      try {
        recording = new Recording(name, tools, main, log);
        const exhibit = makeExhibit(recording);
        if (this.viewer) stages.push(new Stage(exhibit, () => this.viewer?.drawSoon(), stages[0]?.origin ?? null));
        exhibits.push(exhibit);
      } catch (error) {
        recording?.close();
        notes.push({ name, text: (error as Error).message, isError: true });
      }
    }
    // A file that cannot be read does not end what plays.
    if (exhibits.length === 0 && this.exhibits.length > 0) {
      this.note([...notes, ...this.ownNotes()]);
      return false;
    }
    this.following = "";
    this.update(exhibits, stages, notes);
    if (exhibits.length > 0) {
      this.viewer?.draw();
      this.openingTime = performance.now() - began;
    }
    return true;
  }

  /**
   * The recordings that are shown, which have grown: view, looks and time stay as they are, or go on with the new frames.
   * False for others than these.
   */
  async follow(files: GivenFile[]): Promise<boolean> {
    const tools = await engines();
    const recordings: Recording[] = [];
    const close = (): void => recordings.forEach((recording) => recording.close());
    let exhibits: Exhibit[];
    try {
      for (const { name, main, log } of files) recordings.push(new Recording(name, tools, main, log));
      exhibits = recordings.map(makeExhibit);
    } catch {
      close(); // caught in the middle of a change: the next look reads it whole
      return true;
    }
    const olds = this.exhibits.map(({ recording }) => recording);
    const areThese = recordings.every(
      ({ sceneText, times }, i) => sceneText === olds[i]?.sceneText && times.length >= olds[i].times.length,
    );
    const isNew = recordings.some(
      ({ times, finished }, i) => times.length !== olds[i]?.times.length || finished !== olds[i].finished,
    );
    if (areThese && isNew) this.lengthen(exhibits);
    else close();
    return areThese;
  }

  private lengthen(exhibits: Exhibit[]): void {
    const known = this.exhibits.map(({ recording }) => recording.metrics);
    const isAtEnd = !this.clock.isPlaying && this.clock.time >= this.span()[1];
    const stages: Stage[] = [];
    // What the camera sees is counted from the same origin as before.
    const origin = this.stages[0]?.origin ?? null;
    if (this.viewer) for (const exhibit of exhibits) stages.push(new Stage(exhibit, () => this.viewer?.drawSoon(), origin));
    this.put(exhibits, stages);
    this.viewer?.exchange(stages);
    this.showNotes();
    this.setLength();
    showFacts(this.panel, exhibits);
    this.showEnergies(known);
    this.fillLegend();
    this.setTheme();
    if (isAtEnd && this.clock.ranOut) this.clock.play();
    else if (isAtEnd) this.seek(this.span()[1]);
  }

  get time(): number {
    return this.clock.time;
  }

  /** Goes to the frame nearest to a time [s] and stays there. */
  seek(time: number): void {
    this.clock.pause();
    this.showTime(this.lead()?.recording.times[this.lead()!.recording.nearest(time)] ?? time);
  }

  step(frames: number): void {
    const times = this.lead()?.recording.times ?? [];
    const now = Number(this.transport.slider.value);
    const next = times[Math.min(Math.max(now + frames, 0), times.length - 1)];
    if (next !== undefined) this.seek(next);
  }

  playOrPause(): void {
    if (this.clock.isPlaying) this.seek(this.clock.time);
    else this.clock.play();
  }

  toEnd(last: boolean): void {
    const [begin, end] = this.span();
    this.seek(last ? end : begin);
  }

  changeSpeed(by: number): void {
    const at = SPEEDS.indexOf(Number(this.transport.speed.value)) + by;
    const speed = SPEEDS[Math.min(Math.max(at, 0), SPEEDS.length - 1)]!;
    this.transport.speed.value = String(speed);
    this.clock.speed = speed;
  }

  toggleLoop(): void {
    this.clock.loops = !this.clock.loops;
    this.transport.loop.setAttribute("aria-pressed", String(this.clock.loops));
  }

  /** The index of each recording's frame that is shown. */
  frames(): number[] {
    return this.exhibits.map(({ recording }) => recording.nearest(this.clock.time));
  }

  /** [-] of each node of a cloth; null where the scene does not say where its springs are. */
  strainOf(recording: number, cloth: number, positions: ArrayLike<number>): Float64Array | null {
    return this.stages[recording]?.cloths[cloth]?.strainOf(positions) ?? null;
  }

  showAgain(): void {
    this.showTime(this.clock.time);
  }

  setTheme(): void {
    const isDark = matchMedia("(prefers-color-scheme: dark)").matches;
    for (const stage of this.stages) stage.setTheme(isDark);
    this.plot.redraw();
    this.showAgain();
  }

  private connect(): void {
    const { transport, panel } = this;
    transport.play.addEventListener("click", () => this.playOrPause());
    transport.back.addEventListener("click", () => this.step(-1));
    transport.forward.addEventListener("click", () => this.step(1));
    transport.loop.addEventListener("click", () => this.toggleLoop());
    transport.speed.addEventListener("change", () => (this.clock.speed = Number(transport.speed.value)));
    transport.slider.addEventListener("input", () => {
      const time = this.lead()?.recording.times[Number(transport.slider.value)];
      if (time !== undefined) this.seek(time);
    });
    panel.colours.addEventListener("change", () => this.showAgain());
    panel.wires.addEventListener("change", () => this.showAgain());
    panel.reset.addEventListener("click", () => this.viewer?.reset());
    panel.arrangement.addEventListener("change", () => this.arrange());
    window.addEventListener("hashchange", () => {
      const time = timeInAddress();
      if (time !== null) this.seek(time);
    });
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.setTheme());
    new ResizeObserver(() => this.placeLabels()).observe(this.layout.canvas);
  }

  /** The recording whose frames the timeline has: the longest. */
  private lead(): Exhibit | undefined {
    const end = (exhibit: Exhibit): number => exhibit.recording.times.at(-1) ?? -Infinity;
    return this.exhibits.reduce<Exhibit | undefined>((a, b) => (a && end(a) >= end(b) ? a : b), undefined);
  }

  private span(): [number, number] {
    const times = this.lead()?.recording.times ?? [];
    return [times[0] ?? 0, times.at(-1) ?? 0];
  }

  private update(exhibits: Exhibit[], stages: Stage[], notes: Note[]): void {
    this.put(exhibits, stages);
    this.viewer?.show(stages);
    this.note([...notes, ...this.ownNotes()]);
    this.fillIn();
    this.setTheme();
    const [begin, end] = this.span();
    this.seek(Math.min(Math.max(timeInAddress() ?? begin, begin), end));
    // The camera may follow a body that is elsewhere by now.
    this.viewer?.reset();
  }

  /** In the place of those before. */
  private put(exhibits: Exhibit[], stages: Stage[]): void {
    for (const stop of this.stopEnergies.splice(0)) stop();
    for (const stage of this.stages) stage.dispose();
    for (const { recording } of this.exhibits) recording.close();
    this.exhibits = exhibits;
    this.stages = stages;
    this.range = exhibits.reduce((range, exhibit) => Math.max(range, exhibit.strainRange), 0);
  }

  showNotes(): void {
    this.note(this.ownNotes());
  }

  private ownNotes(): Note[] {
    const name = ({ recording }: Exhibit): string => (this.exhibits.length > 1 ? recording.name + ":" : "");
    const notes = this.exhibits.flatMap((exhibit) =>
      exhibit.notes.map((text) => ({ name: name(exhibit), text, isError: false })),
    );
    return this.following === "" ? notes : [...notes, { name: "", text: this.following, isError: false }];
  }

  private note(notes: Note[]): void {
    showNotes(this.panel, notes);
    this.panel.element.hidden = this.exhibits.length === 0 && notes.length === 0;
  }

  private fillIn(): void {
    const { layout, panel, transport, exhibits } = this;
    const any = exhibits.length > 0;
    const first = exhibits[0];
    layout.invitation.hidden = any;
    layout.canvas.hidden = !any || !this.viewer;
    for (const element of [transport.element, ...panel.element.querySelectorAll<HTMLElement>(".card")]) element.hidden = !any;
    layout.title.textContent = first ? first.scene.name.replaceAll("_", " ") : "Weft playback";
    layout.summary.textContent = first ? [first.scene.summary, first.recording.engine].filter(Boolean).join(" · ") : "Plays recordings of weft run";
    document.title = first ? `${first.scene.name}, Weft playback` : "Weft playback";
    this.setLength();
    showRecordings(panel, exhibits, this.labels(), (hidden) => {
      this.viewer?.setHidden(hidden);
      this.placeLabels();
    });
    showFacts(panel, exhibits);
    this.showEnergies([]);
    this.arrange();
    this.fillLegend();
  }

  private setLength(): void {
    this.transport.slider.max = String(Math.max((this.lead()?.recording.times.length ?? 1) - 1, 0));
  }

  private labels(): string[] {
    const engineNames = this.exhibits.map(({ recording }) => recording.engine);
    const areDifferent = new Set(engineNames).size === engineNames.length && !engineNames.includes("");
    return areDifferent ? engineNames : this.exhibits.map(({ recording }) => recording.name);
  }

  /** known: metrics of each recording when it was shorter. */
  private showEnergies(known: Metric[][]): void {
    const recordings = this.exhibits.map(({ recording }) => recording);
    const show = (done: boolean): void => {
      if (done) this.panel.energies.hidden = !this.plot.show(recordings);
      this.panel.energyState.textContent = done ? "" : "Computing…";
      this.plot.setTime(this.clock.time);
    };
    let waiting = 0;
    for (const [i, exhibit] of this.exhibits.entries()) {
      const stop = startEnergies(exhibit, known[i] ?? [], (done) => {
        if (done) waiting -= 1;
        if (done && waiting === 0) show(true);
      });
      if (!stop) continue;
      waiting += 1;
      this.stopEnergies.push(stop);
    }
    show(waiting === 0);
  }

  private fillLegend(): void {
    const percent = 100 * this.range;
    const texts = [`−${formatNumber(percent, 2)}`, "0", `+${formatNumber(percent, 2)}`];
    this.layout.marks.forEach((mark, i) => (mark.textContent = texts[i]!));
  }

  private arrange(): void {
    if (this.viewer) this.viewer.arrangement = this.panel.arrangement.value === "over" ? "over" : "beside";
    this.viewer?.reset();
    this.placeLabels();
    this.showAgain();
  }

  /** In the picture: which recording is which. */
  private placeLabels(): void {
    const { layout, viewer } = this;
    const labels = this.labels();
    const several = labels.length > 1 && viewer !== null;
    const isOver = viewer?.arrangement === "over";
    const entries = several ? viewer.places() : [];
    layout.labels.replaceChildren(
      ...entries.map(({ stage, left }, i) => {
        const chip = h("span", { class: "chip", "aria-hidden": "true" });
        chip.style.background = `var(--series-${(stage % 8) + 1})`;
        const label = h("span", { class: "label" }, isOver && chip, labels[stage] ?? "");
        label.style.left = `calc(${100 * left}% + 0.75rem)`;
        label.style.top = isOver ? `${0.75 + 1.9 * i}rem` : "0.75rem";
        return label;
      }),
    );
  }

  private look(index: number): Look {
    const isOver = this.exhibits.length > 1 && this.viewer?.arrangement === "over";
    return {
      strain: this.panel.colours.value === "strain",
      wires: this.panel.wires.checked,
      strainRange: this.range > 0 && Number.isFinite(this.range) ? this.range : 1,
      tint: isOver ? new Color(variable(`--series-${(index % 8) + 1}`)) : null,
    };
  }

  private showTime(time: number): void {
    const lead = this.lead();
    this.clock.time = time;
    if (!lead || lead.recording.times.length === 0) return;
    const index = lead.recording.nearest(time);
    const shown = lead.recording.times[index] ?? time;
    const { transport } = this;
    transport.slider.value = String(index);
    const text = `t\u00a0=\u00a0${shown.toFixed(3)}\u00a0s`;
    transport.slider.setAttribute("aria-valuetext", text);
    transport.time.textContent = text;
    transport.frame.textContent = `frame ${index + 1} of ${lead.recording.times.length}`;
    this.layout.legend.hidden = this.panel.colours.value !== "strain";
    this.layout.canvas.setAttribute("aria-label", `${lead.scene.name} in 3D at ${text}`);
    this.viewer?.pose(this.frames(), this.exhibits.map((_, i) => this.look(i)));
    this.plot.setTime(shown);
    if (!this.clock.isPlaying) keepTimeInAddress(shown);
  }

  private playingChanged(): void {
    showPlaying(this.transport, this.clock.isPlaying);
    if (!this.clock.isPlaying) keepTimeInAddress(this.clock.time);
  }
}
