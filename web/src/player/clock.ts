// Time that passes while a recording plays.

export class Clock {
  speed = 1;
  loops = false;
  isPlaying = false;
  /** Whether it stands because it has come to the end. */
  ranOut = false;
  private last = 0;
  private request = 0;

  /** tick gets the new time [s]; changed tells that playing began or ended. */
  constructor(
    private readonly span: () => [number, number],
    private readonly tick: (time: number) => void,
    private readonly changed: () => void,
  ) {}

  time = 0; // [s]

  play(): void {
    const [begin, end] = this.span();
    if (this.isPlaying || !(end > begin)) return;
    if (this.time >= end) this.time = begin;
    this.isPlaying = true;
    this.ranOut = false;
    this.last = performance.now();
    this.request = window.requestAnimationFrame((now) => this.advance(now));
    this.changed();
  }

  pause(): void {
    this.ranOut = false;
    if (!this.isPlaying) return;
    this.isPlaying = false;
    window.cancelAnimationFrame(this.request);
    this.changed();
  }

  private advance(now: number): void {
    if (!this.isPlaying) return;
    const [begin, end] = this.span();
    // A page that was hidden, or a slow machine, does not jump.
    this.time += (this.speed * Math.min(Math.max(now - this.last, 0), 250)) / 1000;
    this.last = now;
    if (this.time >= end) {
      this.time = this.loops ? begin : end;
      this.tick(this.time);
      if (!this.loops) {
        this.pause();
        this.ranOut = true;
        return;
      }
    } else {
      this.tick(this.time);
    }
    this.request = window.requestAnimationFrame((next) => this.advance(next));
  }
}
