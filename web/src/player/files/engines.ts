// What reads recordings, made once: SQLite and the hash, both compiled to WebAssembly, inside the page.
import { createXXHash128, type IHasher } from "hash-wasm";
import initSqlJs, { type SqlJsStatic } from "sql.js";
import wasmUrl from "sql.js/dist/sql-wasm-browser.wasm?url";

import { fromBase64 } from "./bytes";

export interface Engines {
  sql: SqlJsStatic;
  /** XXH3-128 as 32 hexadecimal digits. */
  hash: (bytes: Uint8Array) => string;
}

async function make(): Promise<Engines> {
  const base64 = wasmUrl.slice(wasmUrl.indexOf(",") + 1);
  const [sql, hasher] = await Promise.all([
    initSqlJs({ wasmBinary: fromBase64(base64).buffer } as Parameters<typeof initSqlJs>[0]),
    createXXHash128(),
  ]);
  return { sql, hash: (bytes) => (hasher as IHasher).init().update(bytes).digest("hex") };
}

let made: Promise<Engines> | undefined;

export function engines(): Promise<Engines> {
  made ??= make();
  return made;
}
