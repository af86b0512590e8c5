// From the bytes of a recording, whatever its state, to those of a database that SQLite opens from memory: with the
// committed pages of its log, and at its full length if the end is missing. File format: sqlite.org/fileformat2.html
import { view } from "./bytes";

/** A file that cannot be shown; the message is for the reader of the page. */
export class UnreadableFile extends Error {}

const MAGIC = "SQLite format 3\0";
const APPLICATIONS = [0x57454654, 0x57454650]; // "WEFT", a recording; "WEFP", the copy in a page
const HEADER = 100;
const LOG_HEADER = 32;
const LOG_FRAME_HEADER = 24;

export interface DatabaseFile {
  bytes: Uint8Array;
  /** Bytes that are missing at the end; 0 for a whole file. */
  missing: number;
  /** Whether it says that a log belongs to it, which was not given. */
  lacksLog: boolean;
}

/** The running sum over pairs of words that SQLite has for its log. */
class LogSum {
  a = 0;
  b = 0;
  constructor(private readonly little: boolean) {}

  add(bytes: DataView, from: number, to: number): void {
    for (let at = from; at < to; at += 8) {
      this.a = (this.a + bytes.getUint32(at, this.little) + this.b) >>> 0;
      this.b = (this.b + bytes.getUint32(at + 4, this.little) + this.a) >>> 0;
    }
  }

  is(bytes: DataView, at: number): boolean {
    return bytes.getUint32(at) === this.a && bytes.getUint32(at + 4) === this.b;
  }
}

interface LoggedPage {
  page: number;
  at: number; // of its bytes in the log
}

interface Log {
  pageSize: number;
  /** Pages of the database after the last commit. */
  pages: number;
  written: LoggedPage[];
}

/** What a log has committed; null for one that is no log of SQLite or has no commit. */
function readLog(log: Uint8Array): Log | null {
  if (log.length < LOG_HEADER) return null;
  const words = view(log);
  const magic = words.getUint32(0);
  if (magic !== 0x377f0682 && magic !== 0x377f0683) return null;
  const pageSize = words.getUint32(8);
  const sum = new LogSum(magic === 0x377f0682);
  sum.add(words, 0, 24);
  if (!sum.is(words, 24) || pageSize < 512) return null;
  const result: Log = { pageSize, pages: 0, written: [] };
  let pending: LoggedPage[] = [];
  for (let at = LOG_HEADER; at + LOG_FRAME_HEADER + pageSize <= log.length; at += LOG_FRAME_HEADER + pageSize) {
    // Frames of an earlier round have other salts; the first torn one ends what counts.
    if (words.getUint32(at + 8) !== words.getUint32(16) || words.getUint32(at + 12) !== words.getUint32(20)) break;
    const begin = at + LOG_FRAME_HEADER;
    sum.add(words, at, at + 8);
    sum.add(words, begin, begin + pageSize);
    if (!sum.is(words, at + 16)) break;
    pending.push({ page: words.getUint32(at), at: begin });
    const pages = words.getUint32(at + 4);
    if (pages === 0) continue;
    result.pages = pages;
    result.written.push(...pending);
    pending = [];
  }
  return result.pages > 0 ? result : null;
}

function check(main: Uint8Array): void {
  if (main.length === 0) throw new UnreadableFile("is empty, expected a recording of weft run");
  if (main.length < HEADER || String.fromCharCode(...main.subarray(0, 16)) !== MAGIC) {
    throw new UnreadableFile("is not a recording, expected a file that weft run wrote (.weftrec)");
  }
  if (!APPLICATIONS.includes(view(main).getUint32(68))) {
    throw new UnreadableFile("is a SQLite database, but not a recording of weft run");
  }
}

export function databaseFile(main: Uint8Array, log: Uint8Array | null): DatabaseFile {
  check(main);
  const words = view(main);
  const stored = words.getUint16(16);
  const pageSize = stored === 1 ? 65536 : stored;
  const isKnown = words.getUint32(24) === words.getUint32(92);
  const promised = isKnown ? pageSize * words.getUint32(28) : main.length;
  const hasLogMode = words.getUint8(18) === 2;
  const committed = log && readLog(log);
  const full = committed ? committed.pages * committed.pageSize : Math.max(promised, main.length);
  // With a log the file may be behind its header.
  const missing = committed ? 0 : Math.max(0, promised - main.length);
  const bytes = new Uint8Array(Math.max(full, HEADER));
  bytes.set(main.subarray(0, bytes.length));
  for (const { page, at } of committed?.written ?? []) {
    const place = (page - 1) * committed!.pageSize;
    if (place + committed!.pageSize <= bytes.length) {
      bytes.set(log!.subarray(at, at + committed!.pageSize), place);
    }
  }
  // From memory SQLite opens a database only if it keeps no log.
  bytes[18] = 1;
  bytes[19] = 1;
  return { bytes, missing, lacksLog: hasLogMode && !committed };
}
