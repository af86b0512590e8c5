// Recordings that come as files: dropped on the page or chosen. A log ("x.weftrec-wal") belongs to the file of its name.

export interface GivenFile {
  name: string;
  main: Uint8Array;
  log: Uint8Array | null;
}

const LOG = "-wal";

export async function readFiles(list: Iterable<File>): Promise<GivenFile[]> {
  const bytes = new Map<string, Uint8Array>();
  for (const file of list) bytes.set(file.name, new Uint8Array(await file.arrayBuffer()));
  const given: GivenFile[] = [];
  for (const [name, main] of bytes) {
    if (name.endsWith(LOG) && bytes.has(name.slice(0, -LOG.length))) continue;
    if (name.endsWith("-shm") || name.endsWith(".lock")) continue;
    given.push({ name, main, log: bytes.get(name + LOG) ?? null });
  }
  return given;
}

/** Calls open with what is dropped anywhere on the page; hover tells whether something is held over it. */
export function acceptDrops(open: (files: File[]) => void, hover: (over: boolean) => void): void {
  document.addEventListener("dragover", (event) => {
    event.preventDefault();
    hover(true);
  });
  document.addEventListener("dragleave", (event) => {
    if (event.relatedTarget === null) hover(false);
  });
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    hover(false);
    const files = [...(event.dataTransfer?.files ?? [])];
    if (files.length > 0) open(files);
  });
}

/** A button that opens the browser's dialog. */
export function acceptChoice(button: HTMLButtonElement, open: (files: File[]) => void): void {
  const input = document.createElement("input");
  input.type = "file";
  input.multiple = true;
  input.hidden = true;
  input.accept = ".weftrec,.weftrec-wal";
  input.tabIndex = -1;
  input.setAttribute("aria-label", "Recordings");
  button.after(input);
  button.addEventListener("click", () => input.click());
  input.addEventListener("change", () => {
    const files = [...(input.files ?? [])];
    input.value = "";
    if (files.length > 0) open(files);
  });
}
