// The time in the address of the page, as #t=1.25 [s]: a link leads to a moment.

const DELAY = 200; // [ms]

export function timeInAddress(): number | null {
  const value = new URLSearchParams(location.hash.slice(1)).get("t");
  const time = value === null || value.trim() === "" ? NaN : Number(value);
  return Number.isFinite(time) ? time : null;
}

let timer = 0;

export function keepTimeInAddress(time: number): void {
  window.clearTimeout(timer);
  // Browsers allow few changes in a second.
  timer = window.setTimeout(() => {
    history.replaceState(null, "", `#t=${Number(time.toPrecision(9))}`);
  }, DELAY);
}
