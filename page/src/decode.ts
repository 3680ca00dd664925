// How the arrays come out of the page: base64, raw deflate, then byte planes, zigzag and differences undone.

import { DataUtils } from "./three";
import type { ArrayEntry, Meta } from "./meta.ts";

export type Numbers = Uint8Array | Uint16Array | Uint32Array | Int16Array | Int32Array | Float32Array;

/** Columns one after the other: `values[column * rows + row]`. */
export interface Table {
  rows: number;
  columns: number;
  values: Numbers;
}

/** The arrays of the page, each decoded when it is first asked for. */
export class Arrays {
  private readonly done = new Map<string, Table>();

  constructor(private readonly bytes: Uint8Array, private readonly entries: Meta["arrays"]) {}

  has(name: string): boolean {
    return name in this.entries;
  }

  get(name: string): Table {
    let table = this.done.get(name);
    if (!table) {
      const entry = this.entries[name];
      if (!entry) throw new Error(`the page has no array ${name}`);
      table = decode(this.bytes.subarray(entry.offset, entry.offset + entry.bytes), entry);
      this.done.set(name, table);
    }
    return table;
  }
}

export function readMeta(): Meta {
  const meta = JSON.parse(text("meta")) as Meta;
  if (meta.format !== 1) throw new Error(`the data have format ${meta.format}, this page reads 1`);
  return meta;
}

export async function readArrays(meta: Meta, from = "data"): Promise<Arrays> {
  const packed = fromBase64(text(from));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  return new Arrays(new Uint8Array(await new Response(stream).arrayBuffer()), meta.arrays);
}

export function text(id: string): string {
  const element = document.getElementById(id);
  if (!element) throw new Error(`the page has no data "${id}"`);
  return element.textContent ?? "";
}

function fromBase64(coded: string): Uint8Array<ArrayBuffer> {
  const binary = atob(coded.trim());
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i++) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

/** One array; exported for the tests. */
export function decode(bytes: Uint8Array, entry: ArrayEntry): Table {
  const rows = entry.shape[0];
  const columns = entry.shape.length > 1 ? entry.shape[1] : 1;
  const size = Number(entry.dtype[1]);
  const count = rows * columns;
  if (bytes.length !== count * size) throw new Error(`an array of ${count} values has ${bytes.length} bytes`);
  let values: Numbers;
  if (size === 1) {
    values = bytes.slice();
  } else {
    const joined = new Uint8Array(count * size);
    for (let k = 0; k < size; k++) {
      const plane = bytes.subarray(k * count, (k + 1) * count);
      for (let i = 0; i < count; i++) joined[i * size + k] = plane[i];
    }
    values = size === 2 ? new Uint16Array(joined.buffer) : new Uint32Array(joined.buffer);
  }
  if (entry.filter.endsWith("_z")) {
    for (let i = 0; i < count; i++) values[i] = (values[i] >>> 1) ^ -(values[i] & 1);
  }
  const times = entry.filter.startsWith("delta2") ? 2 : entry.filter.startsWith("delta") ? 1 : 0;
  for (let time = 0; time < times; time++) {
    for (let c = 0; c < columns; c++) {
      for (let i = c * rows + 1; i < (c + 1) * rows; i++) values[i] += values[i - 1];
    }
  }
  if (entry.dtype === "i2") values = new Int16Array(values.buffer);
  if (entry.dtype === "i4") values = new Int32Array(values.buffer);
  if (entry.dtype === "f2") values = Float32Array.from(values, (bits) => DataUtils.fromHalfFloat(bits));
  return { rows, columns, values };
}
