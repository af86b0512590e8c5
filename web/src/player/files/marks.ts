// What a program has drawn into a frame beside its bodies: the rows of table mark (docs/recording_format.md).
import { unshuffled } from "./chunk_codec";

export type MarkKind = "points" | "lines" | "arrows";

export interface MarkRow {
  id: number;
  frame: number;
  name: string;
  kind: string;
  /** 0xRRGGBB */
  colour: number;
  rawBytes: number;
  hash: string;
}

export interface Mark {
  name: string;
  kind: MarkKind;
  colour: number;
  /** [m], x y z of each point, or where lines and arrows begin. */
  from: Float32Array;
  /** [m], where they end; empty for points. */
  to: Float32Array;
}

const KINDS: readonly string[] = ["points", "lines", "arrows"];

export function decodeMark(row: MarkRow, data: Uint8Array): Mark {
  if (!KINDS.includes(row.kind)) throw new Error(`mark ${row.id} is of a kind that is not known: ${row.kind}`);
  const kind = row.kind as MarkKind;
  const values = new Float32Array(unshuffled(data, row.rawBytes, 4));
  const split = kind === "points" ? values.length : values.length / 2;
  return { name: row.name, kind, colour: row.colour, from: values.subarray(0, split), to: values.subarray(split) };
}
