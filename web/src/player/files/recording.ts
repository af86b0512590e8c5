// A recording, or the copy of one in a page: its small tables at once, its frames when they are asked for.
import type { Database, SqlValue } from "sql.js";

import { decodeFull, decodeRounded, unshuffled, type Frame, type Layout } from "./chunk_codec";
import type { Engines } from "./engines";
import { decodeMark, type Mark, type MarkRow } from "./marks";
import { databaseFile, UnreadableFile } from "./sqlite_file";
import { sizeText } from "./bytes";

export interface Body {
  name: string;
  isCloth: boolean;
  nodes: number;
}

/** What a torn cloth consists of from a frame on. */
export interface Topology {
  firstFrame: number;
  nodes: number;
  triangles: Uint32Array;
  /** Of each node beyond those of the scene: the node it was split from. */
  origins: Uint32Array;
}

export interface Metric {
  name: string;
  times: number[];
  values: number[];
}

export interface BlowUp {
  time: number;
  body: string;
  node: number;
  reason: string;
}

/** What a program has said about a moment. */
export interface ProgramNote {
  time: number; // [s]
  text: string;
}

interface Chunk {
  id: number;
  first: number; // frame
  count: number;
  codec: string;
  rawBytes: number;
  hash: string;
}

/** Decoded chunks that are kept [byte]. */
const CACHE = 300e6;
const LATEST_VERSION = 2;

function bytesOf(frames: Frame[]): number {
  let bytes = 0;
  for (const frame of frames) {
    for (const array of [...frame.positions, ...frame.velocities]) bytes += array.byteLength;
  }
  return bytes;
}

export class Recording {
  readonly meta = new Map<string, string>();
  readonly sceneText: string;
  readonly bodies: Body[] = [];
  /** [s] of the frames that are whole. */
  readonly times: number[] = [];
  readonly metrics: Metric[] = [];
  readonly assets = new Map<string, Uint8Array>();
  readonly blowUp: BlowUp | null;
  readonly events: ProgramNote[] = [];
  /** What its reader must know: partial, cut off, damaged. */
  readonly notes: string[] = [];

  private readonly database: Database;
  private readonly chunks: Chunk[] = [];
  private readonly chunkOf: Chunk[] = []; // of each frame in times
  private readonly storedFrame: number[] = []; // frame.id of each frame in times
  private readonly markRows = new Map<number, MarkRow[]>(); // of each stored frame
  private readonly topologies = new Map<number, Topology[]>();
  private readonly cache = new Map<number, Frame[]>();
  private cached = 0;

  constructor(
    readonly name: string,
    private readonly engines: Engines,
    main: Uint8Array,
    log: Uint8Array | null,
  ) {
    const file = databaseFile(main, log);
    this.database = new engines.sql.Database(file.bytes);
    try {
      const version = Number(this.database.exec("PRAGMA user_version")[0]?.values[0]?.[0]);
      if (!(version >= 1 && version <= LATEST_VERSION)) {
        throw new UnreadableFile(`has format version ${version}, which this page does not know: it knows 1 and 2`);
      }
      for (const [key, value] of this.rows("SELECT key, value FROM meta")) this.meta.set(String(key), String(value));
      this.sceneText = String(this.rows("SELECT text FROM scene")[0]?.[0] ?? "");
      for (const [name, kind, nodes] of this.rows("SELECT name, kind, nodes FROM body ORDER BY id")) {
        this.bodies.push({ name: String(name), isCloth: kind === "cloth", nodes: Number(nodes) });
      }
      if (this.meta.get("byte_order") !== "little" || this.sceneText === "" || this.bodies.length === 0) {
        throw new UnreadableFile("has no scene or no bodies: the file is damaged");
      }
      this.readTopologies();
      this.blowUp = this.readBlowUp();
      this.readFrames(file.missing > 0);
      this.readMetrics(file.missing > 0);
      this.readAssets();
      this.readMarks(file.missing > 0);
    } catch (error) {
      this.close();
      if (error instanceof UnreadableFile) throw error;
      const missing = file.missing > 0 ? `, ${sizeText(file.missing)} are missing at its end` : "";
      throw new UnreadableFile(`cannot be read${missing}: the file is damaged (${(error as Error).message})`);
    }
    this.noteState(file.missing, file.lacksLog);
  }

  get finished(): boolean {
    return this.meta.get("finished") === "yes";
  }

  /** "bullet_weft float32", or as much of it as is known. */
  get engine(): string {
    const engine = this.meta.get("provenance.engine");
    return engine ? `${engine} ${this.meta.get("precision") ?? ""}`.trim() : "";
  }

  /** [m] by which rounding may have moved a coordinate; 0 for the engine's own numbers. */
  get positionError(): number {
    return Number(this.meta.get("position_error_m") ?? 0);
  }

