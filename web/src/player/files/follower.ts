// Looks again and again at recordings that a run is still writing, and shows what has come.
import type { Player } from "../player";
import { finishedName, readPair, stampOf, type GivenFile, type Pair, type Source } from "./sources";

/** Between two looks [ms]. Opening a long recording takes time itself: at most a fifth of the page's. */
const INTERVAL = 500;
const IDLE_SHARE = 4;

const GONE = "NotFoundError";

export class Follower {
  private pairs: Pair[] = [];
  private given: GivenFile[] = [];
  private stamps: string[] = [];
  private timer = 0;
  private round = 0; // of start() or stop()

  constructor(private readonly player: Player) {}

  stop(): void {
    this.round += 1;
    window.clearTimeout(this.timer);
    this.player.following = "";
  }

  /** pairs: of the recordings that are shown, one for each, as given was read from them. */
  start(pairs: Pair[], given: GivenFile[]): void {
    this.stop();
    this.pairs = pairs;
    this.given = given;
    this.stamps = pairs.map(() => "");
    const areShown = this.player.exhibits.length === pairs.length;
    if (!areShown || !pairs.some((_, i) => this.mayGrow(i))) return;
    this.player.following = "New frames are shown as they come; the key End stays with the newest.";
    this.player.showNotes();
    this.wait(INTERVAL);
  }

  private mayGrow(i: number): boolean {
    const recording = this.player.exhibits[i]?.recording;
    return this.pairs[i]!.main.isLive && recording !== undefined && !recording.finished && recording.blowUp === null;
  }

  private wait(time: number): void {
    this.timer = window.setTimeout(() => void this.look(), time);
  }

  private async look(): Promise<void> {
    const { round } = this;
    const began = performance.now();
    let hasEnded = false;
    let isNew = false;
    for (const i of this.pairs.keys()) {
      if (!this.mayGrow(i)) continue;
      try {
        isNew = (await this.readAgain(i)) || isNew;
      } catch (error) {
        // What cannot be read in this moment can in the next; what has another name cannot.
        if ((error as DOMException).name === GONE && !(await this.rename(i))) hasEnded = true;
      }
      if (round !== this.round) return;
    }
    if (isNew && !(await this.player.follow(this.given))) hasEnded = true;
    if (round !== this.round) return;
    const goesOn = !hasEnded && this.pairs.some((_, i) => this.mayGrow(i));
    if (goesOn) return this.wait(Math.max(INTERVAL, IDLE_SHARE * (performance.now() - began)));
    this.player.following = hasEnded ? "The file is no longer there: its run has ended and given it its name. Drop that one for the last frames." : "";
    this.player.showNotes();
  }

  /** Whether the files have changed. */
  private async readAgain(i: number): Promise<boolean> {
    const pair = this.pairs[i]!;
    const stamp = await stampOf(pair);
    if (stamp === this.stamps[i]) return false;
    this.given[i] = await readPair(pair);
    this.stamps[i] = stamp;
    return true;
  }

  /** Goes on with the finished recording, if it lies in a folder that the page has. */
  private async rename(i: number): Promise<boolean> {
    const { main } = this.pairs[i]!;
    const name = finishedName(main.name);
    const source: Source | null = name === main.name || !main.beside ? null : await main.beside(name);
    if (!source) return false;
    this.pairs[i] = { main: source, log: null };
    return true;
  }
}
