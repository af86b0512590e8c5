import "uplot/dist/uPlot.min.css";
import "../style.css";
import "./player.css";

import { embeddedFiles } from "./files/embedded";
import { Follower } from "./files/follower";
import { showHelp } from "./help";
import { makeHook } from "./hook";
import { installKeys } from "./keys";
import { Player } from "./player";
import { acceptChoice, acceptDrops, pairsOf, readPairs, type GivenFile, type Source } from "./files/sources";

function connectKeys(player: Player): void {
  const { panel, viewer } = player;
  const changed = (control: HTMLElement): boolean => control.dispatchEvent(new Event("change"));
  installKeys({
    playOrPause: () => player.playOrPause(),
    step: (frames) => player.step(frames),
    toEnd: (last) => player.toEnd(last),
    changeSpeed: (by) => player.changeSpeed(by),
    toggleLoop: () => player.toggleLoop(),
    toggleStrain: () => {
      panel.colours.value = panel.colours.value === "strain" ? "scene" : "strain";
      changed(panel.colours);
    },
    toggleWires: () => {
      panel.wires.checked = !panel.wires.checked;
      changed(panel.wires);
    },
    toggleArrangement: () => {
      panel.arrangement.value = panel.arrangement.value === "over" ? "beside" : "over";
      changed(panel.arrangement);
    },
    turn: (around, down) => viewer?.turn(around, down),
    zoom: (factor) => viewer?.zoom(factor),
    resetView: () => viewer?.reset(),
    help: showHelp,
  });
}

/** Without WebGL the pictures that came with the page stand in its place. */
function showStills(player: Player, posters: HTMLImageElement[]): void {
  for (const poster of posters) poster.remove();
  if (player.viewer) return;
  const text = document.createElement("p");
  text.textContent =
    posters.length > 0
      ? "This browser draws no 3D (it has no WebGL 2): still pictures."
      : "This browser draws no 3D (it has no WebGL 2). weft render draws pictures of a recording.";
  player.layout.stills.append(...posters, text);
  player.layout.stills.hidden = false;
}

async function start(page: HTMLElement): Promise<void> {
  const posters = [...document.querySelectorAll<HTMLImageElement>("img.poster")];
  const player = new Player(page);
  const follower = new Follower(player);
  const open = async (sources: Promise<Source[]>): Promise<void> => {
    page.classList.add("busy");
    const began = performance.now();
    const pairs = pairsOf(await sources);
    const given = await readPairs(pairs);
    if (await player.open(given, began)) follower.start(pairs, given);
    page.classList.remove("busy");
  };
  const { layout } = player;
  acceptDrops((sources) => void open(sources), (over) => (layout.veil.hidden = !over));
  acceptChoice(layout.open, (sources) => void open(sources));
  acceptChoice(layout.choose, (sources) => void open(sources));
  layout.help.addEventListener("click", showHelp);
  // Who clicks a button wants the space key to play; who comes by keyboard wants it to press the button.
  page.addEventListener("click", (event) => {
    if (event.detail > 0 && event.target instanceof Element) event.target.closest("button")?.blur();
  });
  connectKeys(player);
  showStills(player, posters);
  const given: GivenFile[] = embeddedFiles();
  player.layout.invitation.hidden ||= given.length > 0;
  const ready = given.length > 0 ? player.open(given, 0).then(() => undefined) : Promise.resolve();
  window.weft = makeHook(player, ready);
  await ready;
}

const page = document.getElementById("page");
if (page) {
  start(page).catch((error: unknown) => {
    // Said on the page and not only in the console: who opens a broken page must not see a blank sheet.
    const text = document.createElement("p");
    text.className = "broken";
    text.setAttribute("role", "alert");
    text.textContent = `This page cannot play. ${String(error)}`;
    page.replaceChildren(text);
    throw error;
  });
}
