// Where recordings come from: files that are read once, and files and folders on the disk that are read again while a run
// writes them. A log ("x.weftrec-wal") belongs to the file of its name.

export interface GivenFile {
  name: string;
  main: Uint8Array;
  log: Uint8Array | null;
  /** Why there are no bytes. */
  problem?: string;
}

/** A file that may be read more than once. */
export interface Source {
  name: string;
  /** Rejects when it is no longer there. */
  file: () => Promise<File>;
  /** Whether file() sees what has been written since. */
  isLive: boolean;
  /** In the same folder, where the page has been given the folder. */
  beside: ((name: string) => Promise<Source | null>) | null;
}

/** A recording with its log. */
export interface Pair {
  main: Source;
  log: Source | null;
}

const LOG = "-wal";
const LOG_HEADER = 32;
const PARTIAL = /\.partial(-\d+)?\.weftrec(-wal)?$/;
/** A log is begun again now and then, and a file may change while it is read. */
const ATTEMPTS = 5;

export function sourceOf(file: File): Source {
  return { name: file.name, file: () => Promise.resolve(file), isLive: false, beside: null };
}

function sourceOfHandle(handle: FileSystemFileHandle, folder: FileSystemDirectoryHandle | null): Source {
  return {
    name: handle.name,
    file: () => handle.getFile(),
    isLive: true,
    beside: folder && ((name) => folder.getFileHandle(name).then((other) => sourceOfHandle(other, folder), () => null)),
  };
}

/** What is to be shown of a folder: the recordings that are being written, or all if none is. */
async function sourcesIn(folder: FileSystemDirectoryHandle): Promise<Source[]> {
  const all: Source[] = [];
  for await (const handle of folder.values()) {
    const isPart = /\.weftrec(-wal)?$/.test(handle.name);
    if (isPart && handle.kind === "file") all.push(sourceOfHandle(handle as FileSystemFileHandle, folder));
  }
  const partial = all.filter(({ name }) => PARTIAL.test(name));
  return (partial.length > 0 ? partial : all).sort((a, b) => (a.name < b.name ? -1 : 1));
}

/** The name that a partial recording gets when its run has ended. */
export function finishedName(name: string): string {
  return name.replace(PARTIAL, ".weftrec");
}

/** Handles of what is dropped, where the browser gives them (Chromium does); to be asked for during the event. */
type Handles = Promise<FileSystemHandle | null>[];
function handlesOf(transfer: DataTransfer): Handles {
  const items = [...transfer.items].filter(({ kind }) => kind === "file");
  return items.map((item) => {
    const { getAsFileSystemHandle } = item as { getAsFileSystemHandle?: () => Promise<FileSystemHandle | null> };
    return getAsFileSystemHandle?.call(item).catch(() => null) ?? Promise.resolve(null);
  });
}

export async function sourcesOf(files: File[], handles: Handles): Promise<Source[]> {
  const sources: Source[] = [];
  for (const [i, file] of files.entries()) {
    const handle = (await handles[i]) ?? null;
    if (handle?.kind === "directory") sources.push(...(await sourcesIn(handle as FileSystemDirectoryHandle)));
    else sources.push(handle ? sourceOfHandle(handle as FileSystemFileHandle, null) : sourceOf(file));
  }
  return sources;
}

export function pairsOf(sources: Source[]): Pair[] {
  const byName = new Map(sources.map((source) => [source.name, source]));
  return [...byName.values()].flatMap((main) => {
    const { name } = main;
    if (name.endsWith(LOG) && byName.has(name.slice(0, -LOG.length))) return [];
    if (name.endsWith("-shm") || name.endsWith(".lock")) return [];
    return [{ main, log: byName.get(name + LOG) ?? null }];
  });
}

async function bytesOf(source: Source): Promise<Uint8Array> {
  return new Uint8Array(await (await source.file()).arrayBuffer());
}

/** What changes when a log is begun again. */
async function beginningOf(log: Source): Promise<string> {
  const bytes = await (await log.file()).slice(0, LOG_HEADER).arrayBuffer();
  return new Uint8Array(bytes).join();
}

/** The file first and its log after it: then the log has all that the file has not, unless it was begun again in between. */
async function readOnce({ main, log }: Pair): Promise<GivenFile | null> {
  if (!log) return { name: main.name, main: await bytesOf(main), log: null };
  const before = await beginningOf(log);
  const given: GivenFile = { name: main.name, main: await bytesOf(main), log: await bytesOf(log) };
  return before === given.log!.subarray(0, LOG_HEADER).join() ? given : null;
}

/** Rejects for a file that is not there or cannot be read. */
export async function readPair(pair: Pair): Promise<GivenFile> {
  let failure: unknown = new Error("it changes all the time");
  for (let attempt = 0; attempt < ATTEMPTS; ++attempt) {
    try {
      const given = await readOnce(pair);
      if (given) return given;
    } catch (error) {
      failure = error;
      if ((error as DOMException).name !== "NotReadableError") break;
    }
  }
  throw failure;
}

/** Says what is wrong with those that cannot be read. */
export async function readPairs(pairs: Pair[]): Promise<GivenFile[]> {
  const none = { main: new Uint8Array(), log: null };
  if (pairs.length === 0) return [{ ...none, name: "", problem: "There is no recording (.weftrec) in this folder." }];
  return Promise.all(
    pairs.map((pair) =>
      readPair(pair).catch((error: unknown) => ({ ...none, name: pair.main.name, problem: `cannot be read (${String(error)})` })),
    ),
  );
}

/** Changes with the files. */
export async function stampOf({ main, log }: Pair): Promise<string> {
  const files = await Promise.all([main.file(), log?.file()]);
  return files.map((file) => (file ? `${file.size} ${file.lastModified}` : "")).join(";");
}

/** Calls open with what is dropped anywhere on the page; hover tells whether something is held over it. */
export function acceptDrops(open: (sources: Promise<Source[]>) => void, hover: (over: boolean) => void): void {
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
    const transfer = event.dataTransfer;
    const files = [...(transfer?.files ?? [])];
    if (transfer && files.length > 0) open(sourcesOf(files, handlesOf(transfer)));
  });
}

/** A button that opens the browser's dialog. */
export function acceptChoice(button: HTMLButtonElement, open: (sources: Promise<Source[]>) => void): void {
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
    if (files.length > 0) open(Promise.resolve(files.map(sourceOf)));
  });
}