  close(): void {
    this.database.close();
    this.cache.clear();
  }

  /** The frame whose time is nearest. */
  nearest(time: number): number {
    let low = 0;
    let high = this.times.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if ((this.times[middle] ?? 0) <= time) low = middle;
      else high = middle;
    }
    const isLow = Math.abs((this.times[low] ?? 0) - time) <= Math.abs((this.times[high] ?? 0) - time);
    return isLow ? low : high;
  }

  frame(index: number): Frame {
    const chunk = this.chunkOf[index];
    if (!chunk) throw new RangeError(`frame ${index} is not there`);
    let frames = this.cache.get(chunk.id);
    if (!frames) {
      frames = this.decode(chunk);
      this.cached += bytesOf(frames);
    }
    // Again at the end: what was used last goes last.
    this.cache.delete(chunk.id);
    this.cache.set(chunk.id, frames);
    for (const [id, old] of this.cache) {
      if (this.cached <= CACHE || id === chunk.id) break;
      this.cached -= bytesOf(old);
      this.cache.delete(id);
    }
    const frame = frames[this.storedFrame[index]! - chunk.first];
    if (!frame) throw new RangeError(`frame ${index} is not in its chunk`);
    return frame;
  }

  /** What a cloth consists of in a frame; null: of what the scene says. */
  topology(body: number, index: number): Topology | null {
    const stored = this.storedFrame[index] ?? 0;
    return this.topologyAt(body, stored);
  }

  private topologyAt(body: number, stored: number): Topology | null {
    return this.topologies.get(body)?.filter((topology) => topology.firstFrame <= stored).at(-1) ?? null;
  }

  private rows(sql: string): SqlValue[][] {
    return this.database.exec(sql)[0]?.values ?? [];
  }

  private blob(sql: string, id: number): Uint8Array {
    const value = this.database.exec(sql, [id])[0]?.values[0]?.[0];
    if (!(value instanceof Uint8Array)) throw new Error("the data are not there");
    return value;
  }

  private has(table: string): boolean {
    return this.rows(`SELECT 1 FROM sqlite_master WHERE type = 'table' AND name = '${table}'`).length > 0;
  }

  private readTopologies(): void {
    if (!this.has("topology")) return;
    for (const row of this.rows("SELECT id, first_frame, body, nodes, raw_bytes, hash FROM topology ORDER BY id")) {
      const [id, firstFrame, body, nodes, rawBytes] = row.slice(0, 5).map(Number) as [number, number, number, number, number];
      const data = this.blob("SELECT data FROM topology WHERE id = ?", id);
      if (this.engines.hash(data) !== row[5]) throw new Error(`topology ${id} does not have its hash`);
      const words = new Uint32Array(unshuffled(data, rawBytes, 4));
      const added = nodes - (this.bodies[body]?.nodes ?? nodes);
      const list = this.topologies.get(body) ?? [];
      list.push({
        firstFrame,
        nodes,
        triangles: words.subarray(0, words.length - added),
        origins: words.subarray(words.length - added),
      });
      this.topologies.set(body, list);
    }
  }

  private readBlowUp(): BlowUp | null {
    const row = this.rows("SELECT time_s, body, node, reason FROM event WHERE kind = 'blow_up'")[0];
    return row ? { time: Number(row[0]), body: String(row[1]), node: Number(row[2]), reason: String(row[3]) } : null;
  }

  /** Rows until the first that cannot be read: behind the end of a file that is cut off there is nothing. */
  private rowsThatAreThere(sql: string, isCut: boolean): SqlValue[][] {
    if (!isCut) return this.rows(sql);
    const rows: SqlValue[][] = [];
    const statement = this.database.prepare(sql);
    try {
      while (statement.step()) rows.push(statement.get());
    } catch {
      // The rows so far are what is left of the table.
    }
    statement.free();
    return rows;
  }

  private isWhole(chunk: Chunk): boolean {
    try {
      return this.engines.hash(this.blob("SELECT data FROM chunk WHERE id = ?", chunk.id)) === chunk.hash;
    } catch {
      return false;
    }
  }

  private readFrames(isCut: boolean): void {
    const sql = "SELECT id, first_frame, num_frames, codec, raw_bytes, hash FROM chunk ORDER BY id";
    const damaged: Chunk[] = [];
    for (const row of this.rowsThatAreThere(sql, isCut)) {
      const [id, first, count] = row.slice(0, 3).map(Number) as [number, number, number];
      const chunk = { id, first, count, codec: String(row[3]), rawBytes: Number(row[4]), hash: String(row[5]) };
      (this.isWhole(chunk) ? this.chunks : damaged).push(chunk);
    }
    const whole = new Map(this.chunks.map((chunk) => [chunk.id, chunk]));
    for (const [id, time, chunkId] of this.rowsThatAreThere("SELECT id, time_s, chunk FROM frame ORDER BY id", isCut)) {
      const chunk = whole.get(Number(chunkId));
      if (!chunk) continue;
      this.times.push(Number(time));
      this.chunkOf.push(chunk);
      this.storedFrame.push(Number(id));
    }
    if (!isCut) {
      for (const { first, count } of damaged) {
        this.notes.push(`Frames ${first} to ${first + count - 1} are damaged (they do not have their hash) and left out.`);
      }
    }
  }

  private readMetrics(isCut: boolean): void {
    const byName = new Map<string, Metric>();
    for (const [name, time, value] of this.rowsThatAreThere("SELECT name, time_s, value FROM metric ORDER BY id", isCut)) {
      const metric = byName.get(String(name)) ?? { name: String(name), times: [], values: [] };
      byName.set(metric.name, metric);
      metric.times.push(Number(time));
      metric.values.push(value === null ? NaN : Number(value));
    }
    this.metrics.push(...byName.values());
  }

  private readAssets(): void {
    if (!this.has("asset")) return;
    for (const [name, data] of this.rows("SELECT name, data FROM asset")) {
      if (data instanceof Uint8Array) this.assets.set(String(name), data);
    }
  }

  private readMarks(isCut: boolean): void {
    const notes = "SELECT time_s, reason FROM event WHERE kind = 'note' ORDER BY id";
    for (const [time, text] of this.rowsThatAreThere(notes, isCut)) this.events.push({ time: Number(time), text: String(text) });
    if (!this.has("mark")) return;
    const sql = "SELECT id, frame, color, raw_bytes, name, kind, hash FROM mark ORDER BY id";
    for (const row of this.rowsThatAreThere(sql, isCut)) {
      const [id, frame, colour, rawBytes] = row.slice(0, 4).map(Number) as [number, number, number, number];
      const list = this.markRows.get(frame) ?? [];
      list.push({ id, frame, colour, rawBytes, name: String(row[4]), kind: String(row[5]), hash: String(row[6]) });
      this.markRows.set(frame, list);
    }
  }

  /** What a frame shows beside its bodies; what is damaged is left out. */
  marks(index: number): Mark[] {
    const rows = this.markRows.get(this.storedFrame[index] ?? -1) ?? [];
    return rows.flatMap((row) => {
      try {
        const data = this.blob("SELECT data FROM mark WHERE id = ?", row.id);
        return this.engines.hash(data) === row.hash ? [decodeMark(row, data)] : [];
      } catch {
        return [];
      }
    });
  }

  private noteState(missing: number, lacksLog: boolean): void {
    const last = this.times.at(-1);
    const reach = last === undefined ? "no frame" : `${this.times.length} frames, to t = ${Number(last.toPrecision(6))} s`;
    if (missing > 0) this.notes.push(`The file is cut off: ${sizeText(missing)} are missing at its end. Shown: ${reach}.`);
    if (!this.finished) {
      const log = lacksLog ? " The newest frames may be in the file of the same name with “-wal” at its end: drop both together." : "";
      this.notes.push(`A partial recording: its run has not ended or was stopped. Shown: ${reach}.${log}`);
    }
    if (this.blowUp) {
      const { time, body, node, reason } = this.blowUp;
      this.notes.push(`The simulation blew up at t = ${Number(time.toPrecision(6))} s: ${body}, node ${node}: ${reason}.`);
    }
    for (const { time, text } of this.events) this.notes.push(`t = ${Number(time.toPrecision(6))} s: ${text}`);
    if (last === undefined && missing === 0) this.notes.push("The recording has no frame yet.");
  }

  private layoutAt(stored: number): Layout {
    const layout: Layout = { clothNodes: [], rigids: 0 };
    this.bodies.forEach((body, i) => {
      if (!body.isCloth) layout.rigids += 1;
      else layout.clothNodes.push(this.topologyAt(i, stored)?.nodes ?? body.nodes);
    });
    return layout;
  }

  private decode(chunk: Chunk): Frame[] {
    const data = this.blob("SELECT data FROM chunk WHERE id = ?", chunk.id);
    switch (chunk.codec) {
      case "shuffle+zstd": {
        const layouts = Array.from({ length: chunk.count }, (_, i) => this.layoutAt(chunk.first + i));
        return decodeFull(data, chunk.rawBytes, this.meta.get("precision") === "float64" ? 8 : 4, layouts);
      }
      case "positions+zstd":
        return decodeRounded(data, chunk.rawBytes, 2 * this.positionError, this.layoutAt(chunk.first), chunk.count);
      default:
        throw new UnreadableFile(`has frames in the codec “${chunk.codec}”, which this page does not know`);
    }
  }
}
