// What the keys do; help.ts lists them for the reader.

export interface Actions {
  playOrPause: () => void;
  step: (frames: number) => void;
  toEnd: (last: boolean) => void;
  changeSpeed: (by: number) => void;
  toggleLoop: () => void;
  toggleStrain: () => void;
  toggleWires: () => void;
  toggleArrangement: () => void;
  turn: (around: number, down: number) => void;
  zoom: (factor: number) => void;
  resetView: () => void;
  help: () => void;
}

const TURN = 0.12; // [rad]
const ZOOM = 1.12;

/** A field or a list has these keys for itself. */
function isTaken(event: KeyboardEvent): boolean {
  const target = event.target instanceof Element ? event.target : null;
  if (document.querySelector("dialog[open]")) return true;
  if (target?.closest("select, textarea, input:not([type=range]):not([type=checkbox])")) return true;
  return event.key === " " && target?.closest("button, a, input[type=checkbox], summary") != null;
}

export function installKeys(actions: Actions): void {
  const plain: Record<string, () => void> = {
    " ": actions.playOrPause,
    ArrowLeft: () => actions.step(-1),
    ArrowRight: () => actions.step(1),
    ",": () => actions.step(-1),
    ".": () => actions.step(1),
    Home: () => actions.toEnd(false),
    End: () => actions.toEnd(true),
    "[": () => actions.changeSpeed(-1),
    "]": () => actions.changeSpeed(1),
    l: actions.toggleLoop,
    c: actions.toggleStrain,
    w: actions.toggleWires,
    o: actions.toggleArrangement,
    r: actions.resetView,
    "+": () => actions.zoom(1 / ZOOM),
    "=": () => actions.zoom(1 / ZOOM),
    "-": () => actions.zoom(ZOOM),
    "?": actions.help,
  };
  const shifted: Record<string, () => void> = {
    ArrowLeft: () => actions.turn(-TURN, 0),
    ArrowRight: () => actions.turn(TURN, 0),
    ArrowUp: () => actions.turn(0, -TURN),
    ArrowDown: () => actions.turn(0, TURN),
  };
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || isTaken(event)) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const action = (event.shiftKey && shifted[key]) || plain[key];
    if (!action) return;
    event.preventDefault();
    action();
  });
}
